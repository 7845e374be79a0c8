#include "render/shade.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>

#include "base/parallel.h"
#include "model/physics.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/shade.cpp"
#include <hwy/foreach_target.h>

#include "base/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace searchlight {
namespace HWY_NAMESPACE {

struct Vectors {
    FloatV x, y, z;
};

HWY_INLINE Vectors load(const Vec3f* from) {
    Vectors v;
    hn::LoadInterleaved3(Float(), &from->x, v.x, v.y, v.z);
    return v;
}

HWY_INLINE FloatV dotOf(const Vectors& a, const Vectors& b) {
    return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}

// T21 by the cosine outside, ratio = 1 / eta: as a product, which keeps its digits at grazing angles. Total reflection,
// where the medium is the thinner one, is a cosine of 0 inside.
HWY_INLINE FloatV transmittance(FloatV cosine, float ratio) {
    const Float d;
    const FloatV r = hn::Set(d, ratio), square = hn::Mul(cosine, cosine);
    // 1 - r^2 (1 - cosine^2), where nothing cancels for matched media.
    const FloatV inside =
        hn::Sqrt(hn::Max(hn::Zero(d), hn::MulAdd(hn::Mul(r, r), square, hn::Set(d, (1 - ratio) * (1 + ratio)))));
    const FloatV s = hn::MulAdd(r, cosine, inside), p = hn::MulAdd(r, inside, cosine);
    const FloatV product = hn::Mul(hn::Mul(hn::Set(d, 2 * ratio), cosine), inside);
    // 1e-30: at a cosine of 0 of matched media both sums are 0.
    const auto part = [&](FloatV sum) { return hn::Div(product, hn::Max(hn::Mul(sum, sum), hn::Set(d, 1e-30f))); };
    return hn::Add(part(s), part(p));
}

// Interpolated normals turn away from the eye where triangles do not: on creases and where a mesh folds back on itself
// its vertices' normals are means of sides that have nothing to do with each other, and T21 of them draws black lines
// and specks. So the cosine is at least so much of the triangle's: half of it where the normals agree within 25
// degrees, as they do on smooth surfaces up to their outlines, all of it from 45 degrees on and up to 0.1.
HWY_INLINE FloatV trust(FloatV agreement) {
    const Float d;
    const FloatV part = hn::NegMulAdd(hn::Set(d, 2.5f), hn::Sub(agreement, hn::Set(d, 0.7f)), hn::Set(d, 1.0f));
    return hn::Min(hn::Max(part, hn::Set(d, 0.5f)), hn::Set(d, 1.0f));
}

HWY_INLINE FloatV factors(const Vec3f* positions, const Vec3f* normals, const Vec3f* geometric, Vec3f eye, float ratio,
                          float scale) {
    const Float d;
    const Vectors position = load(positions);
    const Vectors to_eye{hn::Sub(hn::Set(d, eye.x), position.x), hn::Sub(hn::Set(d, eye.y), position.y),
                         hn::Sub(hn::Set(d, eye.z), position.z)};
    const FloatV per_length = hn::Div(hn::Set(d, 1.0f), hn::Sqrt(dotOf(to_eye, to_eye)));
    const Vectors normal = load(normals), triangle = load(geometric);
    const FloatV seen = hn::Mul(dotOf(to_eye, triangle), per_length);
    const FloatV least = hn::Max(hn::Mul(trust(dotOf(normal, triangle)), seen), hn::Min(seen, hn::Set(d, 0.1f)));
    const FloatV cosine =
        hn::Min(hn::Max(hn::Mul(dotOf(to_eye, normal), per_length), hn::Max(least, hn::Zero(d))), hn::Set(d, 1.0f));
    return hn::Mul(hn::Set(d, scale), transmittance(cosine, ratio));
}

// Samples [begin, end).
void exitRadiancePart(const VisibleSurface& visible, const Rgbf* exitance, Vec3f eye, float ratio, float scale,
                      std::size_t begin, std::size_t end, Rgbf* radiance) {
    const Float d;
    const std::size_t lanes = hn::Lanes(d);
    const auto scaled = [&](const Rgbf* from, FloatV factor, Rgbf* to) {
        FloatV r, g, b;
        hn::LoadInterleaved3(d, &from->r, r, g, b);
        hn::StoreInterleaved3(hn::Mul(r, factor), hn::Mul(g, factor), hn::Mul(b, factor), d, &to->r);
    };
    std::size_t i = begin;
    for (; i + lanes <= end; i += lanes)
        scaled(&exitance[i],
               factors(&visible.positions[i], &visible.normals[i], &visible.geometric_normals[i], eye, ratio, scale),
               &radiance[i]);
    if (i == end) return;
    std::array<Vec3f, 16> positions{}, normals{}, geometric{};
    std::array<Rgbf, 16> from{}, to{};
    const std::size_t rest = end - i;
    std::copy_n(&visible.positions[i], rest, positions.begin());
    std::copy_n(&visible.normals[i], rest, normals.begin());
    std::copy_n(&visible.geometric_normals[i], rest, geometric.begin());
    std::copy_n(&exitance[i], rest, from.begin());
    scaled(from.data(), factors(positions.data(), normals.data(), geometric.data(), eye, ratio, scale), to.data());
    std::copy_n(to.begin(), rest, &radiance[i]);
}

}  // namespace HWY_NAMESPACE
}  // namespace searchlight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace searchlight {

HWY_EXPORT(exitRadiancePart);

namespace {

constexpr std::size_t grain = 8192;

// The brightest channel, so that a colour keeps its hue.
float brightest(const Rgbf& radiance) { return std::max({radiance.r, radiance.g, radiance.b}); }

}  // namespace

void exitRadiance(const VisibleSurface& visible, std::span<const Rgbf> exitance, double eta, int threads,
                  std::vector<Rgbf>& radiance) {
    assert(exitance.size() == visible.positions.size());
    const double normalizer = std::numbers::pi * (1 - 2 * Physics<double>::fresnelMoment(1, 1 / eta));
    const std::size_t n = exitance.size();
    radiance.resize(n);
    parallelFor((n + grain - 1) / grain, threads, [&](std::size_t part) {
        HWY_DYNAMIC_DISPATCH(exitRadiancePart)
        (visible, exitance.data(), toFloat(visible.eye), static_cast<float>(1 / eta),
         static_cast<float>(1 / normalizer), part * grain, std::min(n, (part + 1) * grain), radiance.data());
    });
}

double displayExposure(const VisibleSurface& visible, std::span<const Rgbf> radiance, int threads) {
    constexpr double brighter = 0.02, white = 0.8;
    // Positive floats are in the order of their bits: coverage is added up by the exponent and four bits of the
    // mantissa, and only the bin in which the 2 % are reached is sorted.
    constexpr int shift = 19;
    const auto binOf = [](float value) { return value > 0 ? std::bit_cast<std::uint32_t>(value) >> shift : 0u; };
    const std::size_t n = radiance.size(), parts = (n + grain - 1) / grain;
    std::vector<std::vector<float>> counted(parts);
    parallelFor(parts, threads, [&](std::size_t part) {
        counted[part].resize((0x80000000u >> shift) + 1);
        for (std::size_t i = part * grain; i < std::min(n, (part + 1) * grain); ++i)
            counted[part][binOf(brightest(radiance[i]))] += visible.coverage[i];
    });
    std::vector<double> bins((0x80000000u >> shift) + 1);
    for (const std::vector<float>& part : counted)
        for (std::size_t bin = 0; bin < bins.size(); ++bin) bins[bin] += static_cast<double>(part[bin]);
    const double total = std::accumulate(bins.begin(), bins.end(), 0.0);
    double seen = 0;
    std::size_t bin = bins.size() - 1;
    while (bin > 0 && seen + bins[bin] < brighter * total) seen += bins[bin--];
    if (bin == 0) return 0;
    std::vector<std::pair<float, float>> values;  // and coverage
    for (std::size_t i = 0; i < n; ++i)
        if (const float value = brightest(radiance[i]); binOf(value) == bin)
            values.emplace_back(value, visible.coverage[i]);
    std::ranges::sort(values, std::greater{});
    std::size_t at = 0;
    // Rounding may leave the sum just below.
    for (; at + 1 < values.size(); ++at) {
        seen += static_cast<double>(values[at].second);
        if (seen >= brighter * total) break;
    }
    return std::log2(white / static_cast<double>(values[at].first));
}

void composite(const VisibleSurface& visible, std::span<const Rgbf> radiance, std::span<const Rgbf> coat,
               const Image& background, int threads, Image& picture) {
    assert(radiance.size() == visible.pixels.size() && (coat.empty() || coat.size() == radiance.size()));
    picture.width = visible.width;
    picture.height = visible.height;
    picture.pixels.resize(static_cast<std::size_t>(visible.width) * static_cast<std::size_t>(visible.height));
    const std::size_t size = picture.pixels.size(), n = radiance.size();
    parallelFor((size + grain - 1) / grain, threads, [&](std::size_t part) {
        const std::size_t begin = part * grain, count = std::min(grain, size - begin);
        if (background.empty())
            std::fill_n(&picture.pixels[begin], count, Rgba{0, 0, 0, 0});
        else
            std::copy_n(&background.pixels[begin], count, &picture.pixels[begin]);
    });
    // The samples of a pixel follow each other: those of one that began in the part before are the part's before.
    const auto startOf = [&](std::size_t i) {
        while (i > 0 && i < n && visible.pixels[i] == visible.pixels[i - 1]) ++i;
        return std::min(i, n);
    };
    parallelFor((n + grain - 1) / grain, threads, [&](std::size_t part) {
        const std::size_t end = startOf((part + 1) * grain);
        for (std::size_t i = startOf(part * grain); i < end;) {
            const std::uint32_t at = visible.pixels[i];
            Rgba sum{0, 0, 0, 0};
            for (; i < end && visible.pixels[i] == at; ++i) {
                const float share = visible.coverage[i];
                const Rgbf on_top = coat.empty() ? Rgbf{} : coat[i];
                sum.r += share * (std::max(0.0f, radiance[i].r) + on_top.r);
                sum.g += share * (std::max(0.0f, radiance[i].g) + on_top.g);
                sum.b += share * (std::max(0.0f, radiance[i].b) + on_top.b);
                sum.a += share;
            }
            Rgba& pixel = picture.pixels[at];
            sum.a = std::min(sum.a, 1.0f);
            const float rest = 1 - sum.a;
            pixel = {sum.r + rest * pixel.r, sum.g + rest * pixel.g, sum.b + rest * pixel.b, sum.a + rest * pixel.a};
        }
    });
}

}  // namespace searchlight
#endif
