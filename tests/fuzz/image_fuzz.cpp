// Pictures of every format, or of one (one_format.h): either read or refused with a name.
#include <cstdint>
#include <cstdlib>

#include "base/error.h"
#include "io/image_file.h"
#include "one_format.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const std::string only = searchlight::oneFormat(searchlight::imageEndings());
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    for (const std::string& ending : searchlight::imageEndings()) {
        if (!only.empty() && ending != only) continue;
        try {
            const searchlight::ImageFile file = searchlight::parseImage(bytes, "fuzz" + ending);
            const searchlight::Image& image = file.image;
            if (image.pixels.size() != static_cast<std::size_t>(image.width) * image.height) std::abort();
        } catch (const searchlight::Error& error) {
            if (error.file.empty()) std::abort();
        }
    }
    return 0;
}
