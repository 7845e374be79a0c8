// The directions that stand for all in plane layers: those of neighbouring layers are one another's refractions.
#pragma once

#include <complex>
#include <vector>

#include "transport/exact/ordinate_scattering.h"

namespace searchlight {

/// Plane layers under a beam as discrete directions see them: peaks are set apart, extinction is less by them.
/// Lengths are in mm.
struct OrdinateStack {
    struct Layer {
        double n = 1;
        double sigma_t = 1, sigma_s = 0;  ///< without the peak, 1/mm
        double thickness = 1;             ///< infinity in the last layer
        SmoothPhase phase = {};
        double beam_down = 0, beam_up = 0;  ///< flux of the unscattered beam that enters at the top, at the bottom
        double beam_cosine = 1;  ///< its direction; other than 1 at k = 0 alone, where azimuths do not matter
    };
    double n_above = 1, n_below = 1;
    std::vector<Layer> layers;
};

/// How many directions stand for all. Cosines are those of one hemisphere, azimuths those from 0 to pi.
struct StackCount {
    int escaping = 8;  ///< cosines that no interface reflects totally
    int alone = 4;     ///< more of them where there is no total reflection
    int trapped = 5;   ///< cosines between the critical angles of one interface and the next
    int narrow = 3;    ///< the least of these, however close two indices are
    int azimuths = 12;
    // For the second order alone.
    int second_panel = 24;  ///< cosines of each half of those that no interface reflects totally
    int second_trapped = 10;
    int second_azimuths = 20;
};

/// A range of n sin(angle) within which everything is smooth in t = sqrt(high^2 - (n sin)^2), and its directions.
struct RayPanel {
    double low = 0, high = 1;
    std::size_t first = 0, count = 0;
};

/// Directions of one hemisphere of one layer at a transverse rate; all lists have the same length.
struct LayerRays {
    OrdinateSet set;
    std::vector<double> along, across;     ///< sines times those of the azimuth, along and across the wave
    std::vector<double> F_up, F_down;      ///< reflectances of the interfaces above and below
    std::vector<std::complex<double>> Q;   ///< decay with depth, 1/mm
    std::vector<std::complex<double>> up;  ///< what comes through from the top of the layer to above the slab, straight
    std::vector<std::complex<double>> down;  ///< from its bottom to below the slab

    std::vector<RayPanel> panels;  ///< in ascending order; of stackRays() alone

    std::size_t size() const { return set.mu.size(); }
};

/// Transverse rate 1/mm: light goes as exp(-rate x). Per layer; layers of lower index lack the last directions of
/// those of higher index.
std::vector<LayerRays> stackRays(const OrdinateStack& stack, const StackCount& count, std::complex<double> rate);

/// Many directions of one layer, crowded where what is scattered first and second varies.
LayerRays fineRays(const OrdinateStack& stack, std::size_t layer, const StackCount& count, std::complex<double> rate);

}  // namespace searchlight
