// Small dense least squares.
#pragma once

#include <cstddef>
#include <vector>

namespace searchlight {

/// Column by column.
struct Matrix {
    Matrix(std::size_t rows_, std::size_t cols_) : rows(rows_), cols(cols_), values(rows_ * cols_) {}
    double& operator()(std::size_t row, std::size_t col) { return values[col * rows + row]; }
    double operator()(std::size_t row, std::size_t col) const { return values[col * rows + row]; }

    std::size_t rows, cols;
    std::vector<double> values;
};

/// x that minimises |A x - b|; of a rank-deficient A the shortest.
std::vector<double> leastSquares(const Matrix& A, const std::vector<double>& b);

/// The same with x >= 0, by the active sets of [LawsonHanson1974].
std::vector<double> nonNegativeLeastSquares(const Matrix& A, const std::vector<double>& b);

struct Covariance {
    std::vector<double> standard_error;  ///< of each column's parameter; infinite where the data do not determine it
    Matrix correlation{0, 0};
    double condition = 0;  ///< of the Jacobian with its columns scaled to length 1
};

/// (J^T J)^-1 times `variance`: of parameters whose residuals have that variance, J being d residual / d parameter.
Covariance covarianceOf(const Matrix& jacobian, double variance);

}  // namespace searchlight
