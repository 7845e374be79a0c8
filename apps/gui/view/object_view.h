// The object under the light: the engine's picture, and the mouse and keys that turn it.
#pragma once

#include <QPointF>
#include <QWidget>

#include "gui/view/picture_service.h"
#include "gui/window/desk.h"

namespace searchlight::gui {

/// Drag orbits; with the right button, or Ctrl, it turns the light; with the middle button, or Shift, it moves the
/// object; the wheel zooms. Arrow keys do the same.
class ObjectView : public QWidget {
    Q_OBJECT

public:
    explicit ObjectView(Desk& desk, QWidget* parent = nullptr);

    PictureService& pictures() { return pictures_; }

    /// The camera as at the start, whatever the object.
    void frame();

    QSize sizeHint() const override { return {900, 620}; }

protected:
    void paintEvent(QPaintEvent* event) override;
    void resizeEvent(QResizeEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;
    void wheelEvent(QWheelEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;
    void changeEvent(QEvent* event) override;
    void focusInEvent(QFocusEvent* event) override;

private:
    enum class Drag { none, orbit, light, pan, wipe };

    void orbit(QPointF degrees);
    void turnLight(QPointF degrees);
    void pan(QPointF pixels);
    void zoom(double factor);
    void setWipe(double at);
    bool comparing() const;
    bool wiping() const;
    double wipeX() const;
    void paintLabels(QPainter& painter);
    void paintScale(QPainter& painter);
    QString statusText(bool spoken) const;

    Desk& desk_;
    PictureService pictures_;
    QString error_;
    Drag drag_ = Drag::none;
    QPointF last_;
    bool by_keys_ = false;  ///< the focus came by the keyboard, and is drawn
};

}  // namespace searchlight::gui
