#include "validate/check.h"

#include "formula_model.h"

namespace searchlight {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using enum CheckResult::Outcome;

TEST(Check, ACorrectModelPasses) {
    const auto results = checksOf(FormulaModel());
    EXPECT_THAT(namesOf(results, failed), IsEmpty());
    EXPECT_THAT(namesOf(results, reported), IsEmpty());
    // The last is compared with GL, which is not there.
    EXPECT_THAT(namesOf(results, skipped), ElementsAre("backends agree", "compiles", "parameter ends"));
}

TEST(Check, EveryRowHasOneResultInOrder) {
    const FormulaModel formula;
    Observer observer;
    const auto results = checkModel(formula.model, {}, formula.factory(), observer);
    const auto list = checkList();
    ASSERT_EQ(results.size(), list.size());
    for (std::size_t i = 0; i < list.size(); ++i) EXPECT_EQ(results[i].name, list[i].name);
}

TEST(Check, FindsNegativeValues) {
    FormulaModel formula;
    // Twice the exponential less a wider one: the total stays a'/2.
    formula.value = [](const Medium& medium, int c, const ParamValues& p, const Query& query) {
        Query far = query;
        far.xo = 0.5 * query.xo, far.xi = 0.5 * query.xi;
        return 2 * FormulaModel::correct(medium, c, p, query) - 0.25 * FormulaModel::correct(medium, c, p, far);
    };
    const auto results = checksOf(formula);
    EXPECT_THAT(namesOf(results, failed), ElementsAre("non-negative"));
    EXPECT_THAT(results.at("non-negative").detail, HasSubstr("-"));
}

TEST(Check, FindsGainedEnergy) {
    FormulaModel formula;
    formula.value = [](const Medium& medium, int c, const ParamValues& p, const Query& query) {
        return 2.5 * FormulaModel::correct(medium, c, p, query);
    };
    formula.total = [](double alpha_prime) { return 1.25 * alpha_prime; };
    const auto results = checksOf(formula);
    EXPECT_THAT(namesOf(results, failed), ElementsAre("energy"));
    EXPECT_THAT(results.at("energy").detail, HasSubstr("largest total 1.249 of what entered, at alpha' 0.999"));
}

TEST(Check, TheTotalOfAModelThatReadsWoIsItsMeanOverTheLightThatLeaves) {
    FormulaModel formula;
    formula.model.file.no_wo = formula.model.file.reciprocal = false;
    formula.value = [](const Medium& medium, int c, const ParamValues& p, const Query& query) {
        return FormulaModel::correct(medium, c, p, query) * 5 * query.wo.z;
    };
    formula.model.file.diffuse_reflectance = {};
    // 0.999 / 2 * 5 times the mean of wo.z over T21 cos dw at IOR 1.5, 0.68776 by quadrature; the rule is good to 5e-3.
    EXPECT_THAT(checksOf(formula).at("energy").detail, HasSubstr("largest total 1.71"));
}

TEST(Check, ADeclaredGainIsReported) {
    FormulaModel formula;
    formula.model.file.energy_violation = true;
    formula.value = [](const Medium& medium, int c, const ParamValues& p, const Query& query) {
        return 2.5 * FormulaModel::correct(medium, c, p, query);
    };
    formula.total = [](double alpha_prime) { return 1.25 * alpha_prime; };
    const auto results = checksOf(formula);
    EXPECT_THAT(namesOf(results, failed), IsEmpty());
    EXPECT_THAT(namesOf(results, reported), ElementsAre("energy"));
}

TEST(Check, FindsALengthThatDoesNotScale) {
    FormulaModel formula;
    formula.value = [](const Medium& medium, int c, const ParamValues& p, const Query& query) {
        return FormulaModel::correct(medium, c, p, query) / (1 + 0.01 * length(query.xo - query.xi));
    };
    formula.model.file.diffuse_reflectance = {};
    const auto results = checksOf(formula);
    EXPECT_THAT(namesOf(results, failed), ElementsAre("scaling"));
}

TEST(Check, AParameterThatIsALengthScalesWithTheWorld) {
    FormulaModel formula;
    formula.model.file.diffuse_reflectance = {};
    formula.model.file.parameters = {{.name = "Cut", .unit = "mm", .min = 0.01, .max = 100, .value = 5.0}};
    formula.value = [&](const Medium& medium, int c, const ParamValues& p, const Query& query) {
        const double cut = std::get<double>(valueOf(formula.model.file.parameters[0], p));
        return FormulaModel::correct(medium, c, p, query) * std::exp(-length(query.xo - query.xi) / cut);
    };
    EXPECT_THAT(namesOf(checksOf(formula), failed), IsEmpty());
    formula.model.file.parameters[0].unit = "";
    EXPECT_THAT(namesOf(checksOf(formula), failed), ElementsAre("scaling"));
}

TEST(Check, AFitThatDoesNotReadTheMediumIsReported) {
    FormulaModel formula;
    formula.value = [](const Medium&, int, const ParamValues&, const Query& query) {
        const double r = length(query.xo - query.xi);
        return 0.3 * std::exp(-r * r / 2) / (2 * std::numbers::pi);
    };
    formula.total = [](double) { return 0.3; };
    const auto results = checksOf(formula);
    EXPECT_THAT(namesOf(results, failed), IsEmpty());
    EXPECT_THAT(namesOf(results, reported), ElementsAre("scaling"));
}

TEST(Check, FindsAWrongClosedForm) {
    FormulaModel formula;
    formula.total = [](double alpha_prime) { return alpha_prime * 0.5001; };
    EXPECT_THAT(namesOf(checksOf(formula), failed), ElementsAre("closed form"));
}

TEST(Check, FindsAFalseRadialClaim) {
    FormulaModel formula;
    // Stretched along x by 1/1000; symmetric, so that it stays reciprocal.
    formula.value = [](const Medium& medium, int c, const ParamValues& p, const Query& query) {
        Query stretched = query;
        stretched.xo.x *= 1.001, stretched.xi.x *= 1.001;
        return FormulaModel::correct(medium, c, p, stretched);
    };
    const auto failures = namesOf(checksOf(formula), failed);
    EXPECT_THAT(failures, testing::Contains("radial"));
    // A radial profile is integrated along one ray: a false claim may spoil the total, and nothing else.
    EXPECT_THAT(failures, testing::Each(testing::AnyOf("radial", "closed form")));
}

TEST(Check, FindsAFalseNoWiClaim) {
    FormulaModel formula;
    formula.model.file.reciprocal = false;
    formula.value = [](const Medium& medium, int c, const ParamValues& p, const Query& query) {
        return FormulaModel::correct(medium, c, p, query) * (query.wi.z < 0.5 ? 0.999 : 1);
    };
    EXPECT_THAT(namesOf(checksOf(formula), failed), ElementsAre("no_wi"));
}

TEST(Check, FindsAFalseNoWoClaim) {
    FormulaModel formula;
    formula.model.file.reciprocal = false;
    formula.value = [](const Medium& medium, int c, const ParamValues& p, const Query& query) {
        return FormulaModel::correct(medium, c, p, query) * (query.wo.z < 0.5 ? 0.999 : 1);
    };
    const auto failures = namesOf(checksOf(formula), failed);
    EXPECT_THAT(failures, testing::Contains("no_wo"));
    EXPECT_THAT(failures, testing::Each(testing::AnyOf("no_wo", "closed form")));
}

TEST(Check, FindsAFalseClaimOfReciprocity) {
    FormulaModel formula;
    formula.model.file.no_wi = false;
    formula.value = [](const Medium& medium, int c, const ParamValues& p, const Query& query) {
        return FormulaModel::correct(medium, c, p, query) * (0.5 + 0.5 * query.wi.z);
    };
    formula.model.file.diffuse_reflectance = {};
    EXPECT_THAT(namesOf(checksOf(formula), failed), ElementsAre("reciprocal"));
}

TEST(Check, SaysWhichClaimsCouldBeMade) {
    FormulaModel formula;
    formula.model.file.no_wi = false;
    const auto results = checksOf(formula);
    EXPECT_THAT(namesOf(results, failed), IsEmpty());
    EXPECT_THAT(namesOf(results, reported), ElementsAre("no_wi"));
}

TEST(Check, FindsNaNAtTheEndOfAParameter) {
    FormulaModel formula;
    formula.model.file.parameters = {{.name = "Gain", .min = 0, .max = 1, .value = 0.5}};
    formula.value = [&](const Medium& medium, int c, const ParamValues& p, const Query& query) {
        const double gain = std::get<double>(valueOf(formula.model.file.parameters[0], p));
        return FormulaModel::correct(medium, c, p, query) * gain / gain;
    };
    const auto results = checksOf(formula);
    EXPECT_THAT(namesOf(results, failed), ElementsAre("parameter ends"));
    EXPECT_THAT(results.at("parameter ends").detail, HasSubstr("Gain = 0: NaN at r 0.001 mm"));
}

TEST(Check, FindsNaNAnywhere) {
    FormulaModel formula;
    formula.value = [](const Medium& medium, int c, const ParamValues& p, const Query& query) {
        const double one = std::sqrt(1.4 - medium.eta) / std::sqrt(1.4 - medium.eta);
        return FormulaModel::correct(medium, c, p, query) * one;
    };
    const auto results = checksOf(formula);
    EXPECT_EQ(results.at("finite").outcome, failed);
    EXPECT_THAT(results.at("finite").detail, HasSubstr("NaN at r 0.001 mm, alpha' 0.1, IOR 1.5"));
}

TEST(Check, AFaultWithoutAbsorptionIsReported) {
    FormulaModel formula;
    formula.value = [](const Medium& medium, int c, const ParamValues& p, const Query& query) {
        return FormulaModel::correct(medium, c, p, query) * medium.sigma_a[c] / medium.sigma_a[c];
    };
    const auto results = checksOf(formula);
    EXPECT_THAT(namesOf(results, failed), IsEmpty());
    EXPECT_THAT(namesOf(results, reported), ElementsAre("finite"));
}

TEST(Check, AModelOutsideThePortableSubsetIsReported) {
    FormulaModel formula;
    formula.model.file.shader.text =
        "vec3 Bssrdf(vec3 Xi, vec3 Wi, vec3 Xo, vec3 Wo) { vec3 R; R.xy = Xi.xy; return R; }\n";
    const auto results = checksOf(formula);
    EXPECT_THAT(namesOf(results, failed), IsEmpty());
    EXPECT_THAT(namesOf(results, reported), ElementsAre("portable"));
}

TEST(Check, AModelThatNeedsGlSaysSoWithoutIt) {
    FormulaModel formula;
    formula.model.shipped = false;
    Observer observer;
    try {
        checkModel(formula.model, {}, formula.factory(), observer);
        FAIL() << "no Error";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind, ErrorKind::device);
    }
}

TEST(Check, StopsWhenCancelled) {
    struct Impatient : Observer {
        mutable int polls = 0;
        bool cancelled() const override { return ++polls > 20; }
    } observer;
    const FormulaModel formula;
    EXPECT_THROW(checkModel(formula.model, {}, formula.factory(), observer), Error);
    EXPECT_EQ(observer.polls, 21);
}

TEST(Check, ErrorsWithAPlaceInTheModelEndTheRun) {
    FormulaModel formula;
    formula.value = [](const Medium&, int, const ParamValues&, const Query&) -> double {
        throw inputError("loop at line 12 exceeded 1e6 iterations").at("formula.bssrdf", 12);
    };
    EXPECT_THROW(checksOf(formula), Error);
}

TEST(Check, ShippedModelsPassWithoutGl) {
    Observer observer;
    const EvaluatorFactory native = [](const Model& model, std::string_view backend) {
        if (backend == "gl") throw deviceError("no GL in this test");
        return makeNativeEvaluator(model);
    };
    for (const Model& model : shippedModels())
        for (const CheckResult& result : checkModel(model, {}, native, observer))
            EXPECT_NE(result.outcome, failed) << model.id << ": " << result.name << ": " << result.detail;
}

}  // namespace
}  // namespace searchlight
