#include "render/direct/block_sum.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"
#include "render/exitance/receiver_tree.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/direct/block_sum.cpp"
#include <hwy/foreach_target.h>

#include "render/exitance/kernels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace searchlight {
namespace HWY_NAMESPACE {

// Points that a block takes, their flux multiplied by one over the probability.
struct Taken {
    std::vector<float> x, y, z;
    std::vector<float> flux[3];
    std::vector<std::int32_t> index;  // room for whole vectors at the end
    std::vector<float> square;        // of the distance to the box

    void reserve(std::size_t count) {
        for (auto* list : {&x, &y, &z, &flux[0], &flux[1], &flux[2]}) list->resize(count);
        index.resize(count + 32);
        square.resize(count + 32);
    }
};

struct BlockBox {
    float low[3], high[3];
};

BlockBox boxOf(const ReceiverBlocks& receivers, std::size_t block) {
    const std::size_t first = block * ReceiverBlocks::size;
    BlockBox box;
    std::size_t axis = 0;
    for (const auto* list : {&receivers.x, &receivers.y, &receivers.z}) {
        const auto [low, high] =
            std::minmax_element(list->begin() + static_cast<std::ptrdiff_t>(first),
                                list->begin() + static_cast<std::ptrdiff_t>(first + ReceiverBlocks::size));
        box.low[axis] = *low;
        box.high[axis++] = *high;
    }
    return box;
}

// `thresholds`: squares of the distances up to which a point is taken, shifted from block to block, so that each is
// paired with another point there.
std::size_t take(const BlockBox& box, const BlockSources& sources, const float* thresholds, double rate, Taken& taken) {
    const Float d;
    const Int di;
    const std::size_t lanes = hn::Lanes(d);
    const auto away = [&](const std::vector<float>& at, std::size_t i, std::size_t axis) {
        const FloatV place = hn::LoadU(d, &at[i]);
        return hn::Max(hn::Zero(d),
                       hn::Max(hn::Sub(hn::Set(d, box.low[axis]), place), hn::Sub(place, hn::Set(d, box.high[axis]))));
    };
    std::size_t count = 0;
    for (std::size_t i = 0; i < sources.x.size(); i += lanes) {
        const FloatV x = away(sources.x, i, 0), y = away(sources.y, i, 1), z = away(sources.z, i, 2);
        const FloatV square = hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(z, z)));
        const auto near = hn::Lt(square, hn::LoadU(d, thresholds + i));
        if (hn::AllFalse(d, near)) continue;
        storeSet(hn::Iota(di, static_cast<std::int32_t>(i)), hn::RebindMask(di, near), di, taken.index.data() + count);
        storeSet(square, near, d, taken.square.data() + count);
        count += hn::CountTrue(d, near);
    }
    for (std::size_t k = 0; k < count; ++k) {
        const auto i = static_cast<std::size_t>(taken.index[k]);
        taken.x[k] = sources.x[i];
        taken.y[k] = sources.y[i];
        taken.z[k] = sources.z[i];
        const auto weight = static_cast<float>(std::exp(rate * std::sqrt(taken.square[k])));
        for (std::size_t c = 0; c < 3; ++c) taken.flux[c][k] = weight * sources.flux[c][i];
    }
    return count;
}

void sumBlock(const ReceiverBlocks& receivers, std::size_t block, const Taken& taken, std::size_t count,
              const TableLanes& table, std::array<std::vector<float>, 3>& sums) {
    const Float d;
    const std::size_t lanes = hn::Lanes(d);
    const std::size_t first = block * ReceiverBlocks::size;
    for (std::size_t at = first; at < first + ReceiverBlocks::size; at += lanes) {
        const FloatV x = hn::LoadU(d, &receivers.x[at]), y = hn::LoadU(d, &receivers.y[at]),
                     z = hn::LoadU(d, &receivers.z[at]);
        FloatV sum[3] = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
        for (std::size_t k = 0; k < count; ++k) {
            const FloatV dx = hn::Sub(x, hn::Set(d, taken.x[k])), dy = hn::Sub(y, hn::Set(d, taken.y[k])),
                         dz = hn::Sub(z, hn::Set(d, taken.z[k]));
            const Place place = table.place(hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz))));
            for (std::size_t c = 0; c < 3; ++c)
                sum[c] = hn::MulAdd(hn::Set(d, taken.flux[c][k]), table.value(place, c), sum[c]);
        }
        for (std::size_t c = 0; c < 3; ++c) hn::StoreU(sum[c], d, &sums[c][at]);
    }
}

std::uint64_t sumRange(const ReceiverBlocks& receivers, const BlockSources& sources, const RadialTable::Impl& table,
                       const BlockRoulette& roulette, std::span<const float> thresholds, std::size_t begin,
                       std::size_t end, std::array<std::vector<float>, 3>& sums) {
    const TableLanes lanes(table, {});
    Taken taken;
    taken.reserve(sources.x.size());
    std::uint64_t pairs = 0;
    for (std::size_t block = begin; block < end; ++block) {
        SplitMix64 random = streamOf(roulette.seed, block);
        const std::size_t shift = random.next() % sources.x.size();
        const std::size_t count =
            take(boxOf(receivers, block), sources, thresholds.data() + shift, roulette.rate, taken);
        sumBlock(receivers, block, taken, count, lanes, sums);
        pairs += count * ReceiverBlocks::size;
    }
    return pairs;
}

}  // namespace HWY_NAMESPACE
}  // namespace searchlight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace searchlight {

HWY_EXPORT(sumRange);

ReceiverBlocks::ReceiverBlocks(std::span<const Vec3f> receivers) {
    const std::size_t padded = (receivers.size() + size - 1) / size * size;
    for (auto* list : {&x, &y, &z}) list->reserve(padded);
    for (std::size_t i = 0; i < padded; ++i) {
        const Vec3f& p = receivers[std::min(i, receivers.size() - 1)];
        x.push_back(p.x);
        y.push_back(p.y);
        z.push_back(p.z);
    }
}

void BlockSources::resize(std::size_t count) {
    for (auto* list : {&x, &y, &z, &flux[0], &flux[1], &flux[2]}) list->assign(count, 0);
}

std::uint64_t sumBlocks(const ReceiverBlocks& receivers, const BlockSources& given, const RadialTable& table,
                        const BlockRoulette& roulette, int threads, const Observer& observer,
                        std::array<std::vector<float>, 3>& sums) {
    for (auto& channel : sums) channel.assign(receivers.x.size(), 0);
    if (given.x.empty()) return 0;
    // Whole vectors: what fills the last one is too far away to be taken.
    constexpr std::size_t widest = 16;
    BlockSources sources = given;
    while (sources.x.size() % widest != 0) {
        for (auto* list : {&sources.x, &sources.y, &sources.z}) list->push_back(1e18f);
        for (auto& channel : sources.flux) channel.push_back(0);
    }
    const std::size_t count = sources.x.size();
    std::vector<float> thresholds(2 * count);
    const double reach_square = roulette.reach_mm * roulette.reach_mm;
    for (std::size_t i = 0; i < count; ++i) {
        SplitMix64 random = streamOf(~roulette.seed, i);
        const double most =
            roulette.rate > 0 ? -std::log(random.uniform()) / roulette.rate : std::numeric_limits<double>::infinity();
        thresholds[i] = thresholds[count + i] = static_cast<float>(std::min(most * most, reach_square));
    }
    constexpr std::size_t blocks_per_task = 32;
    const std::size_t tasks = (receivers.count() + blocks_per_task - 1) / blocks_per_task;
    std::vector<std::uint64_t> pairs(tasks);
    parallelFor(tasks, threads, [&](std::size_t task) {
        if (observer.cancelled()) throw interruptedError();
        const std::size_t begin = task * blocks_per_task;
        pairs[task] = HWY_DYNAMIC_DISPATCH(sumRange)(receivers, sources, table.impl(), roulette, thresholds, begin,
                                                     std::min(begin + blocks_per_task, receivers.count()), sums);
    });
    std::uint64_t total = 0;
    for (const std::uint64_t each : pairs) total += each;
    return total;
}

}  // namespace searchlight
#endif
