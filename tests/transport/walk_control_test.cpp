// Walks that stop early, go on, and keep their numbers.
#include "transport/walk/chunks.h"

#include <gtest/gtest.h>

#include <cmath>

#include "transport/half_space/half_space.h"
#include "transport/slab/slab.h"

namespace searchlight {
namespace {

constexpr HalfSpaceProblem problem{.sigma_a = 0.1, .sigma_s = 0.9, .g = 0.2, .eta = 1.3, .angle_deg = 20};

HalfSpaceOptions options(std::uint64_t walks) {
    HalfSpaceOptions o;
    o.walks = walks;
    o.edges_mm = {0, 0.1, 1, 3};
    o.threads = 2;
    return o;
}

std::vector<double> numbers(const HalfSpaceResult& result) {
    std::vector<double> all{static_cast<double>(result.walks), static_cast<double>(result.collisions)};
    for (const HalfSpaceTally* tally : {&result.all, &result.single, &result.multiple}) {
        for (const Estimate& e : {tally->total, tally->mean_x_mm, tally->mean_r2_mm2})
            all.insert(all.end(), {e.mean, e.standard_error});
        all.insert(all.end(), tally->Rd.begin(), tally->Rd.end());
        all.insert(all.end(), tally->standard_error.begin(), tally->standard_error.end());
    }
    return all;
}

// Cancels after so many reports of progress.
class Impatient : public Observer {
public:
    explicit Impatient(int patience) : patience_(patience) {}
    void progress(std::string_view, std::uint64_t, std::uint64_t, std::string_view) override { --patience_; }
    bool cancelled() const override { return patience_ <= 0; }

private:
    std::atomic<int> patience_;
};

TEST(Chunks, AreManyAndSmallAndCoverEveryWalk) {
    for (const std::uint64_t walks :
         {1ull, 63ull, 64ull, 127ull, 1000ull, 1'000'000ull, 4'194'304ull, 4'200'000ull, 10'000'000'000ull}) {
        const ChunkPlan plan = planChunks(walks);
        EXPECT_GE(plan.chunks(), std::min<std::uint64_t>(walks, 64)) << walks;
        EXPECT_LE(plan.size, 65'536u) << walks;
        const std::uint64_t last = plan.chunks() - 1;
        EXPECT_EQ(last * plan.size + plan.walksOf(last), walks);
    }
}

TEST(Chunks, MilestonesAreFourToADoubling) {
    std::vector<std::uint64_t> found;
    for (std::uint64_t chunks = 0; chunks <= 256; ++chunks)
        if (isMilestone(chunks)) found.push_back(chunks);
    EXPECT_EQ(found, (std::vector<std::uint64_t>{64, 80, 96, 112, 128, 160, 192, 224, 256}));
}

TEST(WalkControl, AnInterruptedWalkGoesOnToTheNumbersOfOneThatNeverStopped) {
    Observer calm;
    const HalfSpaceResult whole = walkHalfSpace(problem, options(100'000), calm);
    WalkState state;
    HalfSpaceOptions o = options(100'000);
    o.control.state = &state;
    for (int interruptions = 0; interruptions < 3; ++interruptions) {
        Impatient observer(9);
        const HalfSpaceResult part = walkHalfSpace(problem, o, observer);
        EXPECT_TRUE(part.interrupted);
        EXPECT_LT(part.walks, 100'000u);
        EXPECT_EQ(part.walks, state.walks);
    }
    EXPECT_GT(state.chunks, 16u);
    const HalfSpaceResult resumed = walkHalfSpace(problem, o, calm);
    EXPECT_FALSE(resumed.interrupted);
    EXPECT_EQ(numbers(resumed), numbers(whole));
}

TEST(WalkControl, AFinishedWalkIsNotWalkedAgain) {
    WalkState state;
    HalfSpaceOptions o = options(64 * 100);
    o.control.state = &state;
    Observer observer;
    const HalfSpaceResult first = walkHalfSpace(problem, o, observer);
    EXPECT_EQ(state.chunks, 64u);
    EXPECT_EQ(numbers(walkHalfSpace(problem, o, observer)), numbers(first));
}

TEST(WalkControl, MoreWalksThanBeforeAreThoseOfOneLongWalk) {
    Observer observer;
    constexpr std::uint64_t whole_chunks = 64 * 65'536;  // from there on, chunks are as large as they get
    WalkState state;
    SlabProblem slab;
    slab.layers = {{.n = 1.4, .sigma_a = 5, .sigma_s = 5, .g = 0, .thickness_mm = 0.1}};
    SlabOptions o;
    o.edges_mm = {0, 0.1, 1};
    o.depth_mm = 0.1;
    o.walks = whole_chunks + 1000;  // a last chunk that is not whole is walked again
    o.control.state = &state;
    walkSlab(slab, o, observer);
    EXPECT_EQ(state.chunks, 64u);
    o.walks = whole_chunks + 70'000;
    const SlabResult extended = walkSlab(slab, o, observer);
    o.control = {};
    const SlabResult straight = walkSlab(slab, o, observer);
    EXPECT_EQ(extended.walks, straight.walks);
    EXPECT_EQ(extended.collisions, straight.collisions);
    EXPECT_EQ(extended.flux, straight.flux);
    EXPECT_EQ(extended.R.standard_error, straight.R.standard_error);
}

// Chunks of a small first run would slow down all that follows.
TEST(WalkControl, ASmallFirstRunGoesOnInLargerChunks) {
    Observer calm;
    WalkState small;
    HalfSpaceOptions o = options(1000);
    o.control.state = &small;
    walkHalfSpace(problem, o, calm);
    EXPECT_EQ(small.chunk_size, 15u);
    EXPECT_EQ(small.walks, 990u);  // a last chunk that is not whole is walked again

    WalkState state = small;
    o = options(400'000);
    o.control.state = &state;
    const HalfSpaceResult straight = walkHalfSpace(problem, o, calm);
    EXPECT_EQ(straight.walks, 400'000u);
    EXPECT_EQ(state.chunk_size, 6250u);
    EXPECT_EQ(state.chunks, 66u + 63u);
    EXPECT_EQ(state.walks, 990u + 63 * 6250u);

    // As ever, neither threads nor interruptions change a number.
    state = small;
    o.threads = 1;
    Impatient first(2), second(9);
    EXPECT_TRUE(walkHalfSpace(problem, o, first).interrupted);
    EXPECT_TRUE(walkHalfSpace(problem, o, second).interrupted);
    o.threads = 3;
    EXPECT_EQ(numbers(walkHalfSpace(problem, o, calm)), numbers(straight));

    // The walks are others than those of one run, the truth and its error are the same.
    const HalfSpaceResult fresh = walkHalfSpace(problem, options(400'000), calm);
    const Estimate a = straight.all.total, b = fresh.all.total;
    EXPECT_NEAR(a.mean, b.mean, 4 * std::hypot(a.standard_error, b.standard_error));
    EXPECT_NEAR(a.standard_error, b.standard_error, 0.4 * b.standard_error);
}

TEST(Chunks, GoOnFromWhereAnEarlierRunEnded) {
    const WalkState state{.chunk_size = 10, .chunks = 70, .walks = 700, .sums = {}};
    const ChunkPlan larger = ChunkPlan{2000, 30}.goingOn(&state);
    EXPECT_EQ(larger.chunks(), 70u + 44u);
    EXPECT_EQ(larger.firstOf(70), 700u);
    EXPECT_EQ(larger.walksOf(112), 30u);
    EXPECT_EQ(larger.walksOf(113), 10u);
    EXPECT_EQ((ChunkPlan{1200, 19}.goingOn(&state).size), 10u) << "not twice as large";
    EXPECT_EQ((ChunkPlan{500, 5}.goingOn(&state).chunks()), 70u) << "nothing is left to walk";
    EXPECT_EQ((ChunkPlan{2000, 30}.goingOn(nullptr).chunks()), 67u);
}

TEST(WalkControl, StopsWhenTheErrorIsSmallEnoughWhateverTheThreads) {
    Observer observer;
    HalfSpaceOptions o = options(100'000'000);
    o.control.until_error = 0.01;
    const HalfSpaceResult result = walkHalfSpace(problem, o, observer);
    EXPECT_LT(result.walks, 1'000'000u);
    EXPECT_LE(result.all.total.standard_error, 0.01 * result.all.total.mean);
    o.threads = 1;
    EXPECT_EQ(numbers(walkHalfSpace(problem, o, observer)), numbers(result));
}

TEST(WalkControl, WithoutAStateAnInterruptionThrows) {
    Impatient observer(3);
    EXPECT_THROW(walkHalfSpace(problem, options(100'000), observer), Error);
}

TEST(WalkControl, RefusesAStateOfOtherTallies) {
    Observer observer;
    WalkState state;
    HalfSpaceOptions o = options(6400);
    o.control.state = &state;
    walkHalfSpace(problem, o, observer);
    o.edges_mm = {0, 1};
    EXPECT_THROW(walkHalfSpace(problem, o, observer), Error);
}

TEST(WalkControl, SumsSurviveBeingPacked) {
    BatchRatios a(2), b(2);
    const double one[] = {1.5, 2}, two[] = {3, 0.25};
    a.add(one, 10);
    a.add(two, 11);
    b.unpack(a.pack());
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(b.estimate(i, 1).mean, a.estimate(i, 1).mean);
        EXPECT_EQ(b.estimate(i, 1).standard_error, a.estimate(i, 1).standard_error);
    }
}

// A day of walks, with tallies as large as chunks make them: chunk i sends half +- a tenth of its walks to the middle
// bin, each after more collisions than fit into 32 bits for the job.
TEST(Chunks, TenBillionWalksOverflowNothing) {
    constexpr std::uint64_t walks = 10'000'000'000, collisions_per_walk = 4000;
    const std::vector<double> edges = {0, 1, 2, 3};
    const TallyLayout layout{RadialBins(edges)};
    ChunkedWalk job;
    job.plan = planChunks(walks);
    job.threads = 1;
    Observer observer;
    const ChunkedResult result = walkChunks(
        job, {BatchRatios(layout.slots())}, ExitTally(layout),
        [](std::uint64_t chunk, std::uint64_t n, ExitTally& tally) {
            const double part = chunk % 2 == 0 ? 0.4 : 0.6;
            tally.sums(ExitTally::multiple).flux[2] = part * static_cast<double>(n);
            return n * collisions_per_walk;
        },
        [](const ExitTally& tally, std::uint64_t n, std::vector<BatchRatios>& sums) {
            sums[0].add(tally.sums(ExitTally::multiple).flux, static_cast<double>(n));
        },
        observer);
    EXPECT_EQ(result.walks, walks);
    EXPECT_EQ(result.collisions, walks * collisions_per_walk);
    const Estimate bin = result.sums[0].estimate(2, result.walks);
    // The last chunk, of 58,368 walks in place of 65,536, unbalances the mean by 0.1 / 152,588 chunks.
    EXPECT_NEAR(bin.mean, 0.5, 1e-6);
    EXPECT_NEAR(bin.standard_error, 0.1 / std::sqrt(static_cast<double>(job.plan.chunks())), 1e-8);
    EXPECT_EQ(bin.count, walks);

    // What is kept of them, and sent between processes, is the same.
    BatchRatios copy(layout.slots());
    copy.unpack(result.sums[0].pack());
    EXPECT_EQ(copy.estimate(2, walks).mean, bin.mean);
    EXPECT_EQ(copy.estimate(2, walks).standard_error, bin.standard_error);
}

}  // namespace
}  // namespace searchlight
