#include "transport/slab/slab_lead.h"

#include <algorithm>
#include <cmath>

namespace searchlight {

namespace {

// A weight grows by no more than 1 / (1 - rate) from flight to flight; floats hold exp of the other.
constexpr double kMostRate = 0.9, kMostExponent = 60;
constexpr double kRowsPerExponent = 8, kMostRows = 400;

}  // namespace

SlabLead leadThrough(const SlabWalk& walk) {
    std::vector<double> rates;
    double exponent = 0;
    for (const SlabWalk::Layer& layer : walk.layers) {
        rates.push_back(std::min(kMostRate, decayPerMfp(layer)));
        exponent += rates.back() * layer.thickness_mm / layer.mfp_mm;
    }
    const double least = std::min(1.0, kMostExponent / exponent);
    SlabLead lead;
    double above = 0;
    for (std::size_t i = 0; i < walk.layers.size(); ++i) {
        const SlabWalk::Layer& layer = walk.layers[i];
        const double rate = least * rates[i], depth = rate * layer.thickness_mm / layer.mfp_mm;
        lead.rate.push_back(static_cast<float>(rate));
        SlabImportance::Layer& rows = lead.importance.layers.emplace_back();
        rows.first_row = static_cast<std::int32_t>(lead.importance.value.size()) / SlabImportance::kColumns;
        rows.rows = static_cast<std::int32_t>(std::clamp(kRowsPerExponent * depth, 1.0, kMostRows));
        rows.rows_per_mm = layer.thickness_mm > 0 ? static_cast<float>(rows.rows / layer.thickness_mm) : 0;
        for (int row = 0; row < rows.rows; ++row)
            lead.importance.value.insert(lead.importance.value.end(), SlabImportance::kColumns,
                                         static_cast<float>(std::exp(above + depth * (row + 0.5) / rows.rows)));
        above += depth;
    }
    return lead;
}

}  // namespace searchlight
