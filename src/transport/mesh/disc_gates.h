// Which of a disc's beams may bring the light of one of its directions to a place: many are tried, one or two do.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "base/vec.h"

namespace searchlight {

/// A beam behind a facet, for vectors of four: u, v, 1 - u - v and t of a place x are place[0] x.x + place[1] x.y +
/// place[2] x.z + place[3]. Light from the disc's direction w enters where the first three are less by t times those of
/// towards[0] w.x + towards[1] w.y + towards[2] w.z + towards[3], within t times the fourth.
struct alignas(64) DiscGate {
    float place[4][4] = {}, towards[4][4] = {};
};

struct DiscPlace {
    Vec3f position;
    Vec3f wi;  ///< of the disc
};

constexpr std::size_t kGatesAtOnce = 64;

/// A bit for each of at most kGatesAtOnce gates of the list through which the light may come, where u, v and 1 - u - v
/// may be off by `margin`.
std::uint64_t openGates(std::span<const DiscGate> gates, std::span<const std::uint32_t> list, const DiscPlace& place,
                        float margin);

}  // namespace searchlight
