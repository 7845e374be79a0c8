#include "io/gunzip.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>

#include "base/error.h"
#include "io/shape_formats.h"

namespace searchlight {

namespace {

struct Inflater {
    z_stream stream{};
    // 16 on top of the largest window: gzip's header and checksum instead of zlib's.
    Inflater() : ready(inflateInit2(&stream, 16 + MAX_WBITS) == Z_OK) {}
    ~Inflater() { inflateEnd(&stream); }
    Inflater(const Inflater&) = delete;
    bool ready;
};

}  // namespace

std::string gunzip(std::string_view bytes, const std::string& path) {
    Inflater inflater;
    if (!inflater.ready) throw inputError("no memory to unpack it").at(path);
    z_stream& stream = inflater.stream;
    const std::size_t most = std::min(kMostShapeBytes, std::max(std::size_t{1} << 26, 100 * bytes.size()));
    const auto error = [&](std::string_view what) {
        return inputError(fmt::format("byte {}: {}", bytes.size() - stream.avail_in, what), "gzip").at(path);
    };
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    // Files are smaller than 2 GiB.
    stream.avail_in = static_cast<uInt>(bytes.size());
    std::string unpacked;
    std::string piece(std::size_t{1} << 18, '\0');
    while (true) {
        stream.next_out = reinterpret_cast<Bytef*>(piece.data());
        stream.avail_out = static_cast<uInt>(piece.size());
        const int status = inflate(&stream, Z_NO_FLUSH);
        unpacked.append(piece, 0, piece.size() - stream.avail_out);
        if (unpacked.size() > most) throw error(fmt::format("unpacks to more than {} MiB", most >> 20));
        if (status == Z_STREAM_END) {
            if (stream.avail_in == 0) return unpacked;
            inflateReset(&stream);  // a further member
        } else if (status == Z_BUF_ERROR || (status == Z_OK && stream.avail_in == 0 && stream.avail_out > 0)) {
            throw error("the packed data is cut off");
        } else if (status != Z_OK) {
            throw error(stream.msg ? stream.msg : "the packed data is damaged");
        }
    }
}

}  // namespace searchlight
