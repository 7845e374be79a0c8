// Maps of all lights and the filter that reads them, kept while nothing that they are made from changes.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "render/light_view/light_map.h"
#include "render/light_view/ring_filter.h"
#include "render/technique.h"

namespace searchlight {

class LightViewSum {
public:
    /// `profile`: what is summed, of which `profile_version` tells one from another. `samples` per receiver and map,
    /// `resolution` of the maps. `input` stays alive until the next start.
    void start(const RenderInput& input, const Profile& profile, std::uint64_t profile_version, int samples,
               int resolution, Observer& observer);

    /// Adds the light of the next map to the exitance, and after the last that of LightMaps::grazed. True when there is
    /// none left.
    bool step(std::span<Rgbf> exitance, Observer& observer);

    /// Stages "maps" and "filter", and numbers; notes where lights have no view of their own.
    void addTo(TechniqueReport& report) const;

private:
    void addGrazed(std::span<Rgbf> exitance, Observer& observer) const;

    RenderInput input_;
    std::string maps_from_, filter_from_;
    LightMaps maps_;
    std::optional<RingFilter> filter_;
    std::optional<std::uint64_t> receivers_of_;  // the view that they are of
    RingReceivers receivers_;
    std::optional<PointTree> grazed_;
    std::optional<RadialTable> grazed_table_;
    std::optional<ReceiverTree> grazed_receivers_;
    int samples_ = 0;
    std::size_t next_ = 0;
    double maps_ms_ = 0, filter_ms_ = 0;
};

}  // namespace searchlight
