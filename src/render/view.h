// What the camera sees: pixels to rays, and the surface behind them.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "base/observer.h"
#include "base/vec.h"
#include "geometry/object.h"
#include "geometry/rays.h"
#include "scene/scene.h"

namespace searchlight {

/// A pinhole camera placed in mm. Pixel (0, 0) is at the top left; the image plane is at distance 1.
struct View {
    int width = 0, height = 0;
    Vec3 eye;
    Vec3 right, up, forward;  ///< orthonormal
    double tan_half = 0;      ///< of the vertical field of view

    /// Through the picture's point (x, y) in pixels; not normalised: forward component 1.
    Vec3 direction(double x, double y) const {
        const double pixel = 2 * tan_half / height;
        return forward + (pixel * (x - 0.5 * width)) * right + (pixel * (0.5 * height - y)) * up;
    }
};

/// The camera, with a distance of 0 replaced by the one from which the object fills 70 % of the picture's height, or
/// 84 % of its width where that needs more.
Camera framedCamera(const Camera& camera, const Object& object, int width, int height);

/// The scene's camera around the object, framed.
View makeView(const Camera& camera, const Object& object, int width, int height);

/// The surface samples behind the pixels, listed by tiles of 64 x 64 pixels and in these by blocks of 8 x 8, so that
/// neighbours in the list are neighbours in space. The samples of a pixel follow each other. A pixel has one sample or,
/// with antialiasing at edges, several.
struct VisibleSurface {
    int width = 0, height = 0;
    Vec3 eye;                              ///< mm
    std::vector<std::uint32_t> pixels;     ///< y * width + x, per sample
    std::vector<float> coverage;           ///< of its pixel, per sample; a pixel's add up to at most 1
    std::vector<Vec3f> positions;          ///< mm, on the triangle
    std::vector<Vec3f> normals;            ///< for shading: interpolated, unit, on the geometric normal's side
    std::vector<Vec3f> geometric_normals;  ///< unit, towards the eye
};

struct TraceOptions {
    int edge_samples = 8;  ///< rays through a pixel that an edge crosses; at most 1: none are added
    int threads = 0;       ///< 0: all
};

/// One ray through the centre of each pixel, and `edge_samples` through those where coverage, depth or normal jump to a
/// neighbour: samples of one patch are merged there. `rays` hold object.mesh. Throws interruptedError() when cancelled.
VisibleSurface traceVisible(const View& view, const Object& object, const RayScene& rays, const TraceOptions& options,
                            Observer& observer);

/// Where in a pixel, from its top left corner, the rays through an edge go: `count` of them.
std::vector<std::pair<double, double>> edgePattern(int count);

/// What is hit by rays of a picture, by whatever means it was found.
class PictureHits {
public:
    virtual ~PictureHits() = default;

    /// The first hit of `ray`, which goes through pixel (x, y): its centre where `sample` < 0, else that point of
    /// edgePattern(). A miss has t = infinity. Called from many threads.
    virtual RayHit hit(int x, int y, int sample, const Ray& ray) const = 0;
};

/// traceVisible() with these hits.
VisibleSurface visibleSurface(const View& view, const Object& object, const PictureHits& hits,
                              const TraceOptions& options, Observer& observer);

}  // namespace searchlight
