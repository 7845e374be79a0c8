// A run of neighbouring points and the light from one direction on them: the inner loop of every light.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "base/vec.h"
#include "geometry/rays.h"
#include "light/lit_points.h"

namespace searchlight {

/// What is known of a point's view of a light before its ray is traced.
enum class ViewOfLight : std::uint8_t { unknown, open, blocked };

/// At most `capacity` consecutive points, unpacked for vector arithmetic. One per thread at work.
class LitBlock {
public:
    static constexpr std::size_t capacity = 1024;

    /// `rays` null: nothing casts shadows.
    LitBlock(const LitPoints& points, std::size_t first, const RayScene* rays)
        : rays_(rays), count_(std::min(capacity, points.size() - first)) {
        for (std::size_t i = 0; i < count_; ++i) {
            const Vec3f& n = points.normals[first + i];
            nx_[i] = n.x, ny_[i] = n.y, nz_[i] = n.z;
            origins_[i] = points.origins[first + i];
        }
    }

    std::size_t size() const { return count_; }

    /// Calls lit(i, cosine) for the points that face `wi` (unit) and see it.
    template <class Lit>
    void forEachLit(Vec3f wi, const Lit& lit) {
        forEachFacing(wi, {}, [&](std::uint32_t i, float cosine, bool visible) {
            if (visible) lit(i, cosine);
        });
    }

    /// Calls facing(i, cosine, visible) for the points that face `wi`; a ray is traced for those of which `views` (one
    /// per point, or none) knows nothing.
    template <class Facing>
    void forEachFacing(Vec3f wi, std::span<const ViewOfLight> views, const Facing& facing) {
        for (std::size_t i = 0; i < count_; ++i) cosines_[i] = nx_[i] * wi.x + ny_[i] * wi.y + nz_[i] * wi.z;
        std::size_t traced = 0;
        for (std::uint32_t i = 0; i < count_; ++i) {
            if (!(cosines_[i] > 0)) continue;
            const ViewOfLight view = !rays_ ? ViewOfLight::open : views.empty() ? ViewOfLight::unknown : views[i];
            if (view != ViewOfLight::unknown) {
                facing(i, cosines_[i], view == ViewOfLight::open);
                continue;
            }
            indices_[traced] = i;
            from_[traced++] = origins_[i];
        }
        if (traced == 0) return;
        rays_->occluded(std::span(from_).first(traced), wi, std::span(blocked_).first(traced));
        for (std::size_t k = 0; k < traced; ++k) facing(indices_[k], cosines_[indices_[k]], blocked_[k] == 0);
    }

private:
    const RayScene* rays_;
    std::size_t count_;
    std::array<float, capacity> nx_, ny_, nz_, cosines_;
    std::array<Vec3f, capacity> origins_, from_;
    std::array<std::uint32_t, capacity> indices_;
    std::array<std::uint8_t, capacity> blocked_;
};

}  // namespace searchlight
