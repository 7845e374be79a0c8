#include "render/ggx.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "model/physics.h"

namespace searchlight {

namespace {

constexpr double pi = std::numbers::pi;

// Density of facets with that normal per solid angle; by the tangent, since 1 - cos^2 loses a narrow peak's digits.
double distribution(double alpha, Vec3 h) {
    if (h.z <= 0) return 0;
    const double cos2 = h.z * h.z, slope2 = (h.x * h.x + h.y * h.y) / (cos2 * alpha * alpha);
    return 1 / (pi * alpha * alpha * cos2 * cos2 * (1 + slope2) * (1 + slope2));
}

// Smith's Lambda, [Heitz2014] Eq. 72.
double smithLambda(double alpha, Vec3 w) {
    const double slope2 = (w.x * w.x + w.y * w.y) / (w.z * w.z);
    return (std::sqrt(1 + alpha * alpha * slope2) - 1) / 2;
}

}  // namespace

double ggxFresnel(const Ggx& ggx, double cosine) {
    return ggx.reflects_all ? 1 : Physics<double>::fresnelReflectance(cosine, 1 / ggx.eta);
}

double ggxValue(const Ggx& ggx, Vec3 wi, Vec3 wo) {
    if (wi.z <= 0 || wo.z <= 0) return 0;
    const Vec3 h = normalize(wi + wo);
    const double masking = 1 / (1 + smithLambda(ggx.alpha, wi) + smithLambda(ggx.alpha, wo));
    return ggxFresnel(ggx, std::min(1.0, dot(h, wo))) * distribution(ggx.alpha, h) * masking / (4 * wi.z * wo.z);
}

Vec3 ggxSample(const Ggx& ggx, Vec3 wo, double u, double v) {
    // Stretched so that the facets lie on a hemisphere, whose projection towards wo is sampled [Heitz2018].
    const Vec3 stretched = normalize({ggx.alpha * wo.x, ggx.alpha * wo.y, wo.z});
    const double across = std::hypot(stretched.x, stretched.y);
    const Vec3 t1 = across > 0 ? Vec3{-stretched.y / across, stretched.x / across, 0} : Vec3{1, 0, 0};
    const Vec3 t2 = cross(stretched, t1);
    const double radius = std::sqrt(u), angle = 2 * pi * v;
    const double p1 = radius * std::cos(angle), s = (1 + stretched.z) / 2;
    const double p2 = (1 - s) * std::sqrt(std::max(0.0, 1 - p1 * p1)) + s * radius * std::sin(angle);
    const Vec3 on_hemisphere = p1 * t1 + p2 * t2 + std::sqrt(std::max(0.0, 1 - p1 * p1 - p2 * p2)) * stretched;
    const Vec3 h =
        normalize({ggx.alpha * on_hemisphere.x, ggx.alpha * on_hemisphere.y, std::max(1e-12, on_hemisphere.z)});
    return (2 * dot(h, wo)) * h - wo;
}

double ggxPdf(const Ggx& ggx, Vec3 wi, Vec3 wo) {
    if (wi.z <= 0 || wo.z <= 0) return 0;
    const Vec3 h = normalize(wi + wo);
    return distribution(ggx.alpha, h) / (4 * wo.z * (1 + smithLambda(ggx.alpha, wo)));
}

}  // namespace searchlight
