// Tables of kernels out of shaders: either read, as terms that keep their promises, or refused with a place.
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "base/error.h"
#include "kernel/kernel_text.h"

namespace {

void require(bool holds) {
    if (!holds) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        const auto tables = searchlight::parseKernelTables({reinterpret_cast<const char*>(data), size}, "fuzz.hlsl");
        require(!tables.empty() && tables.size() <= searchlight::most_kernel_tables);
        for (const searchlight::KernelTable& table : tables) {
            const auto& offsets = table.term.offsets_mm;
            require(offsets.size() % 2 == 1 && offsets.size() >= 3 && offsets.size() == table.term.weights.size());
            require(offsets[offsets.size() / 2] == 0 && table.line >= 1 && table.index <= table.count);
            for (const double offset : offsets) require(std::isfinite(offset));
        }
        require(!searchlight::kernelsOfTables(tables).empty());
    } catch (const searchlight::Error& error) {
        require(error.file == "fuzz.hlsl");
    }
    return 0;
}
