// Light from what the eye sees, gathered by samples of each receiver's tangent plane: docs/surface-sampling.md.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/observer.h"
#include "base/vec.h"
#include "model/profile.h"
#include "render/exitance_sum.h"
#include "render/screen/screen_samples.h"

namespace searchlight {

/// The visible surface as a patch of a plane per pixel, in camera coordinates (as ScreenSamples has them), and who
/// receives. A grid has a border in which nothing is seen.
struct ScreenPatches {
    /// Of a pixel: n / h, h, and the light; the plane is n x = h with h > 0.
    static constexpr std::size_t floats = 8;

    int width = 0, height = 0;
    float focal = 0;
    std::vector<float> cells;                    ///< rows of width + 2, floats each
    std::array<std::vector<float>, 3> position;  ///< of receivers, mm, padded to whole vectors
    std::array<std::vector<float>, 3> normal;    ///< of their triangles, unit, towards the eye
    std::vector<std::uint32_t> source;           ///< place in the VisibleSurface
    std::vector<std::uint32_t> pixel;            ///< y * width + x

    std::size_t cellAt(int x, int y) const {
        return (static_cast<std::size_t>(y + 1) * static_cast<std::size_t>(width + 2) +
                static_cast<std::size_t>(x + 1)) *
               floats;
    }
};

/// All that does not depend on light. What is seen at less than 1/10 in cosine is no patch. `view` made `visible`.
ScreenPatches screenPatches(const View& view, const VisibleSurface& visible, int threads);

/// `light`: flux per mm^2 that crossed into the medium, per sample of visible. A pixel's is that of its widest sample,
/// times the coverage of all.
void setLight(const VisibleSurface& visible, std::span<const Rgbf> light, ScreenPatches& patches);

/// Whether a point, in camera coordinates and with a normal, lies on a patch, from which it then counts.
bool isSeen(const ScreenPatches& patches, Vec3f position, Vec3f normal);

/// What samples are drawn from, and how many.
class TangentSampler {
public:
    /// `tangent` samples per receiver follow the mean of the channels' |R_d| in its tangent plane; `facing` ones are in
    /// the plane that faces the eye: half follow R_d there as well, as a tangent plane that is seen edge on covers next
    /// to nothing of the picture, and half are even over the disc that holds 90 % of it. Channels without R_d are left
    /// out. Requires one that has some.
    TangentSampler(const Profile& profile, int tangent, int facing, std::uint64_t seed);

    /// Exitance per sample of the VisibleSurface: an estimate of the integral over the patches. Does not depend on
    /// `threads`. Throws interruptedError() when cancelled.
    void gather(const ScreenPatches& patches, int threads, const Observer& observer, std::vector<Rgbf>& exitance) const;

    struct Draws {
        std::vector<float> u, cosine, sine;  ///< per sample: a stratified number, and the unit vector of an angle
    };

    /// What the lanes read.
    struct Tables {
        RadialTable Rd, density;    ///< density: of samples by importance, per mm^2, in every channel
        std::vector<float> annuli;  ///< equalAnnuli(density)
        float even_radius = 0;      ///< mm
        Draws tangent, facing, even;
        std::vector<float> noise_u, noise_angle;  ///< tiles of blue noise
    };

private:
    Tables tables_;
};

}  // namespace searchlight
