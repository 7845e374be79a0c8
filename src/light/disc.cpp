#include "light/disc.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace searchlight {

namespace {

constexpr double pi = std::numbers::pi;

}  // namespace

Disc::Disc(const DirectionalLight& light) : centre_(normalize(light.direction)) {
    // 2 sin^2 of half the radius: 1 - cos would lose the digits of a small disc.
    versine_ = 2 * std::pow(std::sin(0.25 * light.angle_deg * pi / 180), 2);
    // An orthonormal basis around the centre [Duff2017].
    const Vec3 n = centre_;
    const double sign = std::copysign(1.0, n.z);
    const double a = -1 / (sign + n.z), b = n.x * n.y * a;
    tangent_ = {1 + sign * n.x * n.x * a, sign * b, -sign * n.x};
    bitangent_ = {b, sign + n.y * n.y * a, -n.y};
}

Vec3 Disc::sample(double u, double v) const {
    const double below = u * versine_;
    const double sine = std::sqrt(std::max(0.0, below * (2 - below)));
    return (1 - below) * centre_ + (sine * std::cos(2 * pi * v)) * tangent_ +
           (sine * std::sin(2 * pi * v)) * bitangent_;
}

double Disc::solidAngle() const { return 2 * pi * versine_; }

bool Disc::holds(Vec3 direction) const {
    const Vec3 across = direction - centre_;  // its square is 2 (1 - cos)
    return 0.5 * dot(across, across) < versine_;
}

double Disc::weight() const {
    // The solid angle over the integral of the cosine, pi sin^2 = pi versine (2 - versine).
    return 2 / (2 - versine_);
}

}  // namespace searchlight
