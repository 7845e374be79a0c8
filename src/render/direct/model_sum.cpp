#include "render/direct/model_sum.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"

namespace searchlight {

namespace {

// Of the probability, what goes by flux alone.
constexpr double even_part = 0.1;

// Queries that are evaluated at once: what keeps OpenGL busy and fits into a cache.
constexpr std::size_t batch = 8'192;

// The envelope in a table over the logarithm of the squared distance: 16 entries to an octave of it, where it changes
// by a few percent. It chooses, so that it need not be exact.
class Envelope {
public:
    Envelope(const Profile& mean, const Medium& medium) {
        constexpr int octaves = 40;
        const Rgb total = mean.total();
        for (int i = 0; i <= octaves * per_octave; ++i) {
            const double r = std::sqrt(least * std::exp2(static_cast<double>(i) / per_octave));
            const Rgb value = mean(r);
            double sum = 0;
            for (int c = 0; c < Rgb::channels; ++c)
                if (medium.scatters(c) && total[c] > 0) sum += std::abs(value[c]) / total[c];
            values_.push_back(static_cast<float>(sum));
        }
    }

    double operator()(double square_mm2) const {
        const double at = per_octave * std::log2(std::max(square_mm2, least) / least);
        return static_cast<double>(values_[std::min(static_cast<std::size_t>(at), values_.size() - 1)]);
    }

private:
    static constexpr int per_octave = 16;
    static constexpr double least = 1e-6;  // mm^2
    std::vector<float> values_;
};

struct Box {
    Vec3f low, high;

    double squareTo(Vec3f p) const {
        const auto away = [](float from, float to, float x) {
            return static_cast<double>(std::max(0.0f, std::max(from - x, x - to)));
        };
        const double x = away(low.x, high.x, p.x), y = away(low.y, high.y, p.y), z = away(low.z, high.z, p.z);
        return x * x + y * y + z * z;
    }
};

Box boxOf(std::span<const Vec3f> receivers) {
    Box box{receivers[0], receivers[0]};
    for (const Vec3f& p : receivers) {
        box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y), std::min(box.low.z, p.z)};
        box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y), std::max(box.high.z, p.z)};
    }
    return box;
}

double brightness(const Rgbf& flux) {
    return static_cast<double>(flux.r) + static_cast<double>(flux.g) + static_cast<double>(flux.b);
}

struct Taken {
    std::size_t source = 0;
    double times = 1;
};

}  // namespace

ModelEvaluators::ModelEvaluators(const RenderInput& input) {
    const int count = input.threads > 0 ? input.threads : hardwareThreads();
    if (!hasNativeEvaluator(*input.model)) {
        evaluators_.push_back(input.evaluator);
        return;
    }
    for (int i = 0; i < count; ++i) {
        own_.push_back(makeNativeEvaluator(*input.model));
        own_.back()->set(*input.medium, modelParameters(input));
        evaluators_.push_back(own_.back().get());
    }
}

std::uint64_t sumModelBlocks(const RenderInput& input, const ModelEvaluators& evaluators,
                             std::span<const ModelSource> sources, const Profile& mean,
                             const std::function<double(double r_mm)>& weight, const ModelChoice& choice,
                             const Observer& observer, std::vector<Rgb>& sums) {
    const std::span<const Vec3f> receivers = input.visible->positions;
    sums.assign(receivers.size(), {});
    double flux = 0;
    for (const ModelSource& source : sources) flux += brightness(source.flux);
    if (!(flux > 0)) return 0;
    const Envelope envelope(mean, *input.medium);
    const std::size_t blocks = (receivers.size() + ReceiverBlocks::size - 1) / ReceiverBlocks::size;
    std::atomic<std::size_t> next = 0;
    std::atomic<std::uint64_t> pairs = 0;

    const auto sumBlock = [&](std::size_t block, Evaluator& evaluator, std::vector<double>& shares,
                              std::vector<Taken>& taken, std::vector<Query>& queries, std::vector<Rgb>& values) {
        const std::size_t first = block * ReceiverBlocks::size;
        const std::size_t last = std::min(first + ReceiverBlocks::size, receivers.size());
        const Box box = boxOf(receivers.subspan(first, last - first));
        double total = 0;
        for (std::size_t i = 0; i < sources.size(); ++i)
            total += shares[i] = brightness(sources[i].flux) * envelope(box.squareTo(sources[i].position));
        taken.clear();
        SplitMix64 random = streamOf(choice.seed, block);
        const double wanted = static_cast<double>(choice.sources);
        for (std::size_t i = 0; i < sources.size(); ++i) {
            const double by_envelope = total > 0 ? (1 - even_part) * shares[i] / total : 0;
            const double p = wanted * (by_envelope + even_part * brightness(sources[i].flux) / flux);
            if (p >= 1)
                taken.push_back({i, 1});
            else if (random.uniform() < p)
                taken.push_back({i, 1 / p});
        }
        queries.clear();
        std::size_t begin = first;  // of the receivers whose queries are waiting
        for (std::size_t o = first; o < last; ++o) {
            const Vec3 xo = toDouble(receivers[o]), no = toDouble(input.visible->normals[o]);
            const Vec3 wo = normalize(input.visible->eye - xo);
            for (const Taken& each : taken) {
                const ModelSource& source = sources[each.source];
                queries.push_back(
                    {toDouble(source.position), toDouble(source.wi), toDouble(source.normal), xo, wo, no});
            }
            if (queries.size() < batch && o + 1 < last) continue;
            values.resize(queries.size());
            if (!queries.empty()) evaluator.evaluate(queries, values);
            for (std::size_t k = 0; k < queries.size(); ++k) {
                const Taken& each = taken[k % taken.size()];
                const Rgb light = toDouble(sources[each.source].flux);
                const double times = each.times * weight(length(queries[k].xi - queries[k].xo));
                Rgb& sum = sums[begin + k / taken.size()];
                for (int c = 0; c < Rgb::channels; ++c)
                    if (input.medium->scatters(c)) sum[c] += times * light[c] * values[k][c];
            }
            queries.clear();
            begin = o + 1;
        }
        pairs += taken.size() * (last - first);
    };

    parallelFor(std::min(blocks, evaluators.count()), input.threads, [&](std::size_t w) {
        std::vector<double> shares(sources.size());
        std::vector<Taken> taken;
        std::vector<Query> queries;
        std::vector<Rgb> values;
        for (std::size_t block = next++; block < blocks; block = next++) {
            if (observer.cancelled()) throw interruptedError();
            sumBlock(block, evaluators[w], shares, taken, queries, values);
        }
    });
    return pairs;
}

}  // namespace searchlight
