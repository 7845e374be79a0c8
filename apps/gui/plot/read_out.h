// What the cursor reads from a figure: its place, and a value of each curve or map there.
#pragma once

#include <QColor>
#include <QPointF>
#include <QRectF>
#include <QStringList>

#include "base/figure.h"

class QPainter;

namespace searchlight::gui {

class Theme;

/// The axis' value, then "name\tvalue" of each series of the legend that has one there.
QStringList readSeries(const Figure& figure, double x);

/// The place, then "title\tvalue" of each panel's map (of the figure's own, without panels) that has a cell there, with
/// its standard error. x and y as the map has them (base/figure.h).
QStringList readMaps(const Figure& figure, double x, double y);

/// In a box beside `at`, within `frame`.
void paintReadOut(QPainter& painter, const Theme& theme, const QStringList& lines, QPointF at, const QRectF& frame);

}  // namespace searchlight::gui
