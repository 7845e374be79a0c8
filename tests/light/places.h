// Objects and pictures that the tests of light share.
#pragma once

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "geometry/object.h"
#include "geometry/rays.h"
#include "geometry/surface_points.h"
#include "io/image_file.h"
#include "light/irradiance.h"

namespace searchlight::test {

/// An object in its place, with points on it.
struct Place {
    explicit Place(Object object_, std::size_t count = 4000)
        : object(std::move(object_)), rays(object.mesh), cloud(samplePoints(object.mesh, {.count = count}, observer)) {}

    Irradiance irradiance(const Scene& scene, const IrradianceOptions& options = {}, bool shadows = true) {
        return computeIrradiance(SurfacePoints{cloud.positions, cloud.normals}, scene, object,
                                 shadows ? &rays : nullptr, options, observer);
    }

    Observer observer;
    Object object;
    RayScene rays;
    PointCloud cloud;
};

inline Object placed(Mesh mesh) {
    Object object;
    Vec3 low = toDouble(mesh.positions.front()), high = low;
    for (const Vec3f& p : mesh.positions) {
        low = {std::min<double>(low.x, p.x), std::min<double>(low.y, p.y), std::min<double>(low.z, p.z)};
        high = {std::max<double>(high.x, p.x), std::max<double>(high.y, p.y), std::max<double>(high.z, p.z)};
    }
    const Vec3 centre = 0.5 * (low + high);
    for (Vec3f& p : mesh.positions) p = toFloat(toDouble(p) - centre);
    object.half_extent = 0.5 * (high - low);
    object.longest_mm = 2 * std::max({object.half_extent.x, object.half_extent.y, object.half_extent.z});
    object.mesh = std::move(mesh);
    return object;
}

/// The built-in sphere, 10 mm across; each step of `detail` doubles its resolution.
inline Object sphere(int detail = 0) {
    Mesh mesh = builtInObject("sphere", detail);
    double radius = 0;
    for (const Vec3f& p : mesh.positions) radius = std::max(radius, length(toDouble(p)));
    for (Vec3f& p : mesh.positions) p = toFloat((5 / radius) * toDouble(p));
    return placed(std::move(mesh));
}

inline Scene litBy(std::vector<Light> lights) {
    Scene scene;
    scene.lights = std::move(lights);
    return scene;
}

/// A file of that picture, in a folder that goes with this object.
class PictureFile {
public:
    PictureFile(const std::string& name, const Image& picture)
        : path_(std::filesystem::temp_directory_path() / ("searchlight_" + std::to_string(::getpid()) + "_" + name)) {
        ImageFile file;
        file.image = picture;
        writeImage(path_.string(), file);
    }
    ~PictureFile() { std::filesystem::remove(path_); }
    PictureFile(const PictureFile&) = delete;
    PictureFile& operator=(const PictureFile&) = delete;

    std::string path() const { return path_.string(); }

private:
    std::filesystem::path path_;
};

/// Black, with one pixel.
inline Image brightPixel(int width, int height, int x, int y, Rgba value = {1, 1, 1, 1}) {
    Image picture(width, height, {0, 0, 0, 1});
    picture.at(x, y) = value;
    return picture;
}

/// pi 4 C_phi(1/eta) at eta 1.3, docs/conventions.md: the integral of T12 cos over the hemisphere.
inline constexpr double crossed_of_uniform_sky = 2.94954;

}  // namespace searchlight::test
