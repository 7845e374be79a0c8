#include "transport/mesh/disc_gates.h"

#include <hwy/cache_control.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "transport/mesh/disc_gates.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace searchlight {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

std::uint64_t openOf(std::span<const DiscGate> gates, std::span<const std::uint32_t> list, const DiscPlace& place,
                     float least) {
    constexpr std::size_t kAhead = 4;  // asked of the memory
    const hn::Full128<float> d;
    using Four = hn::Vec<decltype(d)>;
    const auto set = [&](float x) { return hn::Set(d, x); };
    const Four px = set(place.position.x), py = set(place.position.y), pz = set(place.position.z);
    const Four wx = set(place.wi.x), wy = set(place.wi.y), wz = set(place.wi.z), margin = set(least);
    const auto sum = [&](const float(&columns)[4][4], Four x, Four y, Four z) {
        return hn::MulAdd(
            hn::Load(d, columns[0]), x,
            hn::MulAdd(hn::Load(d, columns[1]), y, hn::MulAdd(hn::Load(d, columns[2]), z, hn::Load(d, columns[3]))));
    };
    std::uint64_t open = 0;
    for (std::size_t i = 0; i < list.size(); ++i) {
        if (i + kAhead < list.size()) {
            hwy::Prefetch(gates[list[i + kAhead]].place[0]);
            hwy::Prefetch(gates[list[i + kAhead]].towards[0]);
        }
        const DiscGate& gate = gates[list[i]];
        const Four at = sum(gate.place, px, py, pz), off = sum(gate.towards, wx, wy, wz);
        const Four t = hn::Broadcast<3>(at);
        const Four beyond = hn::NegMulAdd(t, off, at), slack = hn::MulAdd(t, hn::Broadcast<3>(off), margin);
        std::uint8_t bits[8] = {};
        hn::StoreMaskBits(d, hn::Ge(hn::Add(beyond, slack), hn::Zero(d)), bits);
        open |= static_cast<std::uint64_t>((bits[0] & 7) == 7) << i;
    }
    return open;
}

}  // namespace HWY_NAMESPACE
}  // namespace searchlight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace searchlight {

HWY_EXPORT(openOf);

std::uint64_t openGates(std::span<const DiscGate> gates, std::span<const std::uint32_t> list, const DiscPlace& place,
                        float margin) {
    return HWY_DYNAMIC_DISPATCH(openOf)(gates, list, place, margin);
}

}  // namespace searchlight
#endif
