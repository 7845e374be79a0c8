#include "geometry/atlas/atlas_file.h"

#include <bit>

#include "base/error.h"
#include "geometry/content_hash.h"
#include "io/byte_reader.h"

namespace searchlight {

namespace {

constexpr std::string_view first_line = "searchlight-atlas/1\n";
constexpr std::size_t checksum_digits = 32;

template <class T>
void append(std::string& bytes, T value) {
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    const T little = loadValue<T>(raw, std::endian::little);
    std::memcpy(raw, &little, sizeof(T));
    bytes.append(raw, sizeof(T));
}

std::string checksum(std::string_view bytes) {
    ContentHash hash;
    hash.take(static_cast<std::uint64_t>(bytes.size()));
    hash.take(bytes);
    return hash.text();
}

}  // namespace

std::string atlasBytes(const Atlas& atlas) {
    std::string bytes(first_line);
    const AtlasReport& report = atlas.report;
    append(bytes, static_cast<std::uint32_t>(atlas.resolution));
    append(bytes, static_cast<std::uint32_t>(report.from_file));
    append(bytes, static_cast<std::uint64_t>(atlas.triangles.size()));
    append(bytes, static_cast<std::uint64_t>(report.charts));
    for (const double value :
         {report.stretch.l2, report.stretch.worst, report.stretch.area_rms, report.stretch.largest_area, report.fill})
        append(bytes, value);
    append(bytes, static_cast<std::uint64_t>(report.fault.size()));
    bytes += report.fault;
    for (const std::uint32_t chart : atlas.charts) append(bytes, chart);
    for (const FlatTriangle& triangle : atlas.triangles)
        for (const Vec2& corner : triangle) append(bytes, corner.x), append(bytes, corner.y);
    return bytes + checksum(bytes);
}

Atlas parseAtlas(std::string_view bytes, const std::string& path, std::size_t triangles, int resolution) {
    const auto fault = [&](const char* what) { return inputError(what, "it is made again").at(path); };
    if (!bytes.starts_with(first_line)) throw fault("this is no atlas of version 1");
    if (bytes.size() < first_line.size() + checksum_digits ||
        checksum(bytes.substr(0, bytes.size() - checksum_digits)) != bytes.substr(bytes.size() - checksum_digits))
        throw fault("the checksum of the atlas is wrong");
    ByteReader reader(bytes.substr(0, bytes.size() - checksum_digits), path, std::endian::little);
    reader.take(first_line.size(), 1, "first line");
    Atlas atlas;
    atlas.resolution = static_cast<int>(reader.value<std::uint32_t>("the resolution"));
    atlas.report.from_file = reader.value<std::uint32_t>("the origin") != 0;
    if (reader.value<std::uint64_t>("the number of triangles") != triangles || atlas.resolution != resolution)
        throw fault("this is the atlas of another mesh");
    atlas.report.charts = reader.value<std::uint64_t>("the number of charts");
    Stretch& stretch = atlas.report.stretch;
    for (double* value : {&stretch.l2, &stretch.worst, &stretch.area_rms, &stretch.largest_area, &atlas.report.fill})
        *value = reader.value<double>("the stretch");
    atlas.report.fault = reader.take(reader.value<std::uint64_t>("a length"), 1, "letters");
    atlas.charts.resize(triangles);
    atlas.triangles.resize(triangles);
    for (std::uint32_t& chart : atlas.charts) {
        chart = reader.value<std::uint32_t>("a chart");
        if (chart != no_triangle && chart >= atlas.report.charts) throw fault("there is no such chart");
    }
    for (FlatTriangle& triangle : atlas.triangles)
        for (Vec2& corner : triangle) {
            for (double* at : {&corner.x, &corner.y})
                if (*at = reader.value<double>("a corner"); !(*at >= 0 && *at <= resolution))
                    throw fault("a triangle leaves the square");
        }
    return atlas;
}

}  // namespace searchlight
