// A hare that sits up and listens: ears thin enough to glow, folds between its limbs, a plinth with flat faces.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/box_charts.h"
#include "geometry/objects/objects.h"
#include "geometry/polygonise.h"

namespace searchlight {

namespace {

// Distances are negative inside. Those of squashed shapes are exact only near the surface.

double clamp01(double x) { return std::clamp(x, 0.0, 1.0); }

// Union with a fillet of about radius k, and the same for an intersection; [Quilez2013], cubic.
double blend(double a, double b, double k) {
    const double h = std::max(k - std::abs(a - b), 0.0) / k;
    return std::min(a, b) - h * h * h * k / 6;
}
double blendedIntersection(double a, double b, double k) { return -blend(-a, -b, k); }

Vec3 turnX(Vec3 p, double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    return {p.x, c * p.y - s * p.z, s * p.y + c * p.z};
}
Vec3 turnY(Vec3 p, double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    return {c * p.x + s * p.z, p.y, -s * p.x + c * p.z};
}
Vec3 turnZ(Vec3 p, double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    return {c * p.x - s * p.y, s * p.x + c * p.y, p.z};
}

double ellipsoid(Vec3 p, Vec3 radii) {
    const Vec3 q{p.x / radii.x, p.y / radii.y, p.z / radii.z};
    const Vec3 slope{q.x / radii.x, q.y / radii.y, q.z / radii.z};
    const double size = length(q), steep = length(slope);
    return steep > 1e-9 ? size * (size - 1) / steep : -std::min({radii.x, radii.y, radii.z});
}

// From a to b, with the radius going from ra to rb.
double limb(Vec3 p, Vec3 a, Vec3 b, double ra, double rb) {
    const Vec3 axis = b - a;
    const double t = clamp01(dot(p - a, axis) / dot(axis, axis));
    return length(p - a - t * axis) - (ra + t * (rb - ra));
}

double roundedBox(Vec3 p, Vec3 half, double radius) {
    const Vec3 q{std::abs(p.x) - half.x + radius, std::abs(p.y) - half.y + radius, std::abs(p.z) - half.z + radius};
    const Vec3 beyond{std::max(q.x, 0.0), std::max(q.y, 0.0), std::max(q.z, 0.0)};
    return length(beyond) + std::min(std::max({q.x, q.y, q.z}), 0.0) - radius;
}

// A leaf from the origin up y, hollow towards +z, at most `width` to either side.
double ear(Vec3 p, double height, double width, double half_thickness) {
    const double t = clamp01(p.y / height);
    // Widest a little above the middle, narrow at the root, pointed at the tip.
    const double half = width * std::pow(std::sin(std::numbers::pi * std::pow(0.06 + 0.94 * t, 0.85)), 0.8) + 0.006;
    const double s = std::min(std::abs(p.x) / half, 1.2);
    // The rims curl forward, and the leaf leans back towards its tip.
    const double lean = 0.16 * height * t * t;
    const double middle = 0.65 * half * s * s - lean;
    const double bend = 1 / std::sqrt(1 + 1.69 * s * s + 0.1 * t * t);
    const double sheet = std::abs(p.z - middle) * bend - half_thickness * (1.15 - 0.15 * s * s);
    // Cut square to the sheet, whose slope at the rim is 1.3: a slanting cut would be a knife's edge.
    const double rim = (std::abs(p.x) - half + 1.3 * (p.z - (0.65 * half - lean))) / std::sqrt(1 + 1.69);
    const double outline = std::max(rim, std::max(p.y - height, -p.y));
    return blendedIntersection(sheet, outline, 2.5 * half_thickness);
}

// A groove of depth 1 in the middle, that ends where |x| is 1.
double groove(double x) {
    const double inside = std::max(0.0, 1 - x * x);
    return inside * inside;
}

double smoothStep(double from, double to, double x) {
    const double t = clamp01((x - from) / (to - from));
    return t * t * (3 - 2 * t);
}

// Locks of fur that sweep down from the nape to the chest.
double ruff(Vec3 p) {
    const double mask = smoothStep(0.33, 0.42, p.y) * (1 - smoothStep(0.475, 0.535, p.y));
    if (mask == 0) return 0;
    const double around = std::atan2(std::abs(p.x), p.z);
    const double phase = 9 * around / std::numbers::pi + 16 * (p.y - 0.4) + 0.45 * std::sin(2 * around);
    return 0.0085 * mask * groove(2.6 * (phase - std::round(phase)));
}

// A spiral that winds into the haunch.
double whorl(Vec3 p) {
    const double r = std::hypot(p.y, 0.92 * p.z);
    if (r > 0.12) return 0;
    const double angle = std::atan2(p.y, -p.z) / (2 * std::numbers::pi);
    const double phase = r / 0.042 - angle;
    const double mask = smoothStep(0.004, 0.02, r) * (1 - smoothStep(0.075, 0.112, r));
    return 0.008 * mask * groove(3.2 * (phase - std::round(phase)));
}

double bodyOf(Vec3 p) {
    const Vec3 m{std::abs(p.x), p.y, p.z};
    double torso = ellipsoid(turnX(p - Vec3{0, 0.27, -0.06}, -0.30), {0.122, 0.205, 0.145});
    torso = blend(torso, ellipsoid(p - Vec3{0, 0.35, 0.025}, {0.09, 0.13, 0.085}), 0.08);
    torso = blend(torso, limb(p, {0, 0.40, 0.015}, {0, 0.58, 0.045}, 0.085, 0.06), 0.07);
    torso += ruff(p);
    // Narrow fillets: the folds around the limbs stay deep.
    const Vec3 h = turnX(m - Vec3{0.105, 0.175, -0.07}, 0.25);
    const double haunch = ellipsoid(h, {0.064, 0.115, 0.128}) + whorl(h);
    double body = blend(torso, haunch, 0.018);
    body = blend(body, limb(m, {0.118, 0.088, -0.10}, {0.124, 0.082, 0.115}, 0.032, 0.025), 0.02);
    body = blend(body, limb(m, {0.055, 0.31, 0.06}, {0.046, 0.10, 0.125}, 0.045, 0.023), 0.022);
    body = blend(body, ellipsoid(m - Vec3{0.046, 0.081, 0.145}, {0.026, 0.022, 0.042}), 0.015);
    body = blend(body, ellipsoid(p - Vec3{0, 0.15, -0.222}, {0.048, 0.052, 0.05}), 0.02);
    return body;
}

// Of the head, whose nose points along +z.
double headOf(Vec3 p) {
    const Vec3 m{std::abs(p.x), p.y, p.z};
    double head = ellipsoid(p, {0.068, 0.070, 0.090});
    head = blend(head, ellipsoid(p - Vec3{0, -0.022, 0.078}, {0.040, 0.038, 0.050}), 0.06);
    head = blend(head, ellipsoid(m - Vec3{0.034, -0.026, 0.030}, {0.036, 0.038, 0.048}), 0.03);
    head = blend(head, ellipsoid(p - Vec3{0, -0.008, 0.122}, {0.017, 0.011, 0.011}), 0.012);
    // Almond eyes, each in a groove of its own.
    const Vec3 eye = turnZ(turnY(m - Vec3{0.0535, 0.009, 0.043}, 0.42), 0.12);
    const double almond = ellipsoid(eye, {0.0135, 0.0175, 0.027});
    head = blend(head, almond + 0.0015, 0.004) + 0.005 * groove((almond - 0.004) / 0.007);
    return head;
}

double hare(Vec3 p, double half_thickness) {
    // Lower bounds stand in for what is too far away to matter.
    const double above = p.y - 0.72, below = 0.60 - p.y;
    double body = above > 0.05 ? above : bodyOf(p);
    // The head is turned a little.
    const Vec3 h = turnX(turnY(p - Vec3{0, 0.61, 0.06}, -0.30), -0.20);
    if (above <= 0.05) body = blend(body, below > 0.12 ? below - 0.05 : headOf(h), 0.045);
    if (below > 0.05) {
        body = std::min(body, below);
    } else {
        const Vec3 left = turnZ(turnX(turnY(h - Vec3{0.031, 0.050, -0.025}, -0.40), 0.20), 0.27);
        const Vec3 right = turnZ(turnX(turnY(h - Vec3{-0.031, 0.050, -0.025}, 0.70), 0.34), -0.36);
        const double ears = std::min(ear(left, 0.35, 0.052, half_thickness), ear(right, 0.35, 0.052, half_thickness));
        body = blend(body, ears, 0.022);
    }
    const double plinth = roundedBox(p - Vec3{0, 0.03, -0.03}, {0.185, 0.03, 0.245}, 0.006);
    return blend(plinth, body, 0.008);
}

}  // namespace

Mesh statueObject(double resolution) {
    const double cell = 0.0065 / resolution;
    // Half the thickness of an ear: what a coarse grid still sees.
    const double half_thickness = std::max(0.0056, 0.9 * cell);
    return boxCharts(
        polygonise([&](Vec3 p) { return hare(p, half_thickness); },
                   {.low = {-0.30, -0.03, -0.36}, .high = {0.30, 1.10, 0.32}, .cell = cell, .lipschitz = 1.5}));
}

}  // namespace searchlight
