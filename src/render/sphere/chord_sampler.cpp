#include "render/sphere/chord_sampler.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "render/sphere/directions.h"

namespace searchlight {

namespace {

// Where a model changes its sign both sides matter.
Profile withoutSign(const Profile& profile) {
    std::vector<double> radii(profile.radii().begin(), profile.radii().end());
    std::vector<Rgb> values(profile.values().begin(), profile.values().end());
    for (Rgb& value : values) value = {std::abs(value.r), std::abs(value.g), std::abs(value.b)};
    return {std::move(radii), std::move(values)};
}

}  // namespace

ChordSampler::ChordSampler(const Profile& profile, const Medium& medium, double radius_mm)
    : profile_(withoutSign(profile)), radius_mm_(radius_mm) {
    within_ = profile_.encircled(2 * radius_mm);
    total_ = profile_.total();
    nearest_ = profile_.encircled(std::min(profile_.radii().front(), 2 * radius_mm));
    for (int c = 0; c < Rgb::channels; ++c)
        if (medium.scatters(c) && within_[c] > 0) channels_[channel_count_++] = c;
}

Vec3 ChordSampler::sample(Vec3 from, double u_channel, double u, double v) const {
    const int c = channels_[std::min(static_cast<int>(u_channel * channel_count_), channel_count_ - 1)];
    const double flux = u * within_[c], first = profile_.radii().front();
    // Below its first radius a profile is constant, but one that starts above 0 goes as 1/r there: even steps in r.
    const double r = flux < nearest_[c] ? std::min(first, 2 * radius_mm_) * flux / nearest_[c]
                                        : std::min(profile_.sampleRadius(flux / total_[c], c), 2 * radius_mm_);
    // The chord r spans an angle whose cosine is 1 - r^2 / 2R^2.
    const double ratio = r / radius_mm_, cosine = 1 - 0.5 * ratio * ratio;
    return directionAround(from, cosine, 2 * std::numbers::pi * v);
}

double ChordSampler::density(double r_mm) const {
    if (channel_count_ == 0) return 0;
    const double first = profile_.radii().front();
    const Rgb value = profile_(r_mm);
    double sum = 0;
    for (int i = 0; i < channel_count_; ++i) {
        const int c = channels_[i];
        sum += r_mm < first ? nearest_[c] / (2 * std::numbers::pi * std::max(r_mm, 1e-300) * first * within_[c])
                            : value[c] / within_[c];
    }
    return sum / channel_count_;
}

}  // namespace searchlight
