#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <set>

#include "job/paper/paper.h"
#include "job/paper/paper_studio.h"

namespace searchlight {
namespace {

TEST(WhereItFallsTo, IsExactOnAPowerLaw) {
    const std::vector<double> x{100, 400, 1600}, errors{0.2, 0.1, 0.05};  // x^-1/2
    EXPECT_NEAR(whereItFallsTo(0.1, x, errors), 400, 1e-9);
    EXPECT_NEAR(whereItFallsTo(0.08, x, errors), 625, 1e-9);
    EXPECT_NEAR(whereItFallsTo(0.4, x, errors), 25, 1e-9);
    EXPECT_NEAR(whereItFallsTo(0.02, x, errors), 10'000, 1e-8);
}

// Of the smallest pictures, on the lightest object; points are kept in a folder of the test's own.
class PaperPicturesTest : public testing::Test {
protected:
    PaperPicturesTest() {
        setenv("XDG_CACHE_HOME", (std::filesystem::temp_directory_path() / "searchlight-paper-test").c_str(), 1);
    }

    PaperPlate make(std::string_view paper, std::string_view figure) {
        for (const Paper& each : papers())
            for (const PaperFigure& entry : each.figures)
                if (each.id == paper && entry.id == figure)
                    return entry.make({.engine = engine_, .observer = observer_, .object = "sphere", .size = 40});
        throw std::runtime_error("no such figure");
    }

    Engine engine_;
    Observer observer_;
};

TEST_F(PaperPicturesTest, HybridFollowsTextureSpaceInOtherMaterials) {
    const PaperPlate plate = make("chang2007", "4.9");
    ASSERT_TRUE(plate.sheet);
    EXPECT_EQ(plate.sheet->cells.size(), plate.sheet->rows.size() * plate.sheet->columns.size());
    for (const SheetCell& cell : plate.sheet->cells) EXPECT_FALSE(cell.png.empty());
    ASSERT_EQ(plate.values.size(), 3u);
    // Of a sphere of 10 mm all that 1,600 samples and the filter leave is noise of a few percent; a slip by a factor,
    // of pi or of the normaliser, is not.
    for (const Json& material : plate.values) {
        EXPECT_LT(material["texture_space"][0]["relative_rmse"].get<double>(), 0.08);
        EXPECT_LT(material["hybrid"]["relative_rmse"].get<double>(), 0.15);
    }
}

TEST_F(PaperPicturesTest, SamplesOfThePictureConverge) {
    const PaperPlate plate = make("mertens2003", "18");
    const Json& errors = plate.values["combined"]["relative_rmse"];
    // 16 to 1,024 samples: by n^-1/2 an eighth, by stratification less.
    EXPECT_LT(errors[3].get<double>(), 0.25 * errors[0].get<double>());
}

TEST(Chang2007, HasItsTablesAndFigures) {
    std::set<std::string> ids;
    for (const Paper& paper : papers()) {
        if (paper.id != "chang2007") continue;
        for (const auto* plates : {&paper.figures, &paper.tables})
            for (const PaperFigure& plate : *plates) EXPECT_TRUE(ids.insert(plate.id + plate.shows).second);
    }
    EXPECT_EQ(ids.size(), 12u);
}

}  // namespace
}  // namespace searchlight
