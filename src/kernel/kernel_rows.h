// Rows of a kernel's table, whatever they were written in.
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "kernel/kernel_text.h"

namespace searchlight {

struct KernelRow {
    std::array<double, 4> value{};  ///< R, G, B, offset
    int line = 1;
};

/// `table` with the taps of `rows`, both sides of them, and what is wrong with them. Throws an input Error without a
/// place where they are no kernel: no middle, or sides that differ in number.
KernelTable tableOfRows(KernelTable table, const std::vector<KernelRow>& rows);

/// The terms of this program's own JSON: an export, or what `kernel --json` prints. Throws an input Error with its
/// place.
std::vector<KernelTable> kernelTablesOfJson(std::string_view text, std::string_view path);

}  // namespace searchlight
