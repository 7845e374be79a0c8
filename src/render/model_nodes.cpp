#include "render/model_nodes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/parallel.h"

namespace searchlight {

namespace {

constexpr int attributes = 6;  // normal and wi

// Sums over points, weighted with w.
struct Sums {
    double w = 0;
    Rgb flux;
    Vec3 x;
    std::array<double, 6> xx{};  // xx, xy, xz, yy, yz, zz
    std::array<double, attributes> a{};
    std::array<Vec3, attributes> ax{};

    void add(const ModelPoint& point) {
        const double weight = std::abs(luminance(point.flux));
        const Vec3& p = point.position;
        w += weight;
        flux = flux + point.flux;
        x = x + weight * p;
        const std::array<double, 6> products{p.x * p.x, p.x * p.y, p.x * p.z, p.y * p.y, p.y * p.z, p.z * p.z};
        for (std::size_t i = 0; i < 6; ++i) xx[i] += weight * products[i];
        const std::array<double, attributes> values{point.normal.x, point.normal.y, point.normal.z,
                                                    point.wi.x,     point.wi.y,     point.wi.z};
        for (std::size_t i = 0; i < attributes; ++i) {
            a[i] += weight * values[i];
            ax[i] = ax[i] + (weight * values[i]) * p;
        }
    }

    void add(const Sums& other) {
        w += other.w;
        flux = flux + other.flux;
        x = x + other.x;
        for (std::size_t i = 0; i < 6; ++i) xx[i] += other.xx[i];
        for (std::size_t i = 0; i < attributes; ++i) {
            a[i] += other.a[i];
            ax[i] = ax[i] + other.ax[i];
        }
    }
};

// Two directions across `n`; any where it has none.
std::pair<Vec3, Vec3> tangents(Vec3 n) {
    if (!(length(n) > 1e-6)) n = {0, 0, 1};
    const Vec3 t = normalize(cross(std::abs(n.x) < 0.7 * length(n) ? Vec3{1, 0, 0} : Vec3{0, 1, 0}, n));
    return {t, normalize(cross(n, t))};
}

ModelNode nodeOf(const Sums& sums) {
    if (!(sums.w > 0)) return {};
    const double inverse = 1 / sums.w;
    const Vec3 mean = inverse * sums.x;
    std::array<double, attributes> a;
    for (std::size_t i = 0; i < attributes; ++i) a[i] = inverse * sums.a[i];
    const Vec3 normal{a[0], a[1], a[2]}, wi{a[3], a[4], a[5]};
    const auto [t1, t2] = tangents(normal);
    // Covariance along the surface, and its Cholesky factor.
    const auto& q = sums.xx;
    const auto covariance = [&](Vec3 s, Vec3 t) {
        const Vec3 qt{q[0] * t.x + q[1] * t.y + q[2] * t.z, q[1] * t.x + q[3] * t.y + q[4] * t.z,
                      q[2] * t.x + q[4] * t.y + q[5] * t.z};
        return inverse * dot(s, qt) - dot(s, mean) * dot(t, mean);
    };
    const double l11 = std::sqrt(std::max(0.0, covariance(t1, t1)));
    const double l21 = l11 > 0 ? covariance(t1, t2) / l11 : 0;
    const double l22 = std::sqrt(std::max(0.0, covariance(t2, t2) - l21 * l21));
    // Slopes along the two factors; none where a factor is rounding alone.
    const double least = 1e-7 * (length(mean) + l11);
    std::array<double, attributes> slope1{}, slope2{};
    for (std::size_t i = 0; i < attributes; ++i) {
        const Vec3 cross_covariance = inverse * sums.ax[i] - a[i] * mean;
        const double along1 = dot(cross_covariance, t1), along2 = dot(cross_covariance, t2);
        if (l11 > least) slope1[i] = along1 / l11;
        if (l22 > least) slope2[i] = (along2 - l21 * slope1[i]) / l22;
    }
    // Two points at +- sqrt(2) of the factor, with a quarter of the weight each, have its square as their moment.
    const double root = std::sqrt(2.0);
    const auto offset = [&](const std::array<double, attributes>& slope, std::size_t first) {
        return toFloat(root * Vec3{slope[first], slope[first + 1], slope[first + 2]});
    };
    return {.position = toFloat(mean),
            .offsets = {toFloat(root * (l11 * t1 + l21 * t2)), toFloat(root * (l22 * t2))},
            .normal = toFloat(normal),
            .flux = toFloat(sums.flux),
            .normal_offsets = {offset(slope1, 0), offset(slope2, 0)},
            .wi = toFloat(wi),
            .wi_offsets = {offset(slope1, 3), offset(slope2, 3)}};
}

}  // namespace

std::vector<ModelPoint> modelPoints(const PointCloud& points, std::span<const Vec3f> wi, std::span<const Rgbf> flux) {
    std::vector<ModelPoint> made(points.positions.size());
    for (std::size_t i = 0; i < made.size(); ++i)
        made[i] = {toDouble(points.positions[i]), toDouble(points.normals[i]), toDouble(wi[wi.size() == 1 ? 0 : i]),
                   static_cast<double>(points.areas[i]) * toDouble(flux[i])};
    return made;
}

bool isFolded(const ModelNode& node) {
    // The mean length of unit vectors that are spread over half a sphere.
    constexpr double least_mean = 0.5;
    return node.flux != Rgbf{} && std::min(length(toDouble(node.normal)), length(toDouble(node.wi))) < least_mean;
}

double leastDistance(double area_mm2) { return 0.5 * std::sqrt(area_mm2 / std::numbers::pi); }

Vec3 pointOfEntry(Vec3 position, Vec3 normal, double least_mm, Vec3 xo) {
    const Vec3 offset = position - xo;
    const double r = length(offset);
    if (r >= least_mm) return position;
    if (r > 1e-3 * least_mm) return xo + (least_mm / r) * offset;
    const Vec3 axis = std::abs(normal.x) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    return xo + least_mm * normalize(cross(normal, axis));
}

std::vector<ModelNode> modelNodes(const HeapTree& tree, std::span<const ModelPoint> points, int threads) {
    std::vector<Sums> sums(tree.nodes());
    std::vector<ModelNode> nodes(tree.nodes());
    for (int level = tree.depth; level >= 0; --level) {
        parallelFor(std::size_t{1} << level, threads, [&](std::size_t k) {
            const std::size_t node = (std::size_t{1} << level) + k;
            if (level == tree.depth) {
                for (std::size_t i = tree.first(level, k); i < tree.first(level, k + 1); ++i)
                    sums[node].add(points[tree.order[i]]);
            } else {
                sums[node].add(sums[2 * node]);
                sums[node].add(sums[2 * node + 1]);
            }
            nodes[node] = nodeOf(sums[node]);
        });
    }
    return nodes;
}

}  // namespace searchlight
