// PDC, Maya's disk cache of particles.
#include <fmt/format.h>

#include "io/byte_reader.h"
#include "io/cloud_builder.h"
#include "io/words.h"

namespace searchlight {

namespace {

// What an attribute holds: whole numbers, doubles or vectors of three doubles, one for all particles or one for each.
enum Type : std::int32_t { kInteger, kIntegers, kDouble, kDoubles, kVector, kVectors };

}  // namespace

Shape parsePdc(std::string_view bytes, const std::string& path) {
    ByteReader reader(bytes, path, std::endian::big);
    if (!bytes.starts_with("PDC ")) throw reader.error(0, "is no PDC file", "the first bytes are: PDC and a blank");
    reader.take(20, 1, "bytes of the header");  // magic, version, byte order, two that are unused
    const std::size_t points_at = reader.at();
    const std::size_t points = reader.count("the number of particles");
    const std::size_t stated = reader.count("the number of attributes");
    if (points == 0) throw reader.error(points_at, "holds no particles");

    std::vector<CloudAttribute> attributes;
    std::vector<std::size_t> columns;  // where an attribute's numbers begin
    for (std::size_t i = 0; i < stated; ++i) {
        const std::size_t name_size = reader.count("the length of an attribute's name");
        const std::string_view name = reader.take(name_size, 1, "characters");
        const std::size_t type_at = reader.at();
        const auto type = reader.value<std::int32_t>("the type of an attribute");
        if (type < kInteger || type > kVectors)
            throw reader.error(type_at, fmt::format("{} is no type of an attribute", type),
                               "valid: 0 (integer), 1 (integers), 2 (double), 3 (doubles), 4 (vector), 5 (vectors)");
        const bool each = type == kIntegers || type == kDoubles || type == kVectors;
        const std::size_t value_bytes = type <= kIntegers ? 4 : type <= kDoubles ? 8 : 24;
        const std::size_t column = reader.at();
        reader.take(each ? points : 1, value_bytes, fmt::format("values of {}", quotedWord(name)));
        if (type != kDoubles && type != kVectors) continue;
        attributes.push_back({std::string(name.substr(0, name.find('\0'))), value_bytes / 8});
        columns.push_back(column);
    }
    if (reader.left() > 0) throw reader.error(reader.at(), "more data than the header states");
    CloudBuilder cloud(attributes);
    if (!cloud.hasPositions()) throw reader.error(reader.at(), "no attribute 'position' of vectors");
    for (std::size_t i = 0; i < points; ++i) {
        const auto complaint = cloud.add([&](std::size_t a, std::size_t k) {
            const std::size_t at = columns[a] + 8 * (i * attributes[a].size + k);
            return static_cast<float>(loadValue<double>(bytes.data() + at, std::endian::big));
        });
        if (complaint) throw reader.error(columns[0], fmt::format("particle {}: {}", i, *complaint));
    }
    return cloud.finish();
}

}  // namespace searchlight
