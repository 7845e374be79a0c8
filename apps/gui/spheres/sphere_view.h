// Pictures of spheres side by side, which turn together.
#pragma once

#include <QImage>
#include <QStringList>
#include <QWidget>

#include "gui/window/desk.h"

namespace searchlight::gui {

class SphereView : public QWidget {
    Q_OBJECT

public:
    explicit SphereView(Desk& desk, QWidget* parent = nullptr);

    struct Panel {
        QString title, note;
        QImage picture;  ///< null: none yet
    };
    void setPanels(QList<Panel> panels, const QString& empty_text);
    const QList<Panel>& panels() const { return panels_; }

    /// Side of one picture for so many panels, device pixels.
    int pictureSide(int panels) const;

    QSize sizeHint() const override { return {620, 280}; }
    QSize minimumSizeHint() const override { return {240, 140}; }

Q_SIGNALS:
    void resized();

protected:
    void paintEvent(QPaintEvent*) override;
    void resizeEvent(QResizeEvent*) override { emit resized(); }
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mouseReleaseEvent(QMouseEvent*) override;
    void keyPressEvent(QKeyEvent* event) override;

private:
    void turn(double right_deg, double up_deg);

    Desk& desk_;
    QList<Panel> panels_;
    QString empty_text_;
    QPointF last_;
    bool turning_ = false;
};

}  // namespace searchlight::gui
