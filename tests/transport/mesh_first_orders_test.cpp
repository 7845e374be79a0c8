#include "transport/mesh/first_orders.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mesh_shapes.h"

namespace searchlight {
namespace {

struct Total {
    double flux = 0, error = 0;
};

Total totalOf(const MeshBody& body, const std::vector<double>& values, const std::vector<double>& errors) {
    Total total;
    double square = 0;
    for (std::size_t cell = 0; cell < body.cellCount(); ++cell) {
        total.flux += body.cellArea(cell) * values[cell];
        square += std::pow(body.cellArea(cell) * errors[cell], 2);
    }
    total.error = std::sqrt(square);
    return total;
}

MeshBody boxOf(double half) { return {boxMesh({half, half, half}), {.cell_area_mm2 = half * half, .shortest_mfp = 1}}; }

PencilLight beamAt(double half, double cosine) {
    return {{0, half, 0}, {0, 1, 0}, {-std::sqrt(1 - cosine * cosine), cosine, 0}};
}

FirstOrders walk(const MeshBody& body, const Medium& medium, const PencilLight& light, std::uint64_t walks) {
    Observer observer;
    return walkFirstOrders(body, medium, 0, light, {.walks = walks, .seed = 3}, observer);
}

// An isotropic half-space without a change of index gives (albedo / 2)(1 - mu ln(1 + 1/mu)) back by single scattering:
// the integral over depth and direction of e^(-t/mu) e^(-t/mu') / (4 pi). A box of 60 mean free paths is one.
TEST(FirstOrders, GiveTheSingleScatteringOfAHalfSpace) {
    const MeshBody body = boxOf(30);
    for (const double mu : {1.0, 0.5}) {
        const FirstOrders walked = walk(body, makeMedium({0.2}, {0.8}, {0}, 1), beamAt(30, mu), 200'000);
        const Total single = totalOf(body, walked.single, walked.single_error);
        // 5 standard errors: one seed in 2e6.
        EXPECT_NEAR(single.flux, 0.4 * (1 - mu * std::log(1 + 1 / mu)), 5 * single.error);
        EXPECT_LT(single.error, 2e-3);
        EXPECT_LT(totalOf(body, walked.unscattered, walked.unscattered_error).flux, 1e-12);
    }
}

// Up and down between two faces, T e^-L / (1 + R e^-L) of what entered leaves in all.
TEST(FirstOrders, FollowTheUnscatteredBeamThroughItsReflections) {
    const MeshBody body = boxOf(0.5);
    const double eta = 1.5, R = std::pow((eta - 1) / (eta + 1), 2), leg = std::exp(-1.0);
    const FirstOrders walked = walk(body, makeMedium({0.5}, {0.5}, {0.3}, eta), beamAt(0.5, 1), 200'000);
    const Total left = totalOf(body, walked.unscattered, walked.unscattered_error);
    EXPECT_NEAR(left.flux, (1 - R) * (1 - R) * leg / (1 - R * leg), 5 * left.error + 1e-6);
    EXPECT_LT(left.error, 1e-3);
}

// Where next to nothing scatters twice, the two orders are all that walkBody() finds: of what scattered once at most
// 2 % scatters again.
TEST(FirstOrders, AreAllThatLeavesAtALowAlbedo) {
    const MeshBody body(sphereMesh(1, 3), {.cell_area_mm2 = 0.5, .shortest_mfp = 1});
    const Medium medium = makeMedium({0.98}, {0.02}, {0.6}, 1.3);
    Observer observer;
    const BodyOptions options{.walks = 200'000, .seed = 5};
    const FirstOrders orders = walkFirstOrders(body, medium, 0, UniformLight{}, options, observer);
    const BodyResult all = walkBody(body, medium, 0, UniformLight{}, options, observer);
    for (std::size_t cell = 0; cell < body.cellCount(); ++cell) {
        const double error =
            std::hypot(all.standard_error[cell], std::hypot(orders.unscattered_error[cell], orders.single_error[cell]));
        EXPECT_NEAR(orders.unscattered[cell] + orders.single[cell], all.exitance[cell],
                    5 * error + 0.02 * orders.single[cell]);
    }
}

}  // namespace
}  // namespace searchlight
