// Names of models as users type them: cut into parts that are not empty, or refused as usage.
#include <cstdint>
#include <cstdlib>

#include "base/error.h"
#include "model/sum_model.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view name(reinterpret_cast<const char*>(data), size);
    try {
        for (const std::string& part : searchlight::partNames(name))
            if (part.empty() && !name.empty()) std::abort();
    } catch (const searchlight::Error& error) {
        if (error.kind != searchlight::ErrorKind::usage) std::abort();
    }
    return 0;
}
