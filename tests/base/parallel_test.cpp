#include "base/parallel.h"

#include <atomic>

#include "base/error.h"

namespace searchlight {
namespace {

TEST(Parallel, EveryIndexIsVisitedOnce) {
    for (const int threads : {0, 1, 2}) {
        std::vector<std::atomic<int>> visits(1000);
        parallelFor(visits.size(), threads, [&](std::size_t i) { ++visits[i]; });
        for (const std::atomic<int>& count : visits) EXPECT_EQ(count, 1);
    }
}

TEST(Parallel, ExceptionReachesTheCaller) {
    EXPECT_THROW(parallelFor(100, 2,
                             [](std::size_t i) {
                                 if (i == 42) throw inputError("42");
                             }),
                 Error);
}

}  // namespace
}  // namespace searchlight
