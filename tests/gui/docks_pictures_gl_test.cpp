// Pictures of the docks for whoever looks at them: SEARCHLIGHT_PICTURES names the folder.
#include <QDir>
#include <QDockWidget>

#include "gui/models/models_dock.h"
#include "gui/plot/figure_view.h"
#include "gui/spheres/sphere_view.h"
#include "window_fixture.h"

namespace searchlight::gui {
namespace {

class DockPictures : public WindowTest {};

TEST_F(DockPictures, AreTakenInBothThemes) {
    const QString folder = qEnvironmentVariable("SEARCHLIGHT_PICTURES");
    if (folder.isEmpty()) GTEST_SKIP() << "SEARCHLIGHT_PICTURES names no folder";
    QDir().mkpath(folder);
    MainWindow window(desk);
    window.resize(1280, 800);
    window.show();
    addNewModel(workspace, QStringLiteral("radial"));
    auto* plot = find<FigureView>(&window, "plot.figure");
    auto* spheres = find<SphereView>(&window, "spheres.view");
    ASSERT_TRUE(waitUntil([&] { return plot->figure().series.size() == 5; }));
    for (const auto mode : {Theme::Mode::dark, Theme::Mode::light}) {
        const QString tone = mode == Theme::Mode::dark ? QStringLiteral("dark") : QStringLiteral("light");
        theme.apply(mode);
        for (const char* view : {"profile", "error", "plane", "slice"}) {
            workspace.setOption(QStringLiteral("Plot"), "plot", "view", std::string(view));
            QTest::qWait(2500);
            window.dock(QStringLiteral("plot"))->raise();
            window.dock(QStringLiteral("models"))->raise();
            QTest::qWait(100);
            window.grab().save(folder + QStringLiteral("/%1_%2.png").arg(QLatin1String(view), tone));
        }
        window.dock(QStringLiteral("spheres"))->raise();
        QTest::qWait(8000);
        EXPECT_EQ(spheres->panels().size(), 3);
        window.grab().save(folder + QStringLiteral("/spheres_%1.png").arg(tone));
    }
}

}  // namespace
}  // namespace searchlight::gui
