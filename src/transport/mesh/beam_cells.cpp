#include "transport/mesh/beam_cells.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace searchlight {

namespace {

constexpr double kFewestCells = 8;  // along the mesh: facets about as large as cells

}  // namespace

void Box::hold(Vec3 p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
}

Box Box::both(const Box& other) const {
    const auto along = [](double from, double to, double other_from, double other_to) {
        const double begin = std::clamp(other_from, from, to);
        return std::pair{begin, std::max(begin, std::min(to, other_to))};
    };
    const auto [x0, x1] = along(low.x, high.x, other.low.x, other.high.x);
    const auto [y0, y1] = along(low.y, high.y, other.low.y, other.high.y);
    const auto [z0, z1] = along(low.z, high.z, other.low.z, other.high.z);
    return {{x0, y0, z0}, {x1, y1, z1}};
}

BeamCells::BeamCells(const Mesh& mesh, double most) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Box box{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
    for (const Vec3f& p : mesh.positions) box.hold(toDouble(p));
    const Vec3 extent = box.high - box.low;
    const double longest = std::max({extent.x, extent.y, extent.z});
    diagonal_mm_ = length(extent);
    cell_mm_ = longest / std::clamp(std::sqrt(static_cast<double>(mesh.triangles.size()) / 6), kFewestCells, most);
    low_ = box.low;
    const auto cells = [&](double side) { return static_cast<std::int32_t>(side / cell_mm_) + 1; };
    nx_ = cells(extent.x), ny_ = cells(extent.y), nz_ = cells(extent.z);
}

std::size_t BeamCells::count() const {
    return static_cast<std::size_t>(nx_) * static_cast<std::size_t>(ny_) * static_cast<std::size_t>(nz_);
}

std::size_t BeamCells::at(Vec3f position) const {
    const auto along = [&](float p, double low, std::int32_t n) {
        return static_cast<std::size_t>(std::clamp((static_cast<double>(p) - low) / cell_mm_, 0.0, n - 1.0));
    };
    return (along(position.z, low_.z, nz_) * static_cast<std::size_t>(ny_) + along(position.y, low_.y, ny_)) *
               static_cast<std::size_t>(nx_) +
           along(position.x, low_.x, nx_);
}

Box BeamCells::boxOf(std::size_t cell) const {
    const auto nx = static_cast<std::size_t>(nx_), ny = static_cast<std::size_t>(ny_);
    const Vec3 low = low_ + cell_mm_ * Vec3{static_cast<double>(cell % nx), static_cast<double>(cell / nx % ny),
                                            static_cast<double>(cell / (nx * ny))};
    return {low, low + cell_mm_ * Vec3{1, 1, 1}};
}

// Visits cells slice by slice, with where the slice begins, until a visit returns false.
template <class Visit>
void BeamCells::slices(const Sweep& sweep, const Visit& visit) const {
    const auto& [base, directions, longest] = sweep;
    const double reach = std::min(longest, diagonal_mm_);  // beyond there is no mesh
    const double margin = 1e-3 * cell_mm_;
    double from = 0;
    do {  // slices as long as a cell
        const double to = std::min(from + cell_mm_, reach);
        const auto range = [&](double low, double high, double along_low, double along_high, double origin,
                               std::int32_t n) {
            const double first = low + std::min(from * along_low, to * along_low) - margin - origin;
            const double last = high + std::max(from * along_high, to * along_high) + margin - origin;
            return std::pair{static_cast<std::int32_t>(std::max(0.0, std::floor(first / cell_mm_))),
                             static_cast<std::int32_t>(std::min(n - 1.0, std::floor(last / cell_mm_)))};
        };
        const auto [x0, x1] = range(base.low.x, base.high.x, directions.low.x, directions.high.x, low_.x, nx_);
        const auto [y0, y1] = range(base.low.y, base.high.y, directions.low.y, directions.high.y, low_.y, ny_);
        const auto [z0, z1] = range(base.low.z, base.high.z, directions.low.z, directions.high.z, low_.z, nz_);
        if (x0 > x1 || y0 > y1 || z0 > z1) return;  // beyond the mesh, and so is what follows
        for (std::int32_t z = z0; z <= z1; ++z)
            for (std::int32_t y = y0; y <= y1; ++y)
                for (std::int32_t x = x0; x <= x1; ++x)
                    if (!visit(from, (static_cast<std::size_t>(z) * static_cast<std::size_t>(ny_) +
                                      static_cast<std::size_t>(y)) *
                                             static_cast<std::size_t>(nx_) +
                                         static_cast<std::size_t>(x)))
                        return;
        from += cell_mm_;
    } while (from < reach);
}

void BeamCells::forEach(const Sweep& sweep, const std::function<void(std::size_t, double)>& visit) const {
    slices(sweep, [&](double from, std::size_t cell) {
        visit(cell, from);
        return true;
    });
}

double BeamCells::clear(const Sweep& sweep, const std::function<bool(std::size_t)>& blocked) const {
    double clear = std::numeric_limits<double>::infinity();
    slices(sweep, [&](double from, std::size_t cell) {
        if (!blocked(cell)) return true;
        clear = from;
        return false;
    });
    return clear;
}

std::optional<CellLists> CellLists::of(const BeamCells& cells, std::uint32_t first, std::uint32_t end,
                                       const std::function<Sweep(std::uint32_t)>& sweep, double most,
                                       std::span<float> nearest) {
    // What meets a cell in two slices is listed there once.
    std::vector<std::uint32_t> last(cells.count(), 0), sizes(cells.count(), 0);
    double total = 0;
    for (std::uint32_t i = first; i < end; ++i) {
        cells.forEach(sweep(i), [&](std::size_t cell, double from) {
            if (last[cell] == i + 1) return;
            last[cell] = i + 1;
            ++sizes[cell], ++total;
            if (!nearest.empty()) nearest[cell] = std::min(nearest[cell], static_cast<float>(from));
        });
        if (total > most) return {};
    }
    CellLists lists;
    lists.first_.assign(cells.count() + 1, 0);
    for (std::size_t cell = 0; cell < cells.count(); ++cell) lists.first_[cell + 1] = lists.first_[cell] + sizes[cell];
    lists.list_.resize(lists.first_.back());
    std::vector<std::uint32_t> next(lists.first_.begin(), lists.first_.end() - 1);
    std::ranges::fill(last, 0);
    for (std::uint32_t i = first; i < end; ++i)
        cells.forEach(sweep(i), [&](std::size_t cell, double) {
            if (last[cell] == i + 1) return;
            last[cell] = i + 1;
            lists.list_[next[cell]++] = i;
        });
    return lists;
}

}  // namespace searchlight
