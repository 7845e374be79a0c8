#include "kernel/singular.h"

#include <Eigen/Dense>
#include <cassert>
#include <numeric>

namespace searchlight {

namespace {

struct Pairs {
    Eigen::VectorXd values;
    Eigen::MatrixXd vectors;  // columns
};

// The largest pairs by magnitude: blocks of A^2 times a few vectors, then Rayleigh and Ritz. Magnitudes fall by a
// factor of 2 and more from one to the next, so that 8 spare vectors and 12 products leave rounding errors; the test
// compares with a full decomposition.
Pairs largestPairs(const Eigen::MatrixXd& matrix, int rank) {
    const Eigen::Index n = matrix.rows(), width = std::min<Eigen::Index>(n, rank + 8);
    Eigen::MatrixXd basis(n, width);
    for (Eigen::Index k = 0; k < width; ++k)
        for (Eigen::Index i = 0; i < n; ++i)
            basis(i, k) = std::cos(3.14159265358979 * static_cast<double>(k) * (static_cast<double>(i) + 0.5) /
                                   static_cast<double>(n));
    for (int i = 0; i < 12; ++i)
        basis =
            Eigen::HouseholderQR<Eigen::MatrixXd>(matrix * basis).householderQ() * Eigen::MatrixXd::Identity(n, width);
    const Eigen::MatrixXd small = basis.transpose() * (matrix * basis);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(small);
    std::vector<Eigen::Index> order(static_cast<std::size_t>(width));
    std::iota(order.begin(), order.end(), 0);
    std::ranges::sort(order, [&](Eigen::Index a, Eigen::Index b) {
        return std::abs(solver.eigenvalues()(a)) > std::abs(solver.eigenvalues()(b));
    });
    Pairs pairs{Eigen::VectorXd(rank), Eigen::MatrixXd(n, rank)};
    for (Eigen::Index k = 0; k < rank; ++k) {
        pairs.values(k) = solver.eigenvalues()(order[static_cast<std::size_t>(k)]);
        pairs.vectors.col(k) = basis * solver.eigenvectors().col(order[static_cast<std::size_t>(k)]);
    }
    return pairs;
}

}  // namespace

SingularKernel singularKernel(const CellKernel& truth, int rank) {
    const std::size_t n = truth.size();
    assert(rank >= 1 && static_cast<std::size_t>(rank) <= n);
    SingularKernel result;
    result.raw = {.method = "svd", .terms = std::vector<KernelTerm>(static_cast<std::size_t>(rank))};
    result.raw.extent_mm = truth.edges.back();
    for (std::size_t c = 0; c < Rgb::channels; ++c) {
        // Widths under the root make the matrix symmetric, and its norm that of the plane's quadrant.
        Eigen::MatrixXd matrix(n, n);
        for (std::size_t j = 0; j < n; ++j)
            for (std::size_t i = 0; i < n; ++i)
                matrix(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
                    std::sqrt(truth.width(i) * truth.width(j)) * truth.mean[c][j * n + i];
        const Pairs pairs = largestPairs(matrix, rank);
        for (int k = 0; k < rank; ++k) {
            const double value = pairs.values(k);
            std::vector<double> means(n);
            double sum = 0;
            for (std::size_t i = 0; i < n; ++i) {
                means[i] = std::sqrt(std::abs(value) / truth.width(i)) * pairs.vectors(static_cast<Eigen::Index>(i), k);
                sum += means[i] * truth.width(i);
            }
            if (sum < 0)
                for (double& mean : means) mean = -mean;
            KernelTerm& term = result.raw.terms[static_cast<std::size_t>(k)];
            term.lines[c] = lineOfCells(truth.edges, means);
            term.scale[static_cast<int>(c)] = value < 0 ? -1 : 1;
            result.eigenvalues[c].push_back(value);
        }
    }
    result.normalised = result.raw;
    const Rgb mass = result.raw.mass();
    for (KernelTerm& term : result.normalised.terms) term.scale = term.scale / mass;
    return result;
}

}  // namespace searchlight
