// Families of comparisons with exact half-spaces, at any number of walks: quick ones and long ones share them.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "base/csv.h"
#include "base/files.h"
#include "judge.h"
#include "transport/half_space/half_space.h"

namespace searchlight {

inline CsvTable table(const std::string& name) {
    const std::string path = SEARCHLIGHT_SOURCE_DIR "/tests/data/transport/" + name;
    return parseCsv(readFile(path), path);
}

inline std::size_t column(const CsvTable& table, std::string_view name) {
    const auto index = table.find(name);
    EXPECT_TRUE(index.has_value()) << name;
    return index.value_or(0);
}

inline HalfSpaceProblem ofAlbedo(double albedo, double eta = 1, double g = 0) {
    return {.sigma_a = 1 - albedo, .sigma_s = albedo, .g = g, .eta = eta};
}

inline HalfSpaceResult walk(const HalfSpaceProblem& problem, double walks, std::uint64_t seed,
                            std::vector<double> edges = {0, 1}, Estimator estimator = Estimator::analogue) {
    Observer observer;
    HalfSpaceOptions options;
    options.walks = static_cast<std::uint64_t>(walks);
    options.seed = seed;
    options.edges_mm = std::move(edges);
    options.estimator = estimator;
    return walkHalfSpace(problem, options, observer);
}

/// Diffuse reflectance at seven incidence cosines and 24 albedos, index matched.
inline void compareMatchedTotals(Judge& judge, double walks, std::uint64_t seed,
                                 Estimator estimator = Estimator::analogue) {
    const CsvTable exact = table("halfspace_isotropic_matched.csv");
    for (std::size_t row = 0; row < exact.rows.size(); ++row) {
        const double albedo = exact.number(row, column(exact, "albedo"));
        for (const double cosine : {1.0, 0.9, 0.8, 0.7, 0.5, 0.3, 0.1}) {
            HalfSpaceProblem problem = ofAlbedo(albedo);
            problem.angle_deg = std::acos(cosine) * (180 / std::numbers::pi);
            const double truth = exact.number(row, column(exact, fmt::format("R_mu0={:g}", cosine)));
            judge.compare(fmt::format("albedo {}, cosine {}", albedo, cosine),
                          walk(problem, walks, seed++, {0, 1}, estimator).all.total, truth);
        }
    }
}

/// Diffuse reflectance and mirror reflection at normal incidence under a Fresnel surface, eight indices, 16 albedos.
inline void compareRefractiveTotals(Judge& judge, double walks, std::uint64_t seed,
                                    Estimator estimator = Estimator::analogue) {
    const CsvTable exact = table("halfspace_refractive_isotropic.csv");
    for (std::size_t row = 0; row < exact.rows.size(); ++row) {
        const double n = exact.number(row, column(exact, "n")), albedo = exact.number(row, column(exact, "albedo"));
        const HalfSpaceResult result = walk(ofAlbedo(albedo, n), walks, seed++, {0, 1}, estimator);
        EXPECT_NEAR(result.specular, exact.number(row, column(exact, "R_specular")), 1e-10);
        judge.compare(fmt::format("n {}, albedo {}", n, albedo), result.all.total,
                      exact.number(row, column(exact, "R_diffuse")));
    }
}

/// Mean exitance over each annulus of the exact searchlight, three albedos.
inline void compareSearchlight(Judge& judge, double walks, std::uint64_t seed,
                               Estimator estimator = Estimator::analogue) {
    const CsvTable exact = table("searchlight_isotropic_matched.csv");
    for (const double albedo : {0.5, 0.9, 0.99}) {
        std::vector<double> edges = {0}, encircled = {0};
        for (std::size_t row = 0; row < exact.rows.size(); ++row)
            if (exact.number(row, column(exact, "albedo")) == albedo) {
                edges.push_back(exact.number(row, column(exact, "r")));
                encircled.push_back(exact.number(row, column(exact, "F_encircled")));
            }
        const HalfSpaceResult result = walk(ofAlbedo(albedo), walks, seed++, edges, estimator);
        for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
            const double area = std::numbers::pi * (edges[i + 1] * edges[i + 1] - edges[i] * edges[i]);
            const double flux = encircled[i + 1] - encircled[i];
            judge.compare(fmt::format("albedo {}, {} to {}", albedo, edges[i], edges[i + 1]),
                          {result.all.Rd[i], result.all.standard_error[i], result.walks}, flux / area, flux * walks);
        }
    }
}

/// Flux scattered exactly once that leaves within annuli, per unit incident flux, normal incidence. With the depth t
/// and the cosine mu of the way back, r = t tan, the integral over depth is closed ([Habel2013] section 5, unreduced):
/// a T12 int 2 pi p(-mu) T(mu) mu / (1 + mu) [exp(-r0 (1 + mu) / sin) - exp(-r1 (1 + mu) / sin)] dmu.
inline std::vector<double> exactSingle(const HalfSpaceProblem& problem, const std::vector<double>& edges) {
    const double eta = problem.eta, g = problem.g, sigma_t = problem.sigma_a + problem.sigma_s;
    const double critical = eta > 1 ? std::sqrt(1 - 1 / (eta * eta)) : 0.0;
    std::vector<double> flux(edges.size() - 1, 0.0);
    // mu = critical + (1 - critical) q^2 smooths the root in T at the critical cosine; 1 - q = p^2 crowds the points
    // where small radii come from. Midpoint rule: 2e5 points leave 1e-7.
    constexpr int points = 200'000;
    for (int i = 0; i < points; ++i) {
        const double p = (i + 0.5) / points, q = 1 - p * p;
        const double mu = critical + (1 - critical) * q * q;
        const double sine = std::sqrt((1 - mu) * (1 + mu));
        const double outside = std::sqrt(std::max(0.0, 1 - eta * eta * sine * sine));
        const double s = (eta * mu - outside) / (eta * mu + outside), t = (mu - eta * outside) / (mu + eta * outside);
        const double transmitted = 1 - 0.5 * (s * s + t * t);
        const double phase = 0.5 * (1 - g * g) / std::pow(1 + g * g + 2 * g * mu, 1.5);  // 2 pi p(-mu)
        const double weight = phase * transmitted * mu / (1 + mu) * 4 * (1 - critical) * q * p / points;
        const double k = sigma_t * (1 + mu) / sine;
        double inner = std::exp(-edges[0] * k);
        for (std::size_t b = 0; b < flux.size(); ++b) {
            const double outer = std::exp(-edges[b + 1] * k);
            flux[b] += weight * (inner - outer);
            inner = outer;
        }
    }
    const double specular = std::pow((eta - 1) / (eta + 1), 2);
    for (double& f : flux) f *= (1 - specular) * problem.sigma_s / sigma_t;
    return flux;
}

/// Single scattering by annuli against quadrature, for several phase functions and indices, at sigma_t = 2 / mm.
inline void compareSingle(Judge& judge, double walks, std::uint64_t seed) {
    const std::vector<double> edges = {0, 0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2};
    for (const double g : {0.0, 0.001, 0.5, 0.9, 0.99, -0.5})
        for (const double eta : {1.0, 1.3, 1.5, 0.8}) {
            const HalfSpaceProblem problem{.sigma_a = 1, .sigma_s = 1, .g = g, .eta = eta};
            const HalfSpaceResult result = walk(problem, walks, seed++, edges);
            const std::vector<double> exact = exactSingle(problem, edges);
            for (std::size_t i = 0; i < exact.size(); ++i) {
                const double area = std::numbers::pi * (edges[i + 1] * edges[i + 1] - edges[i] * edges[i]);
                judge.compare(fmt::format("g {}, eta {}, {} to {}", g, eta, edges[i], edges[i + 1]),
                              {result.single.Rd[i], result.single.standard_error[i], result.walks}, exact[i] / area,
                              exact[i] * walks);
            }
        }
}

}  // namespace searchlight
