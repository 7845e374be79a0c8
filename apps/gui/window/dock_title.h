// The title bar of a dock: its name, and buttons that pop it out and close it.
#pragma once

#include <QWidget>

class QDockWidget;

namespace searchlight::gui {

class Theme;

class DockTitle : public QWidget {
    Q_OBJECT

public:
    DockTitle(Theme& theme, QDockWidget* dock);
};

}  // namespace searchlight::gui
