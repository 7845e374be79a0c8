#include "kernel/fourier.h"

#include <cassert>
#include <kissfft/kissfft.hh>

namespace searchlight {

void fourier(std::vector<std::complex<double>>& values, std::size_t n, bool inverse) {
    assert(values.size() == n * n);
    const kissfft<double> transform(n, inverse);
    std::vector<std::complex<double>> line(n), done(n);
    for (std::size_t j = 0; j < n; ++j) {
        transform.transform(&values[j * n], done.data());
        std::copy(done.begin(), done.end(), values.begin() + static_cast<std::ptrdiff_t>(j * n));
    }
    const double factor = inverse ? 1 / static_cast<double>(n * n) : 1;
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < n; ++j) line[j] = values[j * n + i];
        transform.transform(line.data(), done.data());
        for (std::size_t j = 0; j < n; ++j) values[j * n + i] = factor * done[j];
    }
}

}  // namespace searchlight
