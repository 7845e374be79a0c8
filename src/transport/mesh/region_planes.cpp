#include "transport/mesh/region_planes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace searchlight {

namespace {

// Tried for each cell: how far, in mean free paths, a ball reaches beyond the cell, and how far a plane is moved back
// for one more triangle rather than that another plane is spent on it.
constexpr std::array kReaches{1.0, 2.0};
constexpr std::array kTolerances{0.1, 0.3};

// Length of a triangle that asks for its own plane, in mean free paths.
constexpr double kWide = 2;

// Of what a plane is moved back by, in cells: positions are rounded.
constexpr double kMargin = 1e-3;

constexpr std::size_t kDirections = 32;

// Evenly over the sphere, along a spiral.
std::array<Vec3, kDirections> evenDirections() {
    std::array<Vec3, kDirections> directions;
    for (std::size_t i = 0; i < kDirections; ++i) {
        const double z = 1 - (2.0 * static_cast<double>(i) + 1) / kDirections, ring = std::sqrt(1 - z * z),
                     turn = std::numbers::pi * (3 - std::sqrt(5.0)) * static_cast<double>(i);
        directions[i] = {ring * std::cos(turn), ring * std::sin(turn), z};
    }
    return directions;
}

// A unit normal as the walks know it.
Vec3 quantized(Vec3 n) {
    return {std::round(CutBall::kNormal * n.x), std::round(CutBall::kNormal * n.y), std::round(CutBall::kNormal * n.z)};
}

double lowest(const std::array<Vec3, 3>& corners, Vec3 n) {
    return std::min({dot(n, corners[0]), dot(n, corners[1]), dot(n, corners[2])});
}

}  // namespace

CutBallChooser::CutBallChooser(const NearTriangles& triangles, double cell, double mfp)
    : triangles_(triangles), cell_(cell), mfp_(mfp), half_diagonal_(0.5 * std::sqrt(3.0) * cell) {}

// Takes the triangles one by one, the nearest first; what no plane leaves out moves a plane back, or asks for a further
// one. Where there is none, the ball ends.
CutBall CutBallChooser::cut(double radius, double tolerance, Vec3 inside) const {
    CutBall region;
    region.radius = radius;
    std::array<double, CutBall::kMostPlanes> heights{};  // of the point inside
    const double least = 0.02 * CutBall::kNormal * mfp_, most = CutBall::kNormal * tolerance * mfp_;
    for (const Triangle& triangle : near_) {
        if (triangle.distance >= radius) break;
        double loss = std::numeric_limits<double>::infinity(), to = 0;
        int best = -1;
        for (int i = 0; i < region.planes; ++i) {
            const double low = lowest(triangle.corners, region.normals[i]), lost = region.offsets[i] - low;
            if (lost < loss && (lost <= 0 || low - heights[i] > least)) loss = lost, to = low, best = i;
        }
        if (loss <= 0) continue;
        if (loss > most && region.planes < CutBall::kMostPlanes) {
            const double low = lowest(triangle.corners, triangle.normal), height = dot(triangle.normal, inside);
            if (low - height > least) {
                region.normals[region.planes] = triangle.normal;
                region.offsets[region.planes] = low;
                heights[region.planes++] = height;
                continue;
            }
        }
        if (best < 0) {
            region.radius = triangle.distance;
            break;
        }
        region.offsets[best] = to;
    }
    for (int i = 0; i < region.planes; ++i) region.offsets[i] -= CutBall::kNormal * kMargin * cell_;
    region.radius -= kMargin * cell_;
    return region;
}

// The part of flights from a point that leave the region.
double CutBallChooser::uncleared(const CutBall& region, Vec3 from) const {
    static const std::array directions = evenDirections();
    const double square = region.radius * region.radius - dot(from, from);
    if (!(region.radius > 0 && square > 0)) return 1;
    std::array<double, CutBall::kMostPlanes> rest{};
    for (int i = 0; i < region.planes; ++i) rest[i] = region.offsets[i] - dot(region.normals[i], from);
    double sum = 0;
    for (const Vec3& direction : directions) {
        const double b = dot(from, direction);
        double reach = std::sqrt(b * b + square) - b;
        for (int i = 0; i < region.planes; ++i) {
            const double up = dot(region.normals[i], direction);
            if (up * reach > rest[i]) reach = std::max(rest[i], 0.0) / up;
        }
        const double x = reach / mfp_;
        sum += 1 / (1 + x * (1 + x * (0.5 + x / 6)));  // about exp(-x)
    }
    return sum / kDirections;
}

CutBall CutBallChooser::choose(Vec3 middle, double bound) {
    const double furthest = half_diagonal_ + kReaches.back() * mfp_;
    triangles_.find(middle, furthest, found_);
    std::ranges::sort(found_, {}, &NearTriangles::Near::distance);
    near_.clear();
    Vec3 sum;
    for (const auto& [t, distance] : found_) {
        const auto [a, b, c] = triangles_.corners(t);
        const Vec3 own = triangles_.normal(t);
        // What is longer than a flight is a plane of its own; of smaller ones several share a plane.
        const bool wide = std::max({length(b - a), length(c - b), length(a - c)}) > kWide * mfp_ && length(own) > 0;
        near_.push_back({distance,
                         {a - middle, b - middle, c - middle},
                         quantized(wide ? normalize(own) : triangles_.smoothNormal(t))});
        if (distance < half_diagonal_) sum = sum + triangles_.normal(t);
    }
    // A point of the cell that is well inside, where the cell holds surface.
    Vec3 inside;
    if (length(sum) > 0) {
        const Vec3 n = normalize(sum);
        double low = half_diagonal_;
        for (const Triangle& triangle : near_)
            if (triangle.distance < half_diagonal_) low = std::min(low, lowest(triangle.corners, n));
        inside = std::min(0.0, 0.5 * (low - half_diagonal_)) * n;
    }
    CutBall best;
    if (bound > 0) best.radius = bound + half_diagonal_ - kMargin * cell_;
    double least = uncleared(best, inside);
    for (const double reach : kReaches)
        for (const double tolerance : kTolerances) {
            const CutBall region = cut(half_diagonal_ + reach * mfp_, tolerance, inside);
            const double missed = uncleared(region, inside);
            if (missed < least) least = missed, best = region;
        }
    return best;
}

}  // namespace searchlight
