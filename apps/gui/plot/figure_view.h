// A Figure in the window: laid out by what also draws it on paper, at the widget's size and in the theme's colours,
// with zoom, pan and a cursor that reads values.
#pragma once

#include <QPoint>
#include <QString>
#include <QWidget>
#include <memory>
#include <optional>

#include "base/figure.h"
#include "draw/axis_map.h"
#include "draw/clip.h"
#include "gui/plot/panel_page.h"
#include "gui/window/desk.h"

namespace searchlight::gui {

class Theme;

class FigureView : public QWidget {
    Q_OBJECT

public:
    explicit FigureView(Desk& desk, QWidget* parent = nullptr);

    /// Keeps the zoom while `figure` has the same axes. A figure without series, panels and map shows `empty_text`.
    void setFigure(Figure figure, const QString& empty_text = {});
    const Figure& figure() const { return figure_; }
    bool isEmpty() const;

    /// The values of all series at the cursor's x, or of all maps at its place. Empty where nothing is read.
    QStringList readOut() const { return read_out_; }

    /// The legend stands at the right instead of where it hides least: figures beside each other look alike.
    void setLegendBeside() { legend_beside_ = true; }

    /// The range shown; none: nothing to show, or several panels.
    std::optional<FigureRange> shownRange() const;
    void resetZoom();

    QSize sizeHint() const override { return {520, 380}; }
    QSize minimumSizeHint() const override { return {260, 180}; }

protected:
    void paintEvent(QPaintEvent*) override;
    void resizeEvent(QResizeEvent*) override;
    void changeEvent(QEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseReleaseEvent(QMouseEvent*) override;
    void mouseDoubleClickEvent(QMouseEvent*) override { resetZoom(); }
    void wheelEvent(QWheelEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;
    void leaveEvent(QEvent*) override;

private:
    bool isSingle() const;
    // A small plot has no room for the y axis' label beside it.
    bool labelStandsAbove() const;
    Rect frameOf(const FigureRange& range) const;
    void zoom(double factor, QPointF about);
    void moveBy(QPointF pixels);
    void setCursor(std::optional<QPointF> at);
    void paintSingle(QPainter& painter);
    void requestPage();
    void paintPanels(QPainter& painter);
    void readPanels(QPointF at);

    Desk& desk_;
    Theme& theme_;
    Figure figure_;
    QString empty_text_;
    std::optional<FigureRange> zoomed_;
    std::optional<QPointF> cursor_;
    std::optional<QPointF> dragged_from_;
    QStringList read_out_;
    bool legend_beside_ = false;
    double legend_room_ = 0;                 ///< at the right, where it would hide curves
    std::shared_ptr<const PanelPage> page_;  ///< of a figure with panels or a map; null: none yet
};

}  // namespace searchlight::gui
