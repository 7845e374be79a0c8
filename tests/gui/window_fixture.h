// The real program without its main(): everything that a window is made of, offscreen.
#pragma once

#include <gtest/gtest.h>

#include <QApplication>
#include <QElapsedTimer>
#include <QTest>
#include <functional>

#include "gui/window/main_window.h"
#include "gui/window/theme.h"

namespace searchlight::gui {

/// One for all tests of a program: Qt may be started only once.
inline QApplication& application() {
    static int argc = 1;
    static char name[] = "test_gui";
    static char* argv[] = {name, nullptr};
    static bool prepared = [] {
        qputenv("QT_QPA_PLATFORM", "offscreen");
        return true;
    }();
    (void)prepared;
    // Never destroyed: at exit, Qt's own statics go before it.
    static auto& application = *new QApplication(argc, argv);
    return application;
}

/// Handles events until `done`, or for so many ms, many enough for a machine with other work. Whether it was done.
inline bool waitUntil(const std::function<bool()>& done, int ms = 120'000) {
    QElapsedTimer clock;
    clock.start();
    while (!done() && clock.elapsed() < ms) QTest::qWait(10);
    return done();
}

class WindowTest : public testing::Test {
protected:
    void SetUp() override {
        application();
        const std::string folder = testing::TempDir() + "gui_" + std::to_string(QCoreApplication::applicationPid());
        qputenv("XDG_CACHE_HOME", QByteArray::fromStdString(folder));
        qputenv("SEARCHLIGHT_MODELS", QByteArray::fromStdString(folder + "/models"));
        theme.apply(Theme::Mode::dark);
    }

    template <class Widget>
    Widget* find(QWidget* in, const char* name) {
        auto* found = in->findChild<Widget*>(QString::fromLatin1(name));
        EXPECT_TRUE(found) << name;
        return found;
    }

    Theme theme;
    Workspace workspace;
    Tasks tasks;
    Notices notices;
    Trace trace;
    Desk desk{workspace, tasks, theme, notices, trace};
};

}  // namespace searchlight::gui
