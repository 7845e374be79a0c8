#include "validate/flip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "base/parallel.h"
#include "base/vec.h"

namespace searchlight {

namespace {

using Kernel = std::vector<float>;
constexpr double pi = std::numbers::pi;

// The white of linear Rec. 709: D65, as the sums of the rows below.
constexpr Vec3 white{0.950428545, 1, 1.088900371};

Vec3 xyzFromLinear(Vec3 c) {
    return {(10135552 * c.x + 8788810 * c.y + 4435075 * c.z) / 24577794,
            (2613072 * c.x + 8788810 * c.y + 887015 * c.z) / 12288897,
            (1425312 * c.x + 8788810 * c.y + 70074185 * c.z) / 73733382};
}

Vec3 linearFromXyz(Vec3 c) {
    return {3.241003275 * c.x - 1.537398934 * c.y - 0.498615861 * c.z,
            -0.969224334 * c.x + 1.875930071 * c.y + 0.041554224 * c.z,
            0.055639423 * c.x - 0.204011202 * c.y + 1.057148933 * c.z};
}

Vec3 opponentFromLinear(Vec3 c) {  // YCxCz
    const Vec3 xyz = xyzFromLinear(c);
    const Vec3 n{xyz.x / white.x, xyz.y / white.y, xyz.z / white.z};
    return {116 * n.y - 16, 500 * (n.x - n.y), 200 * (n.y - n.z)};
}

Vec3 linearFromOpponent(Vec3 c) {
    const double y = (c.x + 16) / 116;
    return linearFromXyz({(y + c.y / 500) * white.x, y * white.y, (y - c.z / 200) * white.z});
}

// CIELAB with a and b weakened in the dark: the Hunt effect, [Andersson2020] Sec. 4.1.2.
Vec3 huntLab(Vec3 linear) {
    const auto root = [](double t) {
        constexpr double delta = 6. / 29;
        return t > delta * delta * delta ? std::cbrt(t) : t / (3 * delta * delta) + 4. / 29;
    };
    const Vec3 xyz = xyzFromLinear(linear);
    const double x = root(xyz.x / white.x), y = root(xyz.y / white.y), z = root(xyz.z / white.z);
    const double lightness = 116 * y - 16;
    return {lightness, 0.01 * lightness * 500 * (x - y), 0.01 * lightness * 200 * (y - z)};
}

// City block in lightness, Euclidean in chroma [Abasi2020].
double hyab(Vec3 a, Vec3 b) { return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z); }

constexpr double colour_power = 0.7;  // q_c

// The largest colour difference there is goes to 1; below 0.4 of it (p_c) 95 % of the range (p_t) are spent.
double redistributed(double difference) {
    static const double largest = std::pow(hyab(huntLab({0, 1, 0}), huntLab({0, 0, 1})), colour_power);
    const double knee = 0.4 * largest;
    return difference < knee ? 0.95 / knee * difference : 0.95 + (difference - knee) / (largest - knee) * 0.05;
}

// The contrast sensitivity of one opponent channel as Gaussians in space, a sqrt(pi/b) exp(-pi^2 x^2 / b), x in
// degrees: [Andersson2020] Tab. 1.
struct Sensitivity {
    double a, b;
};
constexpr Sensitivity black_white{1, 0.0047}, red_green{1, 0.0053};
constexpr std::array<Sensitivity, 2> blue_yellow{{{34.1, 0.04}, {13.5, 0.025}}};

// One axis of such a Gaussian; the product of two axes has the amplitude a sqrt(pi/b).
Kernel axisOf(const Sensitivity& s, double pixels_per_degree) {
    const int radius = static_cast<int>(std::ceil(3 * std::sqrt(blue_yellow[0].b / (2 * pi * pi)) * pixels_per_degree));
    Kernel kernel;
    for (int i = -radius; i <= radius; ++i) {
        const double x = i / pixels_per_degree;
        kernel.push_back(static_cast<float>(std::sqrt(s.a * std::sqrt(pi / s.b)) * std::exp(-pi * pi * x * x / s.b)));
    }
    return kernel;
}

double sum(const Kernel& kernel) {
    double total = 0;
    for (const float weight : kernel) total += weight;
    return total;
}

void scale(Kernel& kernel, double factor) {
    for (float& weight : kernel) weight = static_cast<float>(weight * factor);
}

class FlipFilters {
public:
    FlipFilters(double pixels_per_degree, int threads)
        : threads_(threads),
          luminance_(axisOf(black_white, pixels_per_degree)),
          red_green_(axisOf(red_green, pixels_per_degree)) {
        scale(luminance_, 1 / sum(luminance_));
        scale(red_green_, 1 / sum(red_green_));
        double total = 0;
        for (std::size_t i = 0; i < 2; ++i) {
            blue_yellow_[i] = axisOf(blue_yellow[i], pixels_per_degree);
            total += sum(blue_yellow_[i]) * sum(blue_yellow_[i]);
        }
        for (Kernel& kernel : blue_yellow_) scale(kernel, 1 / std::sqrt(total));
        makeFeatureKernels(pixels_per_degree);
    }

    /// The picture as seen from the distance, in Hunt-adjusted CIELAB.
    std::vector<Vec3f> seen(const std::array<PixelPlane, 3>& opponent) const {
        const PixelPlane y = filtered(opponent[0], luminance_, luminance_, threads_);
        const PixelPlane cx = filtered(opponent[1], red_green_, red_green_, threads_);
        const PixelPlane wide = filtered(opponent[2], blue_yellow_[0], blue_yellow_[0], threads_);
        const PixelPlane narrow = filtered(opponent[2], blue_yellow_[1], blue_yellow_[1], threads_);
        std::vector<Vec3f> lab(y.values.size());
        forPixels(lab.size(), [&](std::size_t i) {
            const Vec3 c = linearFromOpponent({y.values[i], cx.values[i], wide.values[i] + narrow.values[i]});
            lab[i] = toFloat(huntLab({std::clamp(c.x, 0., 1.), std::clamp(c.y, 0., 1.), std::clamp(c.z, 0., 1.)}));
        });
        return lab;
    }

    /// How much of an edge and of a point is at each pixel.
    std::vector<Vec2f> features(const PixelPlane& luminance) const {
        const PixelPlane edge_x = filtered(luminance, edge_, smooth_, threads_);
        const PixelPlane edge_y = filtered(luminance, smooth_, edge_, threads_);
        const PixelPlane point_x = filtered(luminance, point_, smooth_, threads_);
        const PixelPlane point_y = filtered(luminance, smooth_, point_, threads_);
        std::vector<Vec2f> found(luminance.values.size());
        // Lightness is a fraction here: Y of YCxCz over 116, whose offset the kernels' zero sums take away.
        for (std::size_t i = 0; i < found.size(); ++i)
            found[i] = {std::hypot(edge_x.values[i], edge_y.values[i]) / 116,
                        std::hypot(point_x.values[i], point_y.values[i]) / 116};
        return found;
    }

    void forPixels(std::size_t count, const std::function<void(std::size_t)>& body) const {
        constexpr std::size_t piece = 4096;
        parallelFor((count + piece - 1) / piece, threads_, [&](std::size_t chunk) {
            for (std::size_t i = chunk * piece; i < std::min(count, (chunk + 1) * piece); ++i) body(i);
        });
    }

private:
    // First and second derivatives of a Gaussian as wide as an edge is seen, 0.082 degrees: positive and negative
    // weights sum to 1 and -1, [Andersson2020] Sec. 4.2.
    void makeFeatureKernels(double pixels_per_degree) {
        const double sigma = 0.5 * 0.082 * pixels_per_degree;
        const int radius = static_cast<int>(std::ceil(3 * sigma));
        for (int x = -radius; x <= radius; ++x) {
            const double gauss = std::exp(-x * x / (2 * sigma * sigma));
            smooth_.push_back(static_cast<float>(gauss));
            edge_.push_back(static_cast<float>(-x * gauss));
            point_.push_back(static_cast<float>((x * x / (sigma * sigma) - 1) * gauss));
        }
        scale(smooth_, 1 / sum(smooth_));
        for (Kernel* kernel : {&edge_, &point_}) {
            double positive = 0, negative = 0;
            for (const float weight : *kernel) (weight > 0 ? positive : negative) += std::abs(weight);
            for (float& weight : *kernel) weight = static_cast<float>(weight / (weight > 0 ? positive : negative));
        }
    }

    int threads_;
    Kernel luminance_, red_green_;
    std::array<Kernel, 2> blue_yellow_;
    Kernel smooth_, edge_, point_;
};

std::array<PixelPlane, 3> opponentPlanes(const Image& image, double factor, const FlipFilters& filters) {
    std::array<PixelPlane, 3> planes{PixelPlane(image.width, image.height), PixelPlane(image.width, image.height),
                                     PixelPlane(image.width, image.height)};
    filters.forPixels(image.pixels.size(), [&](std::size_t i) {
        const Rgba& p = image.pixels[i];
        const auto shown = [&](float value) { return std::clamp(value * factor, 0., 1.); };
        const Vec3 opponent = opponentFromLinear({shown(p.r), shown(p.g), shown(p.b)});
        planes[0].values[i] = static_cast<float>(opponent.x);
        planes[1].values[i] = static_cast<float>(opponent.y);
        planes[2].values[i] = static_cast<float>(opponent.z);
    });
    return planes;
}

}  // namespace

PixelPlane flipMap(const Image& image, const Image& reference, double factor, double pixels_per_degree, int threads) {
    const FlipFilters filters(pixels_per_degree, threads);
    const std::array<PixelPlane, 3> a = opponentPlanes(image, factor, filters);
    const std::array<PixelPlane, 3> b = opponentPlanes(reference, factor, filters);
    const std::vector<Vec3f> seen_a = filters.seen(a), seen_b = filters.seen(b);
    const std::vector<Vec2f> features_a = filters.features(a[0]), features_b = filters.features(b[0]);
    PixelPlane flip(image.width, image.height);
    filters.forPixels(flip.values.size(), [&](std::size_t i) {
        const double colour = redistributed(std::pow(hyab(toDouble(seen_a[i]), toDouble(seen_b[i])), colour_power));
        const double edges = std::abs(features_a[i].x - features_b[i].x);
        const double points = std::abs(features_a[i].y - features_b[i].y);
        const double feature = std::sqrt(std::max(edges, points) / std::numbers::sqrt2);  // q_f = 0.5
        flip.values[i] = static_cast<float>(std::pow(colour, 1 - feature));
    });
    return flip;
}

}  // namespace searchlight
