#include "model/plane_means.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "model/physics.h"

namespace searchlight {

namespace {

constexpr double pi = std::numbers::pi;

struct Node {
    double x, weight;  // of [0, 1]
};

// Gauss-Legendre with 3 points.
constexpr double outermost = 0.3872983346207417;  // sqrt(15) / 10
constexpr std::array<Node, 3> rule{{{0.5 - outermost, 5.0 / 18}, {0.5, 8.0 / 18}, {0.5 + outermost, 5.0 / 18}}};

struct Points {
    std::vector<Vec3> at;
    std::vector<double> weight;  // parts of its cell
};

void addNodes(const PlaneCell& cell, double part, Points& points) {
    for (const Node& u : rule)
        for (const Node& v : rule) {
            points.at.push_back({cell.x0 + u.x * (cell.x1 - cell.x0), cell.y0 + v.x * (cell.y1 - cell.y0), 0});
            points.weight.push_back(part * u.weight * v.weight);
        }
}

// Towards the entry point R_d changes within its own distance: a piece may be half as long as it is far.
void addPieces(const PlaneCell& cell, double part, int halvings, Points& points) {
    const double dx = std::max({cell.x0, -cell.x1, 0.0}), dy = std::max({cell.y0, -cell.y1, 0.0});
    const double width = cell.x1 - cell.x0, height = cell.y1 - cell.y0;
    // 14 halvings, 2^-14 of the area: what is left at the entry point itself.
    if (std::hypot(width, height) <= 0.5 * std::hypot(dx, dy) || halvings == 0) return addNodes(cell, part, points);
    PlaneCell a = cell, b = cell;
    if (width > height)
        a.x1 = b.x0 = 0.5 * (cell.x0 + cell.x1);
    else
        a.y1 = b.y0 = 0.5 * (cell.y0 + cell.y1);
    addPieces(a, 0.5 * part, halvings - 1, points);
    addPieces(b, 0.5 * part, halvings - 1, points);
}

}  // namespace

std::vector<Rgb> cellMeans(Evaluator& evaluator, const Model& model, const Medium& medium, double angle_deg,
                           std::span<const PlaneCell> cells) {
    constexpr int halvings = 14;
    Points points;
    std::vector<std::size_t> ends;
    for (const PlaneCell& cell : cells) {
        addPieces(cell, 1, halvings, points);
        ends.push_back(points.at.size());
    }
    const std::vector<Rgb> Rd = planeRd(evaluator, model, medium, angle_deg, points.at);
    std::vector<Rgb> means(cells.size());
    for (std::size_t i = 0, cell = 0; i < Rd.size(); ++i) {
        while (i >= ends[cell]) ++cell;
        means[cell] = means[cell] + points.weight[i] * Rd[i];
    }
    return means;
}

PlaneMoments planeMoments(Evaluator& evaluator, const Model& model, const Medium& medium, double angle_deg) {
    // From 1e-6 of the shortest mean free path to 60 of the longest decay length, or 1e4 mean free paths without one.
    double from = INFINITY, to = 0;
    for (int c = 0; c < Rgb::channels; ++c) {
        if (!medium.scatters(c)) continue;
        const double sigma_tp = medium.sigmaTp()[c], sigma_tr = std::sqrt(3 * medium.sigma_a[c] * sigma_tp);
        from = std::min({from, 1e-6 / sigma_tp, 1e-8});
        to = std::max({to, sigma_tr > 0 ? 60 / sigma_tr : 0.0, 1e4 / sigma_tp});
    }
    constexpr double step = 0.05;
    constexpr int azimuths = 64;
    const bool radial = model.file.radial || angle_deg == 0;
    // Half a turn is enough: the plane of incidence is a mirror. Midpoints of a smooth periodic function converge
    // exponentially.
    std::vector<Vec3> points;
    std::vector<double> weights;
    for (double u = std::log(from); u < std::log(to); u += step) {
        const double r = std::exp(u);
        for (int k = 0; k < (radial ? 1 : azimuths); ++k) {
            const double phi = radial ? 0.5 * pi : pi * (k + 0.5) / azimuths;
            points.push_back({r * std::cos(phi), r * std::sin(phi), 0});
            weights.push_back(2 * pi * r * r * step / (radial ? 1 : azimuths));
        }
    }
    const std::vector<Rgb> Rd = planeRd(evaluator, model, medium, angle_deg, points);
    PlaneMoments moments;
    for (std::size_t i = 0; i < Rd.size(); ++i) {
        const Rgb flux = weights[i] * Rd[i];
        moments.total = moments.total + flux;
        if (!radial) moments.mean_x = moments.mean_x + points[i].x * flux;
        moments.mean_r2 = moments.mean_r2 + dot(points[i], points[i]) * flux;
    }
    moments.mean_x = moments.mean_x / moments.total;
    moments.mean_r2 = moments.mean_r2 / moments.total;
    for (int c = 0; c < Rgb::channels; ++c)
        if (readsMedium(model) && !(medium.sigma_a[c] > 0))
            moments.mean_r2[c] = std::numeric_limits<double>::quiet_NaN();
    return moments;
}

std::vector<Rgb> sectorRadiance(Evaluator& evaluator, const Medium& medium, double angle_deg, const PlaneSector& sector,
                                int polar, int turns) {
    // Equal parts of the sector's area.
    std::vector<Vec3> points;
    std::vector<double> parts;
    for (const Node& u : rule)
        for (const Node& v : rule) {
            const double r = std::sqrt(std::lerp(sector.r0_mm * sector.r0_mm, sector.r1_mm * sector.r1_mm, u.x));
            const double phi = (sector.azimuth_deg + (2 * v.x - 1) * sector.half_width_deg) * pi / 180;
            points.push_back({r * std::cos(phi), r * std::sin(phi), 0});
            parts.push_back(u.weight * v.weight);
        }
    const double normalizer = pi * (1 - 2 * Physics<double>::fresnelMoment(1, 1 / medium.eta));
    const Vec3 up{0, 0, 1}, wi = pencilBeam(medium.eta, angle_deg).wi;

    std::vector<Query> queries;
    std::vector<double> weights;
    std::vector<std::size_t> cells;
    std::vector<Rgb> radiance(static_cast<std::size_t>(polar) * static_cast<std::size_t>(turns));
    for (int i = 0; i < polar; ++i) {
        const double theta0 = 0.5 * pi * i / polar, theta1 = 0.5 * pi * (i + 1) / polar;
        const double cosines = 0.5 * (std::pow(std::sin(theta1), 2) - std::pow(std::sin(theta0), 2));
        for (const Node& u : rule) {
            const double theta = std::lerp(theta0, theta1, u.x), mu = std::cos(theta), sine = std::sin(theta);
            const double transmitted = 1 - Physics<double>::fresnelReflectance(mu, 1 / medium.eta);
            const double weight = u.weight * (theta1 - theta0) * sine * mu / cosines * transmitted / normalizer;
            for (int j = 0; j < turns; ++j)
                for (const Node& v : rule) {
                    const double phi = 2 * pi * (j + v.x) / turns;
                    const Vec3 wo{sine * std::cos(phi), sine * std::sin(phi), mu};
                    for (std::size_t p = 0; p < points.size(); ++p) {
                        queries.push_back({{}, wi, up, points[p], wo, up});
                        weights.push_back(weight * v.weight * parts[p]);
                        cells.push_back(static_cast<std::size_t>(i * turns + j));
                    }
                }
        }
    }
    std::vector<Rgb> values(queries.size());
    evaluator.evaluate(queries, values);
    for (std::size_t i = 0; i < values.size(); ++i) radiance[cells[i]] = radiance[cells[i]] + weights[i] * values[i];
    return radiance;
}

}  // namespace searchlight
