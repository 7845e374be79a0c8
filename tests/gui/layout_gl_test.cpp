// What stands where: nothing is cut off on a small screen, docks come to the front, maps are read.
#include <QAction>
#include <QComboBox>
#include <QDockWidget>
#include <QFile>
#include <QPushButton>
#include <QScrollArea>
#include <QToolButton>

#include "gui/kernel/kernel_options.h"
#include "gui/plot/figure_view.h"
#include "gui/plot/option_bar.h"
#include "gui/plot/plot_options.h"
#include "gui/view/object_view.h"
#include "gui/window/docks.h"
#include "window_fixture.h"

namespace searchlight::gui {
namespace {

class LayoutTest : public WindowTest {
protected:
    std::unique_ptr<MainWindow> shown(QSize size) {
        auto window = std::make_unique<MainWindow>(desk, QString(), size);
        window->show();
        QTest::qWait(20);
        return window;
    }
};

TEST_F(LayoutTest, NoChosenNameIsCutOff) {
    for (const int width : {1024, 1280, 1440, 1920}) {
        const auto window = shown({width, 800});
        EXPECT_EQ(window->width(), width) << "the docks leave it that small";
        for (const QComboBox* box : window->findChildren<QComboBox*>()) {
            if (!box->isVisible() || box->parentWidget()->visibleRegion().isEmpty()) continue;
            if (qobject_cast<OptionBar*>(box->parentWidget())) {
                EXPECT_EQ(box->visibleRegion().boundingRect().size(), box->size())
                    << box->accessibleName().toStdString();
            }
            const int room = box->width() - 2 * 11 - 22 - (box->itemIcon(box->currentIndex()).isNull() ? 0 : 20);
            EXPECT_GE(room, box->fontMetrics().horizontalAdvance(box->currentText()))
                << box->currentText().toStdString() << " at " << width;
        }
    }
}

TEST_F(LayoutTest, TheKernelDockKeepsItsSizeWhateverItShows) {
    const auto window = shown({1280, 800});
    EXPECT_TRUE(window->showDock("kernel"));
    const QSize before = window->dock("kernel")->size();
    for (const char* method : {"manual", "preintegrated"})
        for (const char* view : {"curves", "edge", "pictures", "table"}) {
            workspace.setOption(QStringLiteral("Kernel"), "kernel", "method", std::string(method));
            workspace.setOption(QStringLiteral("Kernel"), "kernel", "view", std::string(view));
            QTest::qWait(20);
            EXPECT_EQ(window->dock("kernel")->size(), before) << method << " " << view;
            EXPECT_EQ(window->width(), 1280);
            if (std::string(method) != "manual") continue;
            auto* fit = find<QPushButton>(window.get(), "kernel.fit");
            EXPECT_EQ(fit->visibleRegion().boundingRect().size(), fit->size()) << view;
        }
}

TEST_F(LayoutTest, ADockBehindAnotherTabComesToTheFrontBeforeItIsClosed) {
    const auto window = shown({1280, 800});
    auto* action = find<QAction>(window.get(), "show.lights");
    QDockWidget* dock = window->dock("lights");
    const auto is_seen = [&] { return !dock->widget()->visibleRegion().isEmpty(); };
    EXPECT_FALSE(is_seen());
    action->trigger();
    EXPECT_TRUE(waitUntil(is_seen, 2000));
    EXPECT_TRUE(action->isChecked());
    action->trigger();
    EXPECT_TRUE(dock->isHidden());
    EXPECT_FALSE(action->isChecked());
    action->trigger();
    EXPECT_TRUE(waitUntil(is_seen, 2000));
    EXPECT_FALSE(window->showDock("no such"));
}

TEST_F(LayoutTest, WelcomeStandsBesideTheObjectAndFollowsTheTheme) {
    for (const QSize size : {QSize(1280, 800), QSize(1440, 900), QSize(1920, 1080)}) {
        theme.apply(Theme::Mode::dark);
        const auto window = shown(size);
        QFrame* card = nullptr;
        for (QFrame* each : window->findChildren<QFrame*>("card"))
            if (each->accessibleName() == "Welcome") card = each;
        ASSERT_TRUE(card && card->isVisible());
        const QRect view = window->view().rect(), taken = card->geometry();
        EXPECT_TRUE(view.contains(taken)) << size.width();
        // What the first start shows.
        const QRect middle(view.center().x() - view.height() / 5, view.height() / 4, 2 * view.height() / 5,
                           view.height() / 2);
        EXPECT_FALSE(middle.intersects(taken)) << size.width();
        const auto icon = [&] { return card->findChildren<QToolButton*>().back()->icon().pixmap(20, 20).toImage(); };
        const QImage dark = icon();
        theme.apply(Theme::Mode::light);
        EXPECT_NE(icon(), dark);
    }
}

TEST_F(LayoutTest, TheCursorReadsEachMapOfTheSurface) {
    workspace.setOption(QStringLiteral("Plot"), "plot", "view", std::string("slice"));
    const auto window = shown({1440, 900});
    auto* plot = find<FigureView>(window.get(), "plot.figure");
    ASSERT_TRUE(waitUntil([&] { return plot->figure().panels.size() == 4; }, 60'000));
    QStringList read;
    const auto reads = [&] {
        for (int x = 10; x < plot->width() && read.isEmpty(); x += 10) {
            QMouseEvent move(QEvent::MouseMove, QPointF(x, plot->height() / 2), QPointF(), Qt::NoButton, Qt::NoButton,
                             Qt::NoModifier);
            QApplication::sendEvent(plot, &move);
            read = plot->readOut();
        }
        return !read.isEmpty();
    };
    // Maps are painted beside the window, some time after their figure is there.
    ASSERT_TRUE(waitUntil(reads, 60'000));
    ASSERT_EQ(read.size(), 5) << "the place and four maps";
    EXPECT_TRUE(read[0].contains("mm"));
    for (int i = 1; i < 5; ++i) {
        const std::string& title = plot->figure().panels[static_cast<std::size_t>(i - 1)].title;
        EXPECT_EQ(read[i].section('\t', 0, 0).toStdString(), title);
        EXPECT_GT(read[i].section('\t', 1).section(' ', 0, 0).toDouble(), 0) << title;
    }
}

// The flags are those of the command: a command that is copied and run must not be refused.
TEST_F(LayoutTest, CommandsOfDocksNameScaleAndParameters) {
    workspace.edit(QStringLiteral("Material"), {}, [](State& state) {
        state.scene.material = {.id = "", .Rdr = {0.6}, .ld = {1}, .scale = 2};
        state.models[0].model.parameters["Moments"] = std::string("exact");
    });
    workspace.setOption(QStringLiteral("Kernel"), "kernel", "truth", std::string("model"));
    const QString kernel = kernelCommandLine(workspace.state()), plot = plotCommandLine(workspace.state());
    for (const QString& line : {kernel, plot}) {
        EXPECT_TRUE(line.contains("--material-scale 2")) << line.toStdString();
        EXPECT_TRUE(line.contains("--Rdr 0.6 --ld 1")) << line.toStdString();
        // The window inverts by the active model, the command would by the dipole.
        EXPECT_TRUE(line.contains("--inverted-by better_dipole:Moments=exact")) << line.toStdString();
    }
    EXPECT_TRUE(kernel.contains("--set Moments=exact")) << kernel.toStdString();
    EXPECT_TRUE(plot.contains("better_dipole:Moments=exact")) << plot.toStdString();
    const std::string program = SEARCHLIGHT_BINARY_DIR "/bin/searchlight";
    if (!QFile::exists(QString::fromStdString(program))) GTEST_SKIP() << "the command line is not built";
    for (const QString& line : {kernel, plot}) {
        const std::string command =
            program + line.mid(QStringLiteral("searchlight").size()).toStdString() + " --print-job > /dev/null";
        EXPECT_EQ(std::system(command.c_str()), 0) << line.toStdString();
    }
}

}  // namespace
}  // namespace searchlight::gui
