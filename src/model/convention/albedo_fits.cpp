#include "model/convention/albedo_fits.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "model/physics.h"

namespace searchlight {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double largest_cycles_albedo = 0.999999;

// x in [0, 1] with f(x) = y for a monotone f, to the last bit.
template <class Function>
double invert(const Function& f, double y) {
    double low = 0, high = 1;
    const bool rising = f(high) > f(low);
    if (y == f(low)) return low;
    if (y == f(high)) return high;
    if (!(y > std::min(f(low), f(high)) && y < std::max(f(low), f(high)))) return nan;
    for (;;) {
        const double middle = 0.5 * (low + high);
        if (middle <= low || middle >= high) return middle;
        ((f(middle) < y) == rising ? low : high) = middle;
    }
}

// Not clamped, so that it can be inverted.
double wrenninge(double R, double g) {
    const auto polynomial = [g](const auto&... coefficients) {
        double sum = 0, power = 1;
        ((sum += coefficients * power, power *= g), ...);
        return sum;
    };
    const double A = polynomial(1.8260523782, -1.28451056436, -1.79904629312, 9.19393289202, -22.8215585862,
                                32.0234874259, -23.6264803333, 7.21067002658);
    const double B = 4.98511194385 + 0.127355959438 * std::exp(polynomial(0., 31.1491581433, -201.847017512,
                                                                          841.576016723, -2018.09288505, 2731.71560286,
                                                                          -1935.41424244, 559.009054474));
    const double C = polynomial(1.09686102424, -0.394704063468, 1.05258115941, -8.83963712726, 28.8643230661,
                                -46.8802913581, 38.5402837518, -12.7181042538);
    const double D = polynomial(0.496310210422, 0.360146581622, -2.15139309747, 17.8896899217, -55.2984010333,
                                82.065982243, -58.5106008578, 15.8478295021);
    const double E = 4.23190299701 + 0.00310603949088 * std::exp(polynomial(0., 76.7316253952, -594.356773233,
                                                                            2448.8834203, -5576.68528998, 7116.60171912,
                                                                            -4763.54467887, 1303.5318055));
    const double F = polynomial(2.40602999408, -2.51814844609, 9.18494908356, -79.2191708682, 259.082868209,
                                -403.613804597, 302.85712436, -87.4370473567);
    const double blend = std::pow(R, 0.25);
    return (1 - blend) * A * std::pow(std::atan(B * R), C) + blend * D * std::pow(std::atan(E * R), F);
}

// Reflectance for a normal beam, without a boundary: the fit of models/normalized_diffusion, within 0.00064 of exact.
double normalBeam(double s) { return (1 - s) * (1 - 0.172 * s) / (1 + 1.758 * s); }

}  // namespace

double similarity(double alpha, double g) { return std::sqrt((1 - alpha) / (1 - g * alpha)); }
double albedoOfSimilarity(double s, double g) { return (1 - s * s) / (1 - g * s * s); }

double vanDeHulst(double s) { return (1 - s) * (1 - 0.139 * s) / (1 + 1.17 * s); }

double vanDeHulstInverse(double R) {
    if (!(R >= 0 && R <= 1)) return nan;
    // 0.139 s^2 - b s + (1 - R) = 0, the smaller root, without cancellation at R = 1.
    const double b = 1.139 + 1.17 * R;
    return 2 * (1 - R) / (b + std::sqrt(b * b - 4 * 0.139 * (1 - R)));
}

double chiangAlbedo(double R) { return -std::expm1(R * (-5.09406 + R * (2.61188 - R * 4.31805))); }
double chiangInverse(double alpha) { return invert(chiangAlbedo, alpha); }

double wrenningeAlbedo(double R, double g) { return std::clamp(wrenninge(R, g), 0.0, largest_cycles_albedo); }

double wrenningeInverse(double alpha, double g) {
    if (!(g >= 0 && g <= 0.9 && alpha <= largest_cycles_albedo)) return nan;
    return invert([g](double R) { return wrenninge(R, g); }, alpha);
}

double dipoleReflectance(double s, double eta) {
    const double Fdr = Physics<double>::fresnelDiffusePublished(eta);
    const double A = (1 + Fdr) / (1 - Fdr), q = std::sqrt(3.0) * s;
    return 0.5 * (1 - s * s) * (1 + std::exp(-4.0 / 3 * A * q)) * std::exp(-q);
}
double dipoleInverse(double R, double eta) {
    return invert([eta](double s) { return dipoleReflectance(s, eta); }, R);
}

double burleyScale(BurleyWidth width, double A) {
    switch (width) {
        case BurleyWidth::searchlight: return 1.85 - A + 7 * std::pow(std::abs(A - 0.8), 3);
        case BurleyWidth::diffuse: return 1.9 - A + 3.5 * std::pow(A - 0.8, 2);
        case BurleyWidth::diffuse_mean_free_path: break;
    }
    return 3.5 + 100 * std::pow(A - 0.33, 4);
}

double surfaceAlbedo(BurleyWidth width, double s, double eta) {
    const double Fdr = 2 * Physics<double>::fresnelMoment(1, eta), diffuse = vanDeHulst(s);
    return (width == BurleyWidth::diffuse ? diffuse : normalBeam(s)) * (1 - Fdr) / (1 - Fdr * diffuse);
}
double surfaceAlbedoInverse(BurleyWidth width, double A, double eta) {
    return invert([width, eta](double s) { return surfaceAlbedo(width, s, eta); }, A);
}

}  // namespace searchlight
