// What neighbouring lanes read of a picture. Included once per instruction set.
#if defined(SEARCHLIGHT_RENDER_GRID_LOOKUP_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SEARCHLIGHT_RENDER_GRID_LOOKUP_INL_H_
#undef SEARCHLIGHT_RENDER_GRID_LOOKUP_INL_H_
#else
#define SEARCHLIGHT_RENDER_GRID_LOOKUP_INL_H_
#endif

#include <array>
#include <cstddef>

#include "base/lanes-inl.h"
#include "render/screen/filter_pass.h"

HWY_BEFORE_NAMESPACE();
namespace searchlight {
namespace HWY_NAMESPACE {

// What the grid holds in the cells around a place; or the light that taps bring, and how much of them is seen.
struct Texel {
    FloatV r, g, b, z;
};

// The grid under neighbouring lanes: mostly as many neighbouring cells, else a few vectors of one or two rows, which
// permutations bring to their lanes in a fraction of the time of a gather.
struct Grid {
    std::array<const float*, 4> planes;
    IntV stride;
    std::ptrdiff_t row_step;

    Grid(const FilterPass& pass)
        : planes{pass.grid[0], pass.grid[1], pass.grid[2], pass.samples->depth.data()},
          stride(hn::Set(Int(), pass.samples->stride())),
          row_step(pass.samples->stride()) {}

    HWY_INLINE Texel loaded(std::ptrdiff_t base) const {
        const Float d;
        return {hn::LoadU(d, planes[0] + base), hn::LoadU(d, planes[1] + base), hn::LoadU(d, planes[2] + base),
                hn::LoadU(d, planes[3] + base)};
    }

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

HWY_INLINE Texel blended(hn::Mask<Float> second, const Texel& a, const Texel& b) {
    return {hn::IfThenElse(second, b.r, a.r), hn::IfThenElse(second, b.g, a.g), hn::IfThenElse(second, b.b, a.b),
            hn::IfThenElse(second, b.z, a.z)};
}

// Lanes that all hold one of two successive numbers.
struct Step {
    int low = 0;
    bool even = false, near = false;  // all of them `low`; `low` or one more
    hn::Mask<Float> up;

    HWY_INLINE explicit Step(IntV numbers) {
        const Int di;
        low = hn::GetLane(numbers);
        even = near = hn::AllTrue(di, hn::Eq(numbers, hn::Set(di, low)));
        if (!even) {
            if (!hn::AllTrue(di, hn::Gt(numbers, hn::Set(di, low - 1)))) --low;
            near =
                hn::AllTrue(di, hn::And(hn::Gt(numbers, hn::Set(di, low - 1)), hn::Lt(numbers, hn::Set(di, low + 2))));
        }
        up = hn::RebindMask(Float(), hn::Gt(numbers, hn::Set(di, low)));
    }
};

// The cells under the lanes, `columns` (1 or 2) from `left` on in `rows` (1 or 2) from `top` on, as
// texels[row][column].
template <int rows, int columns>
HWY_INLINE void lookUp(const Grid& grid, IntV left, IntV top, Texel (&texels)[2][2]) {
    const Float d;
    const Int di;
    const int lanes = static_cast<int>(hn::Lanes(d));
    const Step x(hn::Sub(left, hn::Iota(di, 0))), y(top);
    const auto base = [&](int row, int column) HWY_ATTR {
        return ScreenSamples::margin + static_cast<std::ptrdiff_t>(y.low + row) * grid.row_step + x.low + column;
    };
    if (x.even && y.even) {
        for (int row = 0; row < rows; ++row)
            for (int column = 0; column < columns; ++column) texels[row][column] = grid.loaded(base(row, column));
        return;
    }
    if (x.near && y.near) {
        const auto rowOf = [&](int row, int column) HWY_ATTR {
            const Texel here = grid.loaded(base(row, column));
            return x.even ? here : blended(x.up, here, grid.loaded(base(row, column + 1)));
        };
        for (int column = 0; column < columns; ++column) {
            Texel above = rowOf(0, column);
            for (int row = 0; row < rows; ++row) {
                // Where no lane needs it the row below is not read: the grid may end there.
                if (y.even && row + 1 == rows) {
                    texels[row][column] = above;
                    continue;
                }
                const Texel below = rowOf(row + 1, column);
                texels[row][column] = y.even ? above : blended(y.up, above, below);
                above = below;
            }
        }
        return;
    }
    const IntV one = hn::Set(di, 1);
    const int first = hn::GetLane(left) - lanes / 4;
    const IntV index = hn::Sub(left, hn::Set(di, first));
    const auto in_window = hn::And(hn::Gt(index, hn::Set(di, -1)), hn::Lt(index, hn::Set(di, 2 * lanes - 1)));
    if (y.even && hn::AllTrue(di, in_window)) {
        for (int row = 0; row < rows; ++row)
            for (int column = 0; column < columns; ++column)
                texels[row][column] =
                    grid.permuted(base(row, first - x.low), column == 0 ? index : hn::Add(index, one));
        return;
    }
    const IntV at = hn::Add(hn::Add(hn::Mul(top, grid.stride), left), hn::Set(di, ScreenSamples::margin));
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column) {
            const IntV shift = hn::Set(di, row * static_cast<int>(grid.row_step) + column);
            texels[row][column] = grid.gathered(hn::Add(at, shift));
        }
}

}  // namespace HWY_NAMESPACE
}  // namespace searchlight
HWY_AFTER_NAMESPACE();

#endif
