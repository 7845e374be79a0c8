// Order 1 of slabs by quadrature.
#include "transport/slab/slab_single.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

#include "transport/half_space/single_scattering.h"

namespace searchlight {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

double sum(const std::vector<double>& list) { return std::accumulate(list.begin(), list.end(), 0.0); }

// Mean free path .5 mm; whole, and cut where nothing changes.
TEST(SlabSingle, AnInfiniteLayerIsTheHalfSpace) {
    const std::vector<double> edges{0.01, 0.1, 0.5, 2}, scaled{0.02, 0.2, 1, 4};
    for (const double g : {0.0, 0.6, -0.5})
        for (const double eta : {1.0, 1.4, 0.8}) {
            const SingleScattering exact = singleScattering({.absorbed = 0.3, .g = g, .eta = eta}, scaled);
            SlabWalk::Layer whole{.mfp_mm = 0.5, .absorbed = 0.3, .g = g, .thickness_mm = infinity, .eta_up = eta};
            SlabWalk::Layer top = whole, rest = whole;
            top.thickness_mm = 0.3;
            rest.eta_up = 1;
            for (const std::vector<SlabWalk::Layer>& layers : {std::vector{whole}, std::vector{top, rest}}) {
                SlabWalk walk;
                walk.layers = layers;
                const SlabSingle single = slabSingle(walk, edges, std::vector<char>(layers.size(), 1), 3);
                for (std::size_t i = 0; i < exact.flux.size(); ++i)
                    EXPECT_NEAR(single.reflected[i], exact.flux[i], 1e-6 * exact.total)
                        << "g " << g << ", eta " << eta << ", annulus " << i;
                EXPECT_EQ(sum(single.transmitted), 0);
            }
        }
}

// The series of reflections between two surfaces is geometric.
TEST(SlabSingle, UnscatteredLightIsThatOfTheEtalonWithoutInterference) {
    SlabWalk walk;
    walk.layers = {{.mfp_mm = 2, .thickness_mm = 1, .eta_up = 1.5, .eta_down = 3}};
    const SlabUnscattered beam = slabUnscattered(walk);
    const double up = 0.04, down = 0.25, through = std::exp(-0.5);
    const double rounds = 1 / (1 - up * down * through * through);
    EXPECT_NEAR(beam.T, (1 - down) * through * rounds, 1e-12);
    EXPECT_NEAR(beam.R, (1 - up) * down * through * through * rounds, 1e-12);
}

double smooth(double n, double n_beyond, double cosine) {  // Fresnel's equations as they are usually written
    const double sine = std::sqrt(1 - cosine * cosine) * n / n_beyond;
    if (sine >= 1) return 1;
    const double beyond = std::sqrt(1 - sine * sine);
    const double s = (n * cosine - n_beyond * beyond) / (n * cosine + n_beyond * beyond);
    const double p = (n * beyond - n_beyond * cosine) / (n * beyond + n_beyond * cosine);
    return 0.5 * (s * s + p * p);
}

// Oblique, through glass and a layer that absorbs: what does not leave is absorbed on its way.
TEST(SlabSingle, UnscatteredLightIsNotLostInObliqueLayers) {
    SlabWalk walk;
    walk.layers = {{.mfp_mm = 1e30, .thickness_mm = 1, .eta_up = 1.5, .eta_down = 1.5 / 1.3},
                   {.mfp_mm = 2, .absorbed = 1, .thickness_mm = 1, .eta_up = 1.3 / 1.5, .eta_down = 1.3 / 1.2},
                   {.mfp_mm = 4, .absorbed = 1, .thickness_mm = 3, .eta_up = 1.2 / 1.3, .eta_down = 1.2}};
    walk.sin_beam = 0.5;  // in glass
    walk.cos_beam = std::sqrt(0.75);
    const SlabUnscattered beam = slabUnscattered(walk);
    EXPECT_NEAR(beam.cosine[2], std::sqrt(1 - 0.625 * 0.625), 1e-14);
    double absorbed = 0;
    for (const std::size_t i : {1, 2}) absorbed += beam.collides(walk.layers[i], i, 0, walk.layers[i].thickness_mm);
    EXPECT_NEAR(beam.R + beam.T + absorbed, 1, 1e-12);
    EXPECT_NEAR(beam.down[1],
                beam.down[0] * (1 - smooth(1.5, 1.3, walk.cos_beam)) +
                    beam.up[1] * std::exp(-0.5 / beam.cosine[1]) * smooth(1.3, 1.5, beam.cosine[1]),
                1e-12);
    EXPECT_NEAR(beam.collides(walk.layers[1], 1, 0, 0.4) + beam.collides(walk.layers[1], 1, 0.4, 1),
                beam.collides(walk.layers[1], 1, 0, 1), 1e-14);
}

// One layer under unlike surfaces, by the midpoint rule over depth and angle; the parts of the quadrant outside, too.
TEST(SlabSingle, TotalsBetweenUnlikeSurfacesAreOneDoubleIntegral) {
    constexpr double n = 1.5, below = 1.2, t = 0.7, g = 0.3, albedo = 0.8;
    SlabWalk walk;
    walk.layers = {
        {.mfp_mm = 1, .absorbed = 1 - albedo, .g = g, .thickness_mm = t, .eta_up = n, .eta_down = n / below}};
    const SlabSingle single = slabSingle(walk, std::vector<double>{0.3, 1}, {1}, 6);
    const double r_up = smooth(n, 1, 1), r_down = smooth(n, below, 1), through = std::exp(-t);
    const double down = 1 / (1 - r_up * r_down * through * through), up = down * through * r_down;
    double top = 0, bottom = 0, steep = 0;
    constexpr int points = 2000;
    for (int i = 0; i < points; ++i) {
        const double mu = (i + 0.5) / points;
        const auto phase = [](double cosine) { return 0.5 * (1 - g * g) / std::pow(1 + g * g - 2 * g * cosine, 1.5); };
        for (int k = 0; k < points; ++k) {
            const double z = t * (k + 0.5) / points, falls = down * std::exp(-z), rises = up * std::exp(z - t);
            const double cell = albedo * t / points / points;
            const double out = cell * (falls * phase(-mu) + rises * phase(mu)) * std::exp(-z / mu);
            top += out * (1 - smooth(n, 1, mu));
            if (n * std::sqrt(1 - mu * mu) < 0.5) steep += out * (1 - smooth(n, 1, mu));  // 30 degrees outside
            bottom +=
                cell * (falls * phase(mu) + rises * phase(-mu)) * std::exp((z - t) / mu) * (1 - smooth(n, below, mu));
        }
    }
    // The midpoint rule errs by 1e-4 where Fresnel's reflectance falls steeply, and by a whole column at the 30
    // degrees.
    EXPECT_NEAR(sum(single.reflected), top, 2e-4 * top);
    EXPECT_NEAR(sum(single.transmitted), bottom, 2e-4 * bottom);
    EXPECT_NEAR(sum(single.reflected_a), sum(single.reflected), 1e-6 * top);
    EXPECT_NEAR(sum(single.transmitted_a), sum(single.transmitted), 1e-6 * bottom);
    EXPECT_NEAR(single.reflected_a[0] + single.reflected_a[1], steep, 5e-3 * steep);
}

// Isotropic, matched, of optical thickness t: a / 2 int mu / (1 + mu) (1 - exp(-t (1 + 1 / mu))) dmu goes up,
// a / 2 int mu / (1 - mu) (exp(-t) - exp(-t / mu)) dmu down; here by the midpoint rule.
TEST(SlabSingle, TotalsOfAMatchedSlabAreOneIntegral) {
    for (const double t : {0.1, 1.0, 5.0}) {
        SlabWalk walk;
        walk.layers = {{.mfp_mm = 1, .absorbed = 0.2, .thickness_mm = t}};
        const SlabSingle single = slabSingle(walk, std::vector<double>{0.3, 1}, {1}, 4);
        double up = 0, down = 0;
        constexpr int points = 200'000;
        for (int i = 0; i < points; ++i) {
            const double mu = (i + 0.5) / points;
            up += 0.4 * mu / (1 + mu) * (1 - std::exp(-t * (1 + 1 / mu))) / points;
            down += 0.4 * mu / (1 - mu) * (std::exp(-t) - std::exp(-t / mu)) / points;
        }
        EXPECT_NEAR(sum(single.reflected), up, 1e-7 * up) << t;
        EXPECT_NEAR(sum(single.transmitted), down, 1e-7 * down) << t;
    }
}

// Integrands have kinks where a ray through the whole layer meets an edge: what annuli hold does not depend on how
// they are cut, where these lie, within 1e-5 of the largest.
TEST(SlabSingle, CutAnnuliAddUp) {
    SlabWalk walk;
    walk.layers = {{.mfp_mm = 1, .absorbed = 0.2, .g = 0.5, .thickness_mm = 0.3, .eta_up = 1.4, .eta_down = 1.1},
                   {.mfp_mm = 0.5, .absorbed = 0.1, .thickness_mm = 1, .eta_up = 1 / 1.1, .eta_down = 1.3}};
    const std::vector<double> coarse{0, 0.2, 0.4, 1};
    std::vector<double> fine;
    for (int i = 0; i <= 100; ++i) fine.push_back(0.01 * i);
    const SlabSingle a = slabSingle(walk, coarse, {1, 1}, 5), b = slabSingle(walk, fine, {1, 1}, 5);
    for (const auto& [whole, parts] : {std::pair(a.reflected, b.reflected), std::pair(a.transmitted, b.transmitted)}) {
        const auto range = [&parts = parts](int first, int last) {
            return std::accumulate(parts.begin() + 1 + first, parts.begin() + 1 + last, 0.0);
        };
        EXPECT_NEAR(whole[1], range(0, 20), 1e-5 * whole[1]);
        EXPECT_NEAR(whole[2], range(20, 40), 1e-5 * whole[1]);
        EXPECT_NEAR(whole[3], range(40, 100), 1e-5 * whole[1]);
    }
}

}  // namespace
}  // namespace searchlight
