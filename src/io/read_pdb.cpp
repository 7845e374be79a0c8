// PDB, Maya's particles as memory was: structures of a 32-bit or a 64-bit machine, with their padding and pointers.
#include <fmt/format.h>

#include "io/byte_reader.h"
#include "io/cloud_builder.h"
#include "io/words.h"

namespace searchlight {

namespace {

constexpr std::int32_t kMagic = 670;
constexpr std::size_t kChannelPrefix = 6;

// Sizes of the structures, and where a channel states its type.
struct Layout {
    std::size_t header, channel, type_in_channel, data;
};
constexpr Layout kLayout32{60, 36, 4, 20}, kLayout64{64, 56, 8, 24};

enum Type : std::int32_t { kVector = 1, kReal = 2, kLast = 5 };

// Nothing in the header says which machine wrote the file, but the first channel's type has to be one.
const Layout& layoutOf(std::string_view bytes) {
    const auto fits = [&](const Layout& layout) {
        const std::size_t at = layout.header + kChannelPrefix + layout.type_in_channel;
        if (bytes.size() < at + 4) return false;
        const auto type = loadValue<std::int32_t>(bytes.data() + at, std::endian::little);
        return type >= kVector && type <= kLast;
    };
    return fits(kLayout64) && !fits(kLayout32) ? kLayout64 : kLayout32;
}

}  // namespace

Shape parsePdb(std::string_view bytes, const std::string& path) {
    ByteReader reader(bytes, path, std::endian::little);
    const auto magic = reader.value<std::uint32_t>("the magic number");
    if (magic == 0x9E020000) throw reader.error(0, "is a PDB file of a big-endian machine", "valid: little-endian");
    if (magic != kMagic) throw reader.error(0, "is no PDB file", "the first number is 670");
    const Layout& layout = layoutOf(bytes);
    reader.take(12, 1, "bytes of the header");  // swap, version, time
    const std::size_t points_at = reader.at();
    const std::size_t points = reader.count("the number of particles");
    const std::size_t channels = reader.count("the number of attributes");
    if (points == 0) throw reader.error(points_at, "holds no particles");
    reader.take(layout.header - reader.at(), 1, "bytes of the header");

    std::vector<CloudAttribute> attributes;
    std::vector<std::size_t> columns;  // where an attribute's numbers begin
    for (std::size_t i = 0; i < channels; ++i) {
        reader.take(kChannelPrefix, 1, "bytes of an attribute");
        const std::size_t channel_at = reader.at();
        reader.take(layout.channel, 1, "bytes of an attribute");
        const auto type =
            loadValue<std::int32_t>(bytes.data() + channel_at + layout.type_in_channel, std::endian::little);
        const std::size_t name_size = reader.rest().find('\0');
        if (name_size == std::string_view::npos)
            throw reader.error(reader.at(), "the file ends before the end of an attribute's name");
        const std::string_view name = reader.take(name_size + 1, 1, "characters").substr(0, name_size);
        const std::size_t data_at = reader.at();
        reader.take(layout.data, 1, "bytes of an attribute");
        const auto point_bytes = loadValue<std::uint32_t>(bytes.data() + data_at + 4, std::endian::little);
        const std::size_t column = reader.at();
        reader.take(points, point_bytes, fmt::format("values of {}", quotedWord(name)));
        if ((type != kVector || point_bytes != 12) && (type != kReal || point_bytes != 4)) continue;
        attributes.push_back({std::string(name), point_bytes / 4});
        columns.push_back(column);
    }
    CloudBuilder cloud(attributes);
    if (!cloud.hasPositions()) throw reader.error(reader.at(), "no attribute 'position' of three numbers");
    for (std::size_t i = 0; i < points; ++i) {
        const auto complaint = cloud.add([&](std::size_t a, std::size_t k) {
            return loadValue<float>(bytes.data() + columns[a] + 4 * (i * attributes[a].size + k), std::endian::little);
        });
        if (complaint) throw reader.error(reader.at(), fmt::format("particle {}: {}", i, *complaint));
    }
    return cloud.finish();
}

}  // namespace searchlight
