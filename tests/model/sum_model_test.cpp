// Sums of models by name.
#include "model/sum_model.h"

#include <gmock/gmock.h>

#include "base/error.h"
#include "models.h"

namespace searchlight {
namespace {

const std::string measured_path = std::string(SEARCHLIGHT_SOURCE_DIR) + "/tests/data/measured_profile.csv";

std::string messageOf(const std::string& name) {
    try {
        loadModel(name);
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

std::vector<std::string> parameterNames(const Model& model) {
    std::vector<std::string> names;
    for (const Param& param : model.file.parameters) names.push_back(param.name);
    return names;
}

Rgb valueAt(Evaluator& evaluator) {
    const Query query{{}, normalize(Vec3{-0.5, 0.1, 0.8}), {0, 0, 1}, {0.3, 0.2, 0}, {0, 0, 1}, {0, 0, 1}};
    Rgb value;
    evaluator.evaluate({&query, 1}, {&value, 1});
    return value;
}

TEST(PartNames, AreDividedByPlusButNotWithinAPath) {
    using testing::ElementsAre;
    EXPECT_THAT(partNames("dipole"), ElementsAre("dipole"));
    EXPECT_THAT(partNames("better_dipole+single"), ElementsAre("better_dipole", "single"));
    EXPECT_THAT(partNames("a + b"), ElementsAre("a", "b"));
    EXPECT_THAT(partNames("/home/c++/my.bssrdf+single+./x+y.csv"),
                ElementsAre("/home/c++/my.bssrdf", "single", "./x+y.csv"));
    // What never ends is one path, and no such file.
    EXPECT_THAT(partNames("./a+b"), ElementsAre("./a+b"));
}

TEST(SumOfModels, SaysWhatIsWrongWithItsName) {
    EXPECT_EQ(messageOf("dipole+"),
              "a model without a name in 'dipole+' (models are added as in better_dipole+single)");
    EXPECT_EQ(messageOf("+"), "a model without a name in '+' (models are added as in better_dipole+single)");
    EXPECT_EQ(messageOf("dipole++single"),
              "a model without a name in 'dipole++single' (models are added as in better_dipole+single)");
    EXPECT_EQ(messageOf("dipole+single+dipole"),
              "'dipole' stands twice in a sum of models (each part has another name, by which its parameters are told "
              "apart)");
    EXPECT_THAT(messageOf("dipole+singel"), testing::StartsWith("unknown model 'singel'"));
    EXPECT_EQ(messageOf("dipole+no/such.csv"), "no/such.csv: no such file");
}

TEST(SumOfModels, ReturnsWhatItsPartsReturnTogether) {
    const Medium medium = grey(0.05, 3, 0.3, 1.4);
    const LoadedModel sum = load("better_dipole+directional_dipole+single", medium);
    Rgb expected;
    for (const char* id : {"better_dipole", "directional_dipole", "single"})
        expected = expected + valueAt(*load(id, medium).evaluator);
    EXPECT_EQ(valueAt(*sum.evaluator), expected);
    EXPECT_EQ(sum.evaluator->backend(), "cpu double");
}

TEST(SumOfModels, ClaimsWhatAllOfItsPartsClaim) {
    const Model radial = loadModel("dipole+better_dipole"), directional = loadModel("better_dipole+single");
    EXPECT_TRUE(radial.file.radial && radial.file.no_wi && radial.file.no_wo && radial.file.reciprocal);
    EXPECT_FALSE(radial.file.single_scattering || radial.file.normals);
    EXPECT_FALSE(directional.file.radial || directional.file.no_wi || directional.file.reciprocal);
    EXPECT_TRUE(directional.file.no_wo && directional.file.single_scattering && directional.file.normals);
    EXPECT_TRUE(directional.file.grosjean);
    EXPECT_EQ(directional.id, "better_dipole+single");
    EXPECT_EQ(directional.file.title, "Better dipole + Single scattering");
    EXPECT_THAT(directional.file.citation, testing::HasSubstr("Single scattering: Habel"));
    EXPECT_TRUE(hasNativeEvaluator(directional) && readsMedium(directional));
    EXPECT_EQ(countedTwice(directional), "");
    EXPECT_EQ(countedTwice(loadModel("directional_dipole+better_dipole+single")),
              "Single scattering is part of Directional dipole and of Single scattering: it counts 2 times.");
}

TEST(SumOfModels, NamesParametersByTheirPartsWhereTwoShareAName) {
    const Model sum = loadModel("better_dipole+directional_dipole+single");
    EXPECT_THAT(parameterNames(sum),
                testing::ElementsAre("better_dipole.Moments", "Plane", "Extrapolation", "directional_dipole.Moments",
                                     "ClampNegative", "ForwardPeak"));
    EXPECT_EQ(parameterName(sum, "single.ForwardPeak"), "ForwardPeak");
    EXPECT_EQ(parameterName(sum, "ForwardPeak"), "ForwardPeak");
    EXPECT_EQ(parameterName(sum, "better_dipole.Moments"), "better_dipole.Moments");
    EXPECT_EQ(parameterName(sum, "single.Moments"), "single.Moments");
    const ParamValue exact = std::string("exact");
    const ParamValues given{{"directional_dipole.Moments", exact}, {"ForwardPeak", std::string("reduced")}};
    EXPECT_EQ(partParameters(sum, sum.parts[0], given), ParamValues{});
    EXPECT_EQ(partParameters(sum, sum.parts[1], given), (ParamValues{{"Moments", exact}}));
    EXPECT_EQ(partParameters(sum, sum.parts[2], given), (ParamValues{{"ForwardPeak", std::string("reduced")}}));
}

TEST(SumOfModels, SetsTheParametersOfItsParts) {
    const Medium medium = grey(0.05, 3, 0.8, 1.4);
    const ParamValue reduced = std::string("reduced");
    const double sum = load("dipole+single", medium, {{"ForwardPeak", reduced}}).Rd(0.2);
    EXPECT_EQ(sum, load("dipole", medium).Rd(0.2) + load("single", medium, {{"ForwardPeak", reduced}}).Rd(0.2));
    EXPECT_NE(sum, load("dipole+single", medium).Rd(0.2));
}

TEST(SumOfModels, TakesMeasuredProfiles) {
    const Medium medium = ofAlbedo(0.9, 1.3);
    const LoadedModel sum = load(measured_path + "+dipole", medium);
    const Model measured = loadModel(measured_path);
    EXPECT_TRUE(sum.model.file.radial && hasNativeEvaluator(sum.model));
    EXPECT_EQ(sum.Rd(0.1), measured.profile(0.1).r + load("dipole", medium).Rd(0.1));
    EXPECT_EQ(sum.evaluator->backend(), "table + cpu double");
    EXPECT_FALSE(hasDiffuseReflectance(sum.model));
}

TEST(SumOfModels, HasAClosedFormWhereAllOfItsPartsHave) {
    const LoadedModel sum = load("dipole+better_dipole", ofAlbedo(0.9, 1.3));
    EXPECT_TRUE(hasDiffuseReflectance(sum.model));
    EXPECT_NEAR(sum.closedForm(), sum.total(), 1e-9);
    EXPECT_FALSE(hasDiffuseReflectance(loadModel("dipole+single")));
}

// The better dipole's totals against H functions: without single scattering it lacks most of the light at low albedo;
// at high albedo it lacks little, since it returns everything where nothing is absorbed, and the sum exceeds it.
TEST(SumOfModels, WithSingleScatteringBringsTheBetterDipoleNearerAtLowAlbedo) {
    const std::pair<double, double> exact[] = {{0.5, 0.11523}, {0.9, 0.41495}, {0.99, 0.75272}};
    const bool nearer[] = {true, true, false};
    for (std::size_t i = 0; i < 3; ++i) {
        const auto [albedo, total] = exact[i];
        const double alone = std::abs(load("better_dipole", ofAlbedo(albedo, 1)).total() - total);
        const double sum = std::abs(load("better_dipole+single", ofAlbedo(albedo, 1)).total() - total);
        EXPECT_EQ(sum < alone, nearer[i]) << albedo << ": " << alone << " becomes " << sum;
    }
}

}  // namespace
}  // namespace searchlight
