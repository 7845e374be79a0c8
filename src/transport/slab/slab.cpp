#include "transport/slab/slab.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/error.h"
#include "base/parallel.h"
#include "base/text.h"
#include "transport/slab/slab_best.h"
#include "transport/slab/slab_entry.h"
#include "transport/slab/slab_gl.h"
#include "transport/slab/slab_walk.h"
#include "transport/walk/chunks.h"

namespace searchlight {

namespace {

constexpr std::size_t kMostSlots = std::size_t{1} << 22;  // of which a few per thread are in memory at once
constexpr std::size_t kMostPlanned = 200'000;             // where the best estimator is worth its pilot
constexpr double kLargest = 1e9;
// Free paths in a clear layer: longer than anything, its products within float.
constexpr double kClearMfp = 1e30;

[[noreturn]] void reject(const std::string& what, double value, const char* valid) {
    throw inputError(what + " is " + numberText(value), valid);
}

// Written so that NaN is rejected.
void check(const SlabProblem& problem) {
    const auto checkIndex = [](const std::string& what, double n) {
        if (!(n >= 0.1 && n <= 10)) reject(what, n, "0.1 to 10");
    };
    checkIndex("the refractive index above", problem.n_above);
    checkIndex("the refractive index below", problem.n_below);
    if (!(problem.angle_deg >= 0 && problem.angle_deg < 90))
        reject("the angle of incidence", problem.angle_deg, "0 to below 90 degrees");
    const BeamShape& beam = problem.beam;
    if (beam.kind != BeamShape::pencil && !(beam.radius > 0 && beam.radius <= kLargest))
        reject("the radius of the beam", beam.radius, "above 0, up to 1e9 mm");
    if (problem.layers.empty()) throw inputError("a slab needs at least one layer");
    for (std::size_t i = 0; i < problem.layers.size(); ++i) {
        const SlabLayer& layer = problem.layers[i];
        const auto what = [&](const char* quantity) { return fmt::format("{} of layer {}", quantity, i + 1); };
        checkIndex(what("the refractive index"), layer.n);
        if (!(layer.sigma_a >= 0 && layer.sigma_a <= kLargest)) reject(what("sigma_a"), layer.sigma_a, "0 to 1e9 1/mm");
        if (!(layer.sigma_s >= 0 && layer.sigma_s <= kLargest)) reject(what("sigma_s"), layer.sigma_s, "0 to 1e9 1/mm");
        if (!(layer.g > -1 && layer.g < 1)) reject(what("g"), layer.g, "above -1 and below 1");
        const bool endless = std::isinf(layer.thickness_mm) && layer.thickness_mm > 0;
        if (endless && i + 1 < problem.layers.size())
            throw inputError(what("the thickness") + " is infinite", "only the last layer may be");
        if (endless && layer.clear())
            throw inputError(fmt::format("layer {} is infinite and clear", i + 1), "light would never end in it");
        if (!endless && !(layer.thickness_mm >= 0 && layer.thickness_mm <= 10 * kLargest))
            reject(what("the thickness"), layer.thickness_mm, "0 to 1e10 mm, or infinite in the last layer");
    }
}

void check(const SlabOptions& options) {
    if (options.walks == 0) throw inputError("a reference needs at least one walk");
    const std::vector<double>& edges = options.edges_mm;
    if (edges.size() < 2) throw inputError("radial bins need at least 2 edges");
    if (!(edges.front() >= 0)) reject("the first edge", edges.front(), "0 mm or more");
    for (std::size_t i = 1; i < edges.size(); ++i)
        if (!(edges[i] > edges[i - 1] && edges[i] <= kLargest))
            reject("an edge", edges[i], "edges ascend and end at 1e9 mm");
    if (options.angles < 1) reject("the number of angles", options.angles, "1 or more");
    if (options.depths < 1) reject("the number of depths", options.depths, "1 or more");
    if (!(options.depth_mm > 0 && options.depth_mm <= kLargest))
        reject("the depth of the tally", options.depth_mm, "above 0, up to 1e9 mm");
    if (options.grid < 0) reject("the grid", options.grid, "0 or more cells a side");
    if (options.grid > 0 && !(options.grid_extent_mm > 0 && options.grid_extent_mm <= kLargest))
        reject("the extent of the grid", options.grid_extent_mm, "above 0, up to 1e9 mm");
    const double rows = static_cast<double>(edges.size()) + 1, side = options.grid;
    const double cells = 2.0 * options.angles + 2.0 * options.depths + 2;
    if ((options.maps ? rows * cells : 4 * rows + cells) + 2 * side * side > kMostSlots)
        throw inputError("the tallies have more than 4 million cells", "fewer radial bins, angles, depths or cells");
}

// Which part of the collisions the tally counts: all would take more time than the walk. Where walks collide often
// before they are absorbed, each collision says little that its neighbours do not. At least the absorbed ones, so that
// counting those alone (the analogue estimator, all that there is on OpenGL) is the end of the scale.
double countedPart(const SlabLayer& layer, bool absorbed_alone) {
    const double absorbed = layer.sigma_a / (layer.sigma_a + layer.sigma_s);
    return absorbed_alone ? absorbed : std::clamp(2.5 * std::sqrt(absorbed), 1.0 / 16, 1.0);
}

SlabLayout::Layer countedCollision(const SlabLayer& layer, double top_mm, bool absorbed_alone) {
    if (layer.clear()) return {top_mm, 0, 0};
    const double counted = (layer.sigma_a + layer.sigma_s) * countedPart(layer, absorbed_alone);
    if (counted == 0) return {top_mm, 0, 0};
    return {top_mm, layer.sigma_a / counted, 1 / counted};
}

SlabWalk walkOf(const SlabProblem& problem, const SlabEntry& entry) {
    SlabWalk walk;
    const std::vector<SlabLayer>& layers = problem.layers;
    for (std::size_t i = 0; i < layers.size(); ++i) {
        const SlabLayer& layer = layers[i];
        const double sigma_t = layer.sigma_a + layer.sigma_s;
        const double above = i == 0 ? problem.n_above : layers[i - 1].n;
        const double below = i + 1 == layers.size() ? problem.n_below : layers[i + 1].n;
        SlabWalk::Layer& into = walk.layers.emplace_back();
        into.mfp_mm = layer.clear() ? kClearMfp : 1 / sigma_t;
        into.absorbed = layer.clear() ? 0 : layer.sigma_a / sigma_t;
        into.counted = layer.clear() ? 0 : countedPart(layer, false);
        into.g = layer.g;
        if (layer.phase) into.phase = walk.tables.add(*layer.phase);
        into.thickness_mm = layer.thickness_mm;
        into.eta_up = layer.n / above;
        into.eta_down = layer.n / below;
    }
    walk.entry = entry.shift;
    walk.shape = problem.beam;
    walk.cos_incidence = std::cos(problem.angle_deg * (std::numbers::pi / 180));
    walk.first = static_cast<std::int32_t>(entry.first);
    walk.sin_beam = entry.sine;
    walk.cos_beam = std::sqrt((1 - entry.sine) * (1 + entry.sine));
    return walk;
}

// How much of each depth bin is not clear, and the most that one counted collision there stands for.
struct Occupied {
    double length_mm = 0, absorbed = 0, fluence_mm = 0;
};

std::vector<Occupied> occupiedDepths(const SlabProblem& problem, const SlabOptions& options) {
    std::vector<Occupied> bins(static_cast<std::size_t>(options.depths));
    const double step = options.depth_mm / options.depths;
    double top = 0;
    for (const SlabLayer& layer : problem.layers) {
        const double bottom = top + layer.thickness_mm;
        const SlabLayout::Layer one = countedCollision(layer, top, options.gl);
        for (std::size_t i = 0; one.fluence_mm > 0 && i < bins.size(); ++i) {
            const double begin = step * static_cast<double>(i), end = step * static_cast<double>(i + 1);
            const double length = std::min(bottom, end) - std::max(top, begin);
            if (length <= 1e-9 * step) continue;  // the rounding of thicknesses that are multiples of the step
            bins[i].length_mm += std::min(length, step);
            bins[i].absorbed = std::max(bins[i].absorbed, one.absorbed);
            bins[i].fluence_mm = std::max(bins[i].fluence_mm, one.fluence_mm);
        }
        top = bottom;
    }
    return bins;
}

// From sums over chunks to the numbers of the result.
class Reduction {
public:
    /// `walks` behind the sums; 0: no light came into the slab, and all is exactly 0. `best`: who walked, or null.
    Reduction(const SlabProblem& problem, const SlabOptions& options, const SlabLayout& layout, double transmitted,
              const BatchRatios& sums, std::uint64_t walks, const SlabBestPlan* best = nullptr)
        : problem_(problem),
          options_(options),
          layout_(layout),
          transmitted_(transmitted),
          sums_(sums),
          walks_(walks),
          best_(best) {}

    void finish(SlabResult& result) const {
        result.R = total(SlabLayout::R_scattered);
        result.R_single = total(SlabLayout::R_single);
        result.R_multiple = total(SlabLayout::R_multiple);
        result.R_unscattered = unscattered(SlabLayout::R_unscattered);
        result.T = total(SlabLayout::T_scattered);
        result.T_unscattered = unscattered(SlabLayout::T_unscattered);
        result.A = total(SlabLayout::A_total);
        for (std::size_t i = 0; i < problem_.layers.size(); ++i)
            result.A_layer.push_back(problem_.layers[i].sigma_a > 0 ? total(SlabLayout::A_layer, i) : Estimate{});

        const std::vector<double> areas = annuli(), solid = solidAngles(false), projected = solidAngles(true);
        result.R_r = series(SlabLayout::R_r, 1, areas);
        result.R_r_single = series(SlabLayout::R_r_single, 1, areas);
        result.R_r_multiple = series(SlabLayout::R_r_multiple, 1, areas);
        result.T_r = series(SlabLayout::T_r, 1, areas);
        result.R_a = series(SlabLayout::R_a, 0, solid);
        result.T_a = series(SlabLayout::T_a, 0, solid);
        depths(result.A_z, result.fluence_z, SlabLayout::A_z, SlabLayout::F_z, 0, 1);
        if (layout_.maps()) {
            for (std::size_t row = 0; row < areas.size(); ++row) {
                std::vector<double> cells = projected;
                for (double& cell : cells) cell *= areas[row];
                const std::size_t angle = (row + 1) * layout_.angles(), depth = (row + 1) * layout_.depths();
                append(result.R_ra, series(SlabLayout::R_ra, angle, cells));
                append(result.T_ra, series(SlabLayout::T_ra, angle, cells));
                depths(result.A_rz, result.fluence_rz, SlabLayout::A_rz, SlabLayout::F_rz, depth, areas[row]);
            }
        }
        if (layout_.grid() > 0) {
            const double side = 2 * options_.grid_extent_mm / options_.grid;
            const std::vector<double> cells(layout_.grid() * layout_.grid(), side * side);
            result.R_xy = series(SlabLayout::R_xy, 0, cells);
            result.T_xy = series(SlabLayout::T_xy, 0, cells);
        }
        for (std::size_t slot = 0; slot < layout_.slots(); ++slot) result.flux.push_back(flux(slot, 0).mean);
    }

private:
    // Per unit incident flux. The scatter of batches without an event would be 0; one event is the least that can be
    // said.
    Estimate flux(std::size_t slot, double one_event) const {
        if (walks_ == 0) return {};
        Estimate e = sums_.estimate(slot, walks_);
        double least = one_event / static_cast<double>(walks_);
        const double led = best_ != nullptr && best_->lead ? best_->lead->event[slot] : 0;
        if (led > 0) least = led / static_cast<double>(walks_);
        // Counted alone, one event is still the least.
        const bool foreseen = best_ != nullptr && best_->mix.foresees && best_->mix.part[slot] < 1;
        if (led > 0 || foreseen)
            // Where less than a thousandth of an exit was foreseen, what leaves may come by ways that no walk took.
            least = e.mean < 1e-3 * least ? least : 0;
        e.standard_error = std::max(e.standard_error, least);
        return {transmitted_ * e.mean, transmitted_ * e.standard_error, e.count};
    }

    Estimate total(SlabLayout::Run run, std::size_t index = 0) const { return flux(layout_.first(run) + index, 1); }

    // The best estimator knows it exactly.
    Estimate unscattered(SlabLayout::Run run) const { return flux(layout_.first(run), best_ ? 0 : 1); }

    static void push(SlabSeries& series, const Estimate& e, double measure) {
        series.mean.push_back(e.mean / measure);
        series.standard_error.push_back(e.standard_error / measure);
    }

    static void append(SlabSeries& to, const SlabSeries& more) {
        to.mean.insert(to.mean.end(), more.mean.begin(), more.mean.end());
        to.standard_error.insert(to.standard_error.end(), more.standard_error.begin(), more.standard_error.end());
    }

    // Slots of the run from `index` on, each over its measure.
    SlabSeries series(SlabLayout::Run run, std::size_t index, const std::vector<double>& measures) const {
        SlabSeries series;
        for (std::size_t i = 0; i < measures.size(); ++i) push(series, total(run, index + i), measures[i]);
        return series;
    }

    void depths(SlabSeries& A, SlabSeries& fluence, SlabLayout::Run A_run, SlabLayout::Run F_run, std::size_t index,
                double area) const {
        const double step = options_.depth_mm / options_.depths;
        const std::vector<Occupied> bins = occupiedDepths(problem_, options_);
        constexpr double nan = std::numeric_limits<double>::quiet_NaN();
        for (std::size_t i = 0; i < bins.size(); ++i) {
            const auto& [length, absorbed_at_most, fluence_at_most] = bins[i];
            push(A, flux(layout_.first(A_run) + index + i, absorbed_at_most), area * step);
            if (length > 0)
                push(fluence, flux(layout_.first(F_run) + index + i, fluence_at_most), area * length);
            else
                push(fluence, {nan, nan, 0}, 1);
        }
    }

    std::vector<double> annuli() const {
        const std::vector<double>& edges = options_.edges_mm;
        std::vector<double> areas;
        for (std::size_t i = 0; i + 1 < edges.size(); ++i)
            areas.push_back(std::numbers::pi * (edges[i + 1] - edges[i]) * (edges[i + 1] + edges[i]));
        return areas;
    }

    // Of the parts of the hemisphere, times the cosine if projected.
    std::vector<double> solidAngles(bool projected) const {
        const double step = 0.5 * std::numbers::pi / options_.angles;
        std::vector<double> parts;
        for (int i = 0; i < options_.angles; ++i) {
            const double middle = (i + 0.5) * step;
            parts.push_back(projected ? std::numbers::pi * std::sin(step) * std::sin(2 * middle)
                                      : 4 * std::numbers::pi * std::sin(0.5 * step) * std::sin(middle));
        }
        return parts;
    }

    const SlabProblem& problem_;
    const SlabOptions& options_;
    const SlabLayout& layout_;
    double transmitted_;
    const BatchRatios& sums_;
    std::uint64_t walks_;
    const SlabBestPlan* best_;
};

// Whether what is reflected, transmitted and absorbed is known well enough, where there is any.
EnoughFunction enoughFor(double error, const SlabLayout& layout) {
    if (error <= 0) return {};
    return [error, &layout](const std::vector<BatchRatios>& sums, std::uint64_t walks) {
        for (const SlabLayout::Run run : {SlabLayout::R_scattered, SlabLayout::T_scattered, SlabLayout::A_total}) {
            const Estimate e = sums[0].estimate(layout.first(run), walks);
            if (e.mean > 0 && e.standard_error > error * e.mean) return false;
        }
        return true;
    };
}

}  // namespace

SlabLayout slabLayout(const SlabProblem& problem, const SlabOptions& options) {
    check(problem);
    check(options);
    std::vector<SlabLayout::Layer> layers;
    double top = 0;
    for (const SlabLayer& layer : problem.layers) {
        layers.push_back(countedCollision(layer, top, options.gl));
        top += layer.thickness_mm;
    }
    return {options.edges_mm,
            static_cast<std::size_t>(options.angles),
            static_cast<std::size_t>(options.depths),
            options.depth_mm,
            {options.maps, static_cast<std::size_t>(options.grid), options.grid_extent_mm},
            std::move(layers)};
}

SlabResult walkSlab(const SlabProblem& problem, const SlabOptions& options, Observer& observer) {
    const SlabLayout layout = slabLayout(problem, options);
    const SlabEntry entry = slabEntry(problem);
    SlabResult result;
    result.specular = entry.specular;
    result.threads = options.threads > 0 ? options.threads : hardwareThreads();
    result.instruction_set = slabInstructionSet();
    if (entry.first == problem.layers.size() || entry.specular == 1) {  // nothing to walk in
        Reduction(problem, options, layout, 1 - entry.specular, BatchRatios(layout.slots()), 0).finish(result);
        result.T_unscattered = {1 - entry.specular, 0, 0};
        return result;
    }

    const SlabWalk walk = walkOf(problem, entry);
    std::optional<SlabBestPlan> best;
    // What a pilot has to learn of more would take longer than most walks.
    if (options.estimator == SlabEstimator::best && !options.gl && layout.slots() > kMostPlanned) {
        observer.log(LogLevel::info, fmt::format("{} tallies: the analogue estimator walks", layout.slots()));
    } else if (options.estimator == SlabEstimator::best && !options.gl) {
        best.emplace(walk, options.edges_mm, layout);
        result.estimator = SlabEstimator::best;
        result.foresees = best->mix.foresees;
    }
    ChunkedWalk job;
    job.plan = planChunks(options.walks, options.control.until_error > 0);
    job.plan = job.plan.goingOn(options.control.state);
    job.threads = options.threads;
    job.enough = enoughFor(options.control.until_error, layout);
    job.control = options.control;
    std::optional<SlabGl> device;
    if (options.gl) {
        device.emplace(*options.gl, walk, options.seed, job.plan, options.control);
        job.threads = result.threads = 1;
        result.instruction_set = device->device();
    }
    const ChunkedResult walked = walkChunks(
        job, {BatchRatios(layout.slots())}, SlabTally(layout),
        [&](std::uint64_t chunk, std::uint64_t walks, SlabTally& tally) {
            if (device) return device->walkChunk(chunk, tally);
            return best ? walkSlabBestChunk(*best, options.seed, chunk, walks, tally)
                        : walkSlabChunk(walk, options.seed, chunk, walks, tally);
        },
        [](const SlabTally& chunk, std::uint64_t walks, std::vector<BatchRatios>& sums) {
            sums[0].add(chunk.flux(), static_cast<double>(walks));
        },
        observer);
    result.seconds = walked.seconds;
    result.walks = walked.walks;
    result.collisions = walked.collisions;
    result.interrupted = walked.interrupted;
    Reduction(problem, options, layout, 1 - entry.specular, walked.sums[0], walked.walks, best ? &*best : nullptr)
        .finish(result);
    return result;
}

}  // namespace searchlight
