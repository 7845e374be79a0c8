// Quick families; half_space_exact_slow_test.cpp repeats them with a hundred times the walks.
#include "exact.h"

namespace searchlight {
namespace {

// Power: the standard errors are 0.1 % to 5 % of the totals, 0.7 % in the middle of the range; a family of 100 sees a
// common shift of a tenth of that. Leaving out internal reflection, or the last line of a roulette, moves totals by 10
// %.
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

// Weak, because these walks are long: sees an error of 2 %. The roulette itself is checked in long_walk_test.cpp.
TEST(HalfSpace, WithoutAbsorptionEverythingLeaves) {
    Judge judge;
    judge.compare("matched", walk(ofAlbedo(1), 4000, 5).all.total, 1);
    judge.compare("index 1.4, g 0.5", walk(ofAlbedo(1, 1.4, 0.5), 4000, 6).all.total, 1 - std::pow(0.4 / 2.4, 2));
    judge.expectAgreement();
}

}  // namespace
}  // namespace searchlight
