// Interactions of expansions on float lanes. Included once per instruction set.
//
// With x from the source's centre to the target's, v a small step and f(w) = R_d, w = |x|^2 + c^2,
//   R_d(|x + v|) = f + g x.v + (g |v|^2 + h (x.v)^2) / 2 + ..., g = 2 f', h = 4 f''.
// The step is v = y - p: a receiver's place about its node's centre less a point's about its own.
#if defined(SEARCHLIGHT_RENDER_KERNELS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SEARCHLIGHT_RENDER_KERNELS_INL_H_
#undef SEARCHLIGHT_RENDER_KERNELS_INL_H_
#else
#define SEARCHLIGHT_RENDER_KERNELS_INL_H_
#endif

#include <array>
#include <cstddef>
#include <cstdint>

#include "render/exitance/point_tree.h"
#include "render/exitance/radial_table.h"
#include "transport/walk/lane_walk-inl.h"

HWY_BEFORE_NAMESPACE();
namespace searchlight {
namespace HWY_NAMESPACE {

constexpr std::size_t kStride = PointTree::Impl::moments_per_node;
constexpr std::size_t kTerms = PointTree::Impl::moments_per_channel;

/// Taylor coefficients about a receiver node's centre: per channel the value, its gradient, and its second derivatives
/// xx xy xz yy yz zz.
struct Expansion {
    float term[3][kTerms];
};

/// Where a squared distance lies in the table.
struct Place {
    IntV entry;   // first float of the bin's entry
    FloatV step;  // from the bin's centre
};

class TableLanes {
public:
    TableLanes(const RadialTable::Impl& table, std::span<const float> opening)
        : entries_(table.entries.front().value.data()),
          opening_(opening.data()),
          offset_(table.offset),
          base_(static_cast<std::int32_t>(table.base)),
          last_(static_cast<std::int32_t>(table.entries.size() - 1)) {}

    HWY_INLINE IntV bin(FloatV square, FloatV& w) const {
        const Float d;
        const Int di;
        w = hn::Add(square, hn::Set(d, offset_));
        const IntV index = hn::Sub(hn::ShiftRight<RadialTable::Impl::shift>(hn::BitCast(di, w)), hn::Set(di, base_));
        return hn::Min(index, hn::Set(di, last_));
    }

    HWY_INLINE FloatV opening(IntV bin) const { return hn::GatherIndex(Float(), opening_, bin); }

    HWY_INLINE Place place(FloatV square) const {
        const Float d;
        const Int di;
        constexpr std::int32_t low = (1 << RadialTable::Impl::shift) - 1, half = 1 << (RadialTable::Impl::shift - 1);
        FloatV w;
        const IntV index = bin(square, w);
        const IntV centre = hn::Or(hn::AndNot(hn::Set(di, low), hn::BitCast(di, w)), hn::Set(di, half));
        return {hn::ShiftLeft<4>(index), hn::Sub(w, hn::BitCast(d, centre))};
    }

    /// R_d of a channel.
    HWY_INLINE FloatV value(const Place& at, std::size_t channel) const {
        const Float d;
        const float* entry = entries_ + RadialEntry::stride * channel;
        const FloatV f0 = hn::GatherIndex(d, entry, at.entry);
        const FloatV f1 = hn::GatherIndex(d, entry + 1, at.entry);
        const FloatV f2 = hn::GatherIndex(d, entry + 2, at.entry);
        const FloatV half_step = hn::Mul(at.step, hn::Set(d, 0.5f));
        return hn::MulAdd(at.step, hn::MulAdd(half_step, f2, f1), f0);
    }

    /// R_d, g = 2 f' and h = 4 f''.
    HWY_INLINE void derivatives(const Place& at, std::size_t channel, FloatV& f, FloatV& g, FloatV& h) const {
        const Float d;
        const float* entry = entries_ + RadialEntry::stride * channel;
        const FloatV f0 = hn::GatherIndex(d, entry, at.entry);
        const FloatV f1 = hn::GatherIndex(d, entry + 1, at.entry);
        const FloatV f2 = hn::GatherIndex(d, entry + 2, at.entry);
        const FloatV f3 = hn::GatherIndex(d, entry + 3, at.entry);
        const FloatV half_step = hn::Mul(at.step, hn::Set(d, 0.5f));
        f = hn::MulAdd(at.step, hn::MulAdd(half_step, f2, f1), f0);
        g = hn::Mul(hn::Set(d, 2.0f), hn::MulAdd(at.step, hn::MulAdd(half_step, f3, f2), f1));
        h = hn::Mul(hn::Set(d, 4.0f), hn::MulAdd(at.step, f3, f2));
    }

private:
    const float* entries_;
    const float* opening_;
    float offset_;
    std::int32_t base_, last_;
};

/// Source nodes that are far enough from a target node, with the vectors from their centres to its centre.
struct Accepted {
    static constexpr std::size_t capacity = 256;
    // Whole vectors are stored at the end.
    alignas(64) std::int32_t node[capacity + 32];
    alignas(64) float x[capacity + 32], y[capacity + 32], z[capacity + 32];
    std::size_t count = 0;
};

/// Adds to the target's expansion what the accepted nodes' moments give; empties the list. Node `nothing` has no
/// moments: it fills the last vector.
HWY_NOINLINE inline void momentsToExpansion(const float* moments, std::int32_t nothing, const TableLanes& table,
                                            Accepted& list, Expansion& to) {
    const Float d;
    const Int di;
    const std::size_t lanes = hn::Lanes(d);
    if (list.count == 0) return;
    hn::StoreU(hn::Set(di, nothing), di, list.node + list.count);
    for (float* to_pad : {list.x, list.y, list.z}) hn::StoreU(hn::Set(d, 1.0f), d, to_pad + list.count);
    for (std::size_t c = 0; c < 3; ++c) {
        FloatV value = hn::Zero(d), x = value, y = value, z = value;
        FloatV xx = value, xy = value, xz = value, yy = value, yz = value, zz = value;
        for (std::size_t i = 0; i < list.count; i += lanes) {
            const FloatV dx = hn::Load(d, list.x + i), dy = hn::Load(d, list.y + i), dz = hn::Load(d, list.z + i);
            const Place at = table.place(hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz))));
            FloatV f, g, h;
            table.derivatives(at, c, f, g, h);
            const IntV node = hn::ShiftLeft<5>(hn::Load(di, list.node + i));
            const auto moment = [&](std::size_t k) { return hn::GatherIndex(d, moments + c * kTerms + k, node); };
            const FloatV m = moment(0), mx = moment(1), my = moment(2), mz = moment(3);
            const FloatV mxx = moment(4), mxy = moment(5), mxz = moment(6);
            const FloatV myy = moment(7), myz = moment(8), mzz = moment(9);
            // x.M1, M2 x and x.M2 x.
            const FloatV along = hn::MulAdd(dx, mx, hn::MulAdd(dy, my, hn::Mul(dz, mz)));
            const FloatV square =
                hn::MulAdd(dx, hn::MulAdd(dx, mxx, hn::Mul(hn::Add(dy, dy), mxy)),
                           hn::MulAdd(dy, hn::MulAdd(dy, myy, hn::Mul(hn::Add(dz, dz), myz)),
                                      hn::Mul(dz, hn::MulAdd(dz, mzz, hn::Mul(hn::Add(dx, dx), mxz)))));
            const FloatV trace = hn::Add(mxx, hn::Add(myy, mzz));
            const FloatV second = hn::MulAdd(g, trace, hn::Mul(h, square));
            value = hn::Add(value, hn::MulAdd(f, m, hn::NegMulAdd(g, along, hn::Mul(hn::Set(d, 0.5f), second))));
            const FloatV gm = hn::Mul(g, m), hm = hn::Mul(h, m);
            const FloatV inward = hn::NegMulAdd(h, along, gm);
            x = hn::Add(x, hn::NegMulAdd(g, mx, hn::Mul(inward, dx)));
            y = hn::Add(y, hn::NegMulAdd(g, my, hn::Mul(inward, dy)));
            z = hn::Add(z, hn::NegMulAdd(g, mz, hn::Mul(inward, dz)));
            const FloatV hx = hn::Mul(hm, dx), hy = hn::Mul(hm, dy), hz = hn::Mul(hm, dz);
            xx = hn::Add(xx, hn::MulAdd(hx, dx, gm));
            yy = hn::Add(yy, hn::MulAdd(hy, dy, gm));
            zz = hn::Add(zz, hn::MulAdd(hz, dz, gm));
            xy = hn::MulAdd(hx, dy, xy);
            xz = hn::MulAdd(hx, dz, xz);
            yz = hn::MulAdd(hy, dz, yz);
        }
        float* term = to.term[c];
        std::size_t k = 0;
        for (const FloatV& sum : {value, x, y, z, xx, xy, xz, yy, yz, zz})
            term[k++] += hn::GetLane(hn::SumOfLanes(d, sum));
    }
    list.count = 0;
}

/// The same polynomial about a centre that is at (dx, dy, dz) from the old one.
HWY_INLINE Expansion shifted(const Expansion& from, float dx, float dy, float dz) {
    Expansion to;
    for (std::size_t c = 0; c < 3; ++c) {
        const float* a = from.term[c];
        float* b = to.term[c];
        const float x = a[4] * dx + a[5] * dy + a[6] * dz;
        const float y = a[5] * dx + a[7] * dy + a[8] * dz;
        const float z = a[6] * dx + a[8] * dy + a[9] * dz;
        b[0] = a[0] + dx * (a[1] + 0.5f * x) + dy * (a[2] + 0.5f * y) + dz * (a[3] + 0.5f * z);
        b[1] = a[1] + x;
        b[2] = a[2] + y;
        b[3] = a[3] + z;
        for (std::size_t k = 4; k < kTerms; ++k) b[k] = a[k];
    }
    return to;
}

/// A vector of receivers and what they have got so far.
struct Receivers {
    FloatV x, y, z;
    FloatV sum[3];

    HWY_INLINE void addExpansion(const Expansion& e, const ReceiverNode& node) {
        const Float d;
        const FloatV dx = hn::Sub(x, hn::Set(d, node.centre.x)), dy = hn::Sub(y, hn::Set(d, node.centre.y)),
                     dz = hn::Sub(z, hn::Set(d, node.centre.z));
        const FloatV half = hn::Set(d, 0.5f);
        const FloatV hx = hn::Mul(half, dx), hy = hn::Mul(half, dy), hz = hn::Mul(half, dz);
        for (std::size_t c = 0; c < 3; ++c) {
            const auto t = [&](std::size_t k) { return hn::Set(d, e.term[c][k]); };
            const FloatV gx = hn::MulAdd(hx, t(4), hn::MulAdd(dy, t(5), hn::MulAdd(dz, t(6), t(1))));
            const FloatV gy = hn::MulAdd(hy, t(7), hn::MulAdd(dz, t(8), t(2)));
            const FloatV gz = hn::MulAdd(hz, t(9), t(3));
            sum[c] = hn::Add(sum[c], hn::MulAdd(dx, gx, hn::MulAdd(dy, gy, hn::MulAdd(dz, gz, t(0)))));
        }
    }

    HWY_INLINE FloatV squareTo(const float* centre, FloatV& dx, FloatV& dy, FloatV& dz) const {
        const Float d;
        dx = hn::Sub(x, hn::Set(d, centre[0]));
        dy = hn::Sub(y, hn::Set(d, centre[1]));
        dz = hn::Sub(z, hn::Set(d, centre[2]));
        return hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz)));
    }

    HWY_INLINE void addMoments(const float* moments, const float* centre, const TableLanes& table) {
        const Float d;
        FloatV dx, dy, dz;
        const Place at = table.place(squareTo(centre, dx, dy, dz));
        for (std::size_t c = 0; c < 3; ++c) {
            FloatV f, g, h;
            table.derivatives(at, c, f, g, h);
            const float* m = moments + c * kTerms;
            const auto moment = [&](std::size_t k) { return hn::Set(d, m[k]); };
            const FloatV along = hn::MulAdd(dx, moment(1), hn::MulAdd(dy, moment(2), hn::Mul(dz, moment(3))));
            const auto twice = [&](std::size_t k) { return hn::Set(d, 2 * m[k]); };
            const FloatV square = hn::MulAdd(dx, hn::MulAdd(dx, moment(4), hn::Mul(dy, twice(5))),
                                             hn::MulAdd(dy, hn::MulAdd(dy, moment(7), hn::Mul(dz, twice(8))),
                                                        hn::Mul(dz, hn::MulAdd(dz, moment(9), hn::Mul(dx, twice(6))))));
            const FloatV second = hn::MulAdd(g, hn::Set(d, m[4] + m[7] + m[9]), hn::Mul(h, square));
            const FloatV low = hn::MulAdd(f, moment(0), hn::NegMulAdd(g, along, sum[c]));
            sum[c] = hn::MulAdd(hn::Set(d, 0.5f), second, low);
        }
    }

    HWY_INLINE void addPoints(const PointTree::Impl& points, std::size_t first, std::size_t count,
                              const TableLanes& table) {
        const Float d;
        for (std::size_t i = first; i < first + count; ++i) {
            const float centre[] = {points.x[i], points.y[i], points.z[i]};
            FloatV dx, dy, dz;
            const Place at = table.place(squareTo(centre, dx, dy, dz));
            for (std::size_t c = 0; c < 3; ++c)
                sum[c] = hn::MulAdd(hn::Set(d, points.flux[c][i]), table.value(at, c), sum[c]);
        }
    }
};

}  // namespace HWY_NAMESPACE
}  // namespace searchlight
HWY_AFTER_NAMESPACE();

#endif
