#include "validate/minimise.h"

#include <nlopt.h>

#include <algorithm>
#include <exception>
#include <limits>
#include <memory>

namespace searchlight {

namespace {

// The library is C: an exception waits here until it has returned.
struct Call {
    const Objective* objective;
    nlopt_opt optimiser;
    std::exception_ptr thrown;
    Minimum best{.value = std::numeric_limits<double>::infinity()};
};

double evaluate(unsigned count, const double* x, double* gradient, void* data) {
    Call& call = *static_cast<Call*>(data);
    try {
        const double value = (*call.objective)({x, count}, {gradient, gradient ? count : 0});
        ++call.best.evaluations;
        if (value < call.best.value) {
            call.best.value = value;
            call.best.x.assign(x, x + count);
        }
        return value;
    } catch (...) {
        call.thrown = std::current_exception();
        nlopt_force_stop(call.optimiser);
        return std::numeric_limits<double>::infinity();
    }
}

}  // namespace

Minimum minimise(const Objective& objective, std::vector<double> start, const std::vector<double>& lower,
                 const std::vector<double>& upper, int max_evaluations) {
    for (std::size_t i = 0; i < start.size(); ++i) start[i] = std::clamp(start[i], lower[i], upper[i]);
    const std::unique_ptr<nlopt_opt_s, decltype(&nlopt_destroy)> optimiser(
        nlopt_create(NLOPT_LD_SLSQP, static_cast<unsigned>(start.size())), nlopt_destroy);
    Call call{&objective, optimiser.get(), nullptr};
    nlopt_set_min_objective(optimiser.get(), evaluate, &call);
    nlopt_set_lower_bounds(optimiser.get(), lower.data());
    nlopt_set_upper_bounds(optimiser.get(), upper.data());
    nlopt_set_xtol_rel(optimiser.get(), 1e-10);
    nlopt_set_ftol_rel(optimiser.get(), 1e-10);
    nlopt_set_maxeval(optimiser.get(), max_evaluations);
    double value = 0;
    // Stopping at the limit of rounding is no failure: the best point seen counts.
    nlopt_optimize(optimiser.get(), start.data(), &value);
    if (call.thrown) std::rethrow_exception(call.thrown);
    if (call.best.x.empty()) call.best.x = start;
    return call.best;
}

}  // namespace searchlight
