#include "transport/exact/ordinate_orders.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "transport/walk/decay.h"

namespace searchlight {

namespace {

using Complex = std::complex<double>;

// Beams weaker than this do not matter: discrete directions have their second order to a hundredth.
constexpr double kWeakBeam = 1e-4;

// Integral of exp(-a (h - z) - b z) from 0 to h, given exp(-a h) and exp(-b h).
Complex met(Complex a, Complex wave_a, Complex b, Complex wave_b, double h) {
    if (wave_a == 0.0 && wave_b == 0.0) return 0;
    const Complex d = a - b, x = d * h;
    if (std::abs(x) < 1e-4) return wave_b * h * (1.0 - x * (0.5 - x / 6.0));
    return (wave_b - wave_a) / d;
}

// A phase function that is asked millions of times. Linear between values: 1e-7 of its largest value at g = 0.5.
class PhaseTable {
public:
    explicit PhaseTable(const SmoothPhase& phase) : values_(kParts + 2) {
        for (std::size_t i = 0; i < values_.size(); ++i)
            values_[i] = phase(std::min(1.0, 2.0 * static_cast<double>(i) / kParts - 1));
    }
    double operator()(double cosine) const {
        const double at = std::clamp(0.5 * kParts * (cosine + 1), 0.0, double{kParts});
        const auto i = static_cast<std::size_t>(at);
        return values_[i] + (at - static_cast<double>(i)) * (values_[i + 1] - values_[i]);
    }

private:
    static constexpr int kParts = 8192;
    std::vector<double> values_;
};

std::vector<Complex> waves(const std::vector<Complex>& rates, double h) {
    std::vector<Complex> result;
    result.reserve(rates.size());
    for (const Complex rate : rates) result.push_back(std::isinf(h) ? 0 : std::exp(-rate * h));
    return result;
}

}  // namespace

StackFlux firstOrder(const OrdinateStack::Layer& layer, const LayerRays& rays, const OrdinateScattering& scattering) {
    const double beta = layer.sigma_t, h = layer.thickness, beam_wave = std::exp(-beta * h);
    const std::vector<Complex> wave = waves(rays.Q, h);
    StackFlux flux;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const Complex Q = rays.Q[i], back = decayed(Q + beta, wave[i] * beam_wave, h);
        const Complex on = met(Q, wave[i], beta, beam_wave, h);
        const double part = layer.sigma_s * rays.set.weight[i];
        const double down = scattering.down[i], up = scattering.up[i];
        flux.R += part * rays.up[i] * (layer.beam_down * up * back + layer.beam_up * down * on);
        flux.T += part * rays.down[i] * (layer.beam_down * down * on + layer.beam_up * up * back);
    }
    return flux;
}

StackFlux secondOrder(const OrdinateStack::Layer& layer, const LayerRays& rays, const OrdinateScattering* scattering) {
    const double beta = layer.sigma_t, h = layer.thickness, beam_wave = std::exp(-beta * h);
    const std::size_t n = rays.size();
    const PhaseTable phase(layer.phase);
    const std::vector<Complex> wave = waves(rays.Q, h);
    // "Near" is the side where a beam enters, "with" the hemisphere of its direction.
    std::vector<double> with(n), against(n);
    std::vector<Complex> back(n), on(n), apart(n), joint(n);
    for (std::size_t j = 0; j < n; ++j) {
        with[j] = scattering ? scattering->down[j] : layer.phase(rays.set.mu[j]);
        against[j] = scattering ? scattering->up[j] : layer.phase(-rays.set.mu[j]);
        back[j] = decayed(rays.Q[j] + beta, wave[j] * beam_wave, h);
        on[j] = met(rays.Q[j], wave[j], beta, beam_wave, h);
        apart[j] = 1.0 / (rays.Q[j] - beta);
        joint[j] = 1.0 / (rays.Q[j] + beta);
    }
    // Then nothing comes from below, and what is left of the terms is simple.
    const bool infinite = std::isinf(h);
    const bool rises = layer.beam_up > kWeakBeam, falls = layer.beam_down > 0;
    StackFlux flux;
    for (std::size_t i = 0; i < n; ++i) {
        if (rays.up[i] == 0.0 && rays.down[i] == 0.0) continue;
        const Complex Qi = rays.Q[i];
        // Of a beam that enters at the near side: leaves there, leaves at the far side; two beams.
        Complex near[2] = {}, far[2] = {};
        for (std::size_t j = 0; j < n; ++j) {
            double same, other;
            if (scattering) {
                same = scattering->same[i * n + j];
                other = scattering->other[i * n + j];
            } else {
                // Mean over both sides of the plane of the wave.
                const double normal = rays.set.mu[i] * rays.set.mu[j], along = rays.along[i] * rays.along[j];
                const double across = rays.across[i] * rays.across[j];
                same = 0.5 * (phase(normal + along + across) + phase(normal + along - across));
                other = 0.5 * (phase(along - normal + across) + phase(along - normal - across));
            }
            const Complex Qj = rays.Q[j];
            const double weight = rays.set.weight[j] / rays.set.mu[j];
            if (infinite) {
                near[0] += weight * (other * (with[j] * back[i] + against[j] * rays.F_up[j] * back[j]) / (Qi + Qj) +
                                     same * against[j] * back[i] * back[j]);
                continue;
            }
            const Complex sum = decayed(Qi + Qj, wave[i] * wave[j], h), cross = met(Qi, wave[i], Qj, wave[j], h);
            // Light on its way j with the beam is (exp(-beta z) - exp(-Qj z)) / (Qj - beta), against it
            // (exp(-beta z) - exp(-(beta + Qj) h + Qj z)) / (Qj + beta).
            const auto from = [&](bool down, Complex& leaves_near, Complex& leaves_far) {
                const double F_near = down ? rays.F_up[j] : rays.F_down[j],
                             F_far = down ? rays.F_down[j] : rays.F_up[j];
                const Complex j_with_i_back = (back[i] - sum) * apart[j], j_with_i_on = (on[i] - cross) * apart[j];
                const Complex j_against_i_back = (back[i] - beam_wave * cross) * joint[j];
                const Complex j_against_i_on = (on[i] - beam_wave * sum) * joint[j];
                leaves_near +=
                    weight * (other * with[j] * j_with_i_back + same * against[j] * j_against_i_back +
                              other * against[j] * F_near * back[j] * sum + same * with[j] * F_far * on[j] * cross);
                leaves_far +=
                    weight * (same * with[j] * j_with_i_on + other * against[j] * j_against_i_on +
                              same * against[j] * F_near * back[j] * cross + other * with[j] * F_far * on[j] * sum);
            };
            if (falls) from(true, near[0], far[0]);
            if (rises) from(false, near[1], far[1]);
        }
        const double part = layer.sigma_s * layer.sigma_s * rays.set.weight[i];
        flux.R += part * rays.up[i] * (layer.beam_down * near[0] + layer.beam_up * far[1]);
        flux.T += part * rays.down[i] * (layer.beam_down * far[0] + layer.beam_up * near[1]);
    }
    return flux;
}

}  // namespace searchlight
