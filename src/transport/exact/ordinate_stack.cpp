// With the rate along x, light of one layer that goes down (d) and up (u), divided by n^2, obeys
//   mu d' = -q d + sigma_s (P+ d + P- u) + source,  -mu u' = -q u + sigma_s (P- d + P+ u) + source.
// A thin layer is solved by its Taylor series in p = d + u and m = d - u, which have p' = -(alpha + beta) m and
// m' = -(alpha - beta) p; doubled, it answers light by R and T. Layers and interfaces are then put on top of each
// other from below, [Grant1969], and light is followed down again.
#include "transport/exact/ordinate_stack.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace searchlight {

namespace {

using Complex = std::complex<double>;
using Matrix = Eigen::MatrixXcd;
using Vector = Eigen::VectorXcd;
using Eigen::Index;

// Of what passes a layer that is infinite.
constexpr double kNothing = 1e-12;
constexpr int kMostDoublings = 80;
// Of light in clear layers between total reflections: there is none, but 0 is divided by what it leaves.
constexpr double kNotTrapped = 1 - 1e-13;

// What a layer answers: light that falls on either side, and a beam of unit flux that enters at its top.
struct Answer {
    Matrix R, T;
    Vector up, down;  // from the beam, at the top and at the bottom
};

struct Equation {
    Matrix plus, minus;  // alpha + beta, alpha - beta
    Vector down, up;     // sources
};

Equation equationOf(const OrdinateStack::Layer& layer, const LayerRays& rays, const OrdinateScattering& scattering) {
    const auto n = static_cast<Index>(rays.size());
    Equation equation{Matrix(n, n), Matrix(n, n), Vector(n), Vector(n)};
    const double per_n2 = 1 / (layer.n * layer.n);
    for (Index i = 0; i < n; ++i) {
        const auto to = static_cast<std::size_t>(i);
        const double part = layer.sigma_s / rays.set.mu[to];
        for (Index j = 0; j < n; ++j) {
            const auto from = static_cast<std::size_t>(j);
            const double weight = part * rays.set.weight[from];
            const double same = weight * scattering.same[to * rays.size() + from];
            const double other = weight * scattering.other[to * rays.size() + from];
            equation.plus(i, j) = other - same;
            equation.minus(i, j) = -other - same;
        }
        equation.plus(i, i) += rays.Q[to];
        equation.minus(i, i) += rays.Q[to];
        equation.down[i] = part * per_n2 / layer.beam_cosine * scattering.down[to];
        equation.up[i] = part * per_n2 / layer.beam_cosine * scattering.up[to];
    }
    return equation;
}

double size(const Matrix& matrix) { return matrix.cwiseAbs().rowwise().sum().maxCoeff(); }

// A layer so thin that its norm is at most 1/2: terms beyond those taken are 1e-13.
Answer thinLayer(const Equation& equation, double beta, double h) {
    const Index n = equation.plus.rows();
    const Matrix one = Matrix::Identity(n, n);
    const Matrix plus = h * equation.plus, minus = h * equation.minus;
    // cosh and sinh(x)/x of the root of X = plus minus, as polynomials in X.
    const Matrix X = plus * minus, X2 = X * X, X3 = X2 * X;
    const auto polynomial = [&](int first) {
        double factor[6], factorial = 1;
        for (int k = 1; k <= first; ++k) factorial *= k;
        for (int k = 0; k < 6; ++k) {
            factor[k] = 1 / factorial;
            factorial *= (first + 2 * k + 1) * (first + 2 * k + 2);
        }
        const Matrix high = factor[3] * one + factor[4] * X + factor[5] * X2;
        return Matrix(factor[0] * one + factor[1] * X + factor[2] * X2 + X3 * high);
    };
    const Matrix cosh_p = polynomial(0), sinh = polynomial(1), rest = polynomial(2);
    const Matrix U = sinh * plus, V = minus * sinh, cosh_m = one + minus * rest * plus;
    Vector source_p = Vector::Zero(n), source_m = Vector::Zero(n);
    {
        Vector p = source_p, m = source_m;  // terms of the Taylor series of what the beam alone sends
        const Vector beam_p = h * (equation.down - equation.up), beam_m = h * (equation.down + equation.up);
        double beam = 1;
        for (int k = 0; k < 16; ++k) {
            const Vector next_p = (beam * beam_p - plus * m) / (k + 1), next_m = (beam * beam_m - minus * p) / (k + 1);
            p = next_p;
            m = next_m;
            source_p += p;
            source_m += m;
            beam *= -beta * h / (k + 1);
        }
    }
    const Matrix du = 0.5 * (cosh_p - cosh_m + U - V), ud = 0.5 * (cosh_p - cosh_m - U + V);
    const Eigen::PartialPivLU<Matrix> uu(0.5 * (cosh_p + cosh_m + U + V));
    Answer answer;
    answer.T = uu.inverse();
    answer.R = -answer.T * ud;
    answer.up = -0.5 * (answer.T * (source_p - source_m));
    answer.down = 0.5 * (source_p + source_m) + du * answer.up;
    return answer;
}

// Light goes straight.
Answer straightAnswer(const OrdinateStack::Layer& layer, const LayerRays& rays) {
    const auto n = static_cast<Index>(rays.size());
    Answer answer{Matrix::Zero(n, n), Matrix::Zero(n, n), Vector::Zero(n), Vector::Zero(n)};
    if (std::isinf(layer.thickness)) return answer;
    for (Index i = 0; i < n; ++i)
        answer.T(i, i) = kNotTrapped * std::exp(-rays.Q[static_cast<std::size_t>(i)] * layer.thickness);
    return answer;
}

Answer layerAnswer(const OrdinateStack::Layer& layer, const LayerRays& rays, const OrdinateScattering& scattering) {
    if (layer.sigma_s == 0) return straightAnswer(layer, rays);
    const Equation equation = equationOf(layer, rays, scattering);
    const bool infinite = std::isinf(layer.thickness);
    const double rate = layer.sigma_t / layer.beam_cosine;
    const double norm = std::max({size(equation.plus), size(equation.minus), rate});
    const int doublings =
        infinite ? kMostDoublings : std::max(0, static_cast<int>(std::ceil(std::log2(2 * norm * layer.thickness))));
    double h = infinite ? 0.5 / norm : layer.thickness * std::pow(0.5, doublings);
    Answer answer = thinLayer(equation, rate, h);
    const Index n = answer.R.rows();
    const Matrix one = Matrix::Identity(n, n);
    for (int step = 0; step < doublings; ++step) {
        const double beam = std::exp(-rate * h);
        const Eigen::PartialPivLU<Matrix> even(one - answer.R), odd(one + answer.R);
        const Vector middle_down = odd.solve(even.solve(answer.down + beam * (answer.R * answer.up)));
        const Vector middle_up = answer.R * middle_down + beam * answer.up;
        answer.up += answer.T * middle_up;
        answer.down = beam * answer.down + answer.T * middle_down;
        // Light on both sides at once meets a mirror in the middle; light of opposite signs a mirror that inverts it.
        const Matrix sum = answer.T * even.solve(answer.T), difference = answer.T * odd.solve(answer.T);
        answer.R += 0.5 * (sum - difference);
        answer.T = 0.5 * (sum + difference);
        h *= 2;
        if (infinite && beam < kNothing && size(answer.T) < kNothing) break;
    }
    return answer;
}

Vector vectorOf(const std::vector<double>& values) {
    Vector vector(static_cast<Index>(values.size()));
    for (Index i = 0; i < vector.size(); ++i) vector[i] = values[static_cast<std::size_t>(i)];
    return vector;
}

struct Light {
    Vector top_down, top_up, bottom_down, bottom_up;
};

// Scattered light at both sides of every layer, divided by n^2.
std::vector<Light> solve(const OrdinateStack& stack, const std::vector<LayerRays>& rays,
                         const std::vector<OrdinateScattering>& scattering) {
    const std::size_t count = stack.layers.size();
    std::vector<Answer> answers;
    for (std::size_t i = 0; i < count; ++i) answers.push_back(layerAnswer(stack.layers[i], rays[i], scattering[i]));
    // What is below a layer's bottom answers with `reflects` and `sends`; so does what is below its top.
    struct Below {
        Matrix passes;  // light at the bottom per light at the top
        Vector sends;   // light at the bottom of what is below the top
        Matrix reflects_bottom, reflects_top, crosses;
        Vector sends_bottom, sends_top, crosses_sends;
    };
    std::vector<Below> below(count);
    for (std::size_t i = count; i-- > 0;) {
        Below& at = below[i];
        const Answer& layer = answers[i];
        const Index n = layer.R.rows();
        const Matrix one = Matrix::Identity(n, n);
        const Vector F = vectorOf(rays[i].F_down);
        at.reflects_bottom = F.asDiagonal();
        at.sends_bottom = Vector::Zero(n);
        if (i + 1 < count) {
            Below& next = below[i + 1];
            const Vector back = vectorOf(rays[i + 1].F_up);
            const Index joint = std::min(n, back.size());
            Matrix open = -next.reflects_top * back.asDiagonal();
            open.diagonal().array() += 1;
            const Eigen::PartialPivLU<Matrix> lu(open);
            Matrix enters = Matrix::Zero(back.size(), n);
            for (Index k = 0; k < joint; ++k) enters(k, k) = 1.0 - F[k];
            next.crosses = lu.solve(next.reflects_top * enters);
            next.crosses_sends = lu.solve(next.sends_top);
            at.reflects_bottom += enters.transpose() * next.crosses;
            at.sends_bottom += enters.transpose() * next.crosses_sends;
        }
        // The beam that rises sees the layer upside down.
        const double falls = stack.layers[i].beam_down, rises = stack.layers[i].beam_up;
        const Vector sent_up = falls * layer.up + rises * layer.down, sent_down = falls * layer.down + rises * layer.up;
        const Eigen::PartialPivLU<Matrix> lu(one - layer.R * at.reflects_bottom);
        at.passes = lu.solve(layer.T);
        at.sends = lu.solve(layer.R * at.sends_bottom + sent_down);
        at.reflects_top = layer.R + layer.T * (at.reflects_bottom * at.passes);
        at.sends_top = sent_up + layer.T * (at.sends_bottom + at.reflects_bottom * at.sends);
    }
    std::vector<Light> light(count);
    for (std::size_t i = 0; i < count; ++i) {
        const Below& at = below[i];
        Light& here = light[i];
        const Vector F = vectorOf(rays[i].F_up);
        if (i == 0) {
            Matrix open = -at.reflects_top * F.asDiagonal();
            open.diagonal().array() += 1;
            here.top_up = open.partialPivLu().solve(at.sends_top);
            here.top_down = F.asDiagonal() * here.top_up;
        } else {
            const Vector& above = light[i - 1].bottom_down;
            const Vector F_above = vectorOf(rays[i - 1].F_down);
            here.top_up = at.crosses * above + at.crosses_sends;
            here.top_down = F.asDiagonal() * here.top_up;
            const Index joint = std::min(F.size(), above.size());
            for (Index k = 0; k < joint; ++k) here.top_down[k] += (1.0 - F_above[k]) * above[k];
        }
        here.bottom_down = at.passes * here.top_down + at.sends;
        here.bottom_up = at.reflects_bottom * here.bottom_down + at.sends_bottom;
    }
    return light;
}

// Flux through a level: of light in one hemisphere, less what an interface sends back.
Complex flux(const OrdinateStack::Layer& layer, const LayerRays& rays, const Vector& light,
             const std::vector<double>* reflectance) {
    Complex sum = 0;
    for (std::size_t i = 0; i < rays.size(); ++i)
        sum += rays.set.weight[i] * rays.set.mu[i] * (reflectance ? 1 - (*reflectance)[i] : 1) *
               light[static_cast<Index>(i)];
    return layer.n * layer.n * sum;
}

std::vector<OrdinateScattering> scatteringOf(const OrdinateStack& stack, const std::vector<LayerRays>& rays) {
    std::vector<OrdinateScattering> scattering;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const OrdinateStack::Layer& layer = stack.layers[i];
        scattering.push_back(layer.sigma_s > 0 ? ordinateScattering(layer.phase.moments, rays[i].set, layer.beam_cosine)
                                               : OrdinateScattering{});
    }
    return scattering;
}

StackFlux leaving(const OrdinateStack& stack, const std::vector<LayerRays>& rays, const std::vector<Light>& light) {
    StackFlux sum{flux(stack.layers.front(), rays.front(), light.front().top_up, &rays.front().F_up), 0};
    if (!std::isinf(stack.layers.back().thickness))
        sum.T = flux(stack.layers.back(), rays.back(), light.back().bottom_down, &rays.back().F_down);
    return sum;
}

// Light that leaves a layer in equal parts of 90 degrees outside, per unit flux that entered: per (n sin)^2 it is
// smooth in the panels' own variable.
std::vector<double> anglesOf(const LayerRays& rays, const Vector& light, const std::vector<double>& reflectance,
                             double n, double n_outside, int angles) {
    std::vector<double> flux(static_cast<std::size_t>(angles));
    const GaussRule rule = gaussRule(12);
    for (const RayPanel& panel : rays.panels) {
        if (panel.low >= n_outside) break;
        const auto variable = [&](double xi) {
            return std::sqrt(std::max(0.0, (panel.high - xi) * (panel.high + xi)));
        };
        std::vector<double> t, value, weight;
        for (std::size_t i = panel.first; i < panel.first + panel.count; ++i) {
            const double mu = rays.set.mu[i];
            t.push_back(variable(n * std::sqrt((1 - mu) * (1 + mu))));
            value.push_back((1 - reflectance[i]) * light[static_cast<Index>(i)].real());
        }
        // Barycentric interpolation.
        for (std::size_t i = 0; i < t.size(); ++i) {
            double product = 1;
            for (std::size_t k = 0; k < t.size(); ++k)
                if (k != i) product *= (t[i] - t[k]) * 4 / variable(panel.low);
            weight.push_back(1 / product);
        }
        const auto at = [&](double x) {
            double above = 0, below = 0;
            for (std::size_t i = 0; i < t.size(); ++i) {
                if (x == t[i]) return value[i];
                const double part = weight[i] / (x - t[i]);
                above += part * value[i];
                below += part;
            }
            return above / below;
        };
        for (std::size_t a = 0; a < flux.size(); ++a) {
            const double part = 0.5 * std::numbers::pi / angles;
            const double from = std::max(panel.low, n_outside * std::sin(part * static_cast<double>(a)));
            const double to = std::min(panel.high, n_outside * std::sin(part * static_cast<double>(a + 1)));
            if (!(from < to)) continue;
            const double end = variable(from), begin = variable(to);
            for (std::size_t k = 0; k < rule.x.size(); ++k) {
                const double x = begin + (end - begin) * rule.x[k];
                flux[a] += 2 * std::numbers::pi * (end - begin) * rule.weight[k] * x * at(x);
            }
        }
    }
    return flux;
}

}  // namespace

StackFlux stackExitance(const OrdinateStack& stack, const StackCount& count, Complex rate) {
    const std::vector<LayerRays> rays = stackRays(stack, count, rate);
    return leaving(stack, rays, solve(stack, rays, scatteringOf(stack, rays)));
}

StackFlux stackTransform(const OrdinateStack& stack, const StackCount& count, Complex rate) {
    const std::vector<LayerRays> rays = stackRays(stack, count, rate);
    const std::vector<OrdinateScattering> scattering = scatteringOf(stack, rays);
    StackFlux sum = leaving(stack, rays, solve(stack, rays, scattering));
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const OrdinateStack::Layer& layer = stack.layers[i];
        if (layer.sigma_s == 0) continue;
        sum -= firstOrder(layer, rays[i], scattering[i]);
        // Twice is done better by more directions.
        sum -= secondOrder(layer, rays[i], &scattering[i]);
        sum += secondOrder(layer, fineRays(stack, i, count, rate), nullptr);
    }
    return sum;
}

StackTotals stackTotals(const OrdinateStack& stack, int cosines, int angles) {
    const StackCount count{.escaping = cosines, .alone = 0, .trapped = cosines, .narrow = cosines, .azimuths = 1};
    const std::vector<LayerRays> rays = stackRays(stack, count, 0);
    const std::vector<OrdinateScattering> scattering = scatteringOf(stack, rays);
    const std::vector<Light> light = solve(stack, rays, scattering);
    const StackFlux out = leaving(stack, rays, light);
    StackTotals totals{out.R.real(), out.T.real(), {}, {}, {}};
    totals.R_a =
        anglesOf(rays.front(), light.front().top_up, rays.front().F_up, stack.layers.front().n, stack.n_above, angles);
    totals.T_a.assign(static_cast<std::size_t>(angles), 0.0);
    if (!std::isinf(stack.layers.back().thickness))
        totals.T_a = anglesOf(rays.back(), light.back().bottom_down, rays.back().F_down, stack.layers.back().n,
                              stack.n_below, angles);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const OrdinateStack::Layer& layer = stack.layers[i];
        const auto net = [&](const Vector& down, const Vector& up) {
            return (flux(layer, rays[i], down, nullptr) - flux(layer, rays[i], up, nullptr)).real();
        };
        if (layer.sigma_t == 0) {
            totals.absorbed.push_back(0);
            continue;
        }
        const double stays = 1 - std::exp(-layer.sigma_t / layer.beam_cosine * layer.thickness);
        totals.absorbed.push_back(net(light[i].top_down, light[i].top_up) +
                                  (std::isinf(layer.thickness) ? 0 : -net(light[i].bottom_down, light[i].bottom_up)) +
                                  stays * (layer.beam_down + layer.beam_up));
    }
    return totals;
}

}  // namespace searchlight
