// A person without a plan: seeded clicks, drags, keys, drops and edits on the real window.
#pragma once

#include <gtest/gtest.h>

#include <QAbstractButton>
#include <QApplication>
#include <QDockWidget>
#include <QDragEnterEvent>
#include <QDropEvent>
#include <QLineEdit>
#include <QMimeData>
#include <QPointer>
#include <QSlider>
#include <QTemporaryDir>
#include <QTest>
#include <QTimer>
#include <QUrl>
#include <cstdio>
#include <ctime>
#include <random>

#include "base/files.h"
#include "gui/window/main_window.h"

namespace searchlight::gui {

class RandomUser {
public:
    RandomUser(MainWindow& window, Desk& desk, unsigned seed) : window_(window), desk_(desk), random_(seed) {
        makeFiles();
        // Dialogs are closed as they open: nobody is there to answer.
        closer_.setInterval(5);
        QObject::connect(&closer_, &QTimer::timeout, [] {
            if (QWidget* dialog = QApplication::activeModalWidget()) dialog->close();
            if (QWidget* popup = QApplication::activePopupWidget()) popup->close();
        });
        closer_.start();
    }

    void act() {
        switch (pick(10)) {
            case 0:
            case 1: click(); break;
            case 2:
            case 3: drag(); break;
            case 4: slide(); break;
            case 5: key(); break;
            case 6: drop(); break;
            case 7: type(); break;
            case 8: (pick(2) ? desk_.workspace.undoStack().undo() : desk_.workspace.undoStack().redo()); break;
            default: arrange(); break;
        }
        // CPU time of the window's thread: on a busy machine the clock on the wall counts other programs.
        const double before = threadMs();
        QApplication::processEvents();
        const double ms = threadMs() - before;
        longest_ms = std::max(longest_ms, ms);
        if (ms > 100) ++blocked;
    }

    double longest_ms = 0;
    int blocked = 0;  ///< times that handling events took more than 100 ms

private:
    static double threadMs() {
        timespec time{};
        clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
        return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
    }

    int pick(int count) { return static_cast<int>(random_() % static_cast<unsigned>(count)); }

    void makeFiles() {
        const std::pair<const char*, const char*> files[] = {
            {"empty.obj", ""},
            {"noise.ply", "ply\nformat ascii 1.0\nelement vertex 99999999\nproperty float x\nend_header\n1"},
            {"short.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 9 +X 9\n"},
            {"no.exr", "v/1\1 nothing"},
            {"broken.bssrdf", "analytic radial no_wi no_wo\n::begin shader\nvec3 Bssrdf(\n::end shader\n"},
            {"table.csv", "r_mm, R_d\n0, 1\n0.5, 0.2\n2, 0.01\n"},
            {"bad.json", "{\"format\": \"searchlight-job/1\", \"command\": \"render\", \"scene\": {\"scale\": -1}}"},
            {"tetra.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"},
            {"what.xyz", "?"}};
        for (const auto& [name, text] : files) {
            writeFile(folder_.filePath(name).toStdString(), text);
            paths_ << folder_.filePath(name);
        }
        paths_ << QString(SEARCHLIGHT_SOURCE_DIR "/examples/gallery/studio.hdr") << folder_.filePath("missing.obj");
    }

    QWidget* someWidget() {
        QList<QWidget*> all;
        for (QWidget* each : window_.findChildren<QWidget*>())
            if (each->isVisible() && each->isEnabled() && each->width() > 2 && each->height() > 2) all << each;
        return all.isEmpty() ? &window_ : all[pick(static_cast<int>(all.size()))];
    }

    QPoint somewhere(QWidget* widget) { return {pick(widget->width()), pick(widget->height())}; }

    void click() {
        QPointer<QWidget> widget = someWidget();
        const Qt::MouseButton button = pick(8) ? Qt::LeftButton : Qt::RightButton;
        QTest::mousePress(widget, button, {}, somewhere(widget));
        if (widget) QTest::mouseRelease(widget, button, {}, somewhere(widget));
    }

    void drag() {
        QPointer<QWidget> widget = pick(2) ? window_.findChild<QWidget*>("object_view") : someWidget();
        const Qt::MouseButton button = pick(3) ? Qt::LeftButton : Qt::RightButton;
        QTest::mousePress(widget, button, {}, somewhere(widget));
        for (int i = 0; i < 4 && widget; ++i) QTest::mouseMove(widget, somewhere(widget));
        if (widget) QTest::mouseRelease(widget, button, {}, somewhere(widget));
    }

    void slide() {
        const auto sliders = window_.findChildren<QSlider*>();
        QPointer<QSlider> slider = sliders[pick(static_cast<int>(sliders.size()))];
        for (int i = 0; i < 6 && slider; ++i) slider->setValue(pick(1001));
    }

    void key() {
        constexpr Qt::Key keys[] = {Qt::Key_Left,   Qt::Key_Right,  Qt::Key_Up,   Qt::Key_Down,
                                    Qt::Key_Plus,   Qt::Key_F,      Qt::Key_Tab,  Qt::Key_Space,
                                    Qt::Key_Escape, Qt::Key_Return, Qt::Key_Minus};
        constexpr Qt::KeyboardModifier modifiers[] = {Qt::NoModifier, Qt::ControlModifier, Qt::ShiftModifier};
        QTest::keyClick(someWidget(), keys[pick(std::size(keys))], modifiers[pick(3)]);
    }

    void drop() {
        QMimeData data;
        QList<QUrl> urls;
        for (int i = 0; i <= pick(2); ++i) urls << QUrl::fromLocalFile(paths_[pick(static_cast<int>(paths_.size()))]);
        data.setUrls(urls);
        QDropEvent event({100, 100}, Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
        QApplication::sendEvent(&window_, &event);
    }

    void type() {
        QPointer<QLineEdit> field;
        const auto fields = window_.findChildren<QLineEdit*>();
        field = fields[pick(static_cast<int>(fields.size()))];
        const char* const texts[] = {"0", "-1", "1e9", "nan", "0.5", "abc", "", "1,2,3", "1e-30", "skin"};
        if (!field->isVisible()) return;
        field->setFocus();
        field->selectAll();
        QTest::keyClicks(field, texts[pick(std::size(texts))]);
        if (field) QTest::keyClick(field, Qt::Key_Return);
    }

    void arrange() {
        const auto docks = window_.findChildren<QDockWidget*>();
        QDockWidget* dock = docks[pick(static_cast<int>(docks.size()))];
        switch (pick(4)) {
            case 0: dock->setVisible(!dock->isVisible()); break;
            case 1: dock->setFloating(!dock->isFloating()); break;
            case 2: window_.resize(700 + pick(800), 500 + pick(500)); break;
            default: dock->raise(); break;
        }
    }

    MainWindow& window_;
    Desk& desk_;
    std::mt19937 random_;
    QTemporaryDir folder_;
    QStringList paths_;
    QTimer closer_;
};

/// So many actions on a window of its own; what has to hold afterwards.
inline void survives(Desk& desk, int actions) {
    {
        MainWindow window(desk);
        window.resize(1100, 700);
        window.show();
        RandomUser user(window, desk, 20260101);
        for (int i = 0; i < actions; ++i) user.act();
        testing::Test::RecordProperty("longest_ms", std::to_string(user.longest_ms));
        testing::Test::RecordProperty("blocked", user.blocked);
        std::printf("events took more than 100 ms %d times, longest %.0f ms\n", user.blocked, user.longest_ms);
        const State& state = desk.workspace.state();
        EXPECT_FALSE(state.models.empty());
        EXPECT_NO_THROW(parseWorkspace(workspaceJson(state), "after.json"));
    }
    // The window is gone while engines still work; they end, and nothing is delivered to what is no more.
    QTest::qWait(20);
}

}  // namespace searchlight::gui
