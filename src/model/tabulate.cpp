#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "base/error.h"
#include "model/plane.h"

namespace searchlight {

namespace {

// Where 2 pi r^2 R_d, the flux per unit of ln r, is below this fraction of its largest value, an error does not matter.
constexpr double negligible = 1e-6;

class Tabulator {
public:
    Tabulator(Evaluator& evaluator, const Model& model, const Medium& medium)
        : evaluator_(evaluator), model_(model), medium_(medium) {}

    Tabulation run(double relative_error) {
        chooseRadii();
        Tabulation result{Profile(radii_, values_)};
        // Each round at least halves the intervals that fail; 40 rounds end at the spacing of doubles.
        for (int round = 0; round < 40; ++round) {
            result.max_relative_error = refine(result.profile, relative_error);
            if (result.max_relative_error <= relative_error) break;
            result.profile = Profile(radii_, values_);
        }
        result.tail = tail(result.profile);
        return result;
    }

private:
    std::vector<Rgb> Rd(const std::vector<double>& radii) {
        std::vector<Rgb> found = radialRd(evaluator_, model_, medium_, 0, radii);
        for (std::size_t i = 0; i < radii.size(); ++i)
            for (int c = 0; c < Rgb::channels; ++c) {
                if (medium_.scatters(c) || std::isfinite(found[i][c])) continue;
                found[i][c] = 0;  // "not applicable"
            }
        return found;
    }

    static bool isFinite(Rgb value) {
        return std::isfinite(value.r) && std::isfinite(value.g) && std::isfinite(value.b);
    }

    static double fluxPerLog(double r, double Rd) { return 2 * std::numbers::pi * r * r * std::abs(Rd); }

    bool matters(double r, Rgb Rd, int c, double fraction) const {
        return fluxPerLog(r, Rd[c]) > fraction * largest_flux_[c];
    }

    bool matters(double r, Rgb Rd, double fraction) const {
        return matters(r, Rd, 0, fraction) || matters(r, Rd, 1, fraction) || matters(r, Rd, 2, fraction);
    }

    // Looks over every length that the profile may have, then keeps what matters, with one radius on either side.
    void chooseRadii() {
        double shortest = 1e-2, longest = 10;  // mm: of profiles that do not depend on the medium
        for (int c = 0; c < Rgb::channels; ++c) {
            shortest = std::min(shortest, 1 / medium_.sigmaTp()[c]);
            longest = std::max(longest, 1 / medium_.sigmaTp()[c]);
        }
        std::vector<double> radii;
        for (double r = 1e-7 * shortest; r < 1e6 * longest; r *= 1.25) radii.push_back(r);
        const std::vector<Rgb> values = Rd(radii);
        for (std::size_t i = 0; i < radii.size(); ++i) {
            if (!isFinite(values[i]))
                throw inputError(fmt::format("the model is not finite at r = {:.3g} mm", radii[i]))
                    .at(model_.file.path);
            for (int c = 0; c < Rgb::channels; ++c)
                largest_flux_[c] = std::max(largest_flux_[c], fluxPerLog(radii[i], values[i][c]));
        }
        std::size_t first = 0, last = radii.size() - 1;
        while (first + 8 < last && !matters(radii[first + 1], values[first + 1], negligible)) ++first;
        // The tail is dropped later than errors are ignored: it is never seen again.
        while (last > first + 4 && !matters(radii[last - 1], values[last - 1], 1e-3 * negligible)) --last;
        const Rgb centre = Rd({0.0})[0];
        if (isFinite(centre)) add(0, centre);
        for (std::size_t i = first; i <= last; ++i) add(radii[i], values[i]);
    }

    void add(double r, Rgb value) {
        radii_.push_back(r);
        values_.push_back(value);
    }

    // Largest error at three points of each interval; halves the intervals where it exceeds the goal.
    double refine(const Profile& profile, double goal) {
        std::vector<double> probes;
        for (std::size_t i = 0; i + 1 < radii_.size(); ++i)
            for (const double t : {0.25, 0.5, 0.75}) probes.push_back(std::lerp(radii_[i], radii_[i + 1], t));
        const std::vector<Rgb> exact = Rd(probes);
        const std::vector<double> radii = std::move(radii_);
        const std::vector<Rgb> values = std::move(values_);
        radii_.clear();
        values_.clear();
        double worst = 0;
        for (std::size_t i = 0; i < radii.size(); ++i) {
            add(radii[i], values[i]);
            if (i + 1 == radii.size()) break;
            double here = 0;
            for (int c = 0; c < Rgb::channels; ++c) {
                // An interval matters as a whole: where the profile falls steeply only one end may.
                if (!matters(radii[i], values[i], c, negligible) &&
                    !matters(radii[i + 1], values[i + 1], c, negligible))
                    continue;
                for (std::size_t k = 3 * i; k < 3 * i + 3; ++k)
                    here = std::max(here, std::abs(profile(probes[k])[c] / exact[k][c] - 1));
            }
            worst = std::max(worst, here);
            if (here > goal) add(probes[3 * i + 1], exact[3 * i + 1]);
        }
        return worst;
    }

    // Largest fraction of the total beyond the last radius, by the trapezoidal rule over ln r: a few digits are enough.
    double tail(const Profile& profile) {
        constexpr double step = 0.02;
        std::vector<double> radii;
        for (int i = 0; i < 800; ++i) radii.push_back(profile.radii().back() * std::exp(step * i));
        const std::vector<Rgb> values = Rd(radii);
        double largest = 0;
        for (int c = 0; c < Rgb::channels; ++c) {
            double beyond = 0;
            for (std::size_t i = 0; i < radii.size(); ++i)
                beyond += (i == 0 ? 0.5 : 1) * step * fluxPerLog(radii[i], values[i][c]);
            if (profile.total()[c] > 0) largest = std::max(largest, beyond / (profile.total()[c] + beyond));
        }
        return largest;
    }

    Evaluator& evaluator_;
    const Model& model_;
    const Medium& medium_;
    std::vector<double> radii_;
    std::vector<Rgb> values_;
    Rgb largest_flux_;
};

}  // namespace

Tabulation tabulate(Evaluator& evaluator, const Model& model, const Medium& medium, double relative_error) {
    return Tabulator(evaluator, model, medium).run(relative_error);
}

}  // namespace searchlight
