#include "render/direct/probes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace searchlight {

namespace {

// [King2013]: half of the lines along the normal, where the surface mostly lies; the others find what stands upright.
constexpr std::array<double, 3> share{0.5, 0.25, 0.25};

// Where a model changes its sign both sides matter.
Profile withoutSign(const Profile& profile) {
    std::vector<double> radii(profile.radii().begin(), profile.radii().end());
    std::vector<Rgb> values(profile.values().begin(), profile.values().end());
    for (Rgb& value : values) value = {std::abs(value.r), std::abs(value.g), std::abs(value.b)};
    return {std::move(radii), std::move(values)};
}

// u in [0, 1) falls into one of `count` even parts, and is uniform there again.
int part(double& u, int count) {
    const int which = std::min(static_cast<int>(u * count), count - 1);
    u = std::clamp(u * count - which, 0.0, 1 - 0x1p-53);
    return which;
}

}  // namespace

ProbeFrame::ProbeFrame(Vec3 normal) {
    const Vec3 other = std::abs(normal.x) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    const Vec3 across = normalize(cross(normal, other));
    axes = {normal, across, cross(normal, across)};
}

Probes::Probes(const Profile& profile, const Medium& medium)
    : profile_(withoutSign(profile)), total_(profile_.total()) {
    for (int c = 0; c < Rgb::channels; ++c)
        if (medium.scatters(c) && total_[c] > 0) channels_[static_cast<std::size_t>(channel_count_++)] = c;
}

double Probes::disc(double r_mm) const {
    const Rgb value = profile_(r_mm);
    double sum = 0;
    for (int i = 0; i < channel_count_; ++i) {
        const int c = channels_[static_cast<std::size_t>(i)];
        sum += value[c] / total_[c];
    }
    return sum / std::max(channel_count_, 1);
}

Ray Probes::sample(Vec3 from, const ProbeFrame& frame, double u, double v) const {
    const int quarter = part(v, 4);
    const std::size_t k = quarter < 2 ? 0 : static_cast<std::size_t>(quarter - 1);
    if (quarter < 2) v = 0.5 * (quarter + v);
    const int channel = channels_[static_cast<std::size_t>(part(u, channel_count_))];
    const double r = std::min(profile_.sampleRadius(u, channel), reach());
    const double angle = 2 * std::numbers::pi * v, half = std::sqrt(std::max(0.0, reach() * reach() - r * r));
    const Vec3 axis = frame.axes[k];
    const Vec3 start = from + (r * std::cos(angle)) * frame.axes[(k + 1) % 3] +
                       (r * std::sin(angle)) * frame.axes[(k + 2) % 3] + half * axis;
    return {.origin = toFloat(start), .direction = toFloat(-1 * axis), .t_max = static_cast<float>(2 * half)};
}

double Probes::density(Vec3 offset, Vec3 normal, const ProbeFrame& frame) const {
    const double square = dot(offset, offset);
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const double along = dot(offset, frame.axes[k]);
        const double cosine = std::abs(dot(normal, frame.axes[k]));
        sum += share[k] * cosine * disc(std::sqrt(std::max(0.0, square - along * along)));
    }
    return sum;
}

}  // namespace searchlight
