// MCML's files from anywhere: read or refused with a place; runs that were read are written and read back unchanged.
#include <cstdint>
#include <cstdlib>

#include "base/error.h"
#include "transport/mcml/mcml_file.h"
#include "transport/slab/slab.h"

namespace {

// Calls `read`; an Error must name the file.
template <class Read>
void attempt(Read read) {
    try {
        read();
    } catch (const searchlight::Error& error) {
        if (error.file.empty()) std::abort();
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace searchlight;
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    attempt([&] {
        const std::vector<McmlRun> runs = parseMci(text, "fuzz.mci");
        if (parseMci(mciText(runs), "fuzz.mci") != runs) std::abort();
    });
    attempt([&] {
        const McmlOutput output = parseMco(text, "fuzz.mco");
        if (parseMco(mcoText(output), "fuzz.mco").run != output.run) std::abort();
    });
    attempt([&] { parseLayers(text, "fuzz.json"); });
    return 0;
}
