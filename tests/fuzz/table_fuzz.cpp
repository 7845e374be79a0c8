// Tables that users bring, materials, measured profiles, data to fit to and phase functions: either read or refused
// with a place.
#include <cstdint>
#include <cstdlib>

#include "base/error.h"
#include "model/measured_file.h"
#include "scene/materials.h"
#include "transport/walk/phase_function.h"
#include "validate/profile_data.h"

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
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    attempt([&] { searchlight::parseMaterials(text, "fuzz.csv"); });
    attempt([&] { searchlight::parseMeasured(text, "fuzz.csv"); });
    attempt([&] { searchlight::parseProfileData(text, "fuzz.csv"); });
    attempt([&] { searchlight::parsePhase(text, "fuzz.csv"); });
    return 0;
}
