// .brdf files: either read or refused with a place.
#include <cstdint>
#include <cstdlib>

#include "base/error.h"
#include "render/brdf_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        searchlight::parseBrdf({reinterpret_cast<const char*>(data), size}, "fuzz.brdf");
    } catch (const searchlight::Error& error) {
        if (error.file.empty()) std::abort();
    }
    return 0;
}
