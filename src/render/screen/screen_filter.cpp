#include "render/screen/screen_filter.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "base/parallel.h"
#include "kernel/filter.h"
#include "render/screen/filter_pass.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/screen/screen_filter.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "render/screen/grid_lookup-inl.h"

HWY_BEFORE_NAMESPACE();
namespace searchlight {
namespace HWY_NAMESPACE {

struct Vectors {
    FloatV x, y, z;
};

HWY_INLINE FloatV dotOf(const Vectors& a, const Vectors& b) {
    return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}

HWY_INLINE Vectors crossOf(const Vectors& a, const Vectors& b) {
    return {hn::MulSub(a.y, b.z, hn::Mul(a.z, b.y)), hn::MulSub(a.z, b.x, hn::Mul(a.x, b.z)),
            hn::MulSub(a.x, b.y, hn::Mul(a.y, b.x))};
}

// 1 / x within a few ulps of any instruction set, in a quarter of the time of a division.
HWY_INLINE FloatV reciprocal(FloatV x) {
    const FloatV guess = hn::ApproximateReciprocal(x);
    return hn::Mul(guess, hn::NegMulAdd(x, guess, hn::Set(Float(), 2.0f)));
}

HWY_INLINE Vectors loaded(const std::array<std::vector<float>, 3>& planes, std::size_t i) {
    const Float d;
    return {hn::LoadU(d, &planes[0][i]), hn::LoadU(d, &planes[1][i]), hn::LoadU(d, &planes[2][i])};
}

// cos and sin of the angle between the pass and u.
struct Turn {
    FloatV cosine, sine;
};

// The line's own angle, and that of each sample where axes turn.
HWY_INLINE Turn turnOf(const FilterPass& pass, std::size_t i) {
    const Float d;
    const FloatV cosine = hn::Set(d, pass.line->cosine), sine = hn::Set(d, pass.line->sine);
    if (!pass.turns[0]) return {cosine, sine};
    const FloatV c = hn::LoadU(d, pass.turns[0] + i), s = hn::LoadU(d, pass.turns[1] + i);
    return {hn::MulSub(cosine, c, hn::Mul(sine, s)), hn::MulAdd(sine, c, hn::Mul(cosine, s))};
}

// The direction of the pass.
HWY_INLINE Vectors axisOf(const FilterPass& pass, const Turn& turn, const Vectors& position, const Vectors& normal) {
    const Float d;
    if (pass.axes == FilterAxes::screen) return {turn.cosine, turn.sine, hn::Zero(d)};
    // The plane of the picture's row meets the tangent plane in u: a pass along u stays in its row.
    const FloatV row_y = hn::Neg(position.z), row_z = position.y;
    Vectors u = {hn::MulSub(row_y, normal.z, hn::Mul(row_z, normal.y)), hn::Mul(row_z, normal.x),
                 hn::Neg(hn::Mul(row_y, normal.x))};
    const FloatV square = dotOf(u, u), limit = hn::Mul(hn::Set(d, FilterPass::edge_on), dotOf(position, position));
    const auto edge_on = hn::Lt(square, limit);
    const FloatV per_length = hn::Div(hn::Set(d, 1.0f), hn::Sqrt(hn::Max(square, limit)));
    u = {hn::IfThenElse(edge_on, hn::Set(d, 1.0f), hn::Mul(per_length, u.x)),
         hn::IfThenZeroElse(edge_on, hn::Mul(per_length, u.y)), hn::IfThenZeroElse(edge_on, hn::Mul(per_length, u.z))};
    if (pass.course == FilterLine::Course::row) return u;
    const Vectors v = crossOf(u, normal);
    return {hn::MulAdd(turn.cosine, u.x, hn::Mul(turn.sine, v.x)),
            hn::MulAdd(turn.cosine, u.y, hn::Mul(turn.sine, v.y)),
            hn::MulAdd(turn.cosine, u.z, hn::Mul(turn.sine, v.z))};
}

// Of a tap whose pixel shows a point at `height` over the plane of the pass; `far`: twice its |offset|, or a little.
template <FilterTrust trust>
HWY_INLINE FloatV trustOf(FloatV per_reach, FloatV far, FloatV height) {
    const Float d;
    if constexpr (trust == FilterTrust::depth)
        return hn::Max(hn::Zero(d), hn::NegMulAdd(hn::Abs(height), per_reach, hn::Set(d, 1.0f)));
    // (1 + y / 4)^-4 stands for e^-y, and h^2 / (|h| + 2 |o|) for the way that it is further, of which it is at least
    // four fifths: together one reciprocal.
    const FloatV sum = hn::Add(hn::Abs(height), far);
    const FloatV root = hn::Mul(sum, reciprocal(hn::MulAdd(hn::Mul(height, height), per_reach, sum)));
    const FloatV root2 = hn::Mul(root, root);
    return hn::Mul(root2, root2);
}

// Samples [begin, end), whole vectors.
template <FilterLine::Course course, FilterTrust trust>
HWY_INLINE void filterLanes(const FilterPass& pass, std::size_t begin, std::size_t end) {
    const Float d;
    const Int di;
    const ScreenSamples& samples = *pass.samples;
    const FloatV zero = hn::Zero(d), one = hn::Set(d, 1.0f);
    // Grid coordinates of the middle of the picture; pixel (0, 0) has its centre at (1, 1) of the grid.
    const FloatV middle_x = hn::Set(d, 0.5f * static_cast<float>(samples.width) + 0.5f);
    const FloatV middle_y = hn::Set(d, 0.5f * static_cast<float>(samples.height) + 0.5f);
    const FloatV last_x = hn::Set(d, static_cast<float>(samples.width) + 0.5f);
    const FloatV last_y = hn::Set(d, static_cast<float>(samples.height) + 0.5f);
    const FloatV focal = hn::Set(d, samples.focal), per_focal = hn::Set(d, 1 / samples.focal);
    const FloatV fallback = hn::Set(d, pass.fallback);
    const FloatV per_reach = hn::Set(d, trust == FilterTrust::depth ? pass.per_reach : 0.25f * pass.per_reach);
    const bool flat = pass.axes == FilterAxes::screen;
    const Grid grid(pass);

    for (std::size_t i = begin; i < end; i += hn::Lanes(d)) {
        const Vectors position = loaded(samples.position, i);
        const Vectors normal = flat ? Vectors{zero, zero, one} : loaded(samples.normal, i);
        const Vectors axis = axisOf(pass, turnOf(pass, i), position, normal);
        const FloatV width = pass.strength.empty() ? hn::Set(d, pass.width)
                                                   : hn::Mul(hn::Set(d, pass.width), hn::LoadU(d, &pass.strength[i]));
        const FloatV nearest = hn::Mul(hn::Set(d, FilterPass::nearest), position.z);
        // What a grid cell (x, y) shows at depth z is z (slope_x x + slope_y y + slope) - plane over the plane.
        const FloatV plane = dotOf(normal, position);
        const FloatV slope_x = hn::Mul(per_focal, normal.x), slope_y = hn::Mul(per_focal, normal.y);
        const FloatV slope = hn::NegMulAdd(slope_x, middle_x, hn::NegMulAdd(slope_y, middle_y, normal.z));
        // The cell that the sample lies in. Its middle is where taps are counted from, also where the sample lies
        // beside it, at an outline: a tap that does not move is the sample's own pixel.
        const FloatV per_depth = hn::Div(focal, position.z);
        const FloatV own_x = hn::MulAdd(per_depth, position.x, middle_x);
        const FloatV own_y = hn::MulAdd(per_depth, position.y, middle_y);
        const auto cellOf = [&](FloatV own, FloatV last) HWY_ATTR {
            return hn::Min(hn::Max(hn::Floor(hn::Add(own, hn::Set(d, 0.5f))), zero), hn::Floor(last));
        };
        const FloatV column = cellOf(own_x, last_x), row = cellOf(own_y, last_y);
        const FloatV from_x = hn::Add(middle_x, hn::Sub(column, own_x));
        const FloatV from_y = hn::Add(middle_y, hn::Sub(row, own_y));
        const IntV own_column = hn::ConvertTo(di, column), own_row = hn::ConvertTo(di, row);

        // The light at an offset, as far as it is trusted, and how far that is.
        const auto lightAt = [&](FloatV offset, FloatV far) HWY_ATTR __attribute__((always_inline)) {
            const FloatV per_z =
                flat ? per_depth : hn::Mul(focal, reciprocal(hn::Max(nearest, hn::MulAdd(offset, axis.z, position.z))));
            const auto place = [&](FloatV along, FloatV from, FloatV middle_of, FloatV last) HWY_ATTR {
                return hn::Min(hn::Max(hn::MulAdd(per_z, hn::MulAdd(offset, along, from), middle_of), zero), last);
            };
            Texel sum{zero, zero, zero, zero};
            const auto add_texel = [&](const Texel& texel, FloatV inclined, FloatV share) HWY_ATTR {
                FloatV weight = share;
                if constexpr (trust != FilterTrust::all)
                    weight = hn::Mul(share, trustOf<trust>(per_reach, far, hn::MulSub(texel.z, inclined, plane)));
                weight = hn::IfThenElseZero(hn::Gt(texel.z, zero), weight);
                sum.r = hn::MulAdd(weight, texel.r, sum.r);
                sum.g = hn::MulAdd(weight, texel.g, sum.g);
                sum.b = hn::MulAdd(weight, texel.b, sum.b);
                sum.z = hn::Add(sum.z, weight);
            };
            Texel texels[2][2];
            if constexpr (course == FilterLine::Course::row) {
                const FloatV x = place(axis.x, position.x, from_x, last_x);
                const FloatV left = hn::Floor(x), fx = hn::Sub(x, left);
                lookUp<1, 2>(grid, hn::ConvertTo(di, left), own_row, texels);
                const FloatV inclined = hn::MulAdd(slope_x, left, hn::MulAdd(slope_y, row, slope));
                add_texel(texels[0][0], inclined, hn::Sub(one, fx));
                add_texel(texels[0][1], hn::Add(inclined, slope_x), fx);
            } else if constexpr (course == FilterLine::Course::column) {
                const FloatV y = place(axis.y, position.y, from_y, last_y);
                const FloatV top = hn::Floor(y), fy = hn::Sub(y, top);
                lookUp<2, 1>(grid, own_column, hn::ConvertTo(di, top), texels);
                const FloatV inclined = hn::MulAdd(slope_y, top, hn::MulAdd(slope_x, column, slope));
                add_texel(texels[0][0], inclined, hn::Sub(one, fy));
                add_texel(texels[1][0], hn::Add(inclined, slope_y), fy);
            } else {
                const FloatV x = place(axis.x, position.x, from_x, last_x);
                const FloatV y = place(axis.y, position.y, from_y, last_y);
                const FloatV left = hn::Floor(x), fx = hn::Sub(x, left);
                const FloatV top = hn::Floor(y), fy = hn::Sub(y, top);
                lookUp<2, 2>(grid, hn::ConvertTo(di, left), hn::ConvertTo(di, top), texels);
                const FloatV upper = hn::MulAdd(slope_x, left, hn::MulAdd(slope_y, top, slope));
                const FloatV lower = hn::Add(upper, slope_y);
                const FloatV right_share = hn::Mul(fx, hn::Sub(one, fy)), both = hn::Mul(fx, fy);
                add_texel(texels[0][0], upper, hn::Sub(hn::Sub(one, fy), right_share));
                add_texel(texels[0][1], hn::Add(upper, slope_x), right_share);
                add_texel(texels[1][0], lower, hn::Sub(fy, both));
                add_texel(texels[1][1], hn::Add(lower, slope_x), both);
            }
            return sum;
        };

        // What taps bring, and what is left to the middle.
        FloatV r = zero, g = zero, b = zero;
        const Rgbf middle = pass.line->middle;
        FloatV rest_r = hn::Set(d, middle.r), rest_g = hn::Set(d, middle.g), rest_b = hn::Set(d, middle.b);
        for (const FilterTap& tap : pass.line->taps) {
            const FloatV offset = hn::Mul(width, hn::Set(d, tap.offset));
            // 1e-30: at offset and height 0.
            const FloatV far = hn::MulAdd(hn::Set(d, 2.0f), hn::Abs(offset), hn::Set(d, 1e-30f));
            const Texel ahead = lightAt(offset, far), behind = lightAt(hn::Neg(offset), far);
            const FloatV missing = hn::Mul(fallback, hn::Sub(hn::Set(d, 2.0f), hn::Add(ahead.z, behind.z)));
            const auto add = [&](float weight, FloatV seen_ahead, FloatV seen_behind, FloatV& to, FloatV& rest)
                                 HWY_ATTR {
                                     to = hn::MulAdd(hn::Set(d, weight), hn::Add(seen_ahead, seen_behind), to);
                                     rest = hn::MulAdd(hn::Set(d, weight), missing, rest);
                                 };
            add(tap.weight.r, ahead.r, behind.r, r, rest_r);
            add(tap.weight.g, ahead.g, behind.g, g, rest_g);
            add(tap.weight.b, ahead.b, behind.b, b, rest_b);
        }
        r = hn::MulAdd(rest_r, hn::LoadU(d, pass.light[0] + i), r);
        g = hn::MulAdd(rest_g, hn::LoadU(d, pass.light[1] + i), g);
        b = hn::MulAdd(rest_b, hn::LoadU(d, pass.light[2] + i), b);
        hn::StoreU(r, d, pass.result[0] + i);
        hn::StoreU(g, d, pass.result[1] + i);
        hn::StoreU(b, d, pass.result[2] + i);
        if (!pass.grid_out[0] || i >= samples.standing) continue;
        const std::size_t last = i + hn::Lanes(d) - 1, cell = samples.cell[i];
        if (last < samples.standing && samples.cell[last] == cell + hn::Lanes(d) - 1) {
            hn::StoreU(r, d, pass.grid_out[0] + cell);
            hn::StoreU(g, d, pass.grid_out[1] + cell);
            hn::StoreU(b, d, pass.grid_out[2] + cell);
        } else
            for (std::size_t k = i; k <= std::min(last, samples.standing - 1); ++k)
                for (std::size_t c = 0; c < 3; ++c) pass.grid_out[c][samples.cell[k]] = pass.result[c][k];
    }
}

template <FilterLine::Course course>
HWY_INLINE void filterCourse(const FilterPass& pass, std::size_t begin, std::size_t end) {
    if (pass.trust == FilterTrust::all) return filterLanes<course, FilterTrust::all>(pass, begin, end);
    if (pass.trust == FilterTrust::depth) return filterLanes<course, FilterTrust::depth>(pass, begin, end);
    filterLanes<course, FilterTrust::distance>(pass, begin, end);
}

void filterPart(const FilterPass& pass, std::size_t begin, std::size_t end) {
    using Course = FilterLine::Course;
    if (pass.course == Course::row) return filterCourse<Course::row>(pass, begin, end);
    if (pass.course == Course::column) return filterCourse<Course::column>(pass, begin, end);
    filterCourse<Course::any>(pass, begin, end);
}

}  // namespace HWY_NAMESPACE
}  // namespace searchlight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace searchlight {

HWY_EXPORT(filterPart);

namespace {

using Planes = ScreenFilter::Planes;

constexpr std::size_t grain = 4096;
static_assert(grain % ScreenSamples::lanes == 0);

std::array<const float*, 3> read(const Planes& planes) {
    return {planes[0].data(), planes[1].data(), planes[2].data()};
}
std::array<float*, 3> written(Planes& planes) { return {planes[0].data(), planes[1].data(), planes[2].data()}; }

}  // namespace

FilterLine::Course FilterLine::course(FilterAxes axes) const {
    if (axes == FilterAxes::turned) return Course::any;
    if (sine == 0) return Course::row;
    // Across a row the tangent plane seldom runs along a column.
    return axes == FilterAxes::screen && cosine == 0 ? Course::column : Course::any;
}

std::vector<FilterTerm> filterTerms(const Taps& taps) {
    std::vector<FilterTerm> terms;
    for (const TapTerm& from : taps.terms) {
        FilterLine line;
        const std::size_t middle = from.offsets_mm.size() / 2;
        line.middle = toFloat(from.weight(middle));
        for (std::size_t i = middle + 1; i < from.offsets_mm.size(); ++i)
            line.taps.push_back({static_cast<float>(from.offsets_mm[i]), toFloat(from.weight(i))});
        FilterTerm term{{line, line}, toFloat(from.scale)};
        const double angle = from.angle_deg * (std::numbers::pi / 180);
        term.lines[0].cosine = term.lines[1].sine = static_cast<float>(std::cos(angle));
        term.lines[0].sine = static_cast<float>(std::sin(angle));
        term.lines[1].cosine = -term.lines[0].sine;
        terms.push_back(std::move(term));
    }
    return terms;
}

std::array<std::vector<float>, 2> filterTurns(const ScreenSamples& samples, int frame, bool second) {
    std::array<std::vector<float>, 2> turns;
    for (std::vector<float>& plane : turns) plane.resize(samples.padded());
    const auto pixelOf = [&](float along, float depth, int size) {
        return std::floor(static_cast<double>(samples.focal) * along / depth + 0.5 * size);
    };
    for (std::size_t i = 0; i < samples.padded(); ++i) {
        const float z = samples.position[2][i];
        const double angle = turnOfPixel(pixelOf(samples.position[0][i], z, samples.width),
                                         pixelOf(samples.position[1][i], z, samples.height), frame, second);
        turns[0][i] = static_cast<float>(std::cos(angle));
        turns[1][i] = static_cast<float>(std::sin(angle));
    }
    return turns;
}

double meanOffset(const Taps& taps) {
    if (taps.terms.empty()) return 0;
    const TapTerm& term = taps.terms.front();
    double sum = 0, mass = 0;
    for (std::size_t i = 0; i < term.offsets_mm.size(); ++i)
        for (int c = 0; c < Rgb::channels; ++c) {
            const double weight = std::abs(term.weight(i)[c]);
            sum += weight * std::abs(term.offsets_mm[i]);
            mass += weight;
        }
    return mass > 0 ? sum / mass : 0;
}

float perReach(const Taps& taps, const ScreenFilterOptions& options) {
    const double reach = options.reach * meanOffset(taps) * options.width;
    // 1e12: a kernel without a width trusts nothing beside the plane, and squares of it stay finite.
    return static_cast<float>(1 / std::max(reach, 1e-12));
}

void ScreenFilter::filter(const ScreenSamples& samples, std::span<const Rgbf> light, const Taps& taps,
                          const ScreenFilterOptions& options, std::vector<Rgbf>& result) {
    assert(light.size() == samples.count && (options.strength.empty() || options.strength.size() == samples.count));
    const std::size_t padded = samples.padded(), parts = (padded + grain - 1) / grain;
    result.resize(samples.count);
    if (samples.count == 0) return;
    for (Planes* planes : {&given_, &between_, &filtered_})
        for (std::vector<float>& plane : *planes) plane.resize(padded);
    for (Planes* planes : {&grid_, &grid_between_})
        for (std::vector<float>& plane : *planes) plane.resize(samples.cells());
    strength_.assign(options.strength.empty() ? 0 : padded, 1.0f);
    if (options.axes == FilterAxes::turned)
        for (const std::size_t line : {0u, 1u}) turns_[line] = filterTurns(samples, options.frame, line == 1);
    const auto forParts = [&](const auto& body) {
        parallelFor(parts, options.threads, [&](std::size_t part) {
            if (options.observer && options.observer->cancelled()) throw interruptedError();
            body(part * grain, std::min(padded, (part + 1) * grain));
        });
    };
    forParts([&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < std::min(end, samples.count); ++i) {
            const Rgbf& value = light[samples.source[i]];
            given_[0][i] = value.r;
            given_[1][i] = value.g;
            given_[2][i] = value.b;
            if (!strength_.empty()) strength_[i] = options.strength[samples.source[i]];
        }
        for (std::size_t c = 0; c < 3; ++c)
            for (std::size_t i = begin; i < std::min(end, samples.standing); ++i)
                grid_[c][samples.cell[i]] = given_[c][i];
    });
    bool empty = true;
    for (const FilterTerm& term : filterTerms(taps)) {
        const auto pass = [&](std::size_t line, const Planes& from_grid, const Planes& from, Planes& to,
                              Planes* to_grid) {
            const FilterLine& along = term.lines[line];
            return FilterPass{.samples = &samples,
                              .line = &along,
                              .course = along.course(options.axes),
                              .axes = options.axes,
                              .trust = options.trust,
                              .width = static_cast<float>(options.width),
                              .per_reach = perReach(taps, options),
                              .fallback = static_cast<float>(options.fallback),
                              .strength = strength_,
                              .turns = options.axes == FilterAxes::turned
                                           ? std::array<const float*, 2>{turns_[line][0].data(), turns_[line][1].data()}
                                           : std::array<const float*, 2>{},
                              .grid = read(from_grid),
                              .light = read(from),
                              .result = written(to),
                              .grid_out = to_grid ? written(*to_grid) : std::array<float*, 3>{}};
        };
        const FilterPass first = pass(0, grid_, given_, between_, &grid_between_);
        const FilterPass second = pass(1, grid_between_, between_, filtered_, nullptr);
        forParts([&](std::size_t begin, std::size_t end) { HWY_DYNAMIC_DISPATCH(filterPart)(first, begin, end); });
        forParts([&](std::size_t begin, std::size_t end) {
            HWY_DYNAMIC_DISPATCH(filterPart)(second, begin, end);
            for (std::size_t i = begin; i < std::min(end, samples.count); ++i) {
                Rgbf& sum = result[samples.source[i]];
                const Rgbf more{term.scale.r * filtered_[0][i], term.scale.g * filtered_[1][i],
                                term.scale.b * filtered_[2][i]};
                sum = empty ? more : Rgbf{sum.r + more.r, sum.g + more.g, sum.b + more.b};
            }
        });
        empty = false;
    }
}

std::vector<Rgbf> filterScreen(const ScreenSamples& samples, std::span<const Rgbf> light, const Taps& taps,
                               const ScreenFilterOptions& options) {
    std::vector<Rgbf> result;
    ScreenFilter().filter(samples, light, taps, options, result);
    return result;
}

}  // namespace searchlight
#endif
