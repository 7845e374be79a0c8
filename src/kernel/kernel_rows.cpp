#include "kernel/kernel_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace searchlight {

namespace {

void findFaults(KernelTable& table, const std::vector<KernelRow>& rows) {
    const std::vector<double>& offsets = table.term.offsets_mm;
    const std::vector<Rgb>& weights = table.term.weights;
    const std::size_t n = offsets.size();
    static constexpr const char* names[] = {"red", "green", "blue"};
    // Six digits, as tables are printed, times the number of taps.
    const double rounding = 1e-6 * static_cast<double>(n);
    if (table.count == 1)
        for (int c = 0; c < Rgb::channels; ++c) {
            double sum = 0;
            for (const Rgb& weight : weights) sum += weight[c];
            if (std::abs(sum - 1) > std::max(rounding, 1e-5))
                table.faults.push_back(fmt::format("{} adds up to {:.6g}, not to 1", names[c], sum));
        }
    for (std::size_t i = 0; i < n / 2; ++i) {
        const std::size_t j = n - 1 - i;
        if (std::abs(offsets[i] + offsets[j]) > 1e-5 * std::abs(offsets[j]))
            table.faults.push_back(fmt::format("offset {:g} has {:g} on the other side", offsets[j], offsets[i]));
        for (int c = 0; c < Rgb::channels; ++c)
            if (std::abs(weights[i][c] - weights[j][c]) > 1e-5 * (std::abs(weights[j][c]) + 1e-3))
                table.faults.push_back(fmt::format("{} at offset {:g} is {:g}, on the other side {:g}", names[c],
                                                   offsets[j], weights[j][c], weights[i][c]));
    }
    for (std::size_t i = 0; i + 1 < n; ++i)
        if (offsets[i] == offsets[i + 1]) table.faults.push_back(fmt::format("offset {:g} stands twice", offsets[i]));
    if (table.count == 1)
        for (std::size_t i = 0; i < n; ++i)
            for (int c = 0; c < Rgb::channels; ++c)
                if (weights[i][c] < 0)
                    table.faults.push_back(fmt::format("{} at offset {:g} is negative", names[c], offsets[i]));
    // One side alone is also written from the outermost tap inwards.
    const auto ordered = [&](auto first, auto last) {
        const auto less = [](const KernelRow& a, const KernelRow& b) { return a.value[3] < b.value[3]; };
        return std::is_sorted(first, last, less) ||
               (table.one_sided && std::is_sorted(first, last, [&](auto& a, auto& b) { return less(b, a); }));
    };
    if (rows.front().value[3] != 0 && !ordered(rows.begin(), rows.end()))
        table.faults.push_back("offsets do not ascend");
    if (rows.front().value[3] == 0 && !ordered(rows.begin() + 1, rows.end()))
        table.faults.push_back("offsets after the middle do not ascend");
    // A density that rises and falls again away from the middle is a slip of digits, where it falls on both sides.
    for (int c = 0; c < Rgb::channels && table.count == 1; ++c) {
        std::vector<double> density;
        for (std::size_t i = n / 2 + 1; i + 1 < n; ++i)
            density.push_back(weights[i][c] / (0.5 * (offsets[i + 1] - offsets[i - 1])));
        for (std::size_t i = 1; i + 1 < density.size(); ++i)
            if (density[i] > 1.02 * density[i - 1] || (i + 2 < density.size() && density[i] < density[i + 1] / 1.02))
                table.faults.push_back(fmt::format("{} per mm does not fall away from the middle at offset {:g}",
                                                   names[c], offsets[n / 2 + 1 + i]));
    }
}

}  // namespace

KernelTable tableOfRows(KernelTable table, const std::vector<KernelRow>& rows) {
    std::vector<KernelRow> sorted = rows;
    std::ranges::stable_sort(sorted, {}, [](const KernelRow& row) { return row.value[3]; });
    if (sorted.front().value[3] >= 0 && sorted.back().value[3] > 0) {
        table.one_sided = true;
        std::vector<KernelRow> both;
        for (auto row = sorted.rbegin(); row != sorted.rend(); ++row) {
            if (row->value[3] == 0) continue;
            both.push_back(*row);
            both.back().value[3] = -row->value[3];
        }
        both.insert(both.end(), sorted.begin(), sorted.end());
        sorted = std::move(both);
    }
    const auto middle = std::ranges::find(sorted, 0.0, [](const KernelRow& row) { return row.value[3]; });
    if (middle == sorted.end()) throw inputError("the table has no tap in the middle", "expected an offset of 0");
    const auto before = static_cast<std::size_t>(middle - sorted.begin());
    if (sorted.size() - before - 1 != before)
        throw inputError(
            fmt::format("{} taps on one side of the middle and {} on the other", before, sorted.size() - before - 1),
            "expected as many, or one side alone");
    for (const KernelRow& row : sorted) {
        table.term.offsets_mm.push_back(row.value[3]);
        table.term.weights.push_back({row.value[0], row.value[1], row.value[2]});
    }
    findFaults(table, rows);
    return table;
}

}  // namespace searchlight
