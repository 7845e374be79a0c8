#include "geometry/point_start.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "base/random.h"
#include "geometry/vertex_normals.h"

namespace searchlight {

namespace {

constexpr std::size_t chunk = 4096;

SurfacePlace placeIn(std::uint32_t triangle, double u, double v) {
    if (u + v > 1) u = 1 - u, v = 1 - v;
    return {triangle, u, v};
}

// Distance along the Hilbert curve of order 10 through the cells of a cube, [Skilling2004].
std::uint32_t hilbertIndex(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    constexpr int order = 10;
    std::uint32_t axes[3] = {x, y, z};
    for (std::uint32_t q = 1u << (order - 1); q > 1; q >>= 1) {
        const std::uint32_t p = q - 1;
        for (std::uint32_t& axis : axes) {
            if (axis & q) {
                axes[0] ^= p;
            } else {
                const std::uint32_t t = (axes[0] ^ axis) & p;
                axes[0] ^= t;
                axis ^= t;
            }
        }
    }
    axes[1] ^= axes[0];
    axes[2] ^= axes[1];
    std::uint32_t t = 0;
    for (std::uint32_t q = 1u << (order - 1); q > 1; q >>= 1)
        if (axes[2] & q) t ^= q - 1;
    for (std::uint32_t& axis : axes) axis ^= t;
    std::uint32_t index = 0;
    for (int bit = order - 1; bit >= 0; --bit)
        for (const std::uint32_t axis : axes) index = index << 1 | (axis >> bit & 1);
    return index;
}

// Part (i, j) of a triangle cut into parts x parts; `upper` ones stand on their heads.
struct Piece {
    std::uint32_t key = 0;
    std::uint32_t triangle = 0;
    std::uint16_t i = 0, j = 0, parts = 1;
    bool upper = false;
};

}  // namespace

double surfaceArea(const Mesh& mesh) {
    double sum = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) sum += length(triangleNormal(mesh, t)) / 2;
    return sum;
}

std::vector<SurfacePlace> randomPlaces(const Mesh& mesh, std::size_t count, std::uint64_t seed, int threads) {
    std::vector<double> ends(mesh.triangles.size());
    double sum = 0;
    for (std::size_t t = 0; t < ends.size(); ++t) ends[t] = sum += length(triangleNormal(mesh, t)) / 2;
    std::vector<SurfacePlace> places(count);
    parallelFor((count + chunk - 1) / chunk, threads, [&](std::size_t c) {
        for (std::size_t i = c * chunk; i < std::min(count, (c + 1) * chunk); ++i) {
            SplitMix64 random = streamOf(seed, i);
            const auto at = std::upper_bound(ends.begin(), ends.end(), random.uniform() * sum);
            const auto triangle = static_cast<std::uint32_t>(
                std::min<std::ptrdiff_t>(at - ends.begin(), static_cast<std::ptrdiff_t>(ends.size()) - 1));
            const double u = random.uniform();
            places[i] = placeIn(triangle, u, random.uniform());
        }
    });
    return places;
}

std::vector<SurfacePlace> stratifiedPlaces(const Mesh& mesh, std::size_t count, std::uint64_t seed, int threads) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    Vec3f low{infinity, infinity, infinity}, high{-infinity, -infinity, -infinity};
    for (const Vec3f p : mesh.positions) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    const double scale =
        1023 / std::max({1e-30, double(high.x) - low.x, double(high.y) - low.y, double(high.z) - low.z});

    // A piece is at most as large as the part of the surface that a point stands for.
    const double part = surfaceArea(mesh) / static_cast<double>(count);
    std::vector<std::size_t> first(mesh.triangles.size() + 1);
    std::vector<std::uint16_t> cuts(mesh.triangles.size());
    for (std::size_t t = 0; t < cuts.size(); ++t) {
        const double area = length(triangleNormal(mesh, t)) / 2;
        cuts[t] = static_cast<std::uint16_t>(std::clamp(std::ceil(std::sqrt(area / part)), 1.0, 65535.0));
        first[t + 1] = first[t] + std::size_t{cuts[t]} * cuts[t];
    }
    std::vector<Piece> pieces(first.back());
    parallelFor((cuts.size() + chunk - 1) / chunk, threads, [&](std::size_t c) {
        for (std::size_t t = c * chunk; t < std::min(cuts.size(), (c + 1) * chunk); ++t) {
            const auto& corners = mesh.triangles[t];
            const Vec3 p = toDouble(mesh.positions[corners[0]]), e1 = toDouble(mesh.positions[corners[1]]) - p,
                       e2 = toDouble(mesh.positions[corners[2]]) - p;
            Piece* piece = &pieces[first[t]];
            const std::uint16_t parts = cuts[t];
            for (std::uint16_t j = 0; j < parts; ++j)
                for (std::uint16_t i = 0; i + j < parts; ++i)
                    for (const bool upper : {false, true}) {
                        if (upper && i + j + 1 >= parts) continue;
                        const double third = upper ? 2.0 / 3 : 1.0 / 3;
                        const Vec3 at = p + ((i + third) / parts) * e1 + ((j + third) / parts) * e2;
                        const auto cell = [&](double x, float from) {
                            return static_cast<std::uint32_t>(std::clamp((x - from) * scale, 0.0, 1023.0));
                        };
                        *piece++ = {hilbertIndex(cell(at.x, low.x), cell(at.y, low.y), cell(at.z, low.z)),
                                    static_cast<std::uint32_t>(t),
                                    i,
                                    j,
                                    parts,
                                    upper};
                    }
        }
    });
    // Stable, so equal keys keep the order of the triangles.
    std::vector<Piece> sorted(pieces.size());
    for (int shift = 0; shift < 30; shift += 10) {
        std::vector<std::size_t> starts(1025);
        for (const Piece& piece : pieces) ++starts[(piece.key >> shift & 1023) + 1];
        for (std::size_t i = 1; i < starts.size(); ++i) starts[i] += starts[i - 1];
        for (const Piece& piece : pieces) sorted[starts[piece.key >> shift & 1023]++] = piece;
        pieces.swap(sorted);
    }
    std::vector<double> ends(pieces.size());
    double sum = 0;
    for (std::size_t i = 0; i < pieces.size(); ++i)
        ends[i] = sum +=
            length(triangleNormal(mesh, pieces[i].triangle)) / 2 / (double(pieces[i].parts) * pieces[i].parts);

    std::vector<SurfacePlace> places(count);
    parallelFor((count + chunk - 1) / chunk, threads, [&](std::size_t c) {
        for (std::size_t i = c * chunk; i < std::min(count, (c + 1) * chunk); ++i) {
            SplitMix64 random = streamOf(seed, i);
            const double at = (static_cast<double>(i) + random.uniform()) / static_cast<double>(count) * sum;
            const auto found = std::upper_bound(ends.begin(), ends.end(), at);
            const Piece& piece =
                pieces[std::min<std::size_t>(static_cast<std::size_t>(found - ends.begin()), pieces.size() - 1)];
            const double u = random.uniform();
            const SurfacePlace inside = placeIn(0, u, random.uniform());
            const double parts = piece.parts;
            places[i] =
                piece.upper
                    ? SurfacePlace{piece.triangle, (piece.i + 1 - inside.u) / parts, (piece.j + 1 - inside.v) / parts}
                    : SurfacePlace{piece.triangle, (piece.i + inside.u) / parts, (piece.j + inside.v) / parts};
        }
    });
    return places;
}

}  // namespace searchlight
