// What is written about two pictures, and what a technique is asked for.
#include <QPushButton>

#include "base/error.h"
#include "gui/view/shown_image.h"
#include "gui/view/technique_options.h"
#include "render/technique.h"
#include "window_fixture.h"

namespace searchlight::gui {
namespace {

Image greys(const std::vector<float>& values) {
    Image image(static_cast<int>(values.size()), 1);
    for (std::size_t i = 0; i < values.size(); ++i) image.pixels[i] = {values[i], values[i], values[i], 1};
    return image;
}

TEST(PictureDifference, IsRelativeToTheMeanOfTheOther) {
    const PictureDifference differs = relativeDifference(greys({3, 1, 2}), greys({2, 2, 2}), "color");
    EXPECT_NEAR(differs.rms, std::sqrt(2.0 / 3) / 2, 1e-6);
    EXPECT_NEAR(differs.mean, 0, 1e-6);
    const PictureDifference brighter = relativeDifference(greys({3, 3}), greys({2, 2}), "red");
    EXPECT_NEAR(brighter.rms, 0.5, 1e-6);
    EXPECT_NEAR(brighter.mean, 0.5, 1e-6);
    EXPECT_LT(relativeDifference(greys({1}), greys({0}), "color").rms, 0) << "nothing is relative to black";
}

// A sky behind the object is in both pictures, or in one beside walks that know none: it says nothing of the object.
TEST(PictureDifference, KnowsNothingOfWhatStandsAroundTheObject) {
    const Image a = objectAlone(greys({50, 30, 3}), {0, 0.5F, 1}), b = objectAlone(greys({0, 1, 2}), {0, 0.5F, 1});
    EXPECT_EQ(a.pixels[1].a, 0);
    EXPECT_NEAR(relativeDifference(a, b, "color").rms, 0.5, 1e-6);
}

class TechniqueSheet : public WindowTest {};

TEST_F(TechniqueSheet, HasARowForEachOptionOfEachTechniqueAndEveryChangeIsUndone) {
    TechniqueOptions sheet(desk, nullptr);
    for (const TechniqueEntry& entry : techniques()) {
        workspace.edit(QStringLiteral("Technique"), {}, [&](State& state) {
            state.technique = entry.id;
            state.technique_options.clear();
        });
        QCoreApplication::sendPostedEvents(nullptr, QEvent::DeferredDelete);
        const auto rows = sheet.findChildren<ParamWidget*>();
        ASSERT_EQ(rows.size(), static_cast<qsizetype>(entry.options.size())) << entry.id;
        for (qsizetype i = 0; i < rows.size(); ++i) {
            const Param& param = entry.options[static_cast<std::size_t>(i)];
            EXPECT_EQ(rows[i]->param().name, param.name);
            EXPECT_EQ(rows[i]->value(), param.value) << entry.id << " " << param.name;
            EXPECT_FALSE(rows[i]->toolTip().isEmpty()) << param.name;
            const ParamValue other = param.type == ParamType::toggle   ? ParamValue(!std::get<bool>(param.value))
                                     : param.type == ParamType::choice ? ParamValue(param.choices.back())
                                                                       : param.value;
            if (other == param.value) continue;
            emit rows[i]->edited(other);
            EXPECT_EQ(workspace.state().technique_options.at(param.name), other);
            EXPECT_EQ(rows[i]->value(), other);
            workspace.undoStack().undo();
            EXPECT_TRUE(workspace.state().technique_options.empty());
            EXPECT_EQ(rows[i]->value(), param.value);
        }
    }
}

TEST_F(TechniqueSheet, NamesTechniquesAsPeopleDo) {
    EXPECT_EQ(techniqueTitle("brute_force"), "Brute force");
    EXPECT_EQ(techniqueTitle("texture-space"), "Texture space");
    EXPECT_EQ(techniqueTitle("tsm"), "TSM");
}

}  // namespace
}  // namespace searchlight::gui
