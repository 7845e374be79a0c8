#include <filesystem>
#include <memory>

#include "base/error.h"
#include "gl/context.h"
#include "validate/check.h"

namespace searchlight {
namespace {

using enum CheckResult::Outcome;

std::vector<CheckResult> checkOnGl(const Model& model, gl::Context& context) {
    const EvaluatorFactory factory = [&](const Model& which, std::string_view backend) {
        return backend == "gl" ? makeGlEvaluator(which, context) : makeNativeEvaluator(which);
    };
    Observer observer;
    return checkModel(model, {}, factory, observer);
}

std::vector<std::string> namesOf(const std::vector<CheckResult>& results, CheckResult::Outcome outcome) {
    std::vector<std::string> names;
    for (const CheckResult& result : results)
        if (result.outcome == outcome) names.push_back(result.name);
    return names;
}

struct Case {
    const char* file;
    std::vector<std::string> fails, reports;
};

void PrintTo(const Case& broken, std::ostream* out) { *out << broken.file; }

class BrokenModel : public testing::TestWithParam<Case> {};

TEST_P(BrokenModel, FailsTheCheckItBreaksAndNoOther) {
    gl::Context context;
    const auto path = std::filesystem::path(SEARCHLIGHT_SOURCE_DIR) / "tests/validate/broken" / GetParam().file;
    const auto results = checkOnGl(loadModel(path.string()), context);
    std::string all;
    for (const CheckResult& result : results) all += result.name + ": " + result.detail + "\n";
    EXPECT_EQ(namesOf(results, failed), GetParam().fails) << all;
    EXPECT_EQ(namesOf(results, reported), GetParam().reports) << all;
}

INSTANTIATE_TEST_SUITE_P(
    Files, BrokenModel,
    testing::Values(Case{"nothing.bssrdf", {}, {}}, Case{"non_negative.bssrdf", {"non-negative"}, {}},
                    Case{"energy.bssrdf", {"energy"}, {}}, Case{"scaling.bssrdf", {"scaling"}, {}},
                    Case{"closed_form.bssrdf", {"closed form"}, {}}, Case{"radial.bssrdf", {"radial"}, {}},
                    Case{"no_wi.bssrdf", {"no_wi"}, {}}, Case{"no_wo.bssrdf", {"no_wo"}, {}},
                    Case{"reciprocal.bssrdf", {"reciprocal"}, {}},
                    Case{"parameter_ends.bssrdf", {"parameter ends"}, {}}, Case{"portable.bssrdf", {}, {"portable"}}),
    [](const auto& broken) { return std::filesystem::path(broken.param.file).stem().string(); });

TEST(CheckOnGl, NaNIsFound) {
    gl::Context context;
    const auto path = std::filesystem::path(SEARCHLIGHT_SOURCE_DIR) / "tests/validate/broken/finite.bssrdf";
    const auto results = checkOnGl(loadModel(path.string()), context);
    EXPECT_THAT(namesOf(results, failed), testing::Contains("finite"));
}

TEST(CheckOnGl, ShippedModelsPassAndNothingIsLeftOut) {
    gl::Context context;
    for (const Model& model : shippedModels()) {
        for (const CheckResult& result : checkOnGl(model, context)) {
            EXPECT_NE(result.outcome, failed) << model.id << ": " << result.name << ": " << result.detail;
            EXPECT_TRUE(result.name != "backends agree" || result.outcome == passed)
                << model.id << ": " << result.detail;
        }
    }
}

}  // namespace
}  // namespace searchlight
