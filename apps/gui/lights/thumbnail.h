// A small picture of a picture file, read beside the window.
#pragma once

#include <QImage>
#include <QWidget>

#include "gui/window/desk.h"

namespace searchlight::gui {

class Thumbnail : public QWidget {
    Q_OBJECT

public:
    Thumbnail(Desk& desk, const QString& path, QWidget* parent = nullptr);
    QSize sizeHint() const override { return {240, 96}; }

Q_SIGNALS:
    void clicked();

protected:
    void paintEvent(QPaintEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;

private:
    Desk& desk_;
    QString path_, error_;
    QImage image_;
};

}  // namespace searchlight::gui
