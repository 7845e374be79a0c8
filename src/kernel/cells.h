// A kernel on a grid: what singular vectors, guided optimisation and errors in kernel space are about.
#pragma once

#include <array>
#include <vector>

#include "kernel/ground_truth.h"
#include "kernel/kernel.h"

namespace searchlight {

/// A uniform grid of square cells about the origin, known by the half-axis: the kernel is even. Cells far out are
/// merged, where the kernel is smooth, so that thousands of them cost a hundred: sums over the grid then run over
/// merged cells, weighted by their area.
struct CellGrid {
    double cell_mm = 0;    ///< side of a cell
    double extent_mm = 0;  ///< half of the grid's side
    bool centred = true;   ///< a cell's middle, not a corner, is at the origin: an odd count of cells per side
    double growth = 0.06;  ///< a merged cell is at most this fraction of its distance wide
    /// R_d is taken at the middle of a cell, as a table of samples has it, instead of its mean over the cell.
    bool sampled = false;
};

/// The rule of [Freude2014] Table 6.1: a cell is a twentieth of the shortest mean free path of the three channels, the
/// extent 32 of the longest.
CellGrid thesisGrid(double shortest_mfp_mm, double longest_mfp_mm);

/// Cells of a twentieth of the radius of half the energy of the narrowest channel; the extent holds all but `rest` of
/// the widest.
CellGrid gridOf(const GroundTruth& truth, double rest = 1e-4);

/// Ascending edges of the merged cells along the half-axis, n + 1 from 0.
std::vector<double> cellEdges(const CellGrid& grid);

/// Mean densities over products of merged cells: symmetric, n x n, row by row; 1/mm^2.
struct CellKernel {
    std::vector<double> edges;
    std::array<std::vector<double>, Rgb::channels> mean;

    std::size_t size() const { return edges.size() - 1; }
    double width(std::size_t i) const { return edges[i + 1] - edges[i]; }
    /// Integral over the plane of one channel.
    double mass(int channel) const;
    /// sqrt of the integral of the square over the plane.
    double norm(int channel) const;
};

/// The ground truth on a grid; means are exact also where R_d is infinite at the origin. Divided by their own sum, so
/// that the grid's kernel has mass 1, as [Freude2014] has it; what lies outside is cut, and its part of the energy is
/// 1 - truth.encircled at the extent, more or less corners.
CellKernel cellKernel(const GroundTruth& truth, const CellGrid& grid);

/// A separable kernel on the same cells. Terms at angles other than 0 are taken at four points of each cell.
CellKernel cellKernel(const SeparableKernel& kernel, const std::vector<double>& edges);

/// Root of the mean square of the difference of cells, over that of `truth` alone; per channel.
Rgb kernelRms(const CellKernel& kernel, const CellKernel& truth);

/// A line through the mean values of the half-axis' cells: it keeps their integrals.
LineKernel lineOfCells(const std::vector<double>& edges, const std::vector<double>& means, double delta = 0);

/// Means of a line over the half-axis' cells; the delta is part of the first.
std::vector<double> cellsOfLine(const LineKernel& line, const std::vector<double>& edges);

}  // namespace searchlight
