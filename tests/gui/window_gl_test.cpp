// The object view, materials and lights, driven as a person does. User models are compiled by OpenGL.
#include <QAction>
#include <QCheckBox>
#include <QComboBox>
#include <QDockWidget>
#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QProgressBar>
#include <QTemporaryDir>
#include <QToolButton>

#include "base/files.h"
#include "gui/lights/light_modes.h"
#include "gui/material/material_dock.h"
#include "gui/material/material_edit.h"
#include "gui/view/object_view.h"
#include "gui/widgets/number_slider.h"
#include "gui/widgets/param_widget.h"
#include "gui/window/docks.h"
#include "io/image_file.h"
#include "window_fixture.h"

namespace searchlight::gui {
namespace {

class MainTest : public WindowTest {
protected:
    void SetUp() override {
        WindowTest::SetUp();
        // A light object, so that a software driver and a busy machine are in time.
        State state = defaultState();
        state.scene.object = "sphere";
        state.scene.coat.reset();
        workspace.open(state, {});
        window = std::make_unique<MainWindow>(desk);
        window->resize(1100, 700);
        window->show();
    }

    bool settled() {
        return waitUntil([&] { return window->view().pictures().atRest(); }, 180'000);
    }
    const ViewPicture& shown() const { return window->view().pictures().shown(); }
    const Scene& scene() const { return workspace.state().scene; }

    std::unique_ptr<MainWindow> window;
};

TEST_F(MainTest, ShowsAPictureByItself) {
    ASSERT_TRUE(settled());
    EXPECT_EQ(shown().a.size(), window->view().size() * window->view().devicePixelRatioF());
    // The object is there, and the corner shows what is behind it.
    EXPECT_EQ(qAlpha(shown().a.pixel(shown().a.rect().center())), 255);
    EXPECT_EQ(qAlpha(shown().a.pixel(0, 0)), 0);
}

TEST_F(MainTest, DragsTurnTheObjectAndTheLight) {
    ASSERT_TRUE(settled());
    ObjectView& view = window->view();
    const Camera camera = scene().camera;
    QTest::mousePress(&view, Qt::LeftButton, {}, {200, 200});
    for (int x = 210; x <= 260; x += 10) QTest::mouseMove(&view, {x, 200});
    QTest::mouseRelease(&view, Qt::LeftButton, {}, {260, 200});
    EXPECT_NE(scene().camera.azimuth_deg, camera.azimuth_deg);
    EXPECT_EQ(workspace.undoStack().count(), 1) << "one drag, one step";
    workspace.undoStack().undo();
    EXPECT_EQ(scene().camera.azimuth_deg, camera.azimuth_deg);
    const Vec3 light = std::get<DirectionalLight>(scene().lights[0]).direction;
    QTest::mousePress(&view, Qt::RightButton, {}, {200, 200});
    QTest::mouseMove(&view, {260, 240});
    QTest::mouseRelease(&view, Qt::RightButton, {}, {260, 240});
    EXPECT_GT(length(std::get<DirectionalLight>(scene().lights[0]).direction - light), 0.01);
    EXPECT_NEAR(length(std::get<DirectionalLight>(scene().lights[0]).direction), length(light), 1e-12);
    QTest::keyClick(&view, Qt::Key_Plus);
    EXPECT_GT(scene().camera.distance, 0);
    EXPECT_TRUE(settled());
}

TEST_F(MainTest, ModelsAndTheReferenceAreCompared) {
    for (const char* against : {"model 1", "reference"}) {
        workspace.edit(QStringLiteral("compare"), {}, [&](State& state) {
            state.options["view"]["compare"] = std::string("difference");
            state.options["view"]["against"] = std::string(against);
        });
        // What the model before left is shown until the reference has walked.
        const bool walks = std::string(against) == "reference";
        ASSERT_TRUE(waitUntil(
            [&] { return !shown().difference.isNull() && shown().differs.rms >= 0 && (shown().walks > 0) == walks; },
            180'000))
            << against;
        EXPECT_EQ(shown().difference.size(), shown().a.size());
    }
}

// Some seconds on one core: it has to be seen while it is made, and to end when a person has seen enough.
TEST_F(MainTest, ASlowTechniqueIsShownAsItGrowsAndCancelled) {
    ASSERT_TRUE(settled());
    std::vector<QImage> seen;
    QObject::connect(&window->view().pictures(), &PictureService::pictureShown, [&] {
        if (shown().partly && !shown().b.isNull()) seen.push_back(shown().b);
    });
    workspace.edit(QStringLiteral("compare"), {}, [&](State& state) {
        state.options["view"]["compare"] = std::string("wipe");
        state.options["view"]["against"] = std::string("technique brute_force");
    });
    auto* bar = find<QProgressBar>(window.get(), "task.bar");
    auto* cancel = find<QToolButton>(window.get(), "task.cancel");
    const auto own = [&] { return tasks.busy("picture", "picture") && bar->isVisible() && bar->maximum() > 0; };
    ASSERT_TRUE(waitUntil([&] { return seen.size() >= 2 && own(); }, 180'000));
    EXPECT_NE(seen[0], seen[1]);
    EXPECT_GT(bar->value(), 0);
    // Whichever task stands longest is offered first.
    EXPECT_TRUE(waitUntil([&] {
        if (cancel->isVisible()) cancel->click();
        return !tasks.busy("picture", "picture");
    }));
    EXPECT_FALSE(shown().a.isNull()) << "what was seen stays";
    EXPECT_TRUE(waitUntil([&] { return !cancel->isVisible(); }, 60'000));
    // And the next change begins anew.
    workspace.setOption(QStringLiteral("compare"), "view", "compare", std::string("none"));
    EXPECT_TRUE(settled());
}

TEST_F(MainTest, LayersShowTheLightThatArrives) {
    ASSERT_TRUE(settled());
    const QImage picture = shown().a;
    for (const char* layer : {"irradiance", "points"}) {
        workspace.setOption(QStringLiteral("layer"), "view", "layer", std::string(layer));
        ASSERT_TRUE(settled());
        EXPECT_NE(shown().a, picture) << layer;
        EXPECT_EQ(qAlpha(shown().a.pixel(shown().a.rect().center())), 255);
    }
}

TEST_F(MainTest, AFaultIsShownAndMendedByTheNextStep) {
    ASSERT_TRUE(settled());
    QString fault;
    QObject::connect(&window->view().pictures(), &PictureService::failed, [&](const QString& text) { fault = text; });
    workspace.edit(QStringLiteral("object"), {}, [](State& state) { state.scene.object = "no/such.obj"; });
    ASSERT_TRUE(waitUntil([&] { return !fault.isEmpty(); }));
    EXPECT_TRUE(fault.contains("no/such.obj")) << fault.toStdString();
    workspace.undoStack().undo();
    EXPECT_TRUE(settled());
}

TEST_F(MainTest, AnEndlessModelStopsAndTheNextOneWorks) {
    QTemporaryDir folder;
    const QString path = folder.filePath("endless.bssrdf");
    writeFile(path.toStdString(),
              "analytic radial no_wi no_wo\n::begin shader\nvec3 Bssrdf(vec3 Xi, vec3 Wi, vec3 Xo, vec3 Wo) {\n"
              "    float s = 0.0;\n    for (int i = 0; i >= 0; i = (i + 1) % 7) s += 1.0;\n    return vec3(s);\n}\n"
              "::end shader\n");
    QString fault;
    QObject::connect(&window->view().pictures(), &PictureService::failed, [&](const QString& text) { fault = text; });
    window->openPaths({path});
    EXPECT_EQ(workspace.state().activeModel().model.id, path.toStdString());
    ASSERT_TRUE(waitUntil([&] { return !fault.isEmpty(); }, 90'000));
    workspace.undoStack().undo();
    EXPECT_TRUE(settled());
}

TEST_F(MainTest, ASliderOfTheMaterialMovesAndIsUndoneExactly) {
    const std::string before = workspaceJson(workspace.state());
    auto* slider = find<NumberSlider>(window.get(), "absorption coefficient.R");
    ASSERT_TRUE(slider);
    slider->slider()->setValue(slider->slider()->value() + 50);
    EXPECT_TRUE(scene().material.id.empty()) << "a preset that is changed is none any more";
    EXPECT_EQ(scene().material.sigma_a.size(), 3u);
    EXPECT_EQ(scene().material.sigma_a[0], slider->value());
    workspace.undoStack().undo();
    EXPECT_EQ(workspaceJson(workspace.state()), before);
    EXPECT_EQ(scene().material.id, "skin1");
}

TEST_F(MainTest, WhatIsTypedAndImpossibleIsExplainedInPlace) {
    auto* slider = find<NumberSlider>(window.get(), "absorption coefficient.G");
    const std::string before = workspaceJson(workspace.state());
    slider->field()->setFocus();
    slider->field()->selectAll();
    QTest::keyClicks(slider->field(), "-3");
    QTest::keyClick(slider->field(), Qt::Key_Return);
    EXPECT_EQ(workspaceJson(workspace.state()), before);
    bool explained = false;
    for (const QLabel* label : slider->findChildren<QLabel*>())
        explained |= label->text().contains("Expected a number from 0") && !label->isHidden();
    EXPECT_TRUE(explained);
}

TEST_F(MainTest, RdrAndLdAreTheSameMediumInOtherWords) {
    const SceneMaterial before = spelledOut(scene().material);
    QToolButton* inverted = nullptr;
    for (QToolButton* button : window->findChildren<QToolButton*>())
        if (button->text() == "Rdr and ld") inverted = button;
    ASSERT_TRUE(inverted);
    inverted->click();
    ASSERT_TRUE(waitUntil([&] { return scene().material.inverted(); }));
    for (QToolButton* button : window->findChildren<QToolButton*>())
        if (button->text() == QString::fromUtf8("\xcf\x83"
                                                "a and "
                                                "\xcf\x83"
                                                "s"))
            button->click();
    ASSERT_TRUE(waitUntil([&] { return !scene().material.inverted(); }));
    for (std::size_t c = 0; c < 3; ++c) {
        // The bisection ends at double precision; reflectance is flat in albedo near 1.
        EXPECT_NEAR(scene().material.sigma_a[c], before.sigma_a[c], 1e-6 * before.sigma_a[c]);
        EXPECT_NEAR(scene().material.sigma_s[c], before.sigma_s[c], 1e-6 * before.sigma_s[c]);
    }
}

TEST_F(MainTest, PresetsAreFoundByWhatOneTypes) {
    auto* list = find<QListWidget>(window.get(), "presets");
    const auto searches = window->findChildren<QLineEdit*>();
    for (QLineEdit* field : searches)
        if (field->accessibleName() == "Search materials") {
            field->setText("whole milk");
            QTest::keyClick(field, Qt::Key_Return);
        }
    EXPECT_TRUE(QString::fromStdString(scene().material.id).contains("milk")) << scene().material.id;
    EXPECT_GT(list->count(), 50);
}

TEST_F(MainTest, EveryModeOfLightMakesAPicture) {
    const QString environment = SEARCHLIGHT_SOURCE_DIR "/examples/gallery/studio.hdr";
    for (const LightMode& mode : lightModes()) {
        workspace.edit(QStringLiteral("light"), {},
                       [&](State& state) { state.scene.lights = mode.make(environment.toStdString()); });
        EXPECT_EQ(modeOf(scene().lights), static_cast<int>(&mode - lightModes().data()));
        EXPECT_TRUE(settled()) << mode.title;
    }
}

TEST_F(MainTest, EveryDockHasANameAndAShortcut) {
    for (const DockEntry& entry : docks()) {
        QDockWidget* dock = window->dock(entry.id);
        ASSERT_TRUE(dock) << entry.id;
        EXPECT_FALSE(dock->accessibleName().isEmpty());
        EXPECT_FALSE(find<QAction>(window.get(), (std::string("show.") + entry.id).c_str())->shortcut().isEmpty());
        dock->setFloating(true);
        EXPECT_TRUE(dock->isFloating());
        dock->setFloating(false);
    }
}

// What has no words on it needs a name for those who do not see it.
TEST_F(MainTest, WhatIsClickedHasANameForScreenReaders) {
    for (const QAbstractButton* button : window->findChildren<QAbstractButton*>()) {
        // Qt names the buttons within its own widgets.
        if (button->objectName().startsWith("qt_") || button->inherits("QLineEditIconButton") ||
            !button->isVisibleTo(window.get()))
            continue;
        EXPECT_FALSE(button->text().isEmpty() && button->accessibleName().isEmpty() && button->toolTip().isEmpty())
            << button->metaObject()->className() << " in " << button->parent()->metaObject()->className();
    }
    for (const QSlider* slider : window->findChildren<QSlider*>()) EXPECT_FALSE(slider->accessibleName().isEmpty());
}

// One Param of each type: the widget shows it, and what the user does comes back in range.
TEST_F(MainTest, EveryKindOfParamHasAWidgetThatWorks) {
    const Param params[] = {
        {.name = "number", .min = 0, .max = 10, .value = 1.0},
        {.name = "integer", .type = ParamType::integer, .min = 0, .max = 10, .value = 3.0},
        {.name = "toggle", .type = ParamType::toggle, .value = false},
        {.name = "color", .type = ParamType::color, .min = 0, .max = 1, .value = Rgb{0.5, 0.5, 0.5}},
        {.name = "choice", .type = ParamType::choice, .value = std::string("a"), .choices = {"a", "b"}},
        {.name = "text", .type = ParamType::text, .value = std::string("x")},
        {.name = "path", .type = ParamType::path, .value = std::string("x")},
        {.name = "numbers", .type = ParamType::numbers, .min = 0, .max = 9, .value = std::vector<double>{1, 2}},
        {.name = "channels", .type = ParamType::channels, .min = 0, .max = 9, .value = std::vector<double>{1}},
    };
    for (const Param& param : params) {
        ParamWidget widget(theme, param);
        EXPECT_EQ(widget.value(), param.value) << param.name;
        std::optional<ParamValue> edited;
        QObject::connect(&widget, &ParamWidget::edited, [&](const ParamValue& value) { edited = value; });
        if (auto* slider = widget.findChild<QSlider*>()) {
            slider->setValue(slider->maximum());
        } else if (auto* box = widget.findChild<QCheckBox*>()) {
            box->click();
        } else if (auto* choices = widget.findChild<QComboBox*>()) {
            choices->setCurrentIndex(1);
            Q_EMIT choices->activated(1);
        } else if (auto* field = widget.findChild<QLineEdit*>()) {
            field->setText("7");
            QTest::keyClick(field, Qt::Key_Return);
        }
        ASSERT_TRUE(edited) << param.name;
        EXPECT_NE(*edited, param.value) << param.name;
        EXPECT_NO_THROW(checkValue(param, *edited)) << param.name;
    }
}

// Every parameter that a shipped model declares.
TEST_F(MainTest, EveryParameterOfAShippedModelHasAWidget) {
    for (const Model& model : shippedModels()) {
        workspace.edit(QStringLiteral("model"), {},
                       [&](State& state) { state.models = {ModelSlot{.model = {.id = model.id}}}; });
        QTest::qWait(1);
        for (const Param& param : model.file.parameters) {
            const auto found = window->findChildren<ParamWidget*>("param." + QString::fromStdString(param.name));
            EXPECT_FALSE(found.isEmpty()) << model.id << " " << param.name;
            for (ParamWidget* widget : found) EXPECT_NO_THROW(checkValue(param, widget->value()));
        }
    }
}

}  // namespace
}  // namespace searchlight::gui
