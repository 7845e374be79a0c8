#include "gui/view/shown_image.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "base/parallel.h"

namespace searchlight::gui {

namespace {

double valueOf(const Rgba& pixel, const std::string& channel) {
    if (channel == "red") return pixel.r;
    if (channel == "green") return pixel.g;
    if (channel == "blue") return pixel.b;
    return luminance({pixel.r, pixel.g, pixel.b});
}

int byteOf(double value) { return static_cast<int>(std::lround(255 * std::clamp(value, 0.0, 1.0))); }

// Rows in parallel.
template <class Body>
void forRows(int height, const Body& body) {
    constexpr int rows = 16;
    parallelFor(static_cast<std::size_t>((height + rows - 1) / rows), 0, [&](std::size_t block) {
        const int begin = static_cast<int>(block) * rows;
        for (int y = begin; y < std::min(height, begin + rows); ++y) body(y);
    });
}

double meanOf(const Image& picture, const std::string& channel) {
    double sum = 0, covered = 0;
    for (const Rgba& pixel : picture.pixels) {
        if (pixel.a <= 0) continue;
        const double value = valueOf(pixel, channel);
        sum += std::isfinite(value) ? value : 0;
        covered += pixel.a;
    }
    return covered > 0 ? sum / covered : 0;
}

}  // namespace

QImage shownImage(const Image& picture, const ToneMap& tone_map, const std::string& channel) {
    QImage shown(picture.width, picture.height, QImage::Format_ARGB32_Premultiplied);
    uchar* const bits = shown.bits();
    const auto stride = static_cast<std::size_t>(shown.bytesPerLine());
    forRows(picture.height, [&](int y) {
        auto* line = reinterpret_cast<QRgb*>(bits + stride * static_cast<std::size_t>(y));
        for (int x = 0; x < picture.width; ++x) {
            Rgba pixel = picture.at(x, y);
            if (pixel.a <= 0) {
                line[x] = 0;
                continue;
            }
            if (channel != "color") {
                const auto value = static_cast<float>(valueOf(pixel, channel));
                pixel = {value, value, value, pixel.a};
            }
            const Rgba out = displayed(pixel, tone_map);
            line[x] = qPremultiply(qRgba(byteOf(out.r), byteOf(out.g), byteOf(out.b), byteOf(out.a)));
        }
    });
    return shown;
}

Image objectAlone(Image picture, const std::vector<float>& coverage) {
    assert(picture.pixels.size() == coverage.size());
    constexpr float whole = 0.999F;  // sums of a few parts end a little below 1
    for (std::size_t i = 0; i < coverage.size(); ++i)
        if (coverage[i] < whole) picture.pixels[i] = {0, 0, 0, 0};
    return picture;
}

QRgb differenceColor(double value) {
    // Linear in sRGB from a light grey to a blue and an orange of the same lightness, so that neither sign looks
    // larger.
    constexpr double grey[3] = {236, 234, 231}, blue[3] = {23, 92, 158}, orange[3] = {176, 71, 10};
    const double t = std::clamp(std::isfinite(value) ? value : 0, -1.0, 1.0);
    const auto& end = t < 0 ? blue : orange;
    const auto mixed = [&](int i) { return static_cast<int>(std::lround(grey[i] + std::abs(t) * (end[i] - grey[i]))); };
    return qRgb(mixed(0), mixed(1), mixed(2));
}

QImage differenceImage(const Image& a, const Image& b, double scale, const std::string& channel) {
    assert(a.width == b.width && a.height == b.height);
    QImage shown(a.width, a.height, QImage::Format_ARGB32_Premultiplied);
    uchar* const bits = shown.bits();
    const auto stride = static_cast<std::size_t>(shown.bytesPerLine());
    const double unit = std::max(meanOf(b, channel) * scale, std::numeric_limits<double>::min());
    forRows(a.height, [&](int y) {
        auto* line = reinterpret_cast<QRgb*>(bits + stride * static_cast<std::size_t>(y));
        for (int x = 0; x < a.width; ++x) {
            const Rgba &from = a.at(x, y), &to = b.at(x, y);
            const int alpha = byteOf(std::max(from.a, to.a));
            const QRgb color = differenceColor((valueOf(from, channel) - valueOf(to, channel)) / unit);
            line[x] = qPremultiply(qRgba(qRed(color), qGreen(color), qBlue(color), alpha));
        }
    });
    return shown;
}

PictureDifference relativeDifference(const Image& a, const Image& b, const std::string& channel) {
    assert(a.width == b.width && a.height == b.height);
    const double mean = meanOf(b, channel);
    if (!(mean > 0)) return {};
    double squares = 0, sum = 0, count = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        const double coverage = std::max(a.pixels[i].a, b.pixels[i].a);
        if (coverage <= 0) continue;
        const double difference = valueOf(a.pixels[i], channel) - valueOf(b.pixels[i], channel);
        if (!std::isfinite(difference)) continue;
        squares += coverage * difference * difference;
        sum += coverage * difference;
        count += coverage;
    }
    return {std::sqrt(squares / count) / mean, sum / count / mean};
}

}  // namespace searchlight::gui
