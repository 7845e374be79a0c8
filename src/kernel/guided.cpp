#include "kernel/guided.h"

#include <Eigen/Dense>
#include <cmath>

namespace searchlight {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// One channel. Cells of one quadrant stand for the plane.
class Guide {
public:
    Guide(const CellKernel& truth, std::size_t channel, const GuidedOptions& options)
        : n_(static_cast<Index>(truth.size())), kernel_(n_, n_), weight_(n_, n_), width_(n_), options_(options) {
        const double extent = truth.edges.back();
        // Far out the middle of the cell will do; at the origin only the mean differs from 0.
        const auto middle = [&](Index i) {
            const auto at = static_cast<std::size_t>(i);
            return 0.5 * (truth.edges[at] + truth.edges[at + 1]) / extent;
        };
        for (Index i = 0; i < n_; ++i) width_(i) = truth.width(static_cast<std::size_t>(i));
        double square = 0;
        for (Index j = 0; j < n_; ++j)
            for (Index i = 0; i < n_; ++i) {
                const double x = middle(i), y = middle(j);
                double gamma = std::pow(x * x + y * y, options.k / 2);
                if (options.b > 0) gamma *= (1 - std::exp(-options.b * x * x)) * (1 - std::exp(-options.b * y * y));
                weight_(i, j) = gamma * width_(i) * width_(j);
                kernel_(i, j) = truth.mean[channel][static_cast<std::size_t>(j * n_ + i)];
                square += weight_(i, j) * kernel_(i, j) * kernel_(i, j);
            }
        soft_ = options.soft * square;
    }

    double mass(const VectorXd& a) const { return 2 * width_.dot(a); }

    double objective(const VectorXd& a) const {
        const double off = 1 - mass(a) * mass(a);
        return (weight_.array() * (kernel_ - a * a.transpose()).array().square()).sum() + soft_ * off * off;
    }

    // Minimises from `a`, in place; the number of steps.
    int run(VectorXd& a) const {
        const bool exact = options_.soft == 0;
        double value = objective(a), damping = 1e-3;
        int steps = 0;
        for (; steps < options_.max_steps; ++steps) {
            VectorXd gradient = -4 * (weight_.array() * (kernel_ - a * a.transpose()).array()).matrix() * a;
            MatrixXd hessian = 4 * (weight_.array() * (a * a.transpose()).array()).matrix();
            hessian.diagonal() += 4 * (weight_ * a.cwiseAbs2());
            const VectorXd sum = 2 * width_;
            if (!exact) {
                const double m = mass(a);
                gradient -= 4 * soft_ * (1 - m * m) * m * sum;
                hessian += 8 * soft_ * m * m * sum * sum.transpose();
            }
            double gained = -1;
            while (gained < 0 && damping < 1e12) {
                MatrixXd damped = hessian;
                damped.diagonal() *= 1 + damping;
                const Eigen::LDLT<MatrixXd> factor(damped);
                VectorXd step = -factor.solve(gradient);
                if (exact) {
                    const VectorXd along = factor.solve(sum);
                    step += ((1 - mass(a) - sum.dot(step)) / sum.dot(along)) * along;
                }
                VectorXd next = (a + step).cwiseMax(0);
                if (exact) next /= mass(next);
                const double after = objective(next);
                gained = value - after;
                if (gained >= 0) {
                    a = next;
                    value = after;
                    damping = std::max(0.1 * damping, 1e-9);
                } else
                    damping *= 10;
            }
            if (gained < 1e-9 * value) break;
        }
        return steps;
    }

private:
    Index n_;
    MatrixXd kernel_, weight_;
    VectorXd width_;
    GuidedOptions options_;
    double soft_ = 0;
};

}  // namespace

GuidedKernel guidedKernel(const CellKernel& truth, const SeparableKernel& start, const GuidedOptions& options) {
    GuidedKernel result;
    result.kernel = {.method = "guided", .terms = std::vector<KernelTerm>(1), .extent_mm = truth.edges.back()};
    for (std::size_t c = 0; c < Rgb::channels; ++c) {
        const LineKernel& line = start.terms[0].lines[c];
        if (line.extent() == 0) continue;
        const std::vector<double> means = cellsOfLine(line, truth.edges);
        VectorXd a = Eigen::Map<const VectorXd>(means.data(), static_cast<Index>(means.size()));
        const Guide guide(truth, c, options);
        a /= guide.mass(a);
        result.steps[c] = guide.run(a);
        result.kernel.terms[0].lines[c] = lineOfCells(truth.edges, {a.begin(), a.end()});
    }
    result.mass = result.kernel.mass();
    return result;
}

}  // namespace searchlight
