// searchlight-gui: the window.
#include <QApplication>
#include <QCommandLineParser>
#include <QDir>
#include <QElapsedTimer>
#include <QStandardPaths>
#include <QTimer>
#include <cstdio>

#include "base/error.h"
#include "base/version.h"
#include "gui/state/recovery.h"
#include "gui/window/docks.h"
#include "gui/window/main_window.h"
#include "gui/window/theme.h"
#include "gui/window/tracer.h"

namespace {

using namespace searchlight::gui;

Theme::Mode modeOf(const QString& text) {
    if (text == "light") return Theme::Mode::light;
    return text == "system" ? Theme::Mode::system : Theme::Mode::dark;
}

QStringList dockIds() {
    QStringList ids;
    for (const DockEntry& entry : docks()) ids << entry.id;
    return ids;
}

QSize sizeOf(const QString& text) {
    const QStringList sides = text.split('x');
    const QSize size = sides.size() == 2 ? QSize(sides[0].toInt(), sides[1].toInt()) : QSize();
    if (size.isEmpty()) throw searchlight::inputError(("no size: " + text).toStdString(), "WIDTHxHEIGHT, as 1440x900");
    return size;
}

void say(const QString& text) { std::fputs(text.toUtf8().constData(), stdout); }

}  // namespace

int main(int argc, char** argv) {
    QElapsedTimer started;
    started.start();
    QApplication application(argc, argv);
    QApplication::setApplicationName("Searchlight");
    QApplication::setDesktopFileName("searchlight");
    QApplication::setApplicationVersion(QString::fromStdString(std::string(searchlight::version())));

    QCommandLineParser parser;
    parser.setApplicationDescription(
        "Turn a translucent object under a light, change its material, compare models with the reference.");
    parser.addHelpOption();
    parser.addVersionOption();
    parser.addPositionalArgument("files", "workspaces and scenes (.json), models, objects, pictures of light",
                                 "[scene.json | mesh | model.bssrdf ...]");
    const QCommandLineOption trace("trace", "print how long a person waits for what, and move a slider to see");
    const QCommandLineOption screenshot("screenshot", "write what the window shows before it is closed", "file.png");
    const QCommandLineOption quit_after("quit-after", "close the window after so many seconds", "seconds");
    const QCommandLineOption theme_option("theme", "dark, light or system, instead of the one last chosen", "name");
    const QCommandLineOption size_option("size", "of the window: WIDTHxHEIGHT, and the layout of the first start",
                                         "size");
    const QCommandLineOption fresh("fresh", "as at the first start: no remembered layout, nothing to recover");
    const QCommandLineOption show("show", "bring a dock to the front: " + dockIds().join(", ") + "; may be repeated",
                                  "dock");
    parser.addOptions({trace, screenshot, quit_after, theme_option, size_option, show, fresh});
    parser.process(application);
    QSize size;
    try {
        if (parser.isSet(size_option)) size = sizeOf(parser.value(size_option));
        for (const QString& id : parser.values(show))
            if (!dockIds().contains(id))
                throw searchlight::inputError(("there is no dock " + id).toStdString(),
                                              dockIds().join(", ").toStdString());
    } catch (const searchlight::Error& error) {
        std::fprintf(stderr, "searchlight-gui: %s\n", error.what());
        return 2;
    }

    // A run that measures or draws must not depend on what somebody did before.
    const bool remembered = !parser.isSet(fresh) && !parser.isSet(trace) && !parser.isSet(screenshot);
    const QString settings =
        remembered ? QStandardPaths::writableLocation(QStandardPaths::GenericConfigLocation) + "/searchlight/window.ini"
                   : QString();
    Theme theme;
    Workspace workspace;
    Notices notices;
    Trace events;
    // The last to be made is the first to go: no task outlives what it publishes to.
    Tasks tasks;
    Desk desk{workspace, tasks, theme, notices, events};
    theme.apply(
        modeOf(parser.isSet(theme_option) ? parser.value(theme_option) : MainWindow::rememberedTheme(settings)));
    Recovery recovery(workspace, remembered ? Recovery::userFolder() : QString());

    MainWindow window(desk, settings, size);
    Tracer tracer(desk, &window, started);
    if (const auto left = recovery.take()) {
        workspace.open(*left, {});
        notices.post(Notices::Level::info,
                     QObject::tr("What was not saved when the program last ended is here again."));
    }
    // Before it is shown: no picture is begun that nobody wants.
    window.openPaths(parser.positionalArguments());
    window.show();
    for (const QString& id : parser.values(show)) window.showDock(id);

    if (parser.isSet(trace)) tracer.exercise();
    const auto finish = [&] {
        if (parser.isSet(trace)) say(tracer.report());
        if (parser.isSet(screenshot) && !window.grab().save(parser.value(screenshot))) {
            std::fprintf(stderr, "searchlight-gui: cannot write %s\n", parser.value(screenshot).toUtf8().constData());
            return QApplication::exit(3);
        }
        QApplication::exit(0);
    };
    if (parser.isSet(quit_after))
        QTimer::singleShot(static_cast<int>(1000 * parser.value(quit_after).toDouble()), &application, finish);
    return QApplication::exec();
}
