#include "kernel/guided.h"

#include "kernel/preintegrated.h"
#include "kernel/profiles.h"
#include "kernel/singular.h"

namespace searchlight {
namespace {

class Guided : public testing::Test {
protected:
    GroundTruth truth = burleyTruth();
    CellKernel cells = cellKernel(truth, CellGrid{.cell_mm = 0.05, .extent_mm = 30});
    SeparableKernel start = preintegrated(truth);

    double error(const SeparableKernel& kernel) { return kernelRms(cellKernel(kernel, cells.edges), cells).r; }
};

TEST_F(Guided, KeepsEnergyToRounding) {
    for (const double k : {0.0, 1.0, 2.0}) {
        const GuidedKernel guided = guidedKernel(cells, start, {.k = k});
        EXPECT_NEAR(guided.mass.r, 1, 1e-12) << k;
        EXPECT_NEAR(guided.mass.g, 1, 1e-12) << k;
    }
}

TEST_F(Guided, WithoutConstraintAndGuideIsTheFirstSingularVector) {
    const GuidedKernel guided = guidedKernel(cells, start, {.k = 0, .soft = 1e-12, .max_steps = 1000});
    // A minimum: errors of the line are squared in it.
    EXPECT_NEAR(error(guided.kernel), error(singularKernel(cells, 1).raw), 1e-6);
}

TEST_F(Guided, ErrsLeastOfAllLinesOfMass1WhereTheGuideIsEven) {
    const GuidedKernel guided = guidedKernel(cells, start, {.k = 0});
    EXPECT_LT(error(guided.kernel), error(start));
    EXPECT_LT(error(guided.kernel), error(singularKernel(cells, 1).normalised));
    EXPECT_GT(error(guided.kernel), error(singularKernel(cells, 1).raw));
}

TEST_F(Guided, IsAMinimumUnderItsGuide) {
    // Small changes that keep the mass make the guided objective larger: a line between it and another is worse.
    const auto objective = [&](const SeparableKernel& kernel) {
        const CellKernel made = cellKernel(kernel, cells.edges);
        double sum = 0;
        for (std::size_t j = 0; j < cells.size(); ++j)
            for (std::size_t i = 0; i < cells.size(); ++i) {
                const double x = 0.5 * (cells.edges[i] + cells.edges[i + 1]);
                const double y = 0.5 * (cells.edges[j] + cells.edges[j + 1]);
                const double off = made.mean[0][j * cells.size() + i] - cells.mean[0][j * cells.size() + i];
                sum += std::hypot(x, y) * cells.width(i) * cells.width(j) * off * off;
            }
        return sum;
    };
    const SeparableKernel guided = guidedKernel(cells, start, {.k = 1}).kernel;
    const double least = objective(guided);
    for (const double part : {0.02, -0.02}) {
        const std::vector<double> a = cellsOfLine(guided.terms[0].lines[0], cells.edges);
        const std::vector<double> b = cellsOfLine(start.terms[0].lines[0], cells.edges);
        std::vector<double> mixed;
        for (std::size_t i = 0; i < a.size(); ++i) mixed.push_back(a[i] + part * (b[i] - a[i]));
        SeparableKernel other = guided;
        other.terms[0].lines[0] = lineOfCells(cells.edges, mixed);
        EXPECT_GT(objective(other), least) << part;
    }
}

}  // namespace
}  // namespace searchlight
