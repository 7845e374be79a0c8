// Quick families; half_space_exact_slow_test.cpp repeats them with a hundred times the walks.
#include "exact.h"

namespace searchlight {
namespace {

// Power: at 1e5 walks the median standard error is 0.3 %; leaving out internal reflection moves totals by 10 % and more.
TEST(HalfSpace, MatchedTotalsAgreeWithTheHFunctionAtSevenIncidences) {
    Judge judge;
    compareMatchedTotals(judge, 2e4, 1000);
    judge.expectAgreement();
}

TEST(HalfSpace, RefractiveTotalsAgreeWithAddingDoubling) {
    Judge judge;
    compareRefractiveTotals(judge, 5e4, 2000);
    judge.expectAgreement();
}

TEST(HalfSpace, AnnuliAgreeWithTheExactSearchlight) {
    Judge judge;
    compareSearchlight(judge, 1e6, 3000);
    judge.expectAgreement();
}

TEST(HalfSpace, SingleScatteringAgreesWithQuadrature) {
    Judge judge;
    compareSingle(judge, 5e5, 4000);
    judge.expectAgreement();
}

// The mean is 1; walks that meet the roulette carry 1e-2 of it, so a roulette that cuts would be 3 errors low.
TEST(HalfSpace, WithoutAbsorptionEverythingLeaves) {
    Judge judge;
    judge.compare("matched", walk(ofAlbedo(1), 2e4, 5).all.total, 1);
    judge.compare("index 1.4, g 0.5", walk(ofAlbedo(1, 1.4, 0.5), 2e4, 6).all.total, 1 - std::pow(0.4 / 2.4, 2));
    judge.expectAgreement();
}

}  // namespace
}  // namespace searchlight
