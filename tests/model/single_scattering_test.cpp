// The models of single scattering against their definition, exact tables and closed forms.
#include <gtest/gtest.h>

#include "model/physics.h"
#include "models.h"
#include "transport/half_space/half_space.h"
#include "transport/half_space/single_scattering.h"
#include "transport/judge.h"

namespace searchlight {
namespace {

// Midpoints: the integrands below are smooth where they do not vanish like a root.
template <class F>
double integral(double from, double to, int n, F&& f) {
    double sum = 0;
    for (int i = 0; i < n; ++i) sum += f(std::lerp(from, to, (i + 0.5) / n));
    return sum * (to - from) / n;
}

// Simpson's rule, halved where it and its halves differ.
template <class F>
double adaptive(F&& f, double a, double b, double fa, double fm, double fb, double error, int depth) {
    const double m = 0.5 * (a + b), left = f(0.5 * (a + m)), right = f(0.5 * (m + b));
    const double whole = (b - a) / 6 * (fa + 4 * fm + fb);
    const double halves = (b - a) / 12 * (fa + 4 * left + 2 * fm + 4 * right + fb);
    if (depth == 0 || std::abs(halves - whole) <= 15 * error) return halves + (halves - whole) / 15;
    return adaptive(f, a, m, fa, left, fm, 0.5 * error, depth - 1) +
           adaptive(f, m, b, fm, right, fb, 0.5 * error, depth - 1);
}

struct Place {
    Vec3 xo, no{0, 0, 1};
};

// What a model answers in its first channel.
double valueAt(const LoadedModel& loaded, double angle_deg, const Place& place) {
    const Query query{{}, pencilBeam(loaded.medium.eta, angle_deg).wi, {0, 0, 1}, place.xo, {0, 0, 1}, place.no};
    Rgb value;
    loaded.evaluator->evaluate({&query, 1}, {&value, 1});
    return value.r;
}

// The definition: where on the refracted beam light is scattered, summed over the length of the way.
double definition(const Medium& medium, double angle_deg, const Place& place) {
    const double sine = std::sin(angle_deg * pi / 180) / medium.eta;
    const Vec3 w{sine, 0, -std::sqrt(1 - sine * sine)};
    const double sigma_t = medium.sigma_a.r + medium.sigma_s.r, g = medium.g.r;
    const auto integrand = [&](double t) {
        const Vec3 to_exit = place.xo - t * w;
        const double d = length(to_exit), mu = dot(to_exit, place.no) / d;
        if (mu <= 0) return 0.0;
        return medium.sigma_s.r * std::exp(-sigma_t * (t + d)) / (d * d) *
               Physics<double>::henyeyGreenstein(dot(w, to_exit) / d, g) *
               (1 - Physics<double>::fresnelReflectance(mu, medium.eta)) * mu;
    };
    // t = exp(v) resolves every scale down to 1e-8 of the distance.
    const double r = length(place.xo), from = std::log(1e-8 * r), to = std::log(40 / sigma_t + 10 * r);
    const auto f = [&](double v) { return integrand(std::exp(v)) * std::exp(v); };
    constexpr int panels = 1000;
    const double coarse = integral(from, to, panels, f);
    double sum = 0;
    for (int i = 0; i < panels; ++i) {
        const double a = std::lerp(from, to, i / double(panels)), b = std::lerp(from, to, (i + 1) / double(panels));
        sum += adaptive(f, a, b, f(a), f(0.5 * (a + b)), f(b), 1e-7 * coarse / panels, 16);
    }
    return sum;
}

struct Setting {
    double g, eta, angle_deg;
};
const std::vector<Setting>& settings() {
    static const std::vector<Setting> all = {{0, 1, 0},      {0, 1.3, 0},    {0.9, 1.5, 0},  {-0.5, 1.3, 0},
                                             {0.5, 0.75, 0}, {0, 1, 60},     {0.8, 1.3, 45}, {0.5, 1.5, 80},
                                             {-0.3, 2, 70},  {0.9, 1.1, 85}, {0, 0.75, 30},  {0.99, 1.4, 60}};
    return all;
}

Medium mediumOf(const Setting& setting) { return grey(0.2, 1.8, setting.g, setting.eta); }

// The rule errs by less than 1e-5 to ten mean free paths and by 1e-4 to thirty, where 1e-13 and less is left; the
// definition by less than 1e-6. Sideways of grazing beams as little is left earlier.
TEST(SingleScattering, IsTheIntegralAlongTheBeamOnAPlane) {
    for (const Setting& setting : settings()) {
        const LoadedModel loaded = load("single", mediumOf(setting));
        for (const double r : {5e-4, 0.01, 0.1, 1.0, 4.0, 15.0})
            for (const double azimuth : {0.0, 1.0, pi / 2, 2.5, pi}) {
                const Place place{{r * std::cos(azimuth), r * std::sin(azimuth), 0}};
                const double expected = definition(loaded.medium, setting.angle_deg, place);
                if (r * r * expected < 1e-18) continue;
                EXPECT_NEAR(valueAt(loaded, setting.angle_deg, place), expected, (r < 5 ? 2e-5 : 1e-4) * expected)
                    << "g " << setting.g << " eta " << setting.eta << ", " << setting.angle_deg << " deg, r " << r
                    << ", azimuth " << azimuth;
            }
    }
}

// Above, below and beside the plane, with normals of their own: the critical angle may cut off the near part of the
// beam, the far part, both or all.
TEST(SingleScattering, IsTheIntegralAlongTheBeamOnACurvedSurface) {
    int lit = 0;
    for (const Setting& setting : settings()) {
        const LoadedModel loaded = load("single", mediumOf(setting));
        for (const Vec3 xo : {Vec3{0.3, 0.2, -0.4}, Vec3{-0.5, 0.1, -1}, Vec3{0.2, 0.6, 0.1}, Vec3{0.01, 0, -1.5}})
            for (const Vec3 no :
                 {Vec3{0, 0, 1}, Vec3{1, 0, 0}, Vec3{0.6, -0.48, -0.64}, Vec3{0, 0.28, -0.96}, Vec3{-0.8, 0, 0.6}}) {
                const Place place{xo, no};
                const double expected = definition(loaded.medium, setting.angle_deg, place);
                lit += expected > 0;
                // 1e-4: where light needs a long way before it may leave, the rule has fewer points for it.
                EXPECT_NEAR(valueAt(loaded, setting.angle_deg, place), expected, 1e-4 * expected + 1e-12)
                    << "g " << setting.g << " eta " << setting.eta << ", " << setting.angle_deg << " deg, xo " << xo.x
                    << " " << xo.y << " " << xo.z << " no " << no.x << " " << no.y << " " << no.z;
            }
    }
    EXPECT_GT(lit, 100);
}

// Exact to 9 digits: tests/data says how.
TEST(SingleScattering, IsThatOfTheExactSolutionWithoutRefraction) {
    const CsvTable exact = table("transport/searchlight_isotropic_matched.csv");
    for (std::size_t i = 0; i < exact.rows.size(); ++i) {
        const double albedo = exact.number(i, 0), r = exact.number(i, 1);
        const double expected = exact.number(i, 3);
        EXPECT_NEAR(load("single", ofAlbedo(albedo, 1)).Rd(r), expected, 1e-5 * expected) << albedo << " at " << r;
    }
}

TEST(SingleScattering, HasTheTotalOfTheReference) {
    for (const double eta : {0.75, 1.0, 1.3, 1.5})
        for (const double g : {-0.5, 0.0, 0.5, 0.9}) {
            const LoadedModel loaded = load("single", grey(0.2, 1.8, g, eta));
            const double expected = singleScattering({.absorbed = 0.1, .g = g, .eta = eta}, {}).total;
            EXPECT_NEAR(loaded.total(), expected, 1e-5 * expected) << "eta " << eta << " g " << g;
        }
}

// Both per incident light; a tally is a mean over its annulus.
TEST(SingleScattering, IsWhatWalksLeaveAfterOneCollision) {
    Judge judge;
    for (const Setting& setting : {Setting{0.8, 1.3, 0}, Setting{0.8, 1.3, 60}, Setting{-0.3, 1, 45}}) {
        const LoadedModel loaded = load("single", grey(0.5, 2.5, setting.g, setting.eta));
        HalfSpaceOptions options;
        options.walks = 1'000'000;
        options.edges_mm = {0, 0.05, 0.1, 0.2, 0.4, 0.8, 1.6};
        Observer observer;
        const HalfSpaceResult walked =
            walkHalfSpace(halfSpaceProblem(loaded.medium, 0, setting.angle_deg), options, observer);
        const double entry = pencilBeam(setting.eta, setting.angle_deg).transmittance;
        const std::vector<Rgb> means =
            annulusMeans(*loaded.evaluator, loaded.model, loaded.medium, setting.angle_deg, options.edges_mm);
        const std::string where = "g " + std::to_string(setting.g) + ", deg " + std::to_string(setting.angle_deg);
        for (std::size_t i = 0; i < means.size(); ++i)
            judge.compare(where, {walked.single.Rd[i], walked.single.standard_error[i], 1}, entry * means[i].r);
        judge.compare(where, walked.single.total,
                      entry * totalRd(*loaded.evaluator, loaded.model, loaded.medium, setting.angle_deg).r);
    }
    judge.expectAgreement();
}

// Light comes down at the cosine mu_i and goes up at mu: of every path the part mu / (mu + mu_i) leaves, wherever that
// is.
double obliqueTotal(const Medium& medium, double angle_deg) {
    const double sine = std::sin(angle_deg * pi / 180) / medium.eta, mu_i = std::sqrt(1 - sine * sine);
    const double critical = medium.eta > 1 ? std::sqrt(1 - 1 / (medium.eta * medium.eta)) : 0;
    // mu = critical + (1 - critical) q^2 smooths the root of the transmittance.
    const double sum = integral(0, 1, 2000, [&](double q) {
        const double mu = critical + (1 - critical) * q * q, s = std::sqrt(1 - mu * mu);
        const double phase = integral(0, pi, 400, [&](double phi) {
            return 2 * Physics<double>::henyeyGreenstein(sine * s * std::cos(phi) - mu_i * mu, medium.g.r);
        });
        return phase * (1 - Physics<double>::fresnelReflectance(mu, medium.eta)) * mu / (mu + mu_i) * (1 - critical) *
               2 * q;
    });
    return sum * medium.sigma_s.r / (medium.sigma_a.r + medium.sigma_s.r);
}

// 1e-5 of the rule, as above.
TEST(SingleScattering, HasTheTotalOfTheHalfSpaceAtAnyAngle) {
    for (const Setting& setting : settings()) {
        const double expected = obliqueTotal(mediumOf(setting), setting.angle_deg);
        const LoadedModel loaded = load("single", mediumOf(setting));
        const double total = totalRd(*loaded.evaluator, loaded.model, loaded.medium, setting.angle_deg).r;
        EXPECT_NEAR(total, expected, 2e-5 * expected)
            << "g " << setting.g << " eta " << setting.eta << ", " << setting.angle_deg << " deg";
    }
}

// Shifted sideways, light is as much. Under grazing beams none leaves upstream, and the edge of where it does takes
// many azimuths: 1024 leave 1e-4.
TEST(SingleScattering, OfJensenHasTheSameTotalAtAnyAngle) {
    for (const Setting& setting : {Setting{0.5, 1.5, 80}, Setting{-0.3, 2, 70}, Setting{0.8, 1.3, 45}}) {
        const LoadedModel loaded = load("single_jensen", mediumOf(setting));
        std::vector<Vec3> points;
        std::vector<double> weights;
        constexpr double step = 0.2;
        constexpr int azimuths = 1024;
        for (double u = std::log(1e-6); u < std::log(100); u += step)
            for (int k = 0; k < azimuths; ++k) {
                const double r = std::exp(u), phi = pi * (k + 0.5) / azimuths;
                points.push_back({r * std::cos(phi), r * std::sin(phi), 0});
                weights.push_back(2 * pi / azimuths * r * r * step);
            }
        const auto Rd = planeRd(*loaded.evaluator, loaded.model, loaded.medium, setting.angle_deg, points);
        double total = 0;
        for (std::size_t i = 0; i < Rd.size(); ++i) total += weights[i] * Rd[i].r;
        const double expected = obliqueTotal(loaded.medium, setting.angle_deg);
        EXPECT_NEAR(total, expected, 2e-4 * expected) << "g " << setting.g << " eta " << setting.eta;
    }
}

// To rounding, which lengths of 0.01 mm lose three digits to.
TEST(SingleScattering, OfJensenIsTheSameUnderANormalBeam) {
    for (const double g : {0.0, 0.7})
        for (const double r : {0.01, 0.3, 5.0}) {
            const Medium medium = grey(0.2, 1.8, g, 1.4);
            EXPECT_NEAR(load("single_jensen", medium).Rd(r) / load("single", medium).Rd(r), 1, 1e-12);
        }
}

TEST(SingleScattering, OfJensenIsTheSameWithoutRefraction) {
    const LoadedModel exact = load("single", grey(0.2, 1.8, 0.5, 1)), jensen = load("single_jensen", exact.medium);
    for (const double angle_deg : {20.0, 70.0})
        for (const Vec3 xo : {Vec3{0.1, 0.2, 0}, Vec3{-1, 0, 0}, Vec3{2, 1, 0}})
            EXPECT_NEAR(valueAt(jensen, angle_deg, {xo}) / valueAt(exact, angle_deg, {xo}), 1, 1e-12);
}

// r R_d tends to sigma_s times an integral over angles, linearly in r but for a logarithm.
TEST(SingleScattering, GrowsAsOneOverRAndIsFiniteAtThePointOfEntry) {
    const LoadedModel loaded = load("single", ofAlbedo(0.9, 1));
    // Isotropic and matched: sigma_s / (4 pi) times the integral of cos over a quarter turn, which is 1.
    EXPECT_NEAR(1e-5 * loaded.Rd(1e-5), 0.9 / (4 * pi), 4e-4 * 0.9 / (4 * pi));
    EXPECT_EQ(loaded.Rd(0), loaded.Rd(1e-6));
    EXPECT_EQ(loaded.Rd(0), loaded.Rd(1e-9));
    for (const double angle_deg : {0.0, 60.0, 89.0})
        for (const double eta : {1.0, 1.3, 0.75}) {
            const LoadedModel oblique = load("single", ofAlbedo(0.9, eta));
            EXPECT_TRUE(std::isfinite(valueAt(oblique, angle_deg, {{0, 0, 0}})));
        }
}

TEST(SingleScattering, OfAMediumThatDoesNotScatterIsNothing) {
    EXPECT_EQ(load("single", grey(1, 0, 0, 1.3)).Rd(0.5), 0);
    EXPECT_EQ(load("single", grey(0, 0, 0, 1.3)).Rd(0.5), 0);
}

// What the parameter says: other coefficients, and nothing else.
TEST(SingleScattering, OfAForwardPeakIsThatOfAnotherMedium) {
    const double g = 0.8;
    const Medium medium = grey(0.1, 2, g, 1.3);
    for (const double r : {0.01, 0.3, 3.0}) {
        EXPECT_NEAR(load("single", medium, {{"ForwardPeak", ParamValue(std::string("delta_eddington"))}}).Rd(r) /
                        load("single", grey(0.1, 2 * (1 - g * g), g / (1 + g), 1.3)).Rd(r),
                    1, 1e-12);
        EXPECT_NEAR(load("single", medium, {{"ForwardPeak", ParamValue(std::string("reduced"))}}).Rd(r) /
                        load("single", grey(0.1, 2 * (1 - g), 0, 1.3)).Rd(r),
                    1, 1e-12);
    }
}

}  // namespace
}  // namespace searchlight
