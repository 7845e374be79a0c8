#include "render/screen/screen_filter.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "base/parallel.h"
#include "render/screen/filter_pass.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/screen/screen_filter.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace searchlight {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Float = hn::CappedTag<float, 16>;
using Int = hn::RebindToSigned<Float>;
using FloatV = hn::Vec<Float>;
using IntV = hn::Vec<Int>;

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

// The direction of the pass.
HWY_INLINE Vectors axisOf(const FilterPass& pass, const Vectors& position, const Vectors& normal) {
    const Float d;
    const FloatV cosine = hn::Set(d, pass.line->cosine), sine = hn::Set(d, pass.line->sine);
    if (pass.axes == FilterAxes::screen) return {cosine, sine, hn::Zero(d)};
    // The plane of the picture's row meets the tangent plane in u: a pass along u stays in its row.
    const FloatV row_y = hn::Neg(position.z), row_z = position.y;
    Vectors u = {hn::MulSub(row_y, normal.z, hn::Mul(row_z, normal.y)), hn::Mul(row_z, normal.x),
                 hn::Neg(hn::Mul(row_y, normal.x))};
    const FloatV square = dotOf(u, u), limit = hn::Mul(hn::Set(d, FilterPass::edge_on), dotOf(position, position));
    const auto edge_on = hn::Lt(square, limit);
    const FloatV per_length = hn::Div(hn::Set(d, 1.0f), hn::Sqrt(hn::Max(square, limit)));
    u = {hn::IfThenElse(edge_on, hn::Set(d, 1.0f), hn::Mul(per_length, u.x)),
         hn::IfThenZeroElse(edge_on, hn::Mul(per_length, u.y)), hn::IfThenZeroElse(edge_on, hn::Mul(per_length, u.z))};
    if (pass.line->sine == 0) return u;
    const Vectors v = crossOf(u, normal);
    return {hn::MulAdd(cosine, u.x, hn::Mul(sine, v.x)), hn::MulAdd(cosine, u.y, hn::Mul(sine, v.y)),
            hn::MulAdd(cosine, u.z, hn::Mul(sine, v.z))};
}

// Of a tap at `offset` whose pixel shows a point at `height` over the plane of the pass.
HWY_INLINE FloatV trustOf(const FilterPass& pass, FloatV offset, FloatV height) {
    const Float d;
    const FloatV one = hn::Set(d, 1.0f), per_reach = hn::Set(d, pass.per_reach);
    if (pass.trust == FilterTrust::all) return one;
    if (pass.trust == FilterTrust::depth) return hn::Max(hn::Zero(d), hn::NegMulAdd(hn::Abs(height), per_reach, one));
    // (1 + y / 4)^-4 stands for e^-y, and h^2 / (|h| + 2 |o|) for the way that it is further, of which it is at least
    // four fifths: together one reciprocal. 1e-30: at offset and height 0.
    const FloatV far = hn::MulAdd(hn::Set(d, 2.0f), hn::Abs(offset), hn::Add(hn::Abs(height), hn::Set(d, 1e-30f)));
    const FloatV root =
        hn::Mul(far, reciprocal(hn::MulAdd(hn::Mul(height, height), hn::Mul(per_reach, hn::Set(d, 0.25f)), far)));
    const FloatV root2 = hn::Mul(root, root);
    return hn::Mul(root2, root2);
}

// What the grid holds in the cells around a place.
struct Texel {
    FloatV r, g, b, z;
};

// The grid under neighbouring lanes: mostly a few vectors of one or two rows, which permutations bring to their lanes
// in a fraction of the time of a gather.
struct Grid {
    std::array<const float*, 4> planes;
    IntV stride;
    std::ptrdiff_t row_step;

    Grid(const FilterPass& pass)
        : planes{pass.grid[0], pass.grid[1], pass.grid[2], pass.samples->depth.data()},
          stride(hn::Set(Int(), pass.samples->stride())),
          row_step(pass.samples->stride()) {}

    HWY_INLINE Texel gathered(IntV at) const {
        const Float d;
        return {hn::GatherIndex(d, planes[0], at), hn::GatherIndex(d, planes[1], at), hn::GatherIndex(d, planes[2], at),
                hn::GatherIndex(d, planes[3], at)};
    }

    // Those at base + index, index below two vectors, permuted.
    HWY_INLINE Texel permuted(std::ptrdiff_t base, IntV index) const {
        const Float d;
        const Int di;
        const IntV lanes = hn::Set(di, static_cast<int>(hn::Lanes(d)));
        const auto indices = hn::IndicesFromVec(d, hn::And(index, hn::Sub(lanes, hn::Set(di, 1))));
        const auto lower = hn::RebindMask(d, hn::Lt(index, lanes));
        const auto one = [&](std::size_t plane) HWY_ATTR {
            const float* from = planes[plane] + base;
            return hn::IfThenElse(lower, hn::TableLookupLanes(hn::LoadU(d, from), indices),
                                  hn::TableLookupLanes(hn::LoadU(d, from + hn::Lanes(d)), indices));
        };
        return {one(0), one(1), one(2), one(3)};
    }
};

// Of a row of cells, `columns` (1 or 2) from `left` on in `rows` (1 or 2) from `top` on, as texels[row][column].
template <int rows, int columns>
HWY_INLINE void lookUp(const Grid& grid, IntV left, IntV top, Texel (&texels)[2][2]) {
    const Float d;
    const Int di;
    const IntV one = hn::Set(di, 1);
    const int lanes = static_cast<int>(hn::Lanes(d));
    const int first_left = hn::GetLane(left) - lanes / 4, first_top = hn::GetLane(top);
    const IntV index = hn::Sub(left, hn::Set(di, first_left));
    const auto in_window = hn::And(hn::Gt(index, hn::Set(di, -1)), hn::Lt(index, hn::Set(di, 2 * lanes - 1)));
    const auto in_row = hn::Eq(top, hn::Set(di, first_top));
    const auto base = [&](int row) {
        return ScreenSamples::margin + static_cast<std::ptrdiff_t>(first_top + row) * grid.row_step + first_left;
    };
    if (hn::AllTrue(di, hn::And(in_window, in_row))) {
        for (int row = 0; row < rows; ++row)
            for (int column = 0; column < columns; ++column)
                texels[row][column] = grid.permuted(base(row), column == 0 ? index : hn::Add(index, one));
        return;
    }
    const IntV at = hn::Add(hn::Add(hn::Mul(top, grid.stride), left), hn::Set(di, ScreenSamples::margin));
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column) {
            const IntV shift = hn::Set(di, row * static_cast<int>(grid.row_step) + column);
            texels[row][column] = grid.gathered(hn::Add(at, shift));
        }
}

// Samples [begin, end), whole vectors.
void filterPart(const FilterPass& pass, std::size_t begin, std::size_t end) {
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
    const Grid grid(pass);
    const FilterLine::Course course = pass.course;

    for (std::size_t i = begin; i < end; i += hn::Lanes(d)) {
        const Vectors position = loaded(samples.position, i);
        const Vectors normal = pass.axes == FilterAxes::screen ? Vectors{zero, zero, one} : loaded(samples.normal, i);
        const Vectors axis = axisOf(pass, position, normal);
        const FloatV plane = dotOf(normal, position);
        const FloatV width = pass.strength.empty() ? hn::Set(d, pass.width)
                                                   : hn::Mul(hn::Set(d, pass.width), hn::LoadU(d, &pass.strength[i]));
        const FloatV nearest = hn::Mul(hn::Set(d, FilterPass::nearest), position.z);
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
        // What taps bring, and what is left to the middle.
        FloatV r = zero, g = zero, b = zero;
        const Rgbf middle = pass.line->middle;
        FloatV rest_r = hn::Set(d, middle.r), rest_g = hn::Set(d, middle.g), rest_b = hn::Set(d, middle.b);
        for (const FilterTap& tap : pass.line->taps) {
            const FloatV offset = hn::Mul(width, hn::Set(d, tap.offset));
            const FloatV per_z = hn::Mul(focal, reciprocal(hn::Max(nearest, hn::MulAdd(offset, axis.z, position.z))));
            const auto place = [&](FloatV along, FloatV from, FloatV middle_of, FloatV last) HWY_ATTR {
                return hn::Min(hn::Max(hn::MulAdd(per_z, hn::MulAdd(offset, along, from), middle_of), zero), last);
            };
            FloatV sum_r = zero, sum_g = zero, sum_b = zero, sum = zero;
            const auto add_texel = [&](const Texel& texel, FloatV grid_x, FloatV grid_y, FloatV share) HWY_ATTR {
                FloatV weight = share;
                if (pass.trust != FilterTrust::all) {
                    const FloatV over_z = hn::Mul(texel.z, per_focal);
                    const Vectors seen = {hn::Mul(over_z, hn::Sub(grid_x, middle_x)),
                                          hn::Mul(over_z, hn::Sub(grid_y, middle_y)), texel.z};
                    weight = hn::Mul(share, trustOf(pass, offset, hn::Sub(dotOf(normal, seen), plane)));
                }
                weight = hn::IfThenElseZero(hn::Gt(texel.z, zero), weight);
                sum_r = hn::MulAdd(weight, texel.r, sum_r);
                sum_g = hn::MulAdd(weight, texel.g, sum_g);
                sum_b = hn::MulAdd(weight, texel.b, sum_b);
                sum = hn::Add(sum, weight);
            };
            Texel texels[2][2];
            if (course == FilterLine::Course::row) {
                const FloatV x = place(axis.x, position.x, from_x, last_x);
                const FloatV left = hn::Floor(x), fx = hn::Sub(x, left);
                lookUp<1, 2>(grid, hn::ConvertTo(di, left), hn::ConvertTo(di, row), texels);
                add_texel(texels[0][0], left, row, hn::Sub(one, fx));
                add_texel(texels[0][1], hn::Add(left, one), row, fx);
            } else if (course == FilterLine::Course::column) {
                const FloatV y = place(axis.y, position.y, from_y, last_y);
                const FloatV top = hn::Floor(y), fy = hn::Sub(y, top);
                lookUp<2, 1>(grid, hn::ConvertTo(di, column), hn::ConvertTo(di, top), texels);
                add_texel(texels[0][0], column, top, hn::Sub(one, fy));
                add_texel(texels[1][0], column, hn::Add(top, one), fy);
            } else {
                const FloatV x = place(axis.x, position.x, from_x, last_x);
                const FloatV y = place(axis.y, position.y, from_y, last_y);
                const FloatV left = hn::Floor(x), fx = hn::Sub(x, left), right = hn::Add(left, one);
                const FloatV top = hn::Floor(y), fy = hn::Sub(y, top), bottom = hn::Add(top, one);
                lookUp<2, 2>(grid, hn::ConvertTo(di, left), hn::ConvertTo(di, top), texels);
                add_texel(texels[0][0], left, top, hn::Mul(hn::Sub(one, fx), hn::Sub(one, fy)));
                add_texel(texels[0][1], right, top, hn::Mul(fx, hn::Sub(one, fy)));
                add_texel(texels[1][0], left, bottom, hn::Mul(hn::Sub(one, fx), fy));
                add_texel(texels[1][1], right, bottom, hn::Mul(fx, fy));
            }
            const FloatV missing = hn::Mul(fallback, hn::Sub(one, sum));
            const auto add = [&](float weight, FloatV from, FloatV& to, FloatV& rest) HWY_ATTR {
                to = hn::MulAdd(hn::Set(d, weight), from, to);
                rest = hn::MulAdd(hn::Set(d, weight), missing, rest);
            };
            add(tap.weight.r, sum_r, r, rest_r);
            add(tap.weight.g, sum_g, g, rest_g);
            add(tap.weight.b, sum_b, b, rest_b);
        }
        const auto put = [&](std::size_t c, FloatV sum, FloatV rest) HWY_ATTR {
            hn::StoreU(hn::MulAdd(rest, hn::LoadU(d, pass.light[c] + i), sum), d, pass.result[c] + i);
        };
        put(0, r, rest_r);
        put(1, g, rest_g);
        put(2, b, rest_b);
    }
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
    if (sine == 0) return Course::row;
    // Across a row the tangent plane seldom runs along a column.
    return axes == FilterAxes::screen && cosine == 0 ? Course::column : Course::any;
}

std::vector<FilterTerm> filterTerms(const Taps& taps) {
    std::vector<FilterTerm> terms;
    for (const TapTerm& from : taps.terms) {
        FilterLine line;
        for (std::size_t i = 0; i < from.offsets_mm.size(); ++i)
            if (from.offsets_mm[i] == 0)
                line.middle = toFloat(from.weight(i));
            else
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

float perReach(const Taps& taps, const FilterOptions& options) {
    const double reach = options.reach * meanOffset(taps) * options.width;
    // 1e12: a kernel without a width trusts nothing beside the plane, and squares of it stay finite.
    return static_cast<float>(1 / std::max(reach, 1e-12));
}

void ScreenFilter::filter(const ScreenSamples& samples, std::span<const Rgbf> light, const Taps& taps,
                          const FilterOptions& options, std::vector<Rgbf>& result) {
    assert(light.size() == samples.count && (options.strength.empty() || options.strength.size() == samples.count));
    const std::size_t padded = samples.padded(), parts = (padded + grain - 1) / grain;
    result.resize(samples.count);
    if (samples.count == 0) return;
    for (Planes* planes : {&given_, &between_, &filtered_})
        for (std::vector<float>& plane : *planes) plane.resize(padded);
    for (Planes* planes : {&grid_, &grid_between_})
        for (std::vector<float>& plane : *planes) plane.resize(samples.cells());
    strength_.assign(options.strength.empty() ? 0 : padded, 1.0f);
    const auto forParts = [&](const auto& body) {
        parallelFor(parts, options.threads, [&](std::size_t part) {
            if (options.observer && options.observer->cancelled()) throw interruptedError();
            body(part * grain, std::min(padded, (part + 1) * grain));
        });
    };
    const auto intoGrid = [&](const Planes& from, Planes& to, std::size_t begin, std::size_t end) {
        for (std::size_t c = 0; c < 3; ++c)
            for (std::size_t i = begin; i < std::min(end, samples.standing); ++i) to[c][samples.cell[i]] = from[c][i];
    };
    forParts([&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < std::min(end, samples.count); ++i) {
            const Rgbf& value = light[samples.source[i]];
            given_[0][i] = value.r;
            given_[1][i] = value.g;
            given_[2][i] = value.b;
            if (!strength_.empty()) strength_[i] = options.strength[samples.source[i]];
            result[samples.source[i]] = {};
        }
        intoGrid(given_, grid_, begin, end);
    });
    for (const FilterTerm& term : filterTerms(taps)) {
        const auto pass = [&](std::size_t line, const Planes& from_grid, const Planes& from, Planes& to) {
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
                              .grid = read(from_grid),
                              .light = read(from),
                              .result = written(to)};
        };
        const FilterPass first = pass(0, grid_, given_, between_), second = pass(1, grid_between_, between_, filtered_);
        forParts([&](std::size_t begin, std::size_t end) {
            HWY_DYNAMIC_DISPATCH(filterPart)(first, begin, end);
            intoGrid(between_, grid_between_, begin, end);
        });
        forParts([&](std::size_t begin, std::size_t end) {
            HWY_DYNAMIC_DISPATCH(filterPart)(second, begin, end);
            for (std::size_t i = begin; i < std::min(end, samples.count); ++i) {
                Rgbf& sum = result[samples.source[i]];
                sum.r += term.scale.r * filtered_[0][i];
                sum.g += term.scale.g * filtered_[1][i];
                sum.b += term.scale.b * filtered_[2][i];
            }
        });
    }
}

std::vector<Rgbf> filterScreen(const ScreenSamples& samples, std::span<const Rgbf> light, const Taps& taps,
                               const FilterOptions& options) {
    std::vector<Rgbf> result;
    ScreenFilter().filter(samples, light, taps, options, result);
    return result;
}

}  // namespace searchlight
#endif
