#include "validate/check_bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/error.h"
#include "base/text.h"

namespace searchlight {

namespace {

// Van der Corput: the digits of `index` mirrored at the point.
double radicalInverse(unsigned base, unsigned index) {
    double value = 0, digit = 1;
    for (; index > 0; index /= base) {
        digit /= base;
        value += digit * (index % base);
    }
    return value;
}

Vec3 circlePoint(double r, double turn) {
    const double angle = 2 * std::numbers::pi * turn;
    return {r * std::cos(angle), r * std::sin(angle), 0};
}

}  // namespace

Finding passed(std::string detail) { return {CheckResult::Outcome::passed, std::move(detail)}; }
Finding failed(std::string detail) { return {CheckResult::Outcome::failed, std::move(detail)}; }
Finding reported(std::string detail) { return {CheckResult::Outcome::reported, std::move(detail)}; }
Finding skipped(std::string detail) { return {CheckResult::Outcome::skipped, std::move(detail)}; }

Medium mediumOf(const Rgb& alpha_prime, double g, double eta) {
    Medium medium;
    medium.eta = eta;
    medium.g = {g, g, g};
    for (int c = 0; c < Rgb::channels; ++c) {
        medium.sigma_a[c] = 1 - alpha_prime[c];
        medium.sigma_s[c] = alpha_prime[c] / (1 - g);
    }
    return medium;
}

const std::vector<Medium>& checkMedia() {
    static const std::vector<Medium> media = [] {
        std::vector<Medium> list;
        for (const double eta : {1.0, 1.3, 1.5})
            for (const double g : {0.0, 0.8})
                for (const Rgb& alpha_prime : {Rgb{0.1, 0.5, 0.8}, Rgb{0.9, 0.99, 0.999}})
                    list.push_back(mediumOf(alpha_prime, g, eta));
        return list;
    }();
    return media;
}

std::string mediumText(const Medium& medium, int channel) {
    return fmt::format("alpha' {}, IOR {}, g {}", prettyNumber(medium.alphaPrime()[channel]), prettyNumber(medium.eta),
                       prettyNumber(medium.g[channel]));
}

std::array<double, 9> haltonPoint(unsigned index) {
    constexpr std::array<unsigned, 9> primes{2, 3, 5, 7, 11, 13, 17, 19, 23};
    std::array<double, 9> point{};
    for (std::size_t k = 0; k < primes.size(); ++k) point[k] = radicalInverse(primes[k], index);
    return point;
}

Vec3 hemisphereDirection(double u, double v, double least_cosine) {
    const double z = least_cosine + (1 - least_cosine) * u;
    const Vec3 flat = circlePoint(std::sqrt(1 - z * z), v);
    return {flat.x, flat.y, z};
}

Probe makeProbe(const ProbeOptions& options) {
    Probe probe;
    probe.directions = options.directions;
    for (int i = 0; i < options.radii; ++i)
        probe.radii_mm.push_back(1e-3 * std::pow(30 / 1e-3, static_cast<double>(i) / (options.radii - 1)));
    unsigned index = 0;
    for (const double r : probe.radii_mm) {
        for (int k = 0; k < options.directions; ++k) {
            const auto u = haltonPoint(++index);
            Query query;
            query.ni = query.no = {0, 0, 1};
            query.wi = hemisphereDirection(u[0], u[1], options.least_cosine);
            query.wo = hemisphereDirection(u[2], u[3], options.least_cosine);
            query.xo = circlePoint(r, u[4]);
            if (options.tilted_exit) {
                const double height = 2 * u[5] - 1;
                query.xo = std::sqrt(1 - height * height) * query.xo;
                query.xo.z = r * height;
                query.no = hemisphereDirection(u[6], u[7]);
                // Leaves on the outer side of its own tangent plane.
                if (dot(query.wo, query.no) <= 0) query.wo = query.no;
            }
            probe.queries.push_back(query);
        }
    }
    return probe;
}

CheckBench::CheckBench(const Model& model, const ParamValues& parameters, const EvaluatorFactory& factory,
                       Observer& observer)
    : model_(model), parameters_(parameters), observer_(observer) {
    if (model.shipped || model.measured) native_ = factory(model, "cpu");
    if (model.measured) return;
    try {
        gl_ = factory(model, "gl");
    } catch (const Error& error) {
        if (error.kind != ErrorKind::device || !native_) throw;
        no_gl_ = error.what();
    }
}

void CheckBench::pollCancelled() const {
    if (observer_.cancelled()) throw interruptedError();
}

std::vector<Rgb> CheckBench::values(const Medium& medium, const Probe& probe, const ParamValues& parameters) {
    pollCancelled();
    evaluator().set(medium, parameters);
    std::vector<Rgb> values(probe.queries.size());
    evaluator().evaluate(probe.queries, values);
    return values;
}

Difference CheckBench::difference(const Medium& medium, const Probe& probe, const std::vector<Rgb>& a,
                                  const std::vector<Rgb>& b) {
    Difference worst;
    const auto step = static_cast<std::size_t>(probe.directions);
    for (std::size_t first = 0; first < a.size(); first += step) {
        for (int c = 0; c < Rgb::channels; ++c) {
            double scale = 0, gap = 0;
            for (std::size_t i = first; i < first + step; ++i) {
                scale = std::max({scale, std::abs(a[i][c]), std::abs(b[i][c])});
                // Written so that NaN is a difference.
                if (const double d = std::abs(a[i][c] - b[i][c]); !(d <= gap))
                    gap = std::isnan(d) ? std::numeric_limits<double>::infinity() : d;
            }
            if ((scale > 1e-30 || std::isinf(gap)) && gap > worst.relative * scale)
                worst = {std::isinf(gap) ? gap : gap / scale,
                         fmt::format("r {} mm, {}", prettyNumber(probe.radius(first), 3), mediumText(medium, c))};
        }
    }
    return worst;
}

bool CheckBench::readsMedium() {
    const Probe probe = makeProbe({.radii = 10, .directions = 2});
    const std::vector<Rgb> first = values(checkMedia().front(), probe);
    return std::ranges::any_of(checkMedia(), [&](const Medium& medium) { return values(medium, probe) != first; });
}

}  // namespace searchlight
