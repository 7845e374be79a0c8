// Families of comparisons of white Monte Carlo, at any number of walks. Numbers from one table are correlated, so only
// the bins of one curve are judged as a family.
#pragma once

#include "exact.h"
#include "transport/white/white.h"

namespace searchlight {

inline WhiteTable whiteTable(WhiteKey key, double walks, std::uint64_t seed) {
    Observer observer;
    key.walks = static_cast<std::uint64_t>(walks);
    key.seed = seed;
    return buildWhiteTable(key, 0, observer);
}

/// Diffuse reflectance at normal incidence for every albedo up to the largest, from one table.
inline void compareWhiteTotals(double walks, std::uint64_t seed) {
    const WhiteTable white = whiteTable({}, walks, seed);
    const CsvTable exact = table("halfspace_isotropic_matched.csv");
    const std::vector<double> edges = {0, 1};
    int count = 0;
    double mean_square = 0;
    for (std::size_t row = 0; row < exact.rows.size(); ++row) {
        const double albedo = exact.number(row, column(exact, "albedo"));
        if (albedo > kWhiteLargestAlbedo) continue;
        const Estimate total = evaluateWhite(white, 1 - albedo, albedo, edges).all.total;
        const double z = (total.mean - exact.number(row, column(exact, "R_mu0=1"))) / total.standard_error;
        EXPECT_LT(std::abs(z), normalQuantile(0.0005 / 24)) << "albedo " << albedo << ", " << total.mean;
        mean_square += z * z;
        ++count;
    }
    EXPECT_GE(count, 22);
    testing::Test::RecordProperty("mean_z2", std::to_string(mean_square / count));
}

/// Mean exitance over each annulus of the exact searchlight, three albedos from one table.
inline void compareWhiteSearchlight(double walks, std::uint64_t seed) {
    const WhiteTable white = whiteTable({}, walks, seed);
    const CsvTable exact = table("searchlight_isotropic_matched.csv");
    for (const double albedo : {0.5, 0.9, 0.99}) {
        std::vector<double> edges = {0}, encircled = {0};
        for (std::size_t row = 0; row < exact.rows.size(); ++row)
            if (exact.number(row, column(exact, "albedo")) == albedo) {
                edges.push_back(exact.number(row, column(exact, "r")));
                encircled.push_back(exact.number(row, column(exact, "F_encircled")));
            }
        const HalfSpaceResult result = evaluateWhite(white, 1 - albedo, albedo, edges);
        Judge judge;
        for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
            const double area = std::numbers::pi * (edges[i + 1] * edges[i + 1] - edges[i] * edges[i]);
            const double flux = encircled[i + 1] - encircled[i];
            if (flux < 1e-6) continue;  // the table has eight digits
            judge.compare(fmt::format("albedo {}, {} to {}", albedo, edges[i], edges[i + 1]),
                          {result.all.Rd[i], result.all.standard_error[i], result.walks}, flux / area, flux * walks);
        }
        judge.expectAgreement();
    }
}

/// Curves of measured materials, oblique and forward scattering media against the analogue walk, all three orders.
inline void compareWhiteWithWalk(double walks, std::uint64_t seed) {
    const HalfSpaceProblem problems[] = {
        {.sigma_a = 0.0021, .sigma_s = 2.19, .eta = 1.5},  // marble
        {.sigma_a = 0.0071, .sigma_s = 3, .eta = 1.5},
        {.sigma_a = 0.032, .sigma_s = 0.74, .eta = 1.3},  // skin1
        {.sigma_a = 0.48, .sigma_s = 1.01, .eta = 1.3},
        {.sigma_a = 0.061, .sigma_s = 0.18, .eta = 1.3},  // ketchup
        {.sigma_a = 1.45, .sigma_s = 0.03, .eta = 1.3},
        {.sigma_a = 0.1, .sigma_s = 5, .g = 0.8, .eta = 1.4, .angle_deg = 60},
        {.sigma_a = 1, .sigma_s = 1, .g = -0.3, .eta = 1, .angle_deg = 30},
    };
    WhiteKey key;
    WhiteTable white;
    for (const HalfSpaceProblem& problem : problems) {
        const WhiteKey needed{problem.g, problem.eta, problem.angle_deg, 0, 0};
        if (white.shift[0].empty() || !(needed == key)) white = whiteTable(key = needed, walks, ++seed);
        const double mfp = 1 / (problem.sigma_a + (1 - problem.g) * problem.sigma_s);
        std::vector<double> edges;
        for (int i = 0; i <= 20; ++i) edges.push_back(0.02 * i * i * mfp);
        const HalfSpaceResult a = evaluateWhite(white, problem.sigma_a, problem.sigma_s, edges),
                              b = walk(problem, walks, ++seed, edges);
        EXPECT_EQ(a.specular, b.specular);
        const std::string what = fmt::format("sigma_a {}, sigma_s {}", problem.sigma_a, problem.sigma_s);
        Judge judge;
        const auto compare = [&](const std::string& name, Estimate x, Estimate y, double exits = 1e9) {
            judge.compare(what + name, {x.mean, std::hypot(x.standard_error, y.standard_error), 0}, y.mean, exits);
        };
        for (HalfSpaceTally HalfSpaceResult::*order : {&HalfSpaceResult::single, &HalfSpaceResult::multiple}) {
            const HalfSpaceTally &x = a.*order, &y = b.*order;
            compare(" total", x.total, y.total);
            for (std::size_t i = 0; i < x.Rd.size(); ++i) {
                const double exits = std::pow(y.Rd[i] / y.standard_error[i], 2);
                compare(fmt::format(" bin {}", i), {x.Rd[i], x.standard_error[i], 0}, {y.Rd[i], y.standard_error[i], 0},
                        exits);
            }
        }
        compare(" x", a.all.mean_x_mm, b.all.mean_x_mm);
        compare(" r2", a.all.mean_r2_mm2, b.all.mean_r2_mm2);
        compare(" all", a.all.total, b.all.total);
        judge.expectAgreement();
    }
}

}  // namespace searchlight
