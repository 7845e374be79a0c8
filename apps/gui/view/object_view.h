// The object under the light: the engine's picture, orbit, zoom.
#pragma once

#include <QImage>
#include <QWidget>

#include "gui/window/desk.h"

namespace searchlight::gui {

class ObjectView : public QWidget {
    Q_OBJECT

public:
    explicit ObjectView(Desk& desk, QWidget* parent = nullptr);

protected:
    void paintEvent(QPaintEvent* event) override;

private:
    Desk& desk_;
    QImage picture_;
};

}  // namespace searchlight::gui
