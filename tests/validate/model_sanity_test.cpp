#include "validate/model_sanity.h"

#include <algorithm>
#include <cmath>

#include "base/csv.h"
#include "base/error.h"
#include "base/files.h"
#include "formula_model.h"
#include "model/evaluator.h"

namespace searchlight {
namespace {

EvaluatorFactory native() {
    return [](const Model& model, std::string_view) { return makeNativeEvaluator(model); };
}

ModelSanity sanityOf(const FormulaModel& formula) {
    Observer observer;
    return modelSanity(formula.model, {}, formula.factory(), observer);
}

TEST(ModelSanity, ACorrectModelIsSane) {
    const ModelSanity sanity = sanityOf(FormulaModel());
    EXPECT_EQ(sanity.totals.size(), 144u);
    EXPECT_EQ(sanity.above.size(), 0u);
    // The formula's total is half the albedo; totals are good to 1e-8.
    for (const SanityTotal& total : sanity.totals) EXPECT_NEAR(total.total, total.albedo / 2, 1e-8);
    EXPECT_EQ(sanity.least_share, 0);
    EXPECT_TRUE(sanity.scales);
    EXPECT_LT(sanity.scaling, 1e-9);
    EXPECT_LT(sanity.reciprocal, 1e-9);
}

TEST(ModelSanity, FindsWhereEnergyIsMade) {
    FormulaModel formula;
    formula.value = [](const Medium& medium, int c, const ParamValues& p, const Query& query) {
        return (medium.eta == 1 && medium.alphaPrime()[c] > 0.99 ? 4 : 1) * FormulaModel::correct(medium, c, p, query);
    };
    const ModelSanity sanity = sanityOf(formula);
    // Three albedos lie above .99, at three g.
    EXPECT_EQ(sanity.above.size(), 9u);
    for (const SanityTotal& total : sanity.above) EXPECT_EQ(total.eta, 1);
    EXPECT_NEAR(sanity.most.total, 2 * .9999, 1e-7);
    EXPECT_NEAR(sanity.most.albedo, .9999, 1e-12);
}

TEST(ModelSanity, FindsWhatIsNegativeOneWayOrFixedInSize) {
    FormulaModel formula;
    formula.model.file.no_wi = false;
    formula.value = [](const Medium& medium, int c, const ParamValues& p, const Query& query) {
        const double lean = medium.g[c] > 0.6 && length(query.xo) > 10 ? -1 : 1 + 0.5 * query.wi.x;
        return lean * FormulaModel::correct(medium, c, p, query);
    };
    ModelSanity sanity = sanityOf(formula);
    EXPECT_LT(sanity.least_share, 0);
    EXPECT_NE(sanity.least_where.find("g 0.9"), std::string::npos) << sanity.least_where;
    EXPECT_GT(sanity.reciprocal, 0.1);
    formula = {};
    formula.value = [](const Medium& medium, int c, const ParamValues&, const Query& query) {
        return medium.alphaPrime()[c] * std::exp(-length(query.xo - query.xi));
    };
    sanity = sanityOf(formula);
    EXPECT_TRUE(sanity.scales);
    EXPECT_GT(sanity.scaling, 0.5);
}

// What the first line of a model's file says is what is measured, and nothing that could be said is missing.
TEST(ModelSanity, ClaimsOfShippedModelsAgreeWithWhatIsMeasured) {
    Observer observer;
    for (const Model& model : shippedModels()) {
        const ModelSanity sanity = modelSanity(model, {}, native(), observer);
        EXPECT_EQ(model.file.energy_violation, !sanity.above.empty())
            << model.id << " returns up to " << sanity.most.total;
        // 1e-9: rounding of double after exponentials of up to 50 (check_bench.h).
        EXPECT_EQ(model.file.reciprocal, sanity.reciprocal <= 1e-9) << model.id << " by " << sanity.reciprocal;
        if (sanity.scales) {
            EXPECT_LE(sanity.scaling, 1e-9) << model.id << " " << sanity.scaling_where;
        }
        EXPECT_EQ(sanity.scales, readsMedium(model)) << model.id;
        // As in the check of negative values: rounding.
        EXPECT_GE(sanity.least_share, -1e-6) << model.id << " " << sanity.least_where;
    }
}

TEST(ModelSanity, TheTablesAlbedosAreThoseOfTheExactTotals) {
    const CsvTable exact = parseCsv(
        readFile(std::filesystem::path(SEARCHLIGHT_SOURCE_DIR) / "tests/data/half_space_refractive.csv"), "exact");
    for (const auto& row : exact.rows) {
        const double albedo = std::stod(row[1].text);
        EXPECT_TRUE(std::ranges::count(sanityAlbedos(), albedo)) << albedo;
    }
}

}  // namespace
}  // namespace searchlight
