#include "geometry/atlas/flatten.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace searchlight {

namespace {

using Sparse = Eigen::SparseMatrix<double>;
using Vector = Eigen::VectorXd;

// A triangle in its own plane. Slivers are made thicker: their cotangents would drown all others.
struct Flat {
    std::array<Vec2, 3> corner;
    std::array<double, 3> cotangent;  // of the angle opposite to side k, which runs from corner k
};

Flat flatTriangle(Vec3 p, Vec3 q, Vec3 r) {
    const Vec3 along = q - p, across = r - p;
    const double base = std::max(length(along), 1e-30);
    const double x = dot(along, across) / base;
    const double longest = std::max({base, length(across), length(r - q)});
    constexpr double thinnest = 0.02;
    const double height = std::max(length(cross(along, across)) / base, thinnest * longest);
    Flat flat{{Vec2{0, 0}, Vec2{base, 0}, Vec2{x, height}}, {}};
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec2 a = flat.corner[k] - flat.corner[(k + 2) % 3],
                   b = flat.corner[(k + 1) % 3] - flat.corner[(k + 2) % 3];
        flat.cotangent[k] = dot(a, b) / cross(a, b);
    }
    return flat;
}

std::vector<Flat> flatTriangles(const ChartMesh& chart) {
    std::vector<Flat> flats;
    for (const auto& [a, b, c] : chart.triangles)
        flats.push_back(flatTriangle(chart.positions[a], chart.positions[b], chart.positions[c]));
    return flats;
}

// Visits (i, j, weight) of the cotangent Laplacian's off-diagonal halves.
template <class Visit>
void eachSide(const ChartMesh& chart, std::span<const Flat> flats, const Visit& visit) {
    for (std::size_t t = 0; t < flats.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k)
            visit(chart.triangles[t][k], chart.triangles[t][(k + 1) % 3], 0.5 * flats[t].cotangent[k]);
}

// Two vertices far apart: what scale and rotation of the conformal map are fixed by.
std::array<std::size_t, 2> ends(std::span<const Vec3> positions) {
    const auto farthest = [&](std::size_t from) {
        std::size_t best = from == 0 ? 1 : 0;
        for (std::size_t i = 0; i < positions.size(); ++i)
            if (i != from && length(positions[i] - positions[from]) > length(positions[best] - positions[from]))
                best = i;
        return best;
    };
    const std::size_t one = farthest(0);
    return {one, farthest(one)};
}

void equalAreas(const ChartMesh& chart, std::vector<Vec2>& places) {
    double area = 0, flat = 0;
    for (const auto& [a, b, c] : chart.triangles) {
        area += length(cross(chart.positions[b] - chart.positions[a], chart.positions[c] - chart.positions[a]));
        flat += cross(places[b] - places[a], places[c] - places[a]);
    }
    if (!(flat > 0)) return;
    const double scale = std::sqrt(area / flat);
    for (Vec2& place : places) place = scale * place;
}

// Along the mean normal: what is left where the conformal system cannot be solved.
std::vector<Vec2> project(const ChartMesh& chart) {
    Vec3 normal;
    for (const auto& [a, b, c] : chart.triangles)
        normal = normal + cross(chart.positions[b] - chart.positions[a], chart.positions[c] - chart.positions[a]);
    if (length(normal) == 0) normal = {0, 0, 1};
    normal = normalize(normal);
    const Vec3 u = normalize(cross(std::abs(normal.x) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}, normal));
    const Vec3 v = cross(normal, u);
    std::vector<Vec2> places;
    for (const Vec3 p : chart.positions) places.push_back({dot(p, u), dot(p, v)});
    return places;
}

// [Levy2002] as in [Mullen2008]: Dirichlet energy less area, which is 0 for a conformal map, two vertices being fixed.
std::vector<Vec2> conformal(const ChartMesh& chart, std::span<const Flat> flats) {
    const std::size_t n = chart.positions.size();
    const std::array<std::size_t, 2> fixed = ends(chart.positions);
    const double apart = length(chart.positions[fixed[1]] - chart.positions[fixed[0]]);
    if (n < 3 || !(apart > 0)) return project(chart);
    std::vector<int> unknown(n, -1);
    int count = 0;
    for (std::size_t i = 0; i < n; ++i)
        if (i != fixed[0] && i != fixed[1]) unknown[i] = count++;

    std::vector<Eigen::Triplet<double>> terms;
    Vector right = Vector::Zero(2 * count);
    // Entry between coordinate p of vertex i and coordinate q of vertex j; the second fixed vertex is at (apart, 0).
    const auto add = [&](std::size_t i, int p, std::size_t j, int q, double value) {
        if (unknown[i] < 0) return;
        if (unknown[j] >= 0)
            terms.emplace_back(2 * unknown[i] + p, 2 * unknown[j] + q, value);
        else if (j == fixed[1] && q == 0)
            right[2 * unknown[i] + p] -= value * apart;
    };
    eachSide(chart, flats, [&](std::size_t i, std::size_t j, double weight) {
        for (int p = 0; p < 2; ++p) {
            add(i, p, i, p, weight), add(j, p, j, p, weight);
            add(i, p, j, p, -weight), add(j, p, i, p, -weight);
        }
        // Sides inside the chart cancel: what stays is the area within the border.
        add(i, 0, j, 1, -0.5), add(j, 1, i, 0, -0.5);
        add(j, 0, i, 1, 0.5), add(i, 1, j, 0, 0.5);
    });
    Sparse matrix(2 * count, 2 * count);
    matrix.setFromTriplets(terms.begin(), terms.end());
    const Eigen::SimplicialLDLT<Sparse> solver(matrix);
    if (solver.info() != Eigen::Success) return project(chart);
    const Vector solution = solver.solve(right);
    std::vector<Vec2> places(n);
    places[fixed[1]] = {apart, 0};
    for (std::size_t i = 0; i < n; ++i)
        if (unknown[i] >= 0) places[i] = {solution[2 * unknown[i]], solution[2 * unknown[i] + 1]};
    if (!solution.allFinite()) return project(chart);
    return places;
}

// [Liu2008]: each triangle's best rotation, then the places that fit the rotated triangles best.
void makeRigid(const ChartMesh& chart, std::span<const Flat> flats, int rounds, std::vector<Vec2>& places) {
    const auto n = static_cast<Eigen::Index>(places.size());
    std::vector<Eigen::Triplet<double>> terms;
    double diagonal = 0;
    eachSide(chart, flats, [&](std::uint32_t a, std::uint32_t b, double weight) {
        const auto i = static_cast<int>(a), j = static_cast<int>(b);
        terms.emplace_back(i, i, weight), terms.emplace_back(j, j, weight);
        terms.emplace_back(i, j, -weight), terms.emplace_back(j, i, -weight);
        diagonal += 2 * std::abs(weight);
    });
    // Holds the first vertex at the origin; the right side sums to 0, so it pulls at nothing.
    terms.emplace_back(0, 0, diagonal / static_cast<double>(n));
    Sparse laplacian(n, n);
    laplacian.setFromTriplets(terms.begin(), terms.end());
    const Eigen::SimplicialLDLT<Sparse> solver(laplacian);
    if (solver.info() != Eigen::Success) return;
    for (int round = 0; round < rounds; ++round) {
        Eigen::MatrixX2d right = Eigen::MatrixX2d::Zero(n, 2);
        for (std::size_t t = 0; t < flats.size(); ++t) {
            double aligned = 0, turned = 0;
            for (std::size_t k = 0; k < 3; ++k) {
                const Vec2 rest = flats[t].corner[(k + 1) % 3] - flats[t].corner[k];
                const Vec2 now = places[chart.triangles[t][(k + 1) % 3]] - places[chart.triangles[t][k]];
                aligned += flats[t].cotangent[k] * dot(rest, now);
                turned += flats[t].cotangent[k] * cross(rest, now);
            }
            const double size = std::hypot(aligned, turned);
            const Vec2 rotation = size > 0 ? Vec2{aligned / size, turned / size} : Vec2{1, 0};
            for (std::size_t k = 0; k < 3; ++k) {
                const Vec2 rest = flats[t].corner[(k + 1) % 3] - flats[t].corner[k];
                const double weight = 0.5 * flats[t].cotangent[k];
                const Vec2 pull{weight * (rotation.x * rest.x - rotation.y * rest.y),
                                weight * (rotation.y * rest.x + rotation.x * rest.y)};
                const auto from = static_cast<Eigen::Index>(chart.triangles[t][k]),
                           to = static_cast<Eigen::Index>(chart.triangles[t][(k + 1) % 3]);
                right(from, 0) -= pull.x, right(from, 1) -= pull.y;
                right(to, 0) += pull.x, right(to, 1) += pull.y;
            }
        }
        const Eigen::MatrixX2d solution = solver.solve(right);
        if (!solution.allFinite()) return;
        for (Eigen::Index i = 0; i < n; ++i) places[static_cast<std::size_t>(i)] = {solution(i, 0), solution(i, 1)};
    }
}

}  // namespace

ChartMesh::ChartMesh(const SurfaceGraph& surface, std::span<const std::uint32_t> faces) {
    std::unordered_map<std::uint32_t, std::uint32_t> numbers;
    for (const std::uint32_t face : faces) {
        std::array<std::uint32_t, 3> corners;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t vertex = surface.triangles[face][k];
            const auto [found, is_new] = numbers.try_emplace(vertex, static_cast<std::uint32_t>(positions.size()));
            if (is_new) positions.push_back(surface.positions[vertex]);
            corners[k] = found->second;
        }
        triangles.push_back(corners);
    }
}

std::vector<Vec2> flatten(const ChartMesh& chart, int rounds) {
    const std::vector<Flat> flats = flatTriangles(chart);
    std::vector<Vec2> places = conformal(chart, flats);
    equalAreas(chart, places);
    makeRigid(chart, flats, rounds, places);
    equalAreas(chart, places);
    return places;
}

std::vector<Vec2> flattenConformally(const ChartMesh& chart) {
    std::vector<Vec2> places = conformal(chart, flatTriangles(chart));
    equalAreas(chart, places);
    return places;
}

}  // namespace searchlight
