#include "job/contest/contest_score.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/text.h"

namespace searchlight {

namespace {

// Relative standard error of a squared standard error, from 32 steps: 2 x 13 %.
constexpr double squares_known_to = 0.26;

// Stops that bring what 2 % of the pixels that count exceed to 0.8, as `render` chooses them.
double exposureOf(const Image& image) {
    std::vector<float> brightest;
    for (const Rgba& p : image.pixels)
        if (p.a > 0) brightest.push_back(std::max({p.r, p.g, p.b}));
    if (brightest.empty()) return 0;
    const auto at = brightest.begin() + static_cast<std::ptrdiff_t>(0.98 * static_cast<double>(brightest.size() - 1));
    std::ranges::nth_element(brightest, at);
    return *at > 0 ? std::log2(0.8 / *at) : 0;
}

ImageErrorOptions at(double exposure, int threads) { return {.exposure = exposure, .threads = threads}; }

// Where both count.
Image common(const Image& reference, const Image& mask) {
    Image image = reference;
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        if (mask.pixels[i].a < 0.999f) image.pixels[i] = {0, 0, 0, 0};
    return image;
}

double quadrature(double a, double b) { return std::sqrt(a * a + b * b); }

}  // namespace

JudgedError judged(double raw, double noise) {
    const double square = raw * raw - noise * noise, slack = 2 * squares_known_to * noise * noise;
    JudgedError error{.raw = raw};
    error.error = std::sqrt(std::max(0.0, square));
    error.lower = std::sqrt(std::max(0.0, square - slack));
    error.upper = std::sqrt(std::max(0.0, square) + slack);
    error.resolved = square > slack;
    return error;
}

ContestScore scoreContest(const std::vector<std::vector<CellRun>>& runs, const ReferencePicture& direct,
                          const ReferencePicture& walked, int threads) {
    ContestScore score;
    score.exposure = exposureOf(direct.image);
    const bool walks = !walked.empty();
    Image inner;
    double walk_noise = 0;
    if (walks) {
        inner = common(walked.image, direct.image);
        walk_noise = relativeNoise(inner, walked.standard_error);
        const ImageError error = compareImages(direct.image, inner, at(score.exposure, threads));
        score.model = judged(error.relative_rmse, quadrature(walk_noise, direct.noise));
        score.model_mean = error.mean_difference;
    }
    for (const std::vector<CellRun>& of_one : runs) {
        std::vector<CellScore>& cells = score.cells.emplace_back();
        for (const CellRun& run : of_one) {
            CellScore cell;
            cell.against_direct = compareImages(run.image, direct.image, at(score.exposure, threads));
            cell.direct = judged(cell.against_direct.relative_rmse, direct.noise);
            if (walks) {
                const ImageError error = compareImages(run.image, inner, at(score.exposure, threads));
                cell.walked = judged(error.relative_rmse, walk_noise);
                cell.walked_mean = error.mean_difference;
            }
            cells.push_back(cell);
        }
    }
    return score;
}

std::vector<BackendStandings> standingsOf(const ContestPlan& plan, const std::vector<std::vector<CellRun>>& runs,
                                          const ContestScore& score, const ReferencePicture& direct, bool cpu_time) {
    // Of errors below this one cannot say which is less.
    const double floor = judged(direct.noise, direct.noise).upper;
    std::vector<BackendStandings> all;
    for (const bool gl : {false, true}) {
        BackendStandings standings{.gl = gl};
        for (std::size_t k = 0; k < plan.contestants.size(); ++k) {
            if (plan.contestants[k].gl != gl) continue;
            std::vector<CostPoint> points;
            for (std::size_t i = 0; i < runs[k].size(); ++i) {
                const JudgedError& error = score.cells[k][i].direct;
                points.push_back({cpu_time ? runs[k][i].cpu_ms : runs[k][i].wall_ms, std::max(error.error, floor)});
            }
            standings.labels.push_back(plan.contestants[k].label);
            standings.curves.emplace_back(std::move(points));
        }
        if (standings.curves.empty()) continue;
        standings.by_time = nearestOverTime(standings.curves, floor);
        standings.by_error = fastestOverError(standings.curves, floor);
        if (score.model.resolved) {
            double from = INFINITY;
            for (const ErrorCurve& curve : standings.curves) from = std::min(from, curve.timeTo(score.model.error));
            if (std::isfinite(from)) standings.model_from_ms = from;
        }
        all.push_back(std::move(standings));
    }
    return all;
}

std::string winnersText(const ContestPlan& plan, const std::vector<BackendStandings>& standings,
                        const ContestScore& score, const ReferencePicture& direct, const ReferencePicture& walked) {
    std::vector<std::string> parts;
    for (const BackendStandings& each : standings) {
        const std::string device = each.gl ? "on OpenGL" : "on the CPU";
        std::string part = fmt::format("{} the nearest to direct is {}", device, reignText(each.by_time, each.labels));
        if (!each.by_error.empty())
            part += fmt::format("; the fastest {} is {}", device, reignText(each.by_error, each.labels));
        parts.push_back(std::move(part));
    }
    std::string text = join(parts, "; ");
    if (!text.empty()) text.front() = 'O';
    text +=
        fmt::format("; differences below {} are noise of direct", errorText(judged(direct.noise, direct.noise).upper));
    if (walked.empty()) return text + ".";
    if (!score.model.resolved)
        return text +
               fmt::format("; against the path-traced reference {}'s own error is not told from its noise of {}.",
                           plan.scene.model.id, errorText(walked.noise));
    text += fmt::format("; against the path-traced reference {}'s own error of {}", plan.scene.model.id,
                        errorText(score.model.error));
    std::vector<std::string> times;
    for (const BackendStandings& each : standings) {
        const bool at_once = each.model_from_ms > 0 && each.model_from_ms <= each.by_time.front().from_ms;
        const std::string device = standings.size() == 1 ? "" : each.gl ? " on OpenGL" : " on the CPU";
        if (at_once)
            times.push_back(fmt::format("at all times{}", device));
        else if (each.model_from_ms > 0)
            times.push_back(fmt::format("after {}{}", durationText(each.model_from_ms), device));
        else
            times.push_back(fmt::format("never{}", device));
    }
    return text + fmt::format(" dominates {}.", join(times, ", "));
}

}  // namespace searchlight
