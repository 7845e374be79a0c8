#include "render/brute_force.h"

#include <algorithm>
#include <cassert>
#include <chrono>

#include "base/error.h"
#include "render/exitance_sum.h"
#include "render/model_nodes.h"

namespace searchlight {

namespace {

// Pairs of a point and a receiver in one slice of work: some tenths of a second.
constexpr std::size_t profile_pairs = 50'000'000, model_pairs = 5'000'000;
constexpr std::size_t queries_per_batch = 65'536;

// A source of light for a model that reads directions: a point under one beam.
struct Source {
    Vec3 position, normal, wi;
    Rgb flux;  // T12 E area
    double least_mm = 0;
};

std::vector<Source> sourcesOf(const RenderInput& input) {
    const PointCloud& points = *input.points;
    std::vector<Source> sources;
    const auto add = [&](std::size_t i, Vec3 wi, Rgbf transmitted) {
        const Rgb flux = points.areas[i] * toDouble(transmitted);
        if (flux == Rgb{}) return;
        sources.push_back(
            {toDouble(points.positions[i]), toDouble(points.normals[i]), wi, flux, leastDistance(points.areas[i])});
    };
    if (input.model->file.no_wi) {
        for (std::size_t i = 0; i < points.positions.size(); ++i)
            add(i, toDouble(points.normals[i]), input.irradiance->transmitted[i]);
        return sources;
    }
    for (const Beam& beam : input.irradiance->beams)
        for (std::size_t i = 0; i < points.positions.size(); ++i)
            add(i, toDouble(beam.wi[beam.wi.size() == 1 ? 0 : i]), beam.flux[i]);
    return sources;
}

class BruteForce final : public Technique {
public:
    void start(const RenderInput& input, const ParamValues&, Observer&) override {
        input_ = input;
        const std::size_t count = input.visible->positions.size();
        exitance_.assign(count, {});
        known_.assign(count, 0);
        order_.clear();
        // Every 64th receiver first, then those between, so that a first picture is there soon.
        for (std::size_t stride = 64; stride >= 1; stride /= 2)
            for (std::size_t i = 0; i < count; i += stride)
                if (stride == 64 || i % (2 * stride) != 0) order_.push_back(static_cast<std::uint32_t>(i));
        next_ = 0;
        sum_ms_ = 0;
        sources_.clear();
        if (!input.profile) sources_ = sourcesOf(input);
    }

    bool step(Observer& observer) override {
        const auto begin = std::chrono::steady_clock::now();
        const std::size_t pairs = input_.profile ? profile_pairs : model_pairs;
        const std::size_t slice =
            std::min(order_.size() - next_, std::max<std::size_t>(1, pairs / std::max<std::size_t>(1, terms())));
        const std::span<const std::uint32_t> chosen(order_.data() + next_, slice);
        if (input_.profile)
            sumProfile(chosen);
        else
            sumModel(chosen, observer);
        next_ += slice;
        fillGaps();
        sum_ms_ += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
        observer.progress("brute force", next_, order_.size(), "receivers");
        return next_ == order_.size();
    }

    std::span<const Rgbf> exitance() const override { return exitance_; }

    TechniqueReport report() const override {
        return {.stage_ms = {{"tree", 0}, {"sum", sum_ms_}},
                .interactions = static_cast<std::uint64_t>(next_) * terms(),
                .approximates = "nothing but the surface by points",
                .device = input_.profile ? "cpu" : input_.evaluator->backend()};
    }

private:
    std::size_t terms() const { return input_.profile ? input_.points->positions.size() : sources_.size(); }

    void sumProfile(std::span<const std::uint32_t> chosen) {
        std::vector<Vec3f> receivers;
        for (const std::uint32_t i : chosen) receivers.push_back(input_.visible->positions[i]);
        const std::vector<Rgb> sums = sumExitanceDirectly(*input_.points, input_.irradiance->transmitted,
                                                          *input_.profile, receivers, input_.threads);
        for (std::size_t k = 0; k < chosen.size(); ++k) set(chosen[k], sums[k]);
    }

    void sumModel(std::span<const std::uint32_t> chosen, Observer& observer) {
        for (const std::uint32_t i : chosen) {
            if (observer.cancelled()) throw interruptedError();
            set(i, modelSum(i));
        }
    }

    Rgb modelSum(std::size_t receiver) {
        const Vec3 xo = toDouble(input_.visible->positions[receiver]);
        const Vec3 no = toDouble(input_.visible->normals[receiver]);
        const Vec3 wo = normalize(input_.visible->eye - xo);
        Rgb sum;
        for (std::size_t begin = 0; begin < sources_.size(); begin += queries_per_batch) {
            const auto sources =
                std::span(sources_).subspan(begin, std::min(queries_per_batch, sources_.size() - begin));
            queries_.clear();
            for (const Source& source : sources)
                queries_.push_back({pointOfEntry(source.position, source.normal, source.least_mm, xo), source.wi,
                                    source.normal, xo, wo, no});
            values_.resize(queries_.size());
            input_.evaluator->evaluate(queries_, values_);
            for (std::size_t i = 0; i < sources.size(); ++i) sum = sum + sources[i].flux * values_[i];
        }
        for (int c = 0; c < Rgb::channels; ++c)
            if (!input_.medium->scatters(c)) sum[c] = 0;
        return sum;
    }

    void set(std::size_t receiver, const Rgb& sum) {
        exitance_[receiver] = toFloat(sum);
        known_[receiver] = 1;
    }

    // What is not summed yet shows its nearest predecessor in the list, which stands beside it.
    void fillGaps() {
        if (next_ == order_.size()) return;
        Rgbf last;
        for (std::size_t i = 0; i < exitance_.size(); ++i)
            if (known_[i])
                last = exitance_[i];
            else
                exitance_[i] = last;
    }

    RenderInput input_;
    std::vector<Source> sources_;  // of a model that is not radial
    std::vector<std::uint32_t> order_;
    std::size_t next_ = 0;
    double sum_ms_ = 0;
    std::vector<std::uint8_t> known_;
    std::vector<Rgbf> exitance_;
    std::vector<Query> queries_;
    std::vector<Rgb> values_;
};

}  // namespace

std::unique_ptr<Technique> makeBruteForce(gl::Context*) { return std::make_unique<BruteForce>(); }

}  // namespace searchlight
