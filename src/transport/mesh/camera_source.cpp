#include "transport/mesh/camera_source.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "transport/mesh/closed_body.h"
#include "transport/walk/fresnel.h"

namespace searchlight {

template <class Body>
CameraSource<Body>::CameraSource(const Body& body, const CameraRays& rays, const Illumination& light, int channel,
                                 double eta, std::uint64_t first, std::uint64_t count, SplitMix64 random)
    : body_(body),
      rays_(rays),
      light_(light),
      channel_(channel),
      eta_(eta),
      next_(first),
      end_(first + count),
      random_(random) {}

template <class Body>
bool CameraSource<Body>::next(Entry& entry) {
    while (next_ < end_) {
        const std::uint64_t pixel = next_++ % rays_.pixels();
        const auto width = static_cast<std::uint64_t>(rays_.width);
        const double x = static_cast<double>(pixel % width) + random_.uniform();
        const double y = static_cast<double>(pixel / width) + random_.uniform();
        const Vec3 direction = normalize(rays_.corner + x * rays_.right + y * rays_.down);
        const std::optional<SurfacePoint> point = body_.seen(rays_.eye, direction);
        if (!point) continue;
        const double c = -dot(direction, point->normal), sine2 = (1 - c) * (1 + c) / (eta_ * eta_);
        if (!(c > 0) || (eta_ != 1 && sine2 >= 1)) continue;
        const double t = eta_ == 1 ? c : std::sqrt(1 - sine2);
        entry.position = body_.below(*point);
        entry.direction = toFloat(normalize((1 / eta_) * direction + (c / eta_ - t) * point->normal));
        entry.weight = static_cast<float>(eta_ == 1 ? 1 : 1 - fresnelReflectance(1, c, eta_, t));
        entry.tag = static_cast<std::uint32_t>(pixel);
        return true;
    }
    return false;
}

// Radiance over the square of the index is kept by refraction, in and out: its factors cancel.
template <class Body>
double CameraSource<Body>::radianceBeyond(Vec3 direction, const Crossing& crossing, bool wide_only) const {
    if (std::holds_alternative<UniformLight>(light_)) return 1;
    const double c = std::clamp(dot(direction, crossing.normal), 0.0, 1.0);
    const double outside = std::sqrt(std::max(0.0, 1 - eta_ * eta_ * (1 - c) * (1 + c)));
    const Vec3 wo = normalize(eta_ * direction + (outside - eta_ * c) * crossing.normal);
    const Vec3 position = toDouble(crossing.position);
    const double radiance = std::get<const LightSampler*>(light_)->radiance(position, wo, wide_only)[channel_];
    if (radiance == 0 || body_.occluded({position, crossing.normal}, wo, std::numeric_limits<double>::infinity()))
        return 0;
    return radiance;
}

template <class Body>
void CameraSource<Body>::leave(std::uint32_t tag, float weight, Vec3 direction, const Crossing& crossing,
                               std::vector<CellExit>& exits) {
    const double radiance = radianceBeyond(direction, crossing, false);
    if (radiance > 0) exits.push_back({tag, static_cast<float>(radiance * static_cast<double>(weight))});
}

template class CameraSource<Ball>;
template class CameraSource<MeshBody>;

}  // namespace searchlight
