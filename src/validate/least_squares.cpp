#include "validate/least_squares.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

namespace searchlight {

namespace {

using Map = Eigen::Map<const Eigen::MatrixXd>;

Map mapOf(const Matrix& A) {
    return {A.values.data(), static_cast<Eigen::Index>(A.rows), static_cast<Eigen::Index>(A.cols)};
}

Eigen::Map<const Eigen::VectorXd> mapOf(const std::vector<double>& b) {
    return {b.data(), static_cast<Eigen::Index>(b.size())};
}

std::vector<double> listOf(const Eigen::VectorXd& x) { return {x.data(), x.data() + x.size()}; }

}  // namespace

std::vector<double> leastSquares(const Matrix& A, const std::vector<double>& b) {
    return listOf(mapOf(A).completeOrthogonalDecomposition().solve(mapOf(b)));
}

std::vector<double> nonNegativeLeastSquares(const Matrix& A, const std::vector<double>& b) {
    const Map a = mapOf(A);
    const Eigen::VectorXd rhs = mapOf(b);
    const Eigen::Index n = a.cols();
    Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
    std::vector<Eigen::Index> passive;
    const double tolerance = 1e-13 * (a.transpose() * rhs).cwiseAbs().maxCoeff();
    // Every turn adds a column whose weight wants to grow; each set of columns occurs once, so this ends. The limit is
    // for rounding.
    for (int turn = 0; turn < 3 * n; ++turn) {
        const Eigen::VectorXd gradient = a.transpose() * (rhs - a * x);
        Eigen::Index enter = -1;
        for (Eigen::Index j = 0; j < n; ++j)
            if (std::ranges::find(passive, j) == passive.end() && gradient[j] > tolerance &&
                (enter < 0 || gradient[j] > gradient[enter]))
                enter = j;
        if (enter < 0) break;
        passive.push_back(enter);
        for (;;) {
            Eigen::MatrixXd columns(a.rows(), static_cast<Eigen::Index>(passive.size()));
            for (std::size_t k = 0; k < passive.size(); ++k)
                columns.col(static_cast<Eigen::Index>(k)) = a.col(passive[k]);
            const Eigen::VectorXd z = columns.colPivHouseholderQr().solve(rhs);
            if ((z.array() > 0).all()) {
                x.setZero();
                for (std::size_t k = 0; k < passive.size(); ++k) x[passive[k]] = z[static_cast<Eigen::Index>(k)];
                break;
            }
            // As far as the first weight that reaches 0, which then leaves.
            double step = 1;
            for (std::size_t k = 0; k < passive.size(); ++k)
                if (const double to = z[static_cast<Eigen::Index>(k)]; to <= 0)
                    step = std::min(step, x[passive[k]] / (x[passive[k]] - to));
            for (std::size_t k = 0; k < passive.size(); ++k)
                x[passive[k]] += step * (z[static_cast<Eigen::Index>(k)] - x[passive[k]]);
            std::erase_if(passive, [&](Eigen::Index j) { return x[j] <= 1e-15 * x.maxCoeff(); });
            if (passive.empty()) break;
        }
    }
    return listOf(x);
}

Covariance covarianceOf(const Matrix& jacobian, double variance) {
    const Map J = mapOf(jacobian);
    const Eigen::Index n = J.cols();
    const Eigen::VectorXd length = J.colwise().norm();
    Eigen::MatrixXd scaled = J;
    for (Eigen::Index j = 0; j < n; ++j)
        if (length[j] > 0) scaled.col(j) /= length[j];
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(scaled, Eigen::ComputeThinV);
    const Eigen::VectorXd sigma = svd.singularValues();
    Covariance result;
    result.condition = sigma[n - 1] > 0 ? sigma[0] / sigma[n - 1] : std::numeric_limits<double>::infinity();
    const Eigen::MatrixXd root = svd.matrixV() * sigma.cwiseInverse().asDiagonal();
    const Eigen::MatrixXd inverse = root * root.transpose();
    result.correlation = Matrix(jacobian.cols, jacobian.cols);
    for (Eigen::Index i = 0; i < n; ++i) {
        result.standard_error.push_back(std::sqrt(variance * inverse(i, i)) / length[i]);
        for (Eigen::Index j = 0; j < n; ++j)
            result.correlation(static_cast<std::size_t>(i), static_cast<std::size_t>(j)) =
                inverse(i, j) / std::sqrt(inverse(i, i) * inverse(j, j));
    }
    return result;
}

}  // namespace searchlight
