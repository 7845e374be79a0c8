#include "light/environment.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "io/image_file.h"
#include "light/picture_light.h"

namespace searchlight {

namespace {

constexpr double pi = std::numbers::pi;

// The last entry of `cdf` (ascending, from 0) at or below u, and how far u is from it to the next, in [0, 1).
std::pair<int, double> invert(const double* cdf, int entries, double u) {
    const double* const above = std::upper_bound(cdf + 1, cdf + entries - 1, u);
    const int cell = static_cast<int>(above - cdf) - 1;
    const double width = cdf[cell + 1] - cdf[cell];
    const double rest = width > 0 ? (u - cdf[cell]) / width : 0.5;
    return {cell, std::clamp(rest, 0.0, 1.0 - 1e-9)};
}

void normalise(std::span<double> cdf, std::span<const double> sums) {
    for (std::size_t i = 0; i < sums.size(); ++i)
        cdf[i] =
            sums.back() > 0 ? sums[i] / sums.back() : static_cast<double>(i) / static_cast<double>(sums.size() - 1);
    cdf.back() = 1;
}

}  // namespace

// Radiance is bilinear between pixel centres, so importance is constant in cells whose corners are pixel centres: a
// cell is black only where all of it is, and its weight is the mean of its corners. Row r of cells lies between rows r
// - 1 and r of pixels; the first and the last are half as high and reach to the poles.
struct Environment::Impl {
    Image picture;
    EnvironmentLight light;
    double cosine = 1, sine = 0;  ///< of the rotation
    std::vector<double> rows;     ///< cumulative over rows of cells, height + 2 values
    std::vector<double> columns;  ///< cumulative within each row of cells, width + 1 values each
    double total = 0;             ///< luminance, before intensity: sum of cell weights
    Rgb total_radiance;

    int cellRows() const { return picture.height + 1; }

    double rowCosine(int row) const {  // of the polar angle at the upper end of a row of cells
        return std::cos(pi * std::clamp((row - 0.5) / picture.height, 0.0, 1.0));
    }
    double cellSolidAngle(int row) const { return (rowCosine(row) - rowCosine(row + 1)) * 2 * pi / picture.width; }
    // Pixel of the corner; columns wrap, rows stop at the poles.
    const Rgba& corner(int row, int column) const {
        const int w = picture.width;
        return picture.at((column % w + w) % w, std::clamp(row, 0, picture.height - 1));
    }
    // Cell `column` lies between the centres of pixels column and column + 1.
    Rgb cellMean(int row, int column) const {
        Rgb sum;
        for (const int dy : {-1, 0})
            for (const int dx : {0, 1}) {
                const Rgba& p = corner(row + dy, column + dx);
                sum = sum + Rgb{p.r, p.g, p.b};
            }
        return 0.25 * sum;
    }

    void build() {
        const int w = picture.width, h = cellRows();
        std::vector<double> row_sums(h + 1), sums(w + 1);
        rows.resize(h + 1);
        columns.resize(static_cast<std::size_t>(h) * (w + 1));
        for (int row = 0; row < h; ++row) {
            const double solid_angle = cellSolidAngle(row);
            for (int column = 0; column < w; ++column) {
                const Rgb mean = cellMean(row, column);
                sums[column + 1] = sums[column] + luminance(mean) * solid_angle;
                total_radiance = total_radiance + solid_angle * mean;
            }
            row_sums[row + 1] = row_sums[row] + sums.back();
            normalise(std::span(columns).subspan(static_cast<std::size_t>(row) * (w + 1), w + 1), sums);
        }
        total = row_sums.back();
        normalise(rows, row_sums);
        total_radiance = light.intensity * total_radiance;
    }

    // Into the picture's own frame, before rotation.
    Vec3 unrotated(Vec3 d) const { return {cosine * d.x - sine * d.z, d.y, sine * d.x + cosine * d.z}; }
    Vec3 rotated(Vec3 d) const { return {cosine * d.x + sine * d.z, d.y, -sine * d.x + cosine * d.z}; }

    // In pixels, from the left and the top.
    std::array<double, 2> at(Vec3 direction) const {
        const Vec3 d = unrotated(direction);
        const double turn = 0.5 + std::atan2(d.x, -d.z) / (2 * pi);
        const double theta = std::atan2(std::hypot(d.x, d.z), d.y);
        return {turn * picture.width, theta / pi * picture.height};
    }

    Rgb radianceAt(double x, double y) const {
        const double left = std::floor(x - 0.5), up = std::floor(y - 0.5);
        const double s = x - 0.5 - left, t = y - 0.5 - up;
        Rgb sum;
        for (const int dy : {0, 1})
            for (const int dx : {0, 1}) {
                const Rgba& p = corner(static_cast<int>(up) + dy, static_cast<int>(left) + dx);
                sum = sum + ((dx ? s : 1 - s) * (dy ? t : 1 - t)) * Rgb{p.r, p.g, p.b};
            }
        return light.intensity * sum;
    }
};

Environment::Environment(const EnvironmentLight& light) : Environment(readImage(light.path).image, light, light.path) {}

Environment::Environment(Image picture, const EnvironmentLight& light, const std::string& name)
    : impl_(std::make_unique<Impl>()) {
    impl_->picture = latitudeLongitude(std::move(picture), light.layout, name);
    impl_->light = light;
    impl_->cosine = std::cos(light.rotation_deg * pi / 180);
    impl_->sine = std::sin(light.rotation_deg * pi / 180);
    impl_->build();
}

Environment::~Environment() = default;
Environment::Environment(Environment&&) noexcept = default;
Environment& Environment::operator=(Environment&&) noexcept = default;

Rgb Environment::radiance(Vec3 direction) const {
    const auto [x, y] = impl_->at(direction);
    return impl_->radianceAt(x, y);
}

EnvironmentSample Environment::sample(double u, double v) const {
    const Impl& impl = *impl_;
    if (impl.total <= 0) return {{0, 1, 0}, {}, 0};
    const int w = impl.picture.width;
    const auto [row, down] = invert(impl.rows.data(), impl.cellRows() + 1, v);
    const auto [column, across] = invert(impl.columns.data() + static_cast<std::size_t>(row) * (w + 1), w + 1, u);
    // Uniform in solid angle within the cell.
    const double top = impl.rowCosine(row), bottom = impl.rowCosine(row + 1);
    const double cos_theta = top + down * (bottom - top);
    const double sin_theta = std::sqrt(std::max(0.0, 1 - cos_theta * cos_theta));
    const double x = column + 0.5 + across;
    const double phi = 2 * pi * (x / w - 0.5);
    const Vec3 direction{sin_theta * std::sin(phi), cos_theta, -sin_theta * std::cos(phi)};
    const double y = std::acos(std::clamp(cos_theta, -1.0, 1.0)) / pi * impl.picture.height;
    return {impl.rotated(direction), impl.radianceAt(x, y), luminance(impl.cellMean(row, column)) / impl.total};
}

double Environment::pdf(Vec3 direction) const {
    if (impl_->total <= 0) return 0;
    const auto [x, y] = impl_->at(direction);
    const int row = std::clamp(static_cast<int>(std::floor(y + 0.5)), 0, impl_->picture.height);
    return luminance(impl_->cellMean(row, static_cast<int>(std::floor(x - 0.5)))) / impl_->total;
}

Rgb Environment::totalRadiance() const { return impl_->total_radiance; }
const Image& Environment::picture() const { return impl_->picture; }
Rgb Environment::intensity() const { return impl_->light.intensity; }

Vec2f Environment::pictureAt(Vec3 direction) const {
    const auto [x, y] = impl_->at(direction);
    return {static_cast<float>(x / impl_->picture.width), static_cast<float>(y / impl_->picture.height)};
}

}  // namespace searchlight
