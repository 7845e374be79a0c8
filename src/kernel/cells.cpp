#include "kernel/cells.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace searchlight {

CellGrid thesisGrid(double shortest_mfp_mm, double longest_mfp_mm) {
    const double cell = shortest_mfp_mm / 20;
    return {.cell_mm = cell, .extent_mm = std::ceil(32 * longest_mfp_mm / cell) * cell};
}

CellGrid gridOf(const GroundTruth& truth, double rest) {
    double narrow = truth.extent(), wide = 0;
    for (int c = 0; c < Rgb::channels; ++c) {
        if (!truth.scatters(c)) continue;
        narrow = std::min(narrow, truth.radiusOf(0.5, c));
        wide = std::max(wide, truth.radiusOf(1 - rest, c));
    }
    return {.cell_mm = narrow / 20, .extent_mm = std::max(wide, narrow)};
}

std::vector<double> cellEdges(const CellGrid& grid) {
    std::vector<double> edges{0};
    double next = grid.centred ? 0.5 * grid.cell_mm : grid.cell_mm;
    while (edges.back() < grid.extent_mm) {
        edges.push_back(next);
        next += grid.cell_mm * std::max(1.0, std::floor(grid.growth * next / grid.cell_mm));
    }
    return edges;
}

double CellKernel::mass(int channel) const {
    double sum = 0;
    for (std::size_t j = 0; j < size(); ++j)
        for (std::size_t i = 0; i < size(); ++i)
            sum += width(i) * width(j) * mean[static_cast<std::size_t>(channel)][j * size() + i];
    return 4 * sum;
}

double CellKernel::norm(int channel) const {
    double sum = 0;
    for (std::size_t j = 0; j < size(); ++j)
        for (std::size_t i = 0; i < size(); ++i) {
            const double value = mean[static_cast<std::size_t>(channel)][j * size() + i];
            sum += width(i) * width(j) * value * value;
        }
    return std::sqrt(4 * sum);
}

namespace {

constexpr std::array<double, 4> abscissa{0.069431844202973713, 0.33000947820757187, 0.66999052179242813,
                                         0.93056815579702629};
constexpr std::array<double, 4> weight{0.17392742256872693, 0.32607257743127307, 0.32607257743127307,
                                       0.17392742256872693};

// Energy within the sector that the segment from (x, y0) to (x, y1) spans with the origin: the encircled energy
// integrated over the angle. An area's energy is the sum over its boundary, whatever R_d does at the origin.
Rgb sector(const GroundTruth& truth, double x, double y0, double y1) {
    const double from = std::atan2(y0, x), to = std::atan2(y1, x);
    Rgb sum;
    for (std::size_t k = 0; k < abscissa.size(); ++k)
        sum = sum + weight[k] * truth.encircled(x / std::cos(std::lerp(from, to, abscissa[k])));
    return ((to - from) / (2 * std::numbers::pi)) * sum;
}

// Mean over a cell so far out that R_d is smooth in it: within this many widths sectors are used instead.
constexpr double smooth_from = 4;

Rgb smoothMean(const GroundTruth& truth, double x0, double x1, double y0, double y1) {
    constexpr double half = 0.28867513459481287;  // of Gauss-Legendre with two points, per width
    Rgb sum;
    for (const double s : {0.5 - half, 0.5 + half})
        for (const double t : {0.5 - half, 0.5 + half})
            sum = sum + truth(std::hypot(std::lerp(x0, x1, s), std::lerp(y0, y1, t)));
    return 0.25 * sum;
}

Rgb cellMean(const GroundTruth& truth, double x0, double x1, double y0, double y1) {
    if (std::hypot(x0, y0) > smooth_from * std::max(x1 - x0, y1 - y0)) return smoothMean(truth, x0, x1, y0, y1);
    Rgb energy = sector(truth, x1, y0, y1) + sector(truth, y1, x0, x1);
    if (x0 > 0) energy = energy - sector(truth, x0, y0, y1);
    if (y0 > 0) energy = energy - sector(truth, y0, x0, x1);
    return (1 / ((x1 - x0) * (y1 - y0))) * energy;
}

}  // namespace

CellKernel cellKernel(const GroundTruth& truth, const CellGrid& grid) {
    CellKernel cells{.edges = cellEdges(grid)};
    const std::size_t n = cells.size();
    for (std::vector<double>& mean : cells.mean) mean.resize(n * n);
    const auto middle = [&](std::size_t i) {
        return i == 0 && grid.centred ? 0 : 0.5 * (cells.edges[i] + cells.edges[i + 1]);
    };
    for (std::size_t j = 0; j < n; ++j)
        for (std::size_t i = 0; i <= j; ++i) {
            const Rgb mean =
                grid.sampled ? truth(std::hypot(middle(i), middle(j)))
                             : cellMean(truth, cells.edges[i], cells.edges[i + 1], cells.edges[j], cells.edges[j + 1]);
            for (std::size_t c = 0; c < Rgb::channels; ++c)
                cells.mean[c][j * n + i] = cells.mean[c][i * n + j] = mean[static_cast<int>(c)];
        }
    for (int c = 0; c < Rgb::channels; ++c) {
        if (!truth.scatters(c)) cells.mean[static_cast<std::size_t>(c)][0] = 1 / (4 * cells.width(0) * cells.width(0));
        const double mass = cells.mass(c);
        for (double& value : cells.mean[static_cast<std::size_t>(c)]) value /= mass;
    }
    return cells;
}

CellKernel cellKernel(const SeparableKernel& kernel, const std::vector<double>& edges) {
    CellKernel cells{.edges = edges};
    const std::size_t n = cells.size();
    for (std::vector<double>& mean : cells.mean) mean.resize(n * n);
    for (const KernelTerm& term : kernel.terms) {
        const double angle = term.angle_deg * std::numbers::pi / 180, cosine = std::cos(angle), sine = std::sin(angle);
        for (std::size_t c = 0; c < Rgb::channels; ++c) {
            const LineKernel& line = term.lines[c];
            const double scale = term.scale[static_cast<int>(c)];
            if (term.angle_deg == 0) {
                const std::vector<double> means = cellsOfLine(line, edges);
                for (std::size_t j = 0; j < n; ++j)
                    for (std::size_t i = 0; i < n; ++i) cells.mean[c][j * n + i] += scale * means[i] * means[j];
                continue;
            }
            for (std::size_t j = 0; j < n; ++j)
                for (std::size_t i = 0; i < n; ++i)
                    for (const double s : {0.25, 0.75})
                        for (const double t : {0.25, 0.75}) {
                            const double x = std::lerp(edges[i], edges[i + 1], s);
                            const double y = std::lerp(edges[j], edges[j + 1], t);
                            cells.mean[c][j * n + i] +=
                                0.25 * scale * line(cosine * x + sine * y) * line(cosine * y - sine * x);
                        }
            cells.mean[c][0] += scale * line.delta() * line.delta() / (4 * cells.width(0) * cells.width(0));
        }
    }
    return cells;
}

Rgb kernelRms(const CellKernel& kernel, const CellKernel& truth) {
    Rgb rms;
    const std::size_t n = truth.size();
    for (std::size_t c = 0; c < Rgb::channels; ++c) {
        double sum = 0;
        for (std::size_t j = 0; j < n; ++j)
            for (std::size_t i = 0; i < n; ++i) {
                const double difference = kernel.mean[c][j * n + i] - truth.mean[c][j * n + i];
                sum += truth.width(i) * truth.width(j) * difference * difference;
            }
        rms[static_cast<int>(c)] = std::sqrt(4 * sum) / truth.norm(static_cast<int>(c));
    }
    return rms;
}

LineKernel lineOfCells(const std::vector<double>& edges, const std::vector<double>& means, double delta) {
    const std::size_t n = means.size();
    std::vector<double> integral{0}, density;
    for (std::size_t i = 0; i < n; ++i) integral.push_back(integral.back() + means[i] * (edges[i + 1] - edges[i]));
    density.push_back(means[0]);
    for (std::size_t i = 1; i < n; ++i) {
        const double before = edges[i] - edges[i - 1], after = edges[i + 1] - edges[i];
        density.push_back((means[i - 1] * after + means[i] * before) / (before + after));
    }
    density.push_back(0);
    return {edges, std::move(integral), std::move(density), delta};
}

std::vector<double> cellsOfLine(const LineKernel& line, const std::vector<double>& edges) {
    std::vector<double> means;
    for (std::size_t i = 0; i + 1 < edges.size(); ++i)
        means.push_back(line.integral(edges[i], edges[i + 1]) / (edges[i + 1] - edges[i]));
    means[0] += 0.5 * line.delta() / edges[1];
    return means;
}

}  // namespace searchlight
