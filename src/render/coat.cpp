#include "render/coat.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "base/directions.h"
#include "base/error.h"
#include "base/files.h"
#include "base/parallel.h"
#include "base/random.h"
#include "render/brdf_evaluator.h"
#include "render/coat_lights.h"
#include "render/ggx.h"

namespace searchlight {

namespace {

// Narrower than this (a roughness of 0.01) is a mirror: the highlight would be fifty times smaller than the sun.
constexpr double least_alpha = 1e-4;

// The frame of sample i. A shading normal that faces away from the viewer gives way to the geometric one.
CoatPoint pointOf(const CoatSamples& samples, std::size_t i) {
    CoatPoint point;
    point.position = toDouble(samples.positions[i]);
    point.normal = toDouble(samples.normals[i]);
    point.geometric_normal = toDouble(samples.geometric_normals[i]);
    const Vec3 wo = toDouble(samples.wo[i]);
    // 1e-3: closer to the horizon, single precision of the normal decides what is seen.
    if (dot(point.normal, wo) < 1e-3) point.normal = point.geometric_normal;
    const Frame frame = frameAround(point.normal);
    point.tangent = frame.tangent;
    point.bitangent = frame.bitangent;
    point.wo = point.local(wo);
    return point;
}

std::uint64_t seedOf(const CoatOptions& options, std::size_t sample) { return streamOf(options.seed, sample).next(); }

Rgb mirrored(const Ggx& ggx, const CoatLights& lights, const CoatPoint& point) {
    const Vec3 wo = point.wo;
    return ggxFresnel(ggx, wo.z) * lights.radianceFrom(point, {-wo.x, -wo.y, wo.z});
}

Rgb glossy(const Ggx& ggx, const CoatLights& lights, const CoatPoint& point, std::uint64_t seed) {
    const CoatChoice choice{[&](double u, double v) { return ggxSample(ggx, point.wo, u, v); },
                            [&](Vec3 wi) { return ggxPdf(ggx, wi, point.wo); }};
    Rgb sum;
    lights.gather(point, seed, choice, [&](Vec3 wi, Rgb weight) { sum = sum + ggxValue(ggx, wi, point.wo) * weight; });
    return sum;
}

void coatOfDielectric(const CoatSamples& samples, double roughness, const CoatLights& lights,
                      const CoatOptions& options, Observer& observer, std::vector<Rgbf>& radiance) {
    const Ggx ggx{roughness * roughness, options.eta, false};
    constexpr std::size_t piece = 256;
    parallelFor((radiance.size() + piece - 1) / piece, options.threads, [&](std::size_t chunk) {
        if (observer.cancelled()) throw interruptedError();
        for (std::size_t i = chunk * piece; i < std::min(radiance.size(), (chunk + 1) * piece); ++i) {
            const CoatPoint point = pointOf(samples, i);
            if (point.wo.z <= 0) continue;
            radiance[i] = toFloat(ggx.alpha < least_alpha ? mirrored(ggx, lights, point)
                                                          : glossy(ggx, lights, point, seedOf(options, i)));
        }
    });
}

// A BRDF of which nothing is known is asked in proportion to the cosine.
Vec3 cosineSample(double u, double v) {
    const double radius = std::sqrt(u), angle = 2 * std::numbers::pi * v;
    return {radius * std::cos(angle), radius * std::sin(angle), std::sqrt(1 - u)};
}

struct Asked {
    BrdfQuery query;
    Rgb weight;
};

void coatOfFile(const CoatSamples& samples, const Coat& coat, const CoatLights& lights, const CoatOptions& options,
                Observer& observer, std::vector<Rgbf>& radiance) {
    const BrdfFile file = parseBrdf(readFile(coat.brdf), coat.brdf);
    if (!options.context)
        throw deviceError("a .brdf file is evaluated on OpenGL, which is not to be had here").at(coat.brdf);
    BrdfEvaluator evaluator(file, coat.parameters, *options.context);
    const CoatChoice choice{cosineSample, [](Vec3 wi) { return std::max(0.0, wi.z) / std::numbers::pi; }};
    // Some 1e5 queries at a time: memory stays small and a cancelled run ends soon.
    constexpr std::size_t piece = 2048;
    std::vector<std::vector<Asked>> asked(piece);
    std::vector<BrdfQuery> queries;
    std::vector<Rgb> values;
    for (std::size_t first = 0; first < radiance.size(); first += piece) {
        if (observer.cancelled()) throw interruptedError();
        const std::size_t count = std::min(piece, radiance.size() - first);
        parallelFor(count, options.threads, [&](std::size_t i) {
            asked[i].clear();
            const CoatPoint point = pointOf(samples, first + i);
            if (point.wo.z <= 0) return;
            const Vec3 wo = point.world(point.wo);
            lights.gather(point, seedOf(options, first + i), choice, [&](Vec3 wi, Rgb weight) {
                asked[i].push_back({{point.world(wi), wo, point.normal, point.tangent, point.bitangent}, weight});
            });
        });
        queries.clear();
        for (std::size_t i = 0; i < count; ++i)
            for (const Asked& one : asked[i]) queries.push_back(one.query);
        values.resize(queries.size());
        evaluator.evaluate(queries, values);
        const Rgb* value = values.data();
        for (std::size_t i = 0; i < count; ++i) {
            Rgb sum;
            for (const Asked& one : asked[i]) sum = sum + one.weight * *value++;
            radiance[first + i] = toFloat(sum);
        }
    }
}

}  // namespace

std::vector<Rgbf> coatRadiance(const CoatSamples& samples, const Scene& scene, const Object& object,
                               const RayScene* rays, const CoatOptions& options, Observer& observer) {
    assert(scene.coat);
    assert(samples.normals.size() == samples.positions.size() && samples.wo.size() == samples.positions.size());
    assert(samples.geometric_normals.size() == samples.positions.size());
    std::vector<Rgbf> radiance(samples.positions.size());
    const CoatLights lights(scene, object, rays, options);
    if (scene.coat->brdf.empty())
        coatOfDielectric(samples, scene.coat->roughness, lights, options, observer, radiance);
    else
        coatOfFile(samples, *scene.coat, lights, options, observer, radiance);
    return radiance;
}

}  // namespace searchlight
