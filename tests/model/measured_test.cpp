#include "base/error.h"
#include "model/measured_file.h"
#include "models.h"

namespace searchlight {
namespace {

std::string message(std::string_view text) {
    try {
        parseMeasured(text, "skin.csv");
    } catch (const Error& error) {
        return error.what();
    }
    return "accepted";
}

Rgb at(const Model& model, double r) {
    const Query query{{}, {0, 0, 1}, {0, 0, 1}, {r, 0, 0}, {0, 0, 1}, {0, 0, 1}};
    Rgb value;
    const auto evaluator = makeMeasuredEvaluator(model);
    evaluator->set(ofAlbedo(0.9, 1.3), {});
    evaluator->evaluate({&query, 1}, {&value, 1});
    return value;
}

TEST(MeasuredProfile, AnswersWithItsTable) {
    const Model model =
        parseMeasured("# title: My skin\nr_mm, R, G, B\n0, 3, 2, 1\n1, 2, 1, 0.5\n2, 1, 0.5, 0.1\n", "skin.csv");
    EXPECT_EQ(model.file.title, "My skin");
    EXPECT_TRUE(model.measured && model.file.radial && model.file.no_wi && model.file.no_wo);
    EXPECT_EQ(at(model, 1), (Rgb{2, 1, 0.5}));
    EXPECT_EQ(at(model, 2.5), Rgb{});
}

TEST(MeasuredProfile, OfOneColumnHoldsForAllChannels) {
    EXPECT_EQ(at(parseMeasured("r_mm,R_d\n0.5,3\n1,2\n", "skin.csv"), 1), (Rgb{2, 2, 2}));
}

TEST(MeasuredProfile, PerIncidentFluxIsDividedByWhatEnters) {
    const Model model = parseMeasured("# per: incident\n# eta: 1.5\nr_mm,R_d\n0.5,3\n1,0.96\n", "skin.csv");
    EXPECT_NEAR(at(model, 1).r, 1, 1e-14);
    EXPECT_EQ(model.file.title, "skin.csv");
}

TEST(MeasuredProfile, HasNoParametersAndNoClosedForm) {
    const Model model = parseMeasured("r_mm,R_d\n0.5,3\n1,2\n", "skin.csv");
    const auto evaluator = makeMeasuredEvaluator(model);
    EXPECT_THROW(evaluator->set(ofAlbedo(0.9, 1), {{"A", ParamValue(1.0)}}), Error);
    EXPECT_THROW(evaluator->diffuseReflectance({}), Error);
    EXPECT_EQ(evaluator->backend(), "table");
}

TEST(MeasuredProfile, LoadsByPath) {
    const Model model = loadModel(std::string(SEARCHLIGHT_SOURCE_DIR) + "/tests/data/measured_profile.csv");
    EXPECT_EQ(model.id, "measured_profile");
    EXPECT_TRUE(model.measured);
}

TEST(MeasuredProfile, RefusesWithAPlaceAndWhatWasExpected) {
    EXPECT_EQ(message("r,R_d\n0,1\n1,1\n"),
              "skin.csv:1:1: unexpected column 'r' (expected r_mm, R, G, B or r_mm, R_d)");
    EXPECT_EQ(message("r_mm,R,G\n0,1,1\n"),
              "skin.csv:1:8: unexpected column 'G' (expected r_mm, R, G, B or r_mm, R_d)");
    EXPECT_EQ(message("r_mm,R_d\n0,1\n0,1\n"),
              "skin.csv:3:1: radius 0 does not ascend (radii are at least 0 and grow from line to line)");
    EXPECT_EQ(message("r_mm,R_d\n-1,1\n0,1\n"),
              "skin.csv:2:1: radius -1 does not ascend (radii are at least 0 and grow from line to line)");
    EXPECT_EQ(message("r_mm,R_d\n1,1\n"), "skin.csv: the table has 1 rows (a profile needs at least 2 radii)");
    EXPECT_EQ(message("# per: photon\nr_mm,R_d\n0,1\n1,1\n"),
              "skin.csv: a profile per 'photon' (expected '# per: transmitted' or '# per: incident')");
    EXPECT_EQ(message("# per: incident\nr_mm,R_d\n0,1\n1,1\n"),
              "skin.csv: a profile per incident flux needs the refractive index (expected a line such as '# eta: 1.4', "
              "within 0.25 to 4)");
    EXPECT_THAT(message("r_mm,R_d\n0,x\n1,1\n"), testing::StartsWith("skin.csv:2:3: "));
    EXPECT_THAT(message("r_mm,R_d\n0,nan\n1,1\n"), testing::StartsWith("skin.csv:2:3: "));
    EXPECT_THAT(message("r_mm,R_d\n0\n1,1\n"), testing::StartsWith("skin.csv:2:"));
}

TEST(LoadModel, AnswersAnUnknownNameWithTheValidOnes) {
    try {
        loadModel("dipol");
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind, ErrorKind::usage);
        EXPECT_THAT(error.what(), testing::HasSubstr("unknown model 'dipol'"));
        EXPECT_THAT(error.what(), testing::HasSubstr("better_dipole"));
    }
}

TEST(LoadModel, RefusesAnotherEnding) {
    EXPECT_THROW(loadModel(std::string(SEARCHLIGHT_SOURCE_DIR) + "/CMakeLists.txt"), Error);
    EXPECT_THROW(loadModel("no/such.bssrdf"), Error);
}

TEST(LoadModel, KnowsACopyOfAShippedModel) {
    const Model model = loadModel(std::string(SEARCHLIGHT_SOURCE_DIR) + "/models/dipole.bssrdf");
    EXPECT_EQ(model.id, "dipole");
    EXPECT_TRUE(hasNativeEvaluator(model));
}

}  // namespace
}  // namespace searchlight
