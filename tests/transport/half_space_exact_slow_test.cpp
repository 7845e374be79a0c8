#include <filesystem>
#include <optional>

#include "base/text.h"
#include "exact.h"

namespace searchlight {
namespace {

// Power: the median standard error is below 0.1 %, and a shift common to a family shows at a tenth of that.
TEST(HalfSpaceLong, MatchedTotalsAgreeWithTheHFunctionAtSevenIncidences) {
    Judge judge;
    compareMatchedTotals(judge, 1e6, 100'000);
    judge.expectAgreement();
}

TEST(HalfSpaceLong, RefractiveTotalsAgreeWithAddingDoubling) {
    Judge judge;
    compareRefractiveTotals(judge, 2e6, 200'000);
    judge.expectAgreement();
}

TEST(HalfSpaceLong, AnnuliAgreeWithTheExactSearchlight) {
    Judge judge;
    compareSearchlight(judge, 5e7, 300'000);
    judge.expectAgreement();
}

TEST(HalfSpaceLong, SingleScatteringAgreesWithQuadrature) {
    Judge judge;
    compareSingle(judge, 2e7, 400'000);
    judge.expectAgreement();
}

// A walk in single precision was once seen 2 standard errors low here. Standard error 3e-5.
TEST(HalfSpaceLong, MatchedTotalAtAlbedo999HasNoBiasOfFloat) {
    Judge judge;
    judge.compare("albedo 0.999", walk(ofAlbedo(0.999), 1e8, 7).all.total, 0.91284914);
    judge.expectAgreement();
}

// The share of the walks that meet the roulette is 0.5 %; the standard error is 0.05 %.
TEST(HalfSpaceLong, WithoutAbsorptionEverythingLeaves) {
    Judge judge;
    judge.compare("matched", walk(ofAlbedo(1), 1e6, 8).all.total, 1);
    judge.expectAgreement();
}

// An independent program: MCML with a sound generator, six media, curves with standard errors of their own.
TEST(HalfSpaceLong, CurvesAgreeWithMcml) {
    const std::filesystem::path folder = SEARCHLIGHT_SOURCE_DIR "/../shared/data/mcml";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "the MCML curves are not there: " << folder;
    Judge judge;
    std::uint64_t seed = 9;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.path().extension() != ".csv") continue;
        const std::string text = readFile(entry.path());
        const auto header = [&](const std::string& key) {
            const std::size_t at = text.find(key + "=") + key.size() + 1;
            return parseNumber(text.substr(at, text.find_first_of(" \n", at) - at)).value();
        };
        const CsvTable curve = parseCsv(text, entry.path().string());
        const double width = header("dr_mm");
        std::vector<double> edges;
        constexpr std::size_t bins = 300;
        for (std::size_t i = 0; i <= bins; ++i) edges.push_back(static_cast<double>(i) * width);
        const HalfSpaceProblem problem{
            .sigma_a = header("mua_per_mm"), .sigma_s = header("mus_per_mm"), .eta = header("n")};
        const HalfSpaceResult result = walk(problem, 2e7, seed++, edges);
        judge.compare(entry.path().filename().string(),
                      {result.all.total.mean, std::hypot(result.all.total.standard_error, header("Rd_stderr")), 0},
                      header("diffuse_Rd"));
        for (std::size_t i = 0; i < bins; ++i) {
            const std::optional<double> relative = parseNumber(curve.rows[i][2].text);
            if (!relative) continue;  // infinite: MCML met nothing there
            const double area = std::numbers::pi * (edges[i + 1] * edges[i + 1] - edges[i] * edges[i]);
            const double other = curve.number(i, 1), other_error = other * *relative;
            const double exits = other * area * std::min(header("photons"), static_cast<double>(result.walks));
            judge.compare(fmt::format("{} bin {}", entry.path().filename().string(), i),
                          {result.all.Rd[i], std::hypot(result.all.standard_error[i], other_error), 0}, other, exits);
        }
    }
    judge.expectAgreement();
}

}  // namespace
}  // namespace searchlight
