// The kernel dock, driven as a person does. Its truth is a model, which costs no walks, but where walks are the point.
#include "gui/kernel/kernel_dock.h"

#include <QAction>
#include <QClipboard>
#include <QDir>
#include <QDockWidget>
#include <QLabel>
#include <QPushButton>
#include <QToolButton>
#include <array>

#include "gui/kernel/kernel_options.h"
#include "gui/kernel/method_table.h"
#include "gui/kernel/picture_row.h"
#include "gui/plot/figure_view.h"
#include "gui/widgets/number_slider.h"
#include "job/job.h"
#include "job/kernel/kernel_judged.h"
#include "window_fixture.h"

namespace searchlight::gui {
namespace {

constexpr int pictures_column = 2, flip_column = 4;

class KernelDockTest : public WindowTest {
protected:
    void SetUp() override {
        WindowTest::SetUp();
        set("truth", std::string("model"));
        dock.reset(makeKernelDock(desk));
        dock->resize(1100, 300);
        figures = {find<FigureView>(dock.get(), "kernel.figure"), find<FigureView>(dock.get(), "kernel.figure.second")};
        table = find<MethodTable>(dock.get(), "kernel.table");
        status = find<QLabel>(dock.get(), "kernel.status");
        dock->show();
    }
    void TearDown() override { dock.reset(); }

    void set(const char* option, ParamValue value) {
        workspace.setOption(QStringLiteral("Kernel"), "kernel", option, std::move(value));
        workspace.endGesture();
    }
    bool settled() {
        return waitUntil([&] { return dock->property("settled").toBool(); });
    }
    bool shows(const std::string& name) {
        return waitUntil([&] { return !figures[0]->isEmpty() && kernelCurve(0).label == name; });
    }
    // Of the series: the kernel comes first, the ground truth last.
    const Series& kernelCurve(std::size_t panel) const { return figures[panel]->figure().series.front(); }
    const Series& trueCurve(std::size_t panel) const { return figures[panel]->figure().series.back(); }
    QString textOf(const std::string& command) {
        Job job;
        job.command = "kernel";
        job.scene.material.id = "skin1";
        job.options = {{"method", std::string("guided")},
                       {"model", workspace.state().activeModel().model.id},
                       {"export", command}};
        return QString::fromStdString(run(job, observer).text);
    }

    Observer observer;
    std::unique_ptr<QWidget> dock;
    std::array<FigureView*, 2> figures{};
    MethodTable* table = nullptr;
    QLabel* status = nullptr;
};

TEST_F(KernelDockTest, ShowsTheKernelBesideTheTruthOnAxisAndDiagonal) {
    ASSERT_TRUE(shows("preintegrated"));
    for (const std::size_t panel : {0, 1}) {
        ASSERT_EQ(figures[panel]->figure().series.size(), 2u);
        EXPECT_EQ(trueCurve(panel).label, "ground truth");
    }
    // R_d is radial, a product of lines is not: far out it is too bright on the axis and too dark on the diagonal.
    EXPECT_EQ(trueCurve(0).y, trueCurve(1).y);
    EXPECT_GT(kernelCurve(0).y[300], trueCurve(0).y[300]);
    EXPECT_LT(kernelCurve(1).y[300], trueCurve(1).y[300]);
}

TEST_F(KernelDockTest, EveryMethodHasTheErrorsOfTheCommand) {
    ASSERT_TRUE(settled());
    Job job;
    job.command = "kernel";
    job.scene.material.id = "skin1";
    job.options = {{"all", true}, {"model", workspace.state().activeModel().model.id}};
    const QString printed = QString::fromStdString(run(job, observer).text);
    for (const NamedMethod& method : namedMethods(17)) {
        const QString name = QString::fromStdString(method.name).leftJustified(16);
        const qsizetype at = printed.indexOf(QLatin1Char('\n') + name);
        ASSERT_GE(at, 0) << method.name;
        const QString line = printed.mid(at + 1, printed.indexOf(QLatin1Char('\n'), at + 1) - at - 1);
        EXPECT_TRUE(line.contains(table->cell(method.name, pictures_column))) << line.toStdString();
        EXPECT_FALSE(table->cell(method.name, pictures_column).isEmpty()) << method.name;
        EXPECT_FALSE(table->cell(method.name, flip_column).isEmpty()) << method.name;
    }
}

TEST_F(KernelDockTest, ARowOfTheTableIsTheKernelThatIsLookedAt) {
    ASSERT_TRUE(shows("preintegrated"));
    for (int r = 0; r < table->rowCount(); ++r)
        if (table->item(r, 0)->text() == QLatin1String("svd 2")) table->setCurrentCell(r, 0);
    ASSERT_TRUE(waitUntil([&] { return kernelCurve(0).label == "svd 2"; }));
    EXPECT_EQ(kernelWish(workspace.state()).method, "svd 2");
}

TEST_F(KernelDockTest, SlidersMoveTheTwoGaussiansAndOneStepOfUndoBringsTheFitBack) {
    set("method", std::string("manual"));
    ASSERT_TRUE(shows("manual"));
    auto* far = find<NumberSlider>(dock.get(), "kernel.far.R");
    auto* fit = find<QPushButton>(dock.get(), "kernel.fit");
    EXPECT_FALSE(fit->isEnabled());
    const Series fitted = kernelCurve(0);
    const double width = far->value();
    const int steps = workspace.undoStack().count();
    // A drag: dozens of moves, each of which is a wish.
    far->slider()->setSliderDown(true);
    for (int i = 0; i < 60; ++i) {
        far->slider()->setValue(far->slider()->value() + 2);
        QTest::qWait(1);
    }
    far->slider()->setSliderDown(false);
    emit far->finished();
    ASSERT_GT(far->value(), width);
    EXPECT_TRUE(waitUntil([&] { return kernelCurve(0).y.back() > fitted.y.back(); })) << "wider is brighter far out";
    EXPECT_TRUE(fit->isEnabled());
    EXPECT_DOUBLE_EQ(kernelWish(workspace.state()).manual->far_mm.r, far->value());
    EXPECT_EQ(workspace.undoStack().count(), steps + 1);
    workspace.undoStack().undo();
    ASSERT_TRUE(waitUntil([&] { return kernelCurve(0).y == fitted.y; }));
    EXPECT_NEAR(far->value(), width, 1e-9 * width);
}

TEST_F(KernelDockTest, PicturesAreShownBeforeAfterAndAsDifference) {
    set("view", std::string("pictures"));
    auto* row = find<PictureRow>(dock.get(), "kernel.pictures");
    ASSERT_TRUE(waitUntil([&] { return row->panels().size() == 4; }));
    EXPECT_TRUE(row->isVisible());
    EXPECT_NE(row->panels()[0].picture, row->panels()[1].picture);
    EXPECT_NE(row->panels()[1].picture, row->panels()[2].picture);
    const QImage discs = row->panels()[0].picture;
    set("signal", std::string("shaded"));
    EXPECT_TRUE(waitUntil([&] { return row->panels()[0].picture != discs; }));
    set("view", std::string("edge"));
    ASSERT_TRUE(waitUntil([&] { return figures[1]->figure().title == "Difference from the ground truth"; }));
    EXPECT_TRUE(figures[0]->isVisible() && figures[1]->isVisible());
}

TEST_F(KernelDockTest, TheExportIsThatOfTheCommand) {
    set("method", std::string("guided k=1"));
    ASSERT_TRUE(shows("guided k=1"));
    for (const char* format : {"hlsl", "godot", "unity"}) {
        QApplication::clipboard()->clear();
        find<QAction>(dock.get(), (std::string("kernel.copy.") + format).c_str())->trigger();
        ASSERT_TRUE(waitUntil([&] { return !QApplication::clipboard()->text().isEmpty(); })) << format;
        EXPECT_EQ(QApplication::clipboard()->text(), textOf(format)) << format;
    }
    EXPECT_EQ(kernelCommandLine(workspace.state()).section(QLatin1String(" --model"), 0, 0),
              QStringLiteral("searchlight kernel --material skin1 --method guided --k 1 --taps 17"));
}

TEST_F(KernelDockTest, FollowsTheMaterialAndSaysWhyThereIsNoKernel) {
    ASSERT_TRUE(shows("preintegrated"));
    const std::vector<double> skin = trueCurve(0).y;
    workspace.edit(QStringLiteral("Material"), {}, [](State& state) { state.scene.material = {.id = "marble"}; });
    ASSERT_TRUE(waitUntil([&] { return status->text().contains(QLatin1String("Marble")); }));
    EXPECT_NE(trueCurve(0).y, skin);
    workspace.edit(QStringLiteral("Material"), {},
                   [](State& state) { state.scene.material = {.id = "", .sigma_a = {1}, .sigma_s = {0}}; });
    ASSERT_TRUE(waitUntil([&] { return figures[0]->isEmpty(); }));
    EXPECT_TRUE(status->text().contains(QLatin1String("scatter"))) << status->text().toStdString();
    EXPECT_FALSE(find<QToolButton>(dock.get(), "kernel.export")->isEnabled());
    EXPECT_TRUE(table->cell("svd 1", pictures_column).isEmpty());
    workspace.undoStack().undo();
    EXPECT_TRUE(waitUntil([&] { return !figures[0]->isEmpty(); }));
}

TEST_F(KernelDockTest, WalksComeFirstFewThenAll) {
    set("truth", std::string("walks"));
    ASSERT_TRUE(waitUntil([&] { return status->text().contains(QStringLiteral("100000 walks")); }, 60'000))
        << status->text().toStdString();
    ASSERT_TRUE(waitUntil([&] { return status->text().contains(QStringLiteral("10⁶ walks")); }, 60'000));
}

TEST_F(KernelDockTest, WhatNobodySeesIsNotComputed) {
    ASSERT_TRUE(shows("preintegrated"));
    dock->hide();
    set("method", std::string("skin"));
    QTest::qWait(100);
    EXPECT_FALSE(tasks.busy());
    dock->show();
    EXPECT_TRUE(shows("skin"));
}

// For whoever looks at them: SEARCHLIGHT_PICTURES names the folder.
TEST_F(WindowTest, PicturesOfTheKernelDockAreTakenInBothThemes) {
    const QString folder = qEnvironmentVariable("SEARCHLIGHT_PICTURES");
    if (folder.isEmpty()) GTEST_SKIP() << "SEARCHLIGHT_PICTURES names no folder";
    QDir().mkpath(folder);
    const auto set = [&](const char* option, const char* value) {
        workspace.setOption(QStringLiteral("Kernel"), "kernel", option, std::string(value));
    };
    for (const QSize size : {QSize(1280, 800), QSize(1920, 1080)}) {
        MainWindow window(desk);
        window.resize(size);
        window.show();
        window.dock(QStringLiteral("kernel"))->raise();
        QWidget* dock = window.dock(QStringLiteral("kernel"))->widget();
        for (const auto mode : {Theme::Mode::dark, Theme::Mode::light}) {
            theme.apply(mode);
            const auto take = [&](const char* name) {
                EXPECT_TRUE(waitUntil([&] { return dock->property("settled").toBool(); }, 120'000)) << name;
                QTest::qWait(50);
                window.grab().save(
                    folder + QStringLiteral("/kernel_%1_%2_%3.png")
                                 .arg(QLatin1String(name))
                                 .arg(size.width())
                                 .arg(mode == Theme::Mode::dark ? QStringLiteral("dark") : QStringLiteral("light")));
            };
            for (const char* view : {"curves", "edge", "pictures", "table"}) {
                set("method", "preintegrated");
                set("view", view);
                take(view);
            }
            set("view", "curves");
            set("method", "manual");
            take("manual");
        }
    }
}

}  // namespace
}  // namespace searchlight::gui
