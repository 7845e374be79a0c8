#include "transport/exact/ordinate_scattering.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace searchlight {

namespace {

using std::numbers::pi;

constexpr double kSmallestMoment = 1e-9;

// sqrt((l - m)! / (l + m)!) P_l^m(x), l >= m.
double legendre(int m, int l, double x) {
    const double sine = std::sqrt((1 - x) * (1 + x));
    double before = 0, at = 1;
    for (int k = 1; k <= m; ++k) at *= sine * std::sqrt((2 * k - 1.0) / (2 * k));
    for (int k = m + 1; k <= l; ++k) {
        const double next = ((2 * k - 1) * x * at - std::sqrt((k - 1.0 - m) * (k - 1.0 + m)) * before) /
                            std::sqrt((static_cast<double>(k) - m) * (static_cast<double>(k) + m));
        before = at;
        at = next;
    }
    return at;
}

}  // namespace

GaussRule gaussRule(int n) {
    GaussRule rule;
    for (int i = 0; i < n; ++i) {
        double z = std::cos(pi * (i + 0.75) / (n + 0.5)), slope = 1;
        for (int step = 0; step < 20; ++step) {
            double before = 1, at = z;
            for (int k = 2; k <= n; ++k) {
                const double next = ((2 * k - 1) * z * at - (k - 1) * before) / k;
                before = at;
                at = next;
            }
            slope = n * (z * at - before) / (z * z - 1);
            z -= at / slope;
        }
        rule.x.push_back(0.5 * (1 - z));
        rule.weight.push_back(1 / ((1 - z * z) * slope * slope));
    }
    return rule;
}

double henyeyGreenstein(double g, double cosine) {
    const double d = 1 + g * g - 2 * g * cosine;
    return (1 - g * g) / (4 * pi * d * std::sqrt(d));
}

double SmoothPhase::operator()(double cosine) const {
    if (peak == 0) return henyeyGreenstein(g, cosine);
    // Clenshaw's recurrence.
    double next = 0, after = 0;
    for (int l = static_cast<int>(moments.size()) - 1; l >= 1; --l) {
        const double now = (2 * l + 1) * moments[static_cast<std::size_t>(l)] +
                           (2 * l + 1.0) / (l + 1) * cosine * next - (l + 1.0) / (l + 2) * after;
        after = next;
        next = now;
    }
    return (1 + cosine * next - 0.5 * after) / (4 * pi);
}

SmoothPhase smoothPhase(double g, int last) {
    SmoothPhase phase;
    phase.g = g;
    if (g == 0) {
        phase.moments = {1};
        return phase;
    }
    const int needed = static_cast<int>(std::log(kSmallestMoment) / std::log(std::abs(g))) + 1;
    if (g > 0 && last < needed) phase.peak = std::pow(g, last + 1);
    for (int l = 0; l <= std::min(last, needed); ++l)
        phase.moments.push_back((std::pow(g, l) - phase.peak) / (1 - phase.peak));
    return phase;
}

OrdinateScattering ordinateScattering(std::span<const double> moments_of_l, const OrdinateSet& directions,
                                      double beam_cosine) {
    const std::size_t size = directions.mu.size();
    const auto n = static_cast<Eigen::Index>(size);
    const int last = static_cast<int>(moments_of_l.size()) - 1;
    const int largest_m = static_cast<int>(directions.azimuths) - 1;
    OrdinateScattering scattering;
    scattering.down.assign(size, 0.0);
    scattering.up = scattering.down;
    // Harmonics that are even and odd in mu do not meet.
    Eigen::MatrixXd kernels[2];
    for (int parity = 0; parity < 2; ++parity) {
        struct Harmonic {
            int l, m;
        };
        std::vector<Harmonic> harmonics;
        for (int l = 0; l <= last; ++l)
            for (int m = 0; m <= std::min(l, largest_m); ++m)
                if ((l + m) % 2 == parity) harmonics.push_back({l, m});
        kernels[parity] = Eigen::MatrixXd::Zero(n, n);
        if (harmonics.size() > size) harmonics.resize(size);
        if (harmonics.empty()) continue;
        const auto count = static_cast<Eigen::Index>(harmonics.size());
        Eigen::MatrixXd values(n, count);
        Eigen::VectorXd moments(count);
        for (Eigen::Index h = 0; h < count; ++h) {
            const auto [l, m] = harmonics[static_cast<std::size_t>(h)];
            moments[h] = moments_of_l[static_cast<std::size_t>(l)];
            const double norm = std::sqrt((2 * l + 1) / (4 * pi) * (m > 0 ? 2 : 1) * 2);
            double p = 0;
            for (std::size_t i = 0; i < size; ++i) {
                if (i % directions.azimuths == 0) p = legendre(m, l, directions.mu[i]);
                values(static_cast<Eigen::Index>(i), h) =
                    std::sqrt(directions.weight[i]) * norm * p * std::cos(m * directions.phi[i]);
            }
        }
        const Eigen::HouseholderQR<Eigen::MatrixXd> qr(values);
        Eigen::MatrixXd basis = qr.householderQ() * Eigen::MatrixXd::Identity(n, count);
        for (Eigen::Index h = 0; h < count; ++h)
            if (qr.matrixQR()(h, h) < 0) basis.col(h) *= -1;
        kernels[parity] = basis * moments.asDiagonal() * basis.transpose();
        for (Eigen::Index h = 0; h < count; ++h) {
            const auto [l, m] = harmonics[static_cast<std::size_t>(h)];
            if (m > 0) continue;
            const double beam = legendre(0, l, beam_cosine);
            for (std::size_t i = 0; i < size; ++i) {
                const double part = moments[h] * beam * std::sqrt((2 * l + 1) / (4 * pi)) *
                                    basis(static_cast<Eigen::Index>(i), h) / std::sqrt(2 * directions.weight[i]);
                scattering.down[i] += part;
                scattering.up[i] += parity == 0 ? part : -part;
            }
        }
    }
    scattering.same.resize(size * size);
    scattering.other.resize(size * size);
    for (std::size_t i = 0; i < size; ++i)
        for (std::size_t j = 0; j < size; ++j) {
            const auto row = static_cast<Eigen::Index>(i), column = static_cast<Eigen::Index>(j);
            const double scale = 0.5 / std::sqrt(directions.weight[i] * directions.weight[j]);
            const double even = kernels[0](row, column), odd = kernels[1](row, column);
            scattering.same[i * size + j] = scale * (even + odd);
            scattering.other[i * size + j] = scale * (even - odd);
        }
    return scattering;
}

}  // namespace searchlight
