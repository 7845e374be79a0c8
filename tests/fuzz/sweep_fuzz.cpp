// Sweep files are not trusted: whatever the bytes, the answer is cells that are jobs, or an Error.
#include <cstdint>
#include <cstdlib>

#include "base/error.h"
#include "job/sweep/sweep.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace searchlight;
    try {
        const Sweep sweep = parseSweep({reinterpret_cast<const char*>(data), size}, "fuzz");
        const std::string text = jobJson(sweep.cells.back().job);
        if (jobJson(parseJob(text, "fuzz")) != text) std::abort();
        if (cellsInOrder(sweep, 0, 1).size() != sweep.cells.size()) std::abort();
    } catch (const Error&) {
    }
    return 0;
}
