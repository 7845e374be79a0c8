// A kept atlas may be damaged in any way: it is read and every triangle lies in its square, or it is refused.
#include <cstdint>
#include <cstdlib>
#include <string>

#include "base/error.h"
#include "geometry/atlas/atlas_file.h"
#include "geometry/content_hash.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace searchlight;
    // Without the checksum no mutation would get past it.
    std::string bytes(reinterpret_cast<const char*>(data), size);
    if (constexpr std::size_t digits = 32; size > digits) {
        bytes.resize(size - digits);
        ContentHash hash;
        hash.take(std::uint64_t{bytes.size()});
        hash.take(std::string_view(bytes));
        bytes += hash.text();
    }
    constexpr int resolution = 64;
    try {
        const Atlas atlas = parseAtlas(bytes, "fuzz.atlas", 12, resolution);
        for (const FlatTriangle& triangle : atlas.triangles)
            for (const Vec2& corner : triangle)
                if (!(corner.x >= 0 && corner.x <= resolution && corner.y >= 0 && corner.y <= resolution)) std::abort();
    } catch (const Error& error) {
        if (error.kind != ErrorKind::input) std::abort();
    }
    return 0;
}
