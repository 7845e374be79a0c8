#include "render/direct/probe_hits.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"
#include "light/stratified.h"

namespace searchlight {

namespace {

// Along one line: more surfaces than any object has, so that rounding cannot keep a line alive.
constexpr int most_hits = 64;

ProbeHits hitsOf(const Probes& probes, const VisibleSurface& visible, std::size_t begin, std::size_t end,
                 int per_receiver, std::uint64_t seed, const RayScene& rays, const SurfaceWalk& walk) {
    std::vector<ProbeFrame> frames;
    std::vector<Ray> lines;
    std::vector<std::uint32_t> owner;
    for (std::size_t i = begin; i < end; ++i) {
        frames.emplace_back(toDouble(visible.normals[i]));
        const StratifiedSequence sequence(streamOf(seed, i).next());
        for (int k = 0; k < per_receiver; ++k) {
            const auto [u, v] = sequence(static_cast<std::uint32_t>(k));
            lines.push_back(probes.sample(toDouble(visible.positions[i]), frames.back(), u, v));
            owner.push_back(static_cast<std::uint32_t>(i));
        }
    }
    ProbeHits found;
    std::vector<RayHit> results(lines.size());
    for (int round = 0; round < most_hits && !lines.empty(); ++round) {
        rays.intersect(lines, results, false);
        std::size_t left = 0;
        for (std::size_t k = 0; k < lines.size(); ++k) {
            const RayHit& hit = results[k];
            if (!std::isfinite(hit.t)) continue;
            const std::uint32_t receiver = owner[k];
            const SurfacePlace place{hit.triangle, hit.u, hit.v};
            const Vec3 at = walk.position(place), offset = at - toDouble(visible.positions[receiver]);
            if (dot(offset, offset) <= probes.reach() * probes.reach()) {
                const double density = probes.density(offset, toDouble(hit.normal), frames[receiver - begin]);
                if (density > 0) {
                    found.hits.push_back({receiver, 1 / (density * per_receiver)});
                    found.places.push_back(place);
                    found.points.positions.push_back(toFloat(at));
                    found.points.normals.push_back(toFloat(walk.shadingNormal(place)));
                }
            }
            // On behind the hit: by what rounding may have moved it.
            Ray on = lines[k];
            on.t_min = hit.t + 4e-6f * (rays.extent() + hit.t);
            if (on.t_min >= on.t_max) continue;
            lines[left] = on;
            owner[left++] = receiver;
        }
        lines.resize(left);
        results.resize(left);
    }
    return found;
}

}  // namespace

ProbeHits findHits(const Probes& probes, const VisibleSurface& visible, std::size_t begin, std::size_t end,
                   int per_receiver, std::uint64_t seed, const RayScene& rays, const SurfaceWalk& walk, int threads,
                   const Observer& observer) {
    constexpr std::size_t receivers_per_task = 256;
    const std::size_t tasks = (end - begin + receivers_per_task - 1) / receivers_per_task;
    std::vector<ProbeHits> parts(tasks);
    parallelFor(tasks, threads, [&](std::size_t task) {
        if (observer.cancelled()) throw interruptedError();
        const std::size_t first = begin + task * receivers_per_task;
        parts[task] =
            hitsOf(probes, visible, first, std::min(first + receivers_per_task, end), per_receiver, seed, rays, walk);
    });
    ProbeHits all;
    for (const ProbeHits& part : parts) {
        all.hits.insert(all.hits.end(), part.hits.begin(), part.hits.end());
        all.places.insert(all.places.end(), part.places.begin(), part.places.end());
        all.points.positions.insert(all.points.positions.end(), part.points.positions.begin(),
                                    part.points.positions.end());
        all.points.normals.insert(all.points.normals.end(), part.points.normals.begin(), part.points.normals.end());
    }
    return all;
}

}  // namespace searchlight
