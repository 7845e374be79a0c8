// A picture all around the scene, as light: what comes from where, and which directions are worth asking.
#pragma once

#include <memory>
#include <string>

#include "base/image.h"
#include "base/vec.h"
#include "scene/scene.h"

namespace searchlight {

struct EnvironmentSample {
    Vec3 wi;         ///< towards the light, unit
    Rgb radiance;    ///< from there, intensity included
    double pdf = 0;  ///< per solid angle; 0: the environment is black everywhere
};

/// Radiance by direction. Immutable; all queries may run on many threads at once.
///
/// The centre of a latitude-longitude picture is what is seen looking along -z; its left and right edges meet at +z,
/// its right half shows +x, its top row +y. `rotation_deg` turns the surroundings about +y, from +z towards +x.
class Environment {
public:
    /// Opens the picture. Throws what readImage() and latitudeLongitude() throw.
    explicit Environment(const EnvironmentLight& light);
    /// The same with a picture in memory; `name` is what errors call it.
    Environment(Image picture, const EnvironmentLight& light, const std::string& name);
    ~Environment();
    Environment(Environment&&) noexcept;
    Environment& operator=(Environment&&) noexcept;

    /// Bilinear between pixel centres, seamless at the sides. `direction` need not be unit.
    Rgb radiance(Vec3 direction) const;

    /// A direction by importance (luminance) for two uniform numbers in [0, 1); stratified numbers give stratified
    /// directions. radiance / pdf is an unbiased estimate of totalRadiance().
    EnvironmentSample sample(double u, double v) const;

    /// Of sample(), per solid angle. `direction` need not be unit.
    double pdf(Vec3 direction) const;

    /// Integral of radiance over all directions; intensity included.
    Rgb totalRadiance() const;

    /// As latitude-longitude, before intensity and rotation.
    const Image& picture() const;

    /// Where in picture() a direction is: x from the left and y from the top, both in [0, 1].
    Vec2f pictureAt(Vec3 direction) const;

    Rgb intensity() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace searchlight
