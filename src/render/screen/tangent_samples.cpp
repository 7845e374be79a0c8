// Samples p of a plane through the receiver are projected along the line of sight onto the patch that is seen there,
// p' = p / w with w = (n_j / h_j) p, the eye being the origin. A plane n x = h that p' is projected back to is hit at
// t p', t = h / (n p'), and areas shrink by dA / dA' = h_j t^3 / h: so the density of a sample of that plane, per area
// of the surface, is q(|t p' - xo|) h_j t^3 / h. On a plane all of it is 1, and R_d / q is a constant: no noise,
// however few pixels R_d is wide.
#include "render/screen/tangent_samples.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "base/parallel.h"
#include "light/stratified.h"
#include "render/exitance/fine_cell.h"
#include "render/exitance/receiver_tree.h"
#include "render/screen/blue_noise.h"
#include "render/screen/equal_annuli.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/screen/tangent_samples.cpp"
#include <hwy/foreach_target.h>

#include "render/exitance/kernels-inl.h"
#include "render/screen/equal_annuli-inl.h"

HWY_BEFORE_NAMESPACE();
namespace searchlight {
namespace HWY_NAMESPACE {

struct Vec3V {
    FloatV x, y, z;
};

HWY_INLINE FloatV dotV(const Vec3V& a, const Vec3V& b) {
    return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}
HWY_INLINE Vec3V minus(const Vec3V& a, const Vec3V& b) {
    return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
HWY_INLINE Vec3V times(FloatV s, const Vec3V& a) { return {hn::Mul(s, a.x), hn::Mul(s, a.y), hn::Mul(s, a.z)}; }
HWY_INLINE Vec3V plus(const Vec3V& a, FloatV s, const Vec3V& b) {
    return {hn::MulAdd(s, b.x, a.x), hn::MulAdd(s, b.y, a.y), hn::MulAdd(s, b.z, a.z)};
}

// A plane of samples through the receivers: unit axes, and the plane's own n and h > 0.
struct Chart {
    Vec3V s, t, n;
    FloatV h;
};

// Any axes of the plane of unit n, continuous but at n = -z, which looks away from the eye [Duff2017].
HWY_INLINE Chart chartOf(const Vec3V& n, const Vec3V& at) {
    const Float d;
    const FloatV one = hn::Set(d, 1.0f), h = dotV(n, at);
    const FloatV a = hn::Div(hn::Set(d, -1.0f), hn::Add(one, hn::Max(n.z, hn::Set(d, -0.999f))));
    const FloatV b = hn::Mul(hn::Mul(n.x, n.y), a);
    return {{hn::MulAdd(hn::Mul(n.x, n.x), a, one), b, hn::Neg(n.x)},
            {b, hn::MulAdd(hn::Mul(n.y, n.y), a, one), hn::Neg(n.y)},
            n,
            h};
}

class Gatherer {
public:
    Gatherer(const ScreenPatches& patches, const TangentSampler::Tables& tables)
        : patches_(patches),
          tables_(tables),
          Rd_(tables.Rd.impl(), {}),
          density_(tables.density.impl(), {}),
          tangent_count_(static_cast<float>(tables.tangent.u.size())),
          facing_count_(static_cast<float>(tables.facing.u.size())),
          even_count_(static_cast<float>(tables.even.u.size())) {}

    void gather(std::size_t at, Rgbf* exitance) {
        const Float d;
        xo_ = load(patches_.position, at);
        // Towards the eye h is negative: the plane is turned over.
        const Vec3V normal = load(patches_.normal, at);
        tangent_ = chartOf({hn::Neg(normal.x), hn::Neg(normal.y), hn::Neg(normal.z)}, xo_);
        const FloatV distance = hn::Sqrt(dotV(xo_, xo_));
        facing_ = chartOf(times(hn::Div(hn::Set(d, 1.0f), distance), xo_), xo_);
        for (FloatV& sum : sum_) sum = hn::Zero(d);
        turn(at);
        takeSamples();
        HWY_ALIGN float sums[3][16];
        for (std::size_t c = 0; c < 3; ++c) hn::Store(sum_[c], d, sums[c]);
        const std::size_t lanes = std::min<std::size_t>(hn::Lanes(d), patches_.source.size() - at);
        for (std::size_t k = 0; k < lanes; ++k)
            exitance[patches_.source[at + k]] = {sums[0][k], sums[1][k], sums[2][k]};
    }

private:
    static HWY_INLINE Vec3V load(const std::array<std::vector<float>, 3>& planes, std::size_t at) {
        const Float d;
        return {hn::LoadU(d, &planes[0][at]), hn::LoadU(d, &planes[1][at]), hn::LoadU(d, &planes[2][at])};
    }

    // How far the draws of each receiver are shifted and turned.
    void turn(std::size_t at) {
        const Float d;
        HWY_ALIGN float shift[16], cosine[16], sine[16];
        for (std::size_t k = 0; k < hn::Lanes(d); ++k) {
            const std::uint32_t pixel = patches_.pixel[std::min(at + k, patches_.pixel.size() - 1)];
            const auto width = static_cast<std::uint32_t>(patches_.width);
            constexpr auto side = static_cast<std::uint32_t>(blue_noise_side);
            const std::size_t cell = pixel / width % side * side + pixel % width % side;
            // Each rank is a step of 1/cells: within it a hash of the pixel decides, as low digits of the draws are all
            // alike.
            constexpr float step = 1.0f / (side * side);
            const float within = static_cast<float>((pixel * 2654435761u) >> 8) * 0x1p-24f - 0.5f;
            shift[k] = tables_.noise_u[cell] + step * within;
            const float angle = 2 * std::numbers::pi_v<float> * tables_.noise_angle[cell];
            cosine[k] = std::cos(angle);
            sine[k] = std::sin(angle);
        }
        shift_ = hn::Load(d, shift);
        cosine_ = hn::Load(d, cosine);
        sine_ = hn::Load(d, sine);
    }

    HWY_INLINE FloatV shifted(float u) const {
        const Float d;
        const FloatV sum = hn::Add(shift_, hn::Set(d, u)), one = hn::Set(d, 1.0f);
        return hn::IfThenElse(hn::Ge(sum, one), hn::Sub(sum, one), sum);
    }

    HWY_INLINE Vec3V onChart(const Chart& chart, FloatV r, const TangentSampler::Draws& draws, std::size_t k) const {
        const Float d;
        const FloatV c = hn::Set(d, draws.cosine[k]), s = hn::Set(d, draws.sine[k]);
        const FloatV along = hn::NegMulAdd(s, sine_, hn::Mul(c, cosine_));
        const FloatV across = hn::MulAdd(s, cosine_, hn::Mul(c, sine_));
        return plus(plus(xo_, hn::Mul(r, along), chart.s), hn::Mul(r, across), chart.t);
    }

    HWY_INLINE FloatV radiusOf(FloatV number) const { return radiusIn(tables_.annuli, number); }

    void takeSamples() {
        const Float d;
        for (std::size_t k = 0; k < tables_.tangent.u.size(); ++k)
            take(onChart(tangent_, radiusOf(shifted(tables_.tangent.u[k])), tables_.tangent, k));
        for (std::size_t k = 0; k < tables_.facing.u.size(); ++k)
            take(onChart(facing_, radiusOf(shifted(tables_.facing.u[k])), tables_.facing, k));
        const FloatV radius = hn::Set(d, tables_.even_radius);
        for (std::size_t k = 0; k < tables_.even.u.size(); ++k)
            take(onChart(facing_, hn::Mul(radius, hn::Sqrt(shifted(tables_.even.u[k]))), tables_.even, k));
    }

    // Where the line of sight through `place` meets a chart: r^2 from the receiver, and dA / dA' without the patch's h;
    // 0 where it does not.
    HWY_INLINE FloatV onto(const Chart& chart, const Vec3V& place, FloatV& shrinks) const {
        const Float d;
        constexpr float beyond = 1e12f;
        const FloatV t = hn::Div(chart.h, dotV(chart.n, place));
        const Vec3V offset = minus(times(t, place), xo_);
        const FloatV square = dotV(offset, offset);
        const auto ahead = hn::And(hn::Gt(t, hn::Zero(d)), hn::Lt(square, hn::Set(d, beyond)));
        shrinks = hn::IfThenElseZero(ahead, hn::Div(hn::Mul(t, hn::Mul(t, t)), chart.h));
        return hn::IfThenElse(ahead, square, hn::Set(d, beyond));
    }

    // Expected samples per area of the patch at `place`, whose plane is h away from the eye.
    HWY_INLINE FloatV densityAt(const Vec3V& place, FloatV h) const {
        const Float d;
        FloatV tangent, facing;
        const FloatV tangent_square = onto(tangent_, place, tangent);
        const FloatV facing_square = onto(facing_, place, facing);
        const FloatV by_tangent = density_.value(density_.place(tangent_square), 0);
        const FloatV by_facing = density_.value(density_.place(facing_square), 0);
        const float radius = tables_.even_radius, area = std::numbers::pi_v<float> * radius * radius;
        const FloatV even =
            hn::IfThenElseZero(hn::Le(facing_square, hn::Set(d, radius * radius)), hn::Set(d, even_count_ / area));
        const FloatV q_facing = hn::MulAdd(hn::Set(d, facing_count_), by_facing, even);
        const FloatV q_tangent = hn::Mul(hn::Set(d, tangent_count_), by_tangent);
        return hn::Mul(h, hn::MulAdd(q_tangent, tangent, hn::Mul(q_facing, facing)));
    }

    // Adds what a sample p brings, whichever plane it is of.
    HWY_INLINE void take(const Vec3V& p) {
        const Float d;
        const Int di;
        const FloatV zero = hn::Zero(d), one = hn::Set(d, 1.0f);
        const FloatV depth = hn::Max(p.z, hn::Set(d, 1e-6f));
        const FloatV scale = hn::Div(hn::Set(d, patches_.focal), depth);
        const auto column = [&](FloatV at, int size) {
            // From -1, the border, to `size`, the other one; + 1 as ConvertTo() cuts off towards 0.
            const FloatV from_border = hn::MulAdd(scale, at, hn::Set(d, 0.5f * static_cast<float>(size) + 1));
            return hn::ConvertTo(di, hn::Min(hn::Max(from_border, zero), hn::Set(d, static_cast<float>(size + 1))));
        };
        const IntV x = column(p.x, patches_.width), y = column(p.y, patches_.height);
        const IntV cell = hn::ShiftLeft<3>(hn::Add(hn::Mul(y, hn::Set(di, patches_.width + 2)), x));
        const float* cells = patches_.cells.data();
        const Vec3V n{hn::GatherIndex(d, cells, cell), hn::GatherIndex(d, cells + 1, cell),
                      hn::GatherIndex(d, cells + 2, cell)};
        const FloatV h = hn::GatherIndex(d, cells + 3, cell), w = dotV(n, p);
        const auto seen = hn::And(hn::And(hn::Gt(h, zero), hn::Gt(w, zero)), hn::Gt(p.z, zero));
        if (hn::AllFalse(d, seen)) return;
        const Vec3V place = times(hn::Div(one, hn::IfThenElse(seen, w, one)), p);
        const FloatV density = densityAt(place, h);
        const Vec3V offset = minus(place, xo_);
        const FloatV square = hn::Min(dotV(offset, offset), hn::Set(d, 1e12f));
        const FloatV weight = hn::IfThenElseZero(hn::And(seen, hn::Gt(density, zero)), hn::Div(one, density));
        const Place at = Rd_.place(square);
        for (std::size_t c = 0; c < 3; ++c) {
            const FloatV light = hn::GatherIndex(d, cells + 4 + c, cell);
            sum_[c] = hn::MulAdd(hn::Mul(weight, light), Rd_.value(at, c), sum_[c]);
        }
    }

    const ScreenPatches& patches_;
    const TangentSampler::Tables& tables_;
    TableLanes Rd_, density_;
    float tangent_count_, facing_count_, even_count_;
    Vec3V xo_;
    Chart tangent_, facing_;
    FloatV shift_, cosine_, sine_;
    FloatV sum_[3];
};

void gatherRange(const ScreenPatches& patches, const TangentSampler::Tables& tables, std::size_t begin, std::size_t end,
                 Rgbf* exitance) {
    Gatherer gatherer(patches, tables);
    for (std::size_t at = begin; at < end; at += hn::Lanes(Float())) gatherer.gather(at, exitance);
}

}  // namespace HWY_NAMESPACE
}  // namespace searchlight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace searchlight {

HWY_EXPORT(gatherRange);

namespace {

// The mean of the channels' |R_d|, each over its total, and that three times.
Profile densityOf(const Profile& profile) {
    std::vector<double> radii(profile.radii().begin(), profile.radii().end());
    std::vector<Rgb> values(profile.values().begin(), profile.values().end());
    for (Rgb& value : values) value = {std::abs(value.r), std::abs(value.g), std::abs(value.b)};
    const Rgb total = Profile(radii, values).total();
    for (Rgb& value : values) {
        double sum = 0;
        for (int c = 0; c < Rgb::channels; ++c)
            if (total[c] > 0) sum += value[c] / total[c];
        value = {sum, sum, sum};
    }
    const double all = Profile(radii, values).total().r;
    for (Rgb& value : values) value = (1 / all) * value;
    return {std::move(radii), std::move(values)};
}

TangentSampler::Draws drawsOf(int count, std::uint64_t seed) {
    TangentSampler::Draws draws;
    const StratifiedSequence sequence(seed);
    for (int k = 0; k < count; ++k) {
        const auto [u, v] = sequence(static_cast<std::uint32_t>(k));
        draws.u.push_back(std::min(static_cast<float>(u), 1 - 0x1p-24f));
        draws.cosine.push_back(static_cast<float>(std::cos(2 * std::numbers::pi * v)));
        draws.sine.push_back(static_cast<float>(std::sin(2 * std::numbers::pi * v)));
    }
    return draws;
}

TangentSampler::Tables tablesOf(const Profile& profile, int tangent, int facing, std::uint64_t seed) {
    const Profile density = densityOf(profile);
    return {.Rd = RadialTable(profile, fineCellArea(profile)),
            .density = RadialTable(density, fineCellArea(density)),
            .annuli = equalAnnuli(density),
            .even_radius = static_cast<float>(density.sampleRadius(0.9, 0)),
            .tangent = drawsOf(tangent, seed),
            .facing = drawsOf(facing / 2, seed + 1),
            .even = drawsOf(facing - facing / 2, seed + 2),
            .noise_u = blueNoise(seed),
            .noise_angle = blueNoise(seed + 1)};
}

}  // namespace

ScreenPatches screenPatches(const View& view, const VisibleSurface& visible, int threads) {
    ScreenSamples samples = screenSamples(view, visible, threads);
    ScreenPatches patches{.width = view.width, .height = view.height, .focal = samples.focal};
    patches.position = std::move(samples.position);
    patches.source = std::move(samples.source);
    for (std::vector<float>& plane : patches.normal) plane.resize(samples.padded());
    patches.cells.assign(
        static_cast<std::size_t>(view.width + 2) * static_cast<std::size_t>(view.height + 2) * ScreenPatches::floats,
        0.0f);
    patches.pixel.resize(samples.count);
    for (std::size_t i = 0; i < samples.padded() && samples.count > 0; ++i) {
        const std::uint32_t from = patches.source[std::min(i, samples.count - 1)];
        const Vec3 normal = toDouble(visible.geometric_normals[from]);
        const Vec3 n{dot(normal, view.right), -dot(normal, view.up), dot(normal, view.forward)};
        patches.normal[0][i] = static_cast<float>(n.x);
        patches.normal[1][i] = static_cast<float>(n.y);
        patches.normal[2][i] = static_cast<float>(n.z);
        if (i >= samples.count) continue;
        patches.pixel[i] = visible.pixels[from];
        if (i >= samples.standing) continue;
        const Vec3 x{patches.position[0][i], patches.position[1][i], patches.position[2][i]};
        const Vec3 away = normalize(x);
        // A patch that is seen edge on has no area that a pixel could tell: its light is left to others.
        constexpr double least_cosine = 0.1;
        const Vec3 facing = -1 * n;
        if (dot(facing, away) < least_cosine) continue;
        const double h = dot(facing, x);
        const int column = static_cast<int>(patches.pixel[i] % static_cast<std::uint32_t>(view.width));
        const int row = static_cast<int>(patches.pixel[i] / static_cast<std::uint32_t>(view.width));
        float* cell = &patches.cells[patches.cellAt(column, row)];
        cell[0] = static_cast<float>(facing.x / h);
        cell[1] = static_cast<float>(facing.y / h);
        cell[2] = static_cast<float>(facing.z / h);
        cell[3] = static_cast<float>(h);
    }
    return patches;
}

void setLight(const VisibleSurface& visible, std::span<const Rgbf> light, ScreenPatches& patches) {
    std::vector<float> covered(static_cast<std::size_t>(patches.width) * static_cast<std::size_t>(patches.height));
    for (std::size_t i = 0; i < visible.pixels.size(); ++i) covered[visible.pixels[i]] += visible.coverage[i];
    // Who stands for a pixel comes first, and others of it must not overwrite its light.
    std::vector<bool> set(covered.size());
    for (std::size_t i = 0; i < patches.source.size(); ++i) {
        const std::uint32_t pixel = patches.pixel[i];
        if (set[pixel]) continue;
        set[pixel] = true;
        const auto width = static_cast<std::uint32_t>(patches.width);
        float* cell = &patches.cells[patches.cellAt(static_cast<int>(pixel % width), static_cast<int>(pixel / width))];
        const Rgbf& value = light[patches.source[i]];
        cell[4] = covered[pixel] * value.r;
        cell[5] = covered[pixel] * value.g;
        cell[6] = covered[pixel] * value.b;
    }
}

bool isSeen(const ScreenPatches& patches, Vec3f position, Vec3f normal) {
    const Vec3 x = toDouble(position);
    if (!(x.z > 0) || dot(x, toDouble(normal)) >= 0) return false;
    const double column = patches.focal * x.x / x.z + 0.5 * patches.width;
    const double row = patches.focal * x.y / x.z + 0.5 * patches.height;
    if (!(column >= 0 && column < patches.width && row >= 0 && row < patches.height)) return false;
    const float* cell = &patches.cells[patches.cellAt(static_cast<int>(column), static_cast<int>(row))];
    if (!(cell[3] > 0)) return false;
    // Behind its patch by more than the patch itself rises in a pixel, it is hidden.
    const double cosine = cell[3] / length(x);
    return x.x * cell[0] + x.y * cell[1] + x.z * cell[2] < 1 + 1 / (patches.focal * cosine);
}

TangentSampler::TangentSampler(const Profile& profile, int tangent, int facing, std::uint64_t seed)
    : tables_(tablesOf(profile, tangent, facing, seed)) {}

void TangentSampler::gather(const ScreenPatches& patches, int threads, const Observer& observer,
                            std::vector<Rgbf>& exitance) const {
    exitance.resize(patches.source.size());
    constexpr std::size_t grain = 4096;
    parallelFor((patches.source.size() + grain - 1) / grain, threads, [&](std::size_t task) {
        if (observer.cancelled()) throw interruptedError();
        HWY_DYNAMIC_DISPATCH(gatherRange)
        (patches, tables_, task * grain, std::min((task + 1) * grain, patches.source.size()), exitance.data());
    });
}

}  // namespace searchlight
#endif
