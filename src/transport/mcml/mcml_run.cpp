#include "transport/mcml/mcml_run.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace searchlight {

namespace {

constexpr double kMmPerCm = 10;
// MCML has no half-space; its files say 1e8 cm.
constexpr double kEndless_cm = 1e7;

// From the slots of the walk to MCML's cells. The first slot in radius is empty (edges begin at 0), the last, like that
// in depth, falls into the cell before it.
class Cells {
public:
    Cells(const McmlRun& run, const SlabResult& result)
        : run_(run), layout_(slabLayout(slabProblem(run), slabOptions(run))), flux_(result.flux) {}

    std::vector<double> radial(SlabLayout::Run slots, double unscattered) const {
        std::vector<double> cells(nr());
        for (std::size_t i = 1; i <= nr() + 1; ++i) cells[std::min(i, nr()) - 1] += at(slots, i);
        cells[0] += unscattered;
        for (std::size_t i = 0; i < cells.size(); ++i) cells[i] /= annulus(i);
        return cells;
    }

    std::vector<double> angular(SlabLayout::Run slots, double unscattered) const {
        std::vector<double> cells(na());
        for (std::size_t i = 0; i < na(); ++i) cells[i] = at(slots, i);
        cells[0] += unscattered;
        for (std::size_t i = 0; i < na(); ++i) cells[i] /= 2 * std::numbers::pi * std::sin(angle(i)) * step();
        return cells;
    }

    std::vector<double> depths() const {
        std::vector<double> cells(nz());
        for (std::size_t i = 0; i <= nz(); ++i) cells[std::min(i, nz() - 1)] += at(SlabLayout::A_z, i) / run_.dz;
        return cells;
    }

    std::vector<double> radialAngular(SlabLayout::Run slots, double unscattered) const {
        std::vector<double> cells(nr() * na());
        for (std::size_t i = 1; i <= nr() + 1; ++i)
            for (std::size_t j = 0; j < na(); ++j) cells[(std::min(i, nr()) - 1) * na() + j] += at(slots, i * na() + j);
        cells[0] += unscattered;
        for (std::size_t i = 0; i < nr(); ++i)
            for (std::size_t j = 0; j < na(); ++j)
                cells[i * na() + j] /=
                    annulus(i) * 2 * std::numbers::pi * std::sin(0.5 * step()) * std::sin(2 * angle(j));
        return cells;
    }

    std::vector<double> radialDepths() const {
        std::vector<double> cells(nr() * nz());
        for (std::size_t i = 1; i <= nr() + 1; ++i)
            for (std::size_t j = 0; j <= nz(); ++j)
                cells[(std::min(i, nr()) - 1) * nz() + std::min(j, nz() - 1)] +=
                    at(SlabLayout::A_rz, i * (nz() + 1) + j);
        for (std::size_t i = 0; i < cells.size(); ++i) cells[i] /= annulus(i / nz()) * run_.dz;
        return cells;
    }

private:
    std::size_t nr() const { return static_cast<std::size_t>(run_.nr); }
    std::size_t nz() const { return static_cast<std::size_t>(run_.nz); }
    std::size_t na() const { return static_cast<std::size_t>(run_.na); }
    double step() const { return 0.5 * std::numbers::pi / run_.na; }
    double angle(std::size_t i) const { return (static_cast<double>(i) + 0.5) * step(); }
    double annulus(std::size_t i) const {  // cm^2
        return 2 * std::numbers::pi * (static_cast<double>(i) + 0.5) * run_.dr * run_.dr;
    }
    double at(SlabLayout::Run slots, std::size_t index) const { return flux_[layout_.first(slots) + index]; }

    const McmlRun& run_;
    SlabLayout layout_;
    const std::vector<double>& flux_;
};

}  // namespace

SlabProblem slabProblem(const McmlRun& run) {
    SlabProblem problem{.n_above = run.n_above, .n_below = run.n_below};
    for (const McmlLayer& layer : run.layers) {
        SlabLayer& mm = problem.layers.emplace_back(SlabLayer{.n = layer.n,
                                                              .sigma_a = layer.mua / kMmPerCm,
                                                              .sigma_s = layer.mus / kMmPerCm,
                                                              .g = layer.g,
                                                              .thickness_mm = layer.d * kMmPerCm});
        if (layer.d >= kEndless_cm && problem.layers.size() == run.layers.size() && !mm.clear())
            mm.thickness_mm = std::numeric_limits<double>::infinity();
    }
    return problem;
}

SlabOptions slabOptions(const McmlRun& run) {
    SlabOptions options;
    options.walks = run.photons;
    for (int i = 0; i <= run.nr; ++i) options.edges_mm.push_back(run.dr * kMmPerCm * i);
    options.angles = run.na;
    options.depths = run.nz;
    options.depth_mm = run.dz * kMmPerCm * run.nz;
    options.maps = true;
    return options;
}

McmlOutput mcmlOutput(const McmlRun& run, const SlabResult& result) {
    McmlOutput output;
    output.run = run;
    output.specular = result.specular;
    const double R0 = result.R_unscattered.mean, T0 = result.T_unscattered.mean;
    output.Rd = result.R.mean + R0;
    output.Rd_error = std::hypot(result.R.standard_error, result.R_unscattered.standard_error);
    output.A = result.A.mean;
    output.A_error = result.A.standard_error;
    output.Tt = result.T.mean + T0;
    output.Tt_error = std::hypot(result.T.standard_error, result.T_unscattered.standard_error);
    for (const Estimate& layer : result.A_layer) output.A_l.push_back(layer.mean);
    const Cells cells(run, result);
    output.A_z = cells.depths();
    output.Rd_r = cells.radial(SlabLayout::R_r, R0);
    output.Rd_a = cells.angular(SlabLayout::R_a, R0);
    output.Tt_r = cells.radial(SlabLayout::T_r, T0);
    output.Tt_a = cells.angular(SlabLayout::T_a, T0);
    output.A_rz = cells.radialDepths();
    output.Rd_ra = cells.radialAngular(SlabLayout::R_ra, R0);
    output.Tt_ra = cells.radialAngular(SlabLayout::T_ra, T0);
    return output;
}

}  // namespace searchlight
