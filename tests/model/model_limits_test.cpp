// Shipped models at the ends of what they may be given.
#include "limits.h"

namespace searchlight {
namespace {

class Limits : public testing::TestWithParam<std::string> {};

std::vector<std::string> shippedIds() {
    std::vector<std::string> ids;
    for (const Model& model : shippedModels()) ids.push_back(model.id);
    return ids;
}

TEST_P(Limits, AreNumbersInDoubleAndFloat) {
    const Model model = loadModel(GetParam());
    for (const Precision precision : {Precision::double_, Precision::single_})
        expectNumbers(*makeNativeEvaluator(model, precision), model);
}

// Absorption that vanishes changes nothing in the end. 1e-9: a diffuse mean free path of 2e4 mean free paths, so that
// within 10 R_d falls by 5e-4 of its value; totals of dipoles by 5e-5.
TEST_P(Limits, AbsorptionMayVanish) {
    const Model model = loadModel(GetParam());
    if (model.id == "normalized_diffusion") GTEST_SKIP() << "its width grows with the diffuse mean free path";
    const LoadedModel white = load(GetParam(), ofAlbedo(1, 1.3)), almost = load(GetParam(), ofAlbedo(1 - 1e-9, 1.3));
    for (const double r : {0.01, 0.3, 1.0, 10.0}) EXPECT_NEAR(almost.Rd(r) / white.Rd(r), 1, 1e-3) << r;
}

INSTANTIATE_TEST_SUITE_P(Shipped, Limits, testing::ValuesIn(shippedIds()), [](const auto& id) { return id.param; });

}  // namespace
}  // namespace searchlight
