// A cached table may be damaged in any way: it is read and answers, or it is refused. A table of one walk
// (`searchlight reference halfspace --white --walks 1`, 0.2 MB) is the corpus to start from; -max_len=300000.
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "base/error.h"
#include "transport/white/white_file.h"

namespace {

// docs/white-cache.md; without it no mutation would get past the checksum.
void mendChecksum(std::string& bytes) {
    std::uint64_t hash = 0xCBF29CE484222325u;
    for (std::size_t at = 0; at + 16 <= bytes.size(); at += 8) {
        std::uint64_t word;
        std::memcpy(&word, bytes.data() + at, 8);
        hash = (hash ^ word) * 0x100000001B3u;
    }
    if (bytes.size() >= 8) std::memcpy(bytes.data() + bytes.size() - 8, &hash, 8);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace searchlight;
    std::string bytes(reinterpret_cast<const char*>(data), size / 8 * 8);
    mendChecksum(bytes);
    try {
        evaluateWhite(parseWhiteTable(bytes, "fuzz.white"), 1, 1, std::vector<double>{0, 0.01, 1});
    } catch (const Error& error) {
        if (error.kind != ErrorKind::input) std::abort();
    }
    return 0;
}
