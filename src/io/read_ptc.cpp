// PTC, the point clouds of RenderMan. Its layout is known from readers, not from a specification.
#include <fmt/format.h>

#include <cstdint>

#include "base/text.h"
#include "io/byte_reader.h"
#include "io/cloud_builder.h"
#include "io/ptc_normal.h"
#include "io/words.h"

namespace searchlight {

namespace {

constexpr std::int32_t kMagic = 'c' << 24 | 't' << 16 | 'p' << 8 | 'p';

// "float _area": the numbers that a variable of that type has in each point.
CloudAttribute parseVariable(std::string_view line, const ByteReader& reader, std::size_t byte) {
    const std::size_t blank = line.find(' ');
    const std::string_view type = line.substr(0, blank);
    CloudAttribute variable;
    if (blank != std::string_view::npos) variable.name = trim(line.substr(blank));
    if (type == "float")
        variable.size = 1;
    else if (type == "point" || type == "vector" || type == "normal" || type == "color")
        variable.size = 3;
    else if (type == "matrix")
        variable.size = 16;
    else
        throw reader.error(byte, fmt::format("{} is no type of a variable", quotedWord(type)),
                           "valid: float, point, vector, normal, color, matrix");
    return variable;
}

}  // namespace

Shape parsePtc(std::string_view bytes, const std::string& path) {
    ByteReader reader(bytes, path, std::endian::little);
    if (reader.value<std::int32_t>("the magic number") != kMagic)
        throw reader.error(0, "is no PTC file", "the first bytes are: pptc");
    const auto version = reader.value<std::int32_t>("the version");
    if (version < 0 || version > 2) throw reader.error(4, fmt::format("PTC version {}", version), "valid: 0, 1, 2");
    const std::size_t points_at = reader.at();
    const auto points = reader.value<double>("the number of points");
    // Bounding box; unknown; largest radius and unknown; two matrices and the size of a picture.
    reader.take(6 + (version >= 1 ? 4 : 0) + (version >= 2 ? 1 + 32 : 0) + 2 * 16 + 3, 4, "numbers of the header");
    const std::size_t variables = reader.count("the number of variables");
    const std::size_t size_at = reader.at();
    const std::size_t size = reader.count("the size of a point's data");

    std::size_t total = 0;
    std::optional<std::size_t> area_offset;  // in numbers, into a point's data
    for (std::size_t i = 0; i < variables; ++i) {
        const std::size_t from = reader.at();
        const std::size_t end = reader.rest().find('\n');
        if (end == std::string_view::npos) throw reader.error(from, "the file ends before the name of a variable");
        const CloudAttribute variable =
            parseVariable(reader.take(end + 1, 1, "characters").substr(0, end), reader, from);
        if (variable.size == 1 && areaRule(variable.name) == AreaRule::area) area_offset = total;
        total += variable.size;
    }
    if (total != size)
        throw reader.error(size_at, fmt::format("the data of a point has {} numbers, its variables {}", size, total));
    if (version >= 1) reader.take(2, 4, "numbers before the points");

    const std::size_t row_bytes = 20 + 4 * size;
    if (!(points >= 1 && points == std::floor(points)))
        throw reader.error(points_at, fmt::format("{} points", points), "a whole number of 1 or more");
    if (points > static_cast<double>(reader.left() / row_bytes))
        throw reader.error(
            reader.at(), fmt::format("{} points of {} bytes, but {} bytes are left", points, row_bytes, reader.left()),
            "the file is cut off or damaged");
    const auto count = static_cast<std::size_t>(points);
    PointCloud cloud;
    cloud.positions.reserve(count);
    cloud.normals.reserve(count);
    cloud.areas.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t from = reader.at();
        const char* row = reader.take(1, row_bytes, "point").data();
        const auto number = [&](std::size_t byte) { return loadValue<float>(row + byte, std::endian::little); };
        const auto code = [&](std::size_t byte) { return loadValue<std::uint16_t>(row + byte, std::endian::little); };
        cloud.positions.push_back({number(0), number(4), number(8)});
        if (!isFinite(cloud.positions.back())) throw reader.error(from, "a position is not finite");
        cloud.normals.push_back(decodePtcNormal({code(12), code(14)}));
        const std::optional<float> area =
            area_offset ? areaOf(AreaRule::area, number(20 + 4 * *area_offset)) : areaOf(AreaRule::radius, number(16));
        if (!area) throw reader.error(from, "an area or radius is negative or not finite");
        cloud.areas.push_back(*area);
    }
    finishCloud(cloud);
    return cloud;
}

}  // namespace searchlight
