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
                const SlabSingle single = slabSingle(walk, edges, std::vector<char>(layers.size(), 1));
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
    const SlabSingle single = slabSingle(walk, std::vector<double>{1, 2}, {1});
    const double up = 0.04, down = 0.25, through = std::exp(-0.5);
    const double rounds = 1 / (1 - up * down * through * through);
    EXPECT_NEAR(single.T_unscattered, (1 - down) * through * rounds, 1e-12);
    EXPECT_NEAR(single.R_unscattered, (1 - up) * down * through * through * rounds, 1e-12);
}

// Isotropic, matched, of optical thickness t: a / 2 int mu / (1 + mu) (1 - exp(-t (1 + 1 / mu))) dmu goes up,
// a / 2 int mu / (1 - mu) (exp(-t) - exp(-t / mu)) dmu down; here by the midpoint rule.
TEST(SlabSingle, TotalsOfAMatchedSlabAreOneIntegral) {
    for (const double t : {0.1, 1.0, 5.0}) {
        SlabWalk walk;
        walk.layers = {{.mfp_mm = 1, .absorbed = 0.2, .thickness_mm = t}};
        const SlabSingle single = slabSingle(walk, std::vector<double>{0.3, 1}, {1});
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
    const SlabSingle a = slabSingle(walk, coarse, {1, 1}), b = slabSingle(walk, fine, {1, 1});
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
