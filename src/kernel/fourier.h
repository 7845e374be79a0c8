// Fourier transforms of pictures.
#pragma once

#include <complex>
#include <vector>

namespace searchlight {

/// In place, of n x n values, row by row: sum of f exp(-2 pi i (jx + ky) / n), without a factor; the inverse has
/// 1 / n^2. n is even and has no prime factors above 5 where speed matters.
void fourier(std::vector<std::complex<double>>& values, std::size_t n, bool inverse);

}  // namespace searchlight
