#include "render/sphere/sphere_reference.h"

#include <algorithm>
#include <limits>

#include "base/error.h"

namespace searchlight {

SphereReference::SphereReference(const Ball& ball, const LightSampler& lights, const Medium& medium, std::uint64_t seed,
                                 int threads)
    : ball_(ball), lights_(lights), medium_(medium), seed_(seed), threads_(threads) {}

void SphereReference::walkTo(std::uint64_t walks, Observer& observer) {
    for (std::size_t c = 0; c < channels_.size(); ++c) {
        if (!medium_.scatters(static_cast<int>(c))) continue;
        BodyOptions options{.walks = walks, .seed = seed_, .threads = threads_};
        options.control.state = &states_[c];
        BodyResult result = walkBody(ball_, medium_, static_cast<int>(c), &lights_, options, observer);
        const bool interrupted = result.interrupted;
        if (result.candidates > 0) channels_[c] = std::move(result);
        if (interrupted) throw interruptedError();
    }
}

std::uint64_t SphereReference::walks() const {
    std::uint64_t fewest = std::numeric_limits<std::uint64_t>::max();
    for (std::size_t c = 0; c < channels_.size(); ++c)
        if (medium_.scatters(static_cast<int>(c)))
            fewest = std::min(fewest, channels_[c] ? channels_[c]->arrivals : std::uint64_t{0});
    return fewest == std::numeric_limits<std::uint64_t>::max() ? 0 : fewest;
}

SphereExitance SphereReference::exitance() const {
    SphereExitance exitance;
    for (std::size_t c = 0; c < channels_.size(); ++c) {
        if (!channels_[c]) continue;
        exitance.mean[c] = channels_[c]->exitance;
        exitance.standard_error[c] = channels_[c]->standard_error;
    }
    return exitance;
}

}  // namespace searchlight
