// Which rays of light from one direction or point pass through a place in a smooth refractive sphere: for
// sphere_beams.cpp alone.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

namespace searchlight {

// The rays that were mirrored `order` times and now pass at the radius r (1: the surface) outwards, or inwards. By
// Snell's law, and as r sin psi is the same all along a ray,
//     sin i = p sin psi, sin gamma = w sin psi, sin t = r sin psi, with p = eta r, w = p nearness,
// for the angles psi between the ray and the way outwards at r, i of incidence, gamma at the light, t of refraction.
// Seen from the centre, with the light at angle 0, such a ray has turned by
//     Phi = i - gamma - (2 order + 1) t + (order + 1) pi - psi.
// Inwards psi is pi - chi, outwards chi, and chi is given by tau in [0, pi/2], sin chi = m sin tau, m = min(1, 1/p):
// all sines are n sin tau with n <= 1, so that Phi is smooth, and has at most one extremum in between: its derivative
// by chi is a sum of terms n cos chi / sqrt(1 - n^2 sin^2 chi), whose order in n makes it monotone where p > 1, and
// else cross the extremum's value once.
class SphereRays {
public:
    SphereRays(double eta, double r, double nearness, int order, bool outwards)
        : end_((outwards ? order + 1 : order) * std::numbers::pi) {
        const double p = eta * r;
        const bool all = p <= 1;
        m_ = all ? 1 : 1 / p;
        terms_[0] = {1, all ? p : 1};
        terms_[1] = {-1, p * nearness * m_};
        terms_[2] = {-(2.0 * order + 1), r * m_};
        terms_[3] = {outwards ? -1.0 : 1.0, m_};
    }

    struct Ray {
        double i = 0, gamma = 0, t = 0, chi = 0;
        double turned = 0, slope = 0;  // Phi, and its derivative by tau
        double per_chi = 0;            // derivative of sin tau over that of sin chi
        double sine = 0;               // of psi
    };

    Ray at(double tau) const {
        const double s = std::sin(tau), c = std::cos(tau);
        double angle[4];
        Ray ray;
        ray.turned = end_;
        for (int k = 0; k < 4; ++k) {
            const double n = terms_[k].n;
            angle[k] = n == 1 ? tau : n == 0 ? 0 : std::asin(n * s);
            ray.turned += terms_[k].factor * angle[k];
        }
        ray.i = angle[0], ray.gamma = angle[1], ray.t = angle[2], ray.chi = angle[3];
        double bend;
        ray.slope = slope(c, bend);
        ray.sine = m_ * s;
        ray.per_chi = m_ == 1 ? 1 : m_ * c / std::cos(ray.chi);
        return ray;
    }

    // Phi' at a cosine of tau, and its derivative by that.
    double slope(double c, double& bend) const {
        double sum = bend = 0;
        for (const auto& [factor, n] : terms_) {
            const double rest = (1 - n) * (1 + n), square = rest + n * n * c * c;
            if (rest == 0) {
                sum += factor;
                continue;
            }
            const double part = factor * n / std::sqrt(square);
            sum += part * c;
            bend += part * rest / square;
        }
        return sum;
    }

private:
    struct Term {
        double factor = 0, n = 0;
    };
    double end_, m_ = 1;
    Term terms_[4];
};

// Where Phi has its extremum; pi/2 when there is none.
inline double extremumOf(const SphereRays& rays) {
    double low = 0, high = 1, bend;
    const double at_low = rays.slope(low, bend), at_high = rays.slope(high, bend);
    if ((at_low < 0) == (at_high < 0)) return std::numbers::pi / 2;
    double c = at_low / (at_low - at_high);
    for (int i = 0; i < 60; ++i) {
        const double slope = rays.slope(c, bend);
        ((slope < 0) == (at_low < 0) ? low : high) = c;
        const double step = slope / bend;
        const bool within = c - step > low && c - step < high;
        c = within ? c - step : 0.5 * (low + high);
        if ((within && std::abs(step) < 1e-10) || high - low < 1e-14) break;
    }
    return std::acos(c);
}

// Where Phi, monotone between two angles, takes a value that it has between them. `extremum`: it is one at the first.
inline double solve(const SphereRays& rays, double first, double last, double from, double to, double value,
                    bool extremum) {
    double part = (value - from) / (to - from);
    if (extremum) part = std::sqrt(part);
    double low = first, high = last, tau = first + part * (last - first);
    for (int i = 0; i < 60; ++i) {
        const SphereRays::Ray ray = rays.at(tau);
        const double excess = ray.turned - value;
        ((excess < 0) == (from < to) ? low : high) = tau;
        const double step = excess / ray.slope, next = tau - step;
        const bool within = next > std::min(low, high) && next < std::max(low, high);
        tau = within ? next : 0.5 * (low + high);
        if ((within && std::abs(step) < 1e-7) || std::abs(high - low) < 1e-14) break;
    }
    return tau;
}

// Visits each ray that comes to the polar angle phi in (0, pi), and the side of the axis that it entered on: 1 that of
// phi, -1 the other.
template <class Visit>
void forEachRay(const SphereRays& rays, double phi, const Visit& visit) {
    const auto piece = [&](double first, double last, bool extremum) {
        const double from = rays.at(first).turned, to = rays.at(last).turned;
        if (from == to) return;
        for (const double side : {1.0, -1.0}) {
            const double turns = std::ceil((std::min(from, to) - side * phi) / (2 * std::numbers::pi));
            for (double value = side * phi + 2 * std::numbers::pi * turns; value < std::max(from, to);
                 value += 2 * std::numbers::pi)
                visit(rays.at(solve(rays, first, last, from, to, value, extremum)), side);
        }
    };
    const double extremum = extremumOf(rays);
    if (extremum < std::numbers::pi / 2) {
        piece(extremum, 0, true);
        piece(extremum, std::numbers::pi / 2, true);
    } else {
        piece(0, std::numbers::pi / 2, false);
    }
}

}  // namespace searchlight
