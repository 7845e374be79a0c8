// A figure with panels as a widget shows it: laid out and painted on a lane's thread, because maps take longer than a
// window may be still.
#pragma once

#include <QImage>
#include <QPointF>
#include <QSize>
#include <string>
#include <vector>

#include "base/figure.h"
#include "base/observer.h"
#include "draw/drawing.h"
#include "draw/paint_qt.h"

namespace searchlight::gui {

struct PanelPage {
    QImage image;                    ///< transparent but for the figure
    QSize size;                      ///< of the widget that it was made for
    double scale = 1;                ///< from the figure's px to the widget's
    QPointF offset;                  ///< of the figure in the widget
    std::vector<PanelFrame> frames;  ///< on the figure
    std::string problem;             ///< why it cannot be laid out; empty: it is
};

/// The columns and the width of the page that fill a widget of that size best; below 0.7 of its size text cannot be
/// read. The caption is for paper. `ratio`: device pixels per pixel of the widget. Any thread. Throws
/// interruptedError() when cancelled.
PanelPage makePanelPage(Figure figure, QSize size, double ratio, const InkFunction& ink, const Observer& observer);

}  // namespace searchlight::gui
