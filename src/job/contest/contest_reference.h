// What a contest judges by: the same model by `direct`, and the light itself by walks.
#pragma once

#include <filesystem>
#include <string>

#include "base/image.h"
#include "job/contest/contest_plan.h"
#include "job/engine.h"
#include "render/view.h"

namespace searchlight {

/// A picture whose noise is known.
struct ReferencePicture {
    Image image;               ///< alpha: coverage by the object; 0 in a pixel that does not count
    Image standard_error;      ///< of each channel; empty: there is no picture
    double noise = 0;          ///< relative RMS of the standard error where the picture counts
    std::uint64_t effort = 0;  ///< passes, or walks per channel
    double seconds = 0;
    std::string absent;  ///< why there is none

    bool empty() const { return image.empty(); }
};

struct ReferenceAims {
    double noise = 0.005;  ///< relative RMS that direct goes on to
    int most_passes = 4096;
    double walks = 4e6;  ///< per channel; 0: none
    std::uint64_t seed = 1;
    int threads = 0;
    bool resume = false;
};

/// The mean of pictures with seeds of their own, drawn until the noise is low enough. Kept in FOLDER/reference.
/// Throws as `render` does.
ReferencePicture directReference(const ContestPlan& plan, const ReferenceAims& aims,
                                 const std::filesystem::path& folder, Engine& engine, Observer& observer);

/// Exitance by walks from the same camera, kept there too; `absent` says why where the body cannot be walked. Pixels
/// that the object does not fill, or whose cells it does not, do not count.
ReferencePicture walkedReference(const ContestPlan& plan, const ReferenceAims& aims, const Camera& camera,
                                 const std::filesystem::path& folder, Engine& engine, Observer& observer);

/// Relative RMS of the standard error over the pixels that count.
double relativeNoise(const Image& image, const Image& standard_error);

}  // namespace searchlight
