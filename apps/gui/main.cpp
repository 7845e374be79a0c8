// searchlight-gui: the window.
#include <QApplication>

#include "gui/window/main_window.h"
#include "gui/window/theme.h"

int main(int argc, char** argv) {
    using namespace searchlight::gui;
    const QApplication application(argc, argv);
    Theme theme;
    theme.apply(Theme::Mode::dark);
    Workspace workspace;
    Tasks tasks;
    Notices notices;
    Trace trace;
    Desk desk{workspace, tasks, theme, notices, trace};
    MainWindow window(desk);
    window.openPaths(QApplication::arguments().mid(1));
    window.show();
    return QApplication::exec();
}
