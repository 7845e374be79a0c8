// A receiver at xo is seen in the map at c. A sample at d mm from c, in the plane that faces the light at the
// receiver's depth, is that of its tangent plane at M^-1 d, where M shortens by m = cos(n, light) along the tilt. So
// with n_t and n_f samples of the density q its expected number per mm^2 of the facing plane is
//   n_t q(|M^-1 d|) / m + n_f q(|d|),
// and what a texel brings is its flux per unit of u and v, over that. As the flux is that of the light's own cross
// section, neither the surface's cosine nor a grazing patch makes it large.
#include "render/light_view/ring_filter.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "base/error.h"
#include "base/parallel.h"
#include "render/exitance/fine_cell.h"
#include "render/exitance/receiver_tree.h"
#include "render/screen/blue_noise.h"
#include "render/screen/equal_annuli.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/light_view/ring_filter.cpp"
#include <hwy/foreach_target.h>

#include "render/exitance/kernels-inl.h"
#include "render/screen/equal_annuli-inl.h"

HWY_BEFORE_NAMESPACE();
namespace searchlight {
namespace HWY_NAMESPACE {

template <bool central>
class RingGatherer {
public:
    RingGatherer(const LightMap& map, const RingReceivers& receivers, const RingFilter::Tables& tables)
        : map_(map),
          receivers_(receivers),
          tables_(tables),
          Rd_(tables.Rd.impl(), {}),
          density_(tables.density.impl(), {}),
          tangent_count_(static_cast<float>(tables.tangent.u.size())),
          facing_count_(static_cast<float>(tables.facing.u.size())) {}

    void gather(std::size_t at, Rgbf* exitance) {
        const Float d;
        place(at);
        turn(at);
        for (FloatV& sum : sum_) sum = hn::Zero(d);
        for (std::size_t k = 0; k < tables_.tangent.u.size(); ++k) {
            FloatV a, b;
            drawn(tables_.tangent, k, a, b);
            // M (a, b): what lies along the tilt is shortened.
            const FloatV along = hn::Mul(less_, hn::MulAdd(a, tilt_x_, hn::Mul(b, tilt_y_)));
            take(hn::NegMulAdd(along, tilt_x_, a), hn::NegMulAdd(along, tilt_y_, b));
        }
        for (std::size_t k = 0; k < tables_.facing.u.size(); ++k) {
            FloatV a, b;
            drawn(tables_.facing, k, a, b);
            take(a, b);
        }
        HWY_ALIGN float sums[3][16];
        for (std::size_t c = 0; c < 3; ++c) hn::Store(sum_[c], d, sums[c]);
        const std::size_t lanes = std::min<std::size_t>(hn::Lanes(d), receivers_.count - at);
        for (std::size_t k = 0; k < lanes; ++k) {
            Rgbf& m = exitance[at + k];
            m = {m.r + sums[0][k], m.g + sums[1][k], m.b + sums[2][k]};
        }
    }

private:
    HWY_INLINE FloatV along(const std::array<FloatV, 3>& v, const Vec3& axis) const {
        const Float d;
        return hn::MulAdd(v[0], hn::Set(d, static_cast<float>(axis.x)),
                          hn::MulAdd(v[1], hn::Set(d, static_cast<float>(axis.y)),
                                     hn::Mul(v[2], hn::Set(d, static_cast<float>(axis.z)))));
    }

    // The receivers in the map, and how their planes are tilted.
    void place(std::size_t at) {
        const Float d;
        const FloatV one = hn::Set(d, 1.0f);
        std::array<FloatV, 3> v, n;
        const double origin[] = {map_.origin.x, map_.origin.y, map_.origin.z};
        for (std::size_t i = 0; i < 3; ++i) {
            v[i] = hn::Sub(hn::LoadU(d, &receivers_.position[i][at]), hn::Set(d, static_cast<float>(origin[i])));
            n[i] = hn::LoadU(d, &receivers_.normal[i][at]);
        }
        x_ = along(v, map_.right), y_ = along(v, map_.up), z_ = along(v, map_.forward);
        const FloatV across = along(n, map_.right), up = along(n, map_.up);
        scale_ = central ? hn::Div(one, z_) : one;
        u_ = hn::Mul(x_, scale_), v_ = hn::Mul(y_, scale_);
        FloatV cosine = hn::Neg(along(n, map_.forward));
        if (central) {
            const FloatV distance = hn::Sqrt(hn::MulAdd(v[0], v[0], hn::MulAdd(v[1], v[1], hn::Mul(v[2], v[2]))));
            cosine = hn::Neg(hn::Div(hn::MulAdd(v[0], n[0], hn::MulAdd(v[1], n[1], hn::Mul(v[2], n[2]))), distance));
        }
        // Where a receiver is turned away its own tilt says nothing of where light enters: from 0.3 down to -0.3 the
        // shortening is taken back.
        const FloatV least = hn::Set(d, 0.3f);
        const FloatV shorter =
            hn::IfThenElse(hn::Ge(cosine, least), cosine,
                           hn::Min(one, hn::NegMulAdd(hn::Set(d, 0.7f / 0.6f), hn::Sub(cosine, least), least)));
        less_ = hn::Sub(one, shorter);
        inverse_ = hn::Div(one, shorter);
        const FloatV square = hn::MulAdd(across, across, hn::Mul(up, up));
        const FloatV unit = hn::Div(one, hn::Sqrt(hn::Max(square, hn::Set(d, 1e-12f))));
        tilt_x_ = hn::Mul(across, unit), tilt_y_ = hn::Mul(up, unit);
        // Without a tilt there is no direction: the vector is short, and so is what it takes away.
        stretch_ = hn::MulAdd(inverse_, inverse_, hn::Set(d, -1.0f));
    }

    void turn(std::size_t at) {
        const Float d;
        HWY_ALIGN float shift[16], cosine[16], sine[16];
        for (std::size_t k = 0; k < hn::Lanes(d); ++k) {
            const std::uint32_t cell = receivers_.turn[std::min(at + k, receivers_.count - 1)];
            shift[k] = tables_.shift[cell];
            const float angle = 2 * std::numbers::pi_v<float> * tables_.angle[cell];
            cosine[k] = std::cos(angle);
            sine[k] = std::sin(angle);
        }
        shift_ = hn::Load(d, shift);
        cosine_ = hn::Load(d, cosine);
        sine_ = hn::Load(d, sine);
    }

    // A place by importance, mm from the receiver's.
    HWY_INLINE void drawn(const RingFilter::Draws& draws, std::size_t k, FloatV& a, FloatV& b) const {
        const Float d;
        const FloatV one = hn::Set(d, 1.0f), sum = hn::Add(shift_, hn::Set(d, draws.u[k]));
        const FloatV number = hn::IfThenElse(hn::Ge(sum, one), hn::Sub(sum, one), sum);
        const FloatV r = radiusIn(tables_.annuli, number);
        const FloatV c = hn::Set(d, draws.cosine[k]), s = hn::Set(d, draws.sine[k]);
        a = hn::Mul(r, hn::NegMulAdd(s, sine_, hn::Mul(c, cosine_)));
        b = hn::Mul(r, hn::MulAdd(s, cosine_, hn::Mul(c, sine_)));
    }

    // Adds what the map holds (a, b) mm from the receiver's place.
    HWY_INLINE void take(FloatV a, FloatV b) {
        const Float d;
        const Int di;
        const FloatV zero = hn::Zero(d), half = hn::Set(d, 0.5f), one = hn::Set(d, 1.0f);
        const FloatV u = hn::MulAdd(scale_, a, u_), v = hn::MulAdd(scale_, b, v_);
        const FloatV inverse_texel = hn::Set(d, 1 / map_.texel);
        const FloatV column = hn::Mul(hn::Sub(u, hn::Set(d, map_.u0)), inverse_texel);
        const FloatV row = hn::Mul(hn::Sub(v, hn::Set(d, map_.v0)), inverse_texel);
        // From -1, the border, to the size, the other one; + 1 as ConvertTo() cuts off towards 0.
        const auto indexOf = [&](FloatV place, int size) {
            const FloatV last = hn::Set(d, static_cast<float>(size + 1));
            return hn::ConvertTo(di, hn::Min(hn::Max(hn::Add(place, one), zero), last));
        };
        const IntV x = indexOf(column, map_.width), y = indexOf(row, map_.height);
        const IntV cell = hn::ShiftLeft<3>(hn::Add(hn::Mul(y, hn::Set(di, map_.width + 2)), x));
        const float* cells = map_.cells.data();
        const FloatV middle = hn::Set(d, 0.5f);
        const FloatV across = hn::Sub(hn::Add(column, middle), hn::ConvertTo(d, x));
        const FloatV up = hn::Sub(hn::Add(row, middle), hn::ConvertTo(d, y));
        FloatV depth = hn::MulAdd(across, hn::GatherIndex(d, cells + 1, cell),
                                  hn::MulAdd(up, hn::GatherIndex(d, cells + 2, cell), hn::GatherIndex(d, cells, cell)));
        const auto seen = hn::And(hn::Gt(hn::GatherIndex(d, cells + 3, cell), half),
                                  central ? hn::Gt(depth, zero) : hn::Eq(depth, depth));
        if (hn::AllFalse(d, seen)) return;
        if (central) depth = hn::Div(one, hn::IfThenElse(seen, depth, one));
        const FloatV dx = hn::Sub(central ? hn::Mul(u, depth) : u, x_);
        const FloatV dy = hn::Sub(central ? hn::Mul(v, depth) : v, y_);
        const FloatV dz = hn::Sub(depth, z_);
        const FloatV square = hn::Min(hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz))), hn::Set(d, 1e12f));
        const FloatV on_plane = hn::MulAdd(a, a, hn::Mul(b, b));
        const FloatV along_tilt = hn::MulAdd(a, tilt_x_, hn::Mul(b, tilt_y_));
        const FloatV on_tangent = hn::MulAdd(hn::Mul(stretch_, along_tilt), along_tilt, on_plane);
        const FloatV by_tangent = density_.value(density_.place(on_tangent), 0);
        const FloatV by_facing = density_.value(density_.place(on_plane), 0);
        const FloatV density = hn::MulAdd(hn::Mul(hn::Set(d, tangent_count_), inverse_), by_tangent,
                                          hn::Mul(hn::Set(d, facing_count_), by_facing));
        FloatV area = hn::Mul(scale_, scale_);
        if (central) area = hn::Mul(area, hn::Mul(depth, hn::Mul(depth, depth)));
        const FloatV weight = hn::IfThenElseZero(hn::And(seen, hn::Gt(density, zero)),
                                                 hn::Div(area, hn::Max(density, hn::Set(d, 1e-30f))));
        const Place at = Rd_.place(square);
        for (std::size_t c = 0; c < 3; ++c) {
            const FloatV light = hn::GatherIndex(d, cells + 4 + c, cell);
            sum_[c] = hn::MulAdd(hn::Mul(weight, light), Rd_.value(at, c), sum_[c]);
        }
    }

    const LightMap& map_;
    const RingReceivers& receivers_;
    const RingFilter::Tables& tables_;
    TableLanes Rd_, density_;
    float tangent_count_, facing_count_;
    FloatV x_, y_, z_;        // receivers, mm
    FloatV u_, v_, scale_;    // in the map, and units of u per mm there
    FloatV tilt_x_, tilt_y_;  // unit, along which the tangent plane is tilted
    FloatV less_, inverse_;   // 1 - m and 1 / m
    FloatV stretch_;          // 1 / m^2 - 1
    FloatV shift_, cosine_, sine_;
    FloatV sum_[3];
};

void gatherRings(const LightMap& map, const RingReceivers& receivers, const RingFilter::Tables& tables,
                 std::size_t begin, std::size_t end, Rgbf* exitance) {
    const auto run = [&](auto gatherer) {
        for (std::size_t at = begin; at < end; at += hn::Lanes(Float())) gatherer.gather(at, exitance);
    };
    if (map.central)
        run(RingGatherer<true>(map, receivers, tables));
    else
        run(RingGatherer<false>(map, receivers, tables));
}

}  // namespace HWY_NAMESPACE
}  // namespace searchlight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace searchlight {

HWY_EXPORT(gatherRings);

namespace {

constexpr std::size_t padding = 16;
// The part of the samples that goes by 1 / (r^2 + a^2), a being the median of the other: whatever the depth of a
// receiver below the light, there are some as far apart as it is deep.
constexpr double broad = 0.25;
// Of the spokes, those in the plane that faces the light.
constexpr int facing_spokes = 4;

Profile densityOf(const Profile& profile, double reach) {
    std::vector<double> radii;
    for (const double r : profile.radii())
        if (r < reach) radii.push_back(r);
    for (int i = 0; i <= 128; ++i) radii.push_back(reach * std::pow(1e-4, 1 - i / 128.0));
    std::ranges::sort(radii);
    const auto tooClose = [&](double a, double b) { return b - a < 1e-6 * b; };
    radii.erase(std::unique(radii.begin(), radii.end(), tooClose), radii.end());
    const auto importance = [&](const Rgb& total) {
        std::vector<Rgb> values;
        for (const double r : radii) {
            const Rgb Rd = profile(r);
            double sum = 0;
            for (int c = 0; c < Rgb::channels; ++c)
                if (total[c] > 0) sum += std::abs(Rd[c]) / total[c];
            values.push_back({sum, sum, sum});
        }
        return Profile(radii, values);
    };
    std::vector<Rgb> without_sign;
    for (const double r : radii) {
        const Rgb Rd = profile(r);
        without_sign.push_back({std::abs(Rd.r), std::abs(Rd.g), std::abs(Rd.b)});
    }
    const Profile narrow = importance(Profile(radii, without_sign).total());
    const double median = narrow.sampleRadius(0.5, 0), narrow_total = narrow.total().r;
    std::vector<Rgb> wide;
    for (const double r : radii) wide.push_back((1 / (r * r + median * median)) * Rgb{1, 1, 1});
    const double wide_total = Profile(radii, wide).total().r;
    std::vector<Rgb> values;
    for (std::size_t i = 0; i < radii.size(); ++i)
        values.push_back(((1 - broad) / narrow_total) * narrow.values()[i] + (broad / wide_total) * wide[i]);
    const double total = Profile(radii, values).total().r;
    for (Rgb& value : values) value = (1 / total) * value;
    return {std::move(radii), std::move(values)};
}

// The middle and the rings, each turned by the golden section against the one before; in a ring radii go by turns, so
// that no two samples of a ring that stand side by side are equally far.
void layOut(int rings, int spokes, RingFilter::Draws& tangent, RingFilter::Draws& facing) {
    const double golden = 0.5 * (std::sqrt(5.0) - 1);
    std::vector<double> angles[2];
    angles[0].push_back(0);
    for (int l = 0; l < rings; ++l)
        for (int c = 0; c < spokes; ++c) {
            int step = std::max(1, static_cast<int>(std::lround(golden * spokes)));
            while (std::gcd(step, spokes) != 1) ++step;
            const double turned = l * golden - std::floor(l * golden);
            const int which = spokes >= facing_spokes && c % facing_spokes == facing_spokes - 1 ? 1 : 0;
            angles[which].push_back((c * step % spokes + turned) / spokes);
        }
    const auto fill = [](const std::vector<double>& of, RingFilter::Draws& draws) {
        for (std::size_t k = 0; k < of.size(); ++k) {
            draws.u.push_back(static_cast<float>((static_cast<double>(k) + 0.5) / static_cast<double>(of.size())));
            draws.cosine.push_back(static_cast<float>(std::cos(2 * std::numbers::pi * of[k])));
            draws.sine.push_back(static_cast<float>(std::sin(2 * std::numbers::pi * of[k])));
        }
    };
    fill(angles[0], tangent);
    fill(angles[1], facing);
}

RingFilter::Tables tablesOf(const Profile& profile, double reach, std::uint64_t seed) {
    const Profile density = densityOf(profile, std::min(reach, profile.radii().back()));
    return {.Rd = RadialTable(profile, fineCellArea(profile)),
            .density = RadialTable(density, fineCellArea(density)),
            .annuli = equalAnnuli(density),
            .tangent = {},
            .facing = {},
            .shift = blueNoise(seed),
            .angle = blueNoise(seed + 1)};
}

}  // namespace

RingReceivers::RingReceivers(const VisibleSurface& visible) : count(visible.positions.size()) {
    const std::size_t padded = (count + padding - 1) / padding * padding;
    for (std::size_t i = 0; i < 3; ++i) {
        position[i].resize(padded);
        normal[i].resize(padded);
    }
    for (std::size_t k = 0; k < padded && count > 0; ++k) {
        const Vec3f& p = visible.positions[std::min(k, count - 1)];
        const Vec3f& n = visible.geometric_normals[std::min(k, count - 1)];
        position[0][k] = p.x, position[1][k] = p.y, position[2][k] = p.z;
        normal[0][k] = n.x, normal[1][k] = n.y, normal[2][k] = n.z;
    }
    constexpr auto side = static_cast<std::uint32_t>(blue_noise_side);
    const auto width = static_cast<std::uint32_t>(visible.width);
    for (const std::uint32_t pixel : visible.pixels) turn.push_back(pixel / width % side * side + pixel % width % side);
}

RingFilter::RingFilter(const Profile& profile, int samples, double reach_mm, std::uint64_t seed)
    : rings_(static_cast<int>(std::sqrt(samples - 1.0))),
      spokes_(rings_ > 0 ? (samples - 1) / rings_ : 0),
      tables_(tablesOf(profile, reach_mm, seed)) {
    layOut(rings_, spokes_, tables_.tangent, tables_.facing);
}

void RingFilter::gather(const LightMap& map, const RingReceivers& receivers, int threads, const Observer& observer,
                        std::span<Rgbf> exitance) const {
    constexpr std::size_t grain = 2048;
    parallelFor((receivers.count + grain - 1) / grain, threads, [&](std::size_t task) {
        if (observer.cancelled()) throw interruptedError();
        HWY_DYNAMIC_DISPATCH(gatherRings)
        (map, receivers, tables_, task * grain, std::min((task + 1) * grain, receivers.count), exitance.data());
    });
}

}  // namespace searchlight
#endif
