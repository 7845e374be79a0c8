#include "render/background.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "base/error.h"
#include "base/parallel.h"
#include "light/environment.h"
#include "light/irradiance.h"

namespace searchlight {

namespace {

// Irradiance from an environment is smooth: one point for a square of this many pixels.
constexpr int coarse = 8;
constexpr int environment_samples = 1024;
// Rows of rays by which a pixel at the horizon is divided.
constexpr int horizon_rows = 8;

class Painter {
public:
    Painter(const View& view, const Scene& scene, const Object& object, const RayScene* rays,
            const BackgroundOptions& options, Observer& observer)
        : view_(view), scene_(scene), object_(object), rays_(rays), options_(options), observer_(observer) {}

    Image run(const VisibleSurface& visible) {
        const bool surrounded = std::ranges::any_of(
            scene_.lights, [](const Light& light) { return std::holds_alternative<EnvironmentLight>(light); });
        if (!scene_.ground && !scene_.backdrop && !surrounded) return {};
        image_ = Image(view_.width, view_.height);
        open_.assign(image_.pixels.size(), 1);
        for (std::size_t i = 0; i < visible.pixels.size(); ++i) open_[visible.pixels[i]] -= visible.coverage[i];
        fillSky();
        if (scene_.ground) fillGround();
        return std::move(image_);
    }

private:
    bool isOpen(std::size_t pixel) const { return open_[pixel] > 1e-4f; }
    std::size_t index(int x, int y) const { return static_cast<std::size_t>(y) * view_.width + x; }

    void fillSky() {
        if (scene_.backdrop) {
            const Rgbf colour = toFloat(*scene_.backdrop);
            for (std::size_t i = 0; i < open_.size(); ++i)
                if (isOpen(i)) image_.pixels[i] = {colour.r, colour.g, colour.b, 1};
            return;
        }
        for (const Light& light : scene_.lights)
            if (const auto* environment = std::get_if<EnvironmentLight>(&light))
                addEnvironment(Environment(*environment));
    }

    void addEnvironment(const Environment& environment) {
        parallelFor(static_cast<std::size_t>(view_.height), options_.threads, [&](std::size_t row) {
            const int y = static_cast<int>(row);
            for (int x = 0; x < view_.width; ++x) {
                if (!isOpen(index(x, y))) continue;
                const Rgbf radiance = toFloat(environment.radiance(view_.direction(x + 0.5, y + 0.5)));
                Rgba& pixel = image_.at(x, y);
                pixel = {pixel.r + radiance.r, pixel.g + radiance.g, pixel.b + radiance.b, 1};
            }
        });
    }

    // Where the ray through (x, y) meets the ground, in front of the eye and from above.
    std::optional<Vec3> groundAt(double x, double y) const {
        const Vec3 direction = view_.direction(x, y);
        const double height = scene_.ground->height * object_.longest_mm - object_.half_extent.y;
        if (view_.eye.y <= height || direction.y >= 0) return std::nullopt;
        return view_.eye + ((height - view_.eye.y) / direction.y) * direction;
    }

    std::vector<Rgbf> irradianceAt(const std::vector<Vec3f>& positions, bool environments) const {
        Scene lights = scene_;
        std::erase_if(lights.lights, [&](const Light& light) {
            return std::holds_alternative<EnvironmentLight>(light) != environments;
        });
        if (positions.empty() || lights.lights.empty()) return std::vector<Rgbf>(positions.size());
        for (Light& light : lights.lights)
            if (auto* environment = std::get_if<EnvironmentLight>(&light)) environment->occlusion = rays_ != nullptr;
        const std::vector<Vec3f> up(positions.size(), Vec3f{0, 1, 0});
        // With matched indices all light crosses: what comes back is irradiance.
        const IrradianceOptions matched{
            .eta = 1, .light_samples = environment_samples, .seed = options_.seed, .threads = options_.threads};
        return computeIrradiance({positions, up}, lights, object_, rays_, matched, observer_).transmitted;
    }

    void fillGround() {
        std::vector<std::size_t> pixels;
        std::vector<Vec3f> positions;
        std::vector<float> shares;  // of the pixel, below the horizon
        for (int y = 0; y < view_.height; ++y)
            for (int x = 0; x < view_.width; ++x) {
                if (!isOpen(index(x, y))) continue;
                std::optional<Vec3> lowest;
                int rows = 0;
                for (int k = 0; k < horizon_rows; ++k)
                    if (const auto hit = groundAt(x + 0.5, y + (k + 0.5) / horizon_rows)) {
                        lowest = hit;
                        ++rows;
                    }
                if (!lowest) continue;
                pixels.push_back(index(x, y));
                positions.push_back(toFloat(groundAt(x + 0.5, y + 0.5).value_or(*lowest)));
                shares.push_back(static_cast<float>(rows) / horizon_rows);
            }
        const std::vector<Rgbf> direct = irradianceAt(positions, false);
        const Image around = environmentIrradiance();
        const Rgb reflectance = (1 / std::numbers::pi) * scene_.ground->albedo;
        for (std::size_t i = 0; i < pixels.size(); ++i) {
            const Rgba& coarse_value = around.pixels[pixels[i]];
            const Rgb irradiance = toDouble(direct[i]) + Rgb{coarse_value.r, coarse_value.g, coarse_value.b};
            const Rgbf radiance = toFloat(reflectance * irradiance);
            Rgba& pixel = image_.pixels[pixels[i]];
            const float a = shares[i], rest = 1 - a;
            pixel = {a * radiance.r + rest * pixel.r, a * radiance.g + rest * pixel.g, a * radiance.b + rest * pixel.b,
                     a + rest * pixel.a};
        }
    }

    // At the corners of squares of pixels, interpolated between them.
    Image environmentIrradiance() const {
        Image image(view_.width, view_.height);
        const bool any = std::ranges::any_of(
            scene_.lights, [](const Light& light) { return std::holds_alternative<EnvironmentLight>(light); });
        if (!any) return image;
        const int columns = view_.width / coarse + 2, rows = view_.height / coarse + 2;
        std::vector<std::size_t> nodes;
        std::vector<Vec3f> positions;
        for (int j = 0; j < rows; ++j)
            for (int i = 0; i < columns; ++i)
                if (const auto hit = groundAt(i * coarse, j * coarse)) {
                    nodes.push_back(static_cast<std::size_t>(j) * columns + i);
                    positions.push_back(toFloat(*hit));
                }
        const std::vector<Rgbf> values = irradianceAt(positions, true);
        std::vector<Rgba> grid(static_cast<std::size_t>(columns) * rows, Rgba{0, 0, 0, 0});
        for (std::size_t k = 0; k < nodes.size(); ++k) grid[nodes[k]] = {values[k].r, values[k].g, values[k].b, 1};
        for (int y = 0; y < view_.height; ++y)
            for (int x = 0; x < view_.width; ++x) {
                const double u = (x + 0.5) / coarse, v = (y + 0.5) / coarse;
                const int i = static_cast<int>(u), j = static_cast<int>(v);
                Rgb sum;
                double weights = 0;
                for (int corner = 0; corner < 4; ++corner) {
                    const int di = corner & 1, dj = corner >> 1;
                    const Rgba& node = grid[static_cast<std::size_t>(j + dj) * columns + i + di];
                    const double weight = node.a * std::abs(1 - di - (u - i)) * std::abs(1 - dj - (v - j));
                    sum = sum + weight * Rgb{node.r, node.g, node.b};
                    weights += weight;
                }
                if (weights <= 0) continue;
                const Rgbf mean = toFloat((1 / weights) * sum);
                image.at(x, y) = {mean.r, mean.g, mean.b, 1};
            }
        return image;
    }

    const View& view_;
    const Scene& scene_;
    const Object& object_;
    const RayScene* rays_;
    BackgroundOptions options_;
    Observer& observer_;
    Image image_;
    std::vector<float> open_;  // fraction of the pixel that the object leaves free
};

}  // namespace

Image paintBackground(const View& view, const Scene& scene, const Object& object, const RayScene* rays,
                      const VisibleSurface& visible, const BackgroundOptions& options, Observer& observer) {
    return Painter(view, scene, object, rays, options, observer).run(visible);
}

}  // namespace searchlight
