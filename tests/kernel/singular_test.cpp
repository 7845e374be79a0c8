#include "kernel/singular.h"

#include <Eigen/Dense>

#include "kernel/profiles.h"

namespace searchlight {
namespace {

CellKernel cells() { return cellKernel(burleyTruth(), {.cell_mm = 0.05, .extent_mm = 30}); }

// All eigenvalues of the plane's quadrant, by a method of its own.
Eigen::VectorXd spectrumOf(const CellKernel& truth, std::size_t channel) {
    const auto n = static_cast<Eigen::Index>(truth.size());
    Eigen::MatrixXd matrix(n, n);
    for (Eigen::Index j = 0; j < n; ++j)
        for (Eigen::Index i = 0; i < n; ++i) {
            const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
            matrix(i, j) = std::sqrt(truth.width(a) * truth.width(b)) * truth.mean[channel][b * truth.size() + a];
        }
    return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix).eigenvalues();
}

TEST(Singular, ErrorIsTheTailOfTheSpectrumAndFallsWithRank) {
    // Eckart and Young: what is left of the Frobenius norm are the eigenvalues not taken.
    const CellKernel truth = cells();
    Eigen::VectorXd values = spectrumOf(truth, 0).cwiseAbs();
    std::sort(values.begin(), values.end(), std::greater<>());
    double before = 1;
    for (int rank = 1; rank <= 6; ++rank) {
        const SingularKernel kernel = singularKernel(truth, rank);
        const double error = kernelRms(cellKernel(kernel.raw, truth.edges), truth).r;
        const double tail = values.tail(values.size() - rank).norm() / values.norm();
        EXPECT_NEAR(error, tail, 1e-9) << rank;
        EXPECT_LT(error, before) << rank;
        before = error;
    }
}

TEST(Singular, NormalisedKernelsHaveMass1AndErrMore) {
    const CellKernel truth = cells();
    for (const int rank : {1, 2, 5}) {
        const SingularKernel kernel = singularKernel(truth, rank);
        EXPECT_NEAR(kernel.normalised.mass().r, 1, 1e-12);
        EXPECT_NEAR(kernel.normalised.mass().g, 1, 1e-12);
        EXPECT_LT(kernel.raw.mass().r, 1);
        EXPECT_GT(kernelRms(cellKernel(kernel.normalised, truth.edges), truth).r,
                  kernelRms(cellKernel(kernel.raw, truth.edges), truth).r);
    }
}

TEST(Singular, AGaussianHasRankOne) {
    const CellKernel truth = cellKernel(radialTruth([](double r) { return std::exp(-r * r / 2); }, 1e-4, 8),
                                        {.cell_mm = 0.05, .extent_mm = 8});
    const SingularKernel kernel = singularKernel(truth, 2);
    // Means over merged cells of 6 % leave of order 1e-4 to the second.
    EXPECT_LT(std::abs(kernel.eigenvalues[0][1] / kernel.eigenvalues[0][0]), 1e-3);
}

TEST(Cells, MergingCellsChangesErrorsLittle) {
    const GroundTruth truth = burleyTruth();
    CellGrid grid{.cell_mm = 0.1, .extent_mm = 12};
    const CellKernel merged = cellKernel(truth, grid);
    grid.growth = 0;
    const CellKernel uniform = cellKernel(truth, grid);
    ASSERT_GT(uniform.size(), 2 * merged.size());
    const auto error = [](const CellKernel& cells) {
        return kernelRms(cellKernel(singularKernel(cells, 1).raw, cells.edges), cells).r;
    };
    EXPECT_NEAR(error(merged) / error(uniform), 1, 0.01);
}

TEST(Cells, HoldTheEnergyOfTheSquare) {
    // Of a Gaussian, whose energy in a square is the square of an error function. Divided by its own sum, the mass is
    // 1; the middle cell's share then is that of the square.
    const CellKernel cells = cellKernel(radialTruth([](double r) { return std::exp(-r * r / 2); }, 1e-5, 9),
                                        {.cell_mm = 0.2, .extent_mm = 7});
    EXPECT_NEAR(cells.mass(0), 1, 1e-12);
    const double side = std::erf(0.1 / std::sqrt(2.0));
    EXPECT_NEAR(cells.mean[0][0] * 0.04, side * side, 1e-6);
}

}  // namespace
}  // namespace searchlight
