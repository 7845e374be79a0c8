// BGEO version 5, the points of Houdini's older binary format (.bhclassic). Its primitives are passed over.
#include <fmt/format.h>

#include "io/byte_reader.h"
#include "io/cloud_builder.h"

namespace searchlight {

namespace {

CloudAttribute parseAttribute(ByteReader& reader) {
    CloudAttribute attribute;
    const auto name_size = reader.value<std::uint16_t>("the name of a point attribute");
    attribute.name = reader.take(name_size, 1, "characters");
    attribute.size = reader.value<std::uint16_t>("the size of a point attribute");
    const std::size_t from = reader.at();
    const auto type = reader.value<std::int32_t>("the type of a point attribute");
    if (type == 4) {
        const std::size_t texts = reader.count("the number of texts");
        for (std::size_t i = 0; i < texts; ++i)
            reader.take(reader.value<std::uint16_t>("a text of an index attribute"), 1, "characters");
    } else if (type == 0 || type == 1 || type == 5) {
        reader.take(attribute.size, 4, "default values");
    } else {
        throw reader.error(from, fmt::format("{} is no type of a point attribute", type),
                           "valid: 0 (float), 1 (int), 4 (index), 5 (vector)");
    }
    return attribute;
}

}  // namespace

Shape parseBgeo(std::string_view bytes, const std::string& path) {
    ByteReader reader(bytes, path, std::endian::big);
    if (bytes.starts_with("\x7FNSJ"))
        throw reader.error(0, "is a BGEO file of Houdini 12 or later, which is binary JSON",
                           "save it from Houdini as .bhclassic, renamed to .bgeo");
    if (!bytes.starts_with("BgeoV")) throw reader.error(0, "is no BGEO file", "the first bytes are: BgeoV");
    reader.take(5, 1, "magic bytes");
    if (const auto version = reader.value<std::int32_t>("the version"); version != 5)
        throw reader.error(5, fmt::format("BGEO version {}", version), "valid: 5");
    const std::size_t points_at = reader.at();
    const std::size_t points = reader.count("the number of points");
    if (points == 0) throw reader.error(points_at, "holds no points");
    reader.take(3, 4, "counts of the header");  // primitives, groups of points, groups of primitives
    const std::size_t attributes_stated = reader.count("the number of point attributes");
    reader.take(3, 4, "counts of the header");  // attributes of vertices, of primitives, of the whole

    // Every row begins with x, y, z and a weight, which is 1 for all but splines.
    std::vector<CloudAttribute> attributes{{"P", 3}, {"Pw", 1}};
    std::vector<std::size_t> offsets{0, 12};
    std::size_t row_bytes = 16;
    for (std::size_t i = 0; i < attributes_stated; ++i) {
        attributes.push_back(parseAttribute(reader));
        offsets.push_back(row_bytes);
        row_bytes += 4 * attributes.back().size;
    }
    const std::size_t rows_at = reader.at();
    const char* rows = reader.take(points, row_bytes, "points").data();
    CloudBuilder cloud(attributes);
    for (std::size_t i = 0; i < points; ++i) {
        const auto complaint = cloud.add([&](std::size_t a, std::size_t k) {
            return loadValue<float>(rows + i * row_bytes + offsets[a] + 4 * k, std::endian::big);
        });
        if (complaint) throw reader.error(rows_at + i * row_bytes, *complaint);
    }
    return cloud.finish();
}

}  // namespace searchlight
