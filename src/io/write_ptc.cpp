#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <numbers>

#include "io/ptc_normal.h"
#include "io/shape_formats.h"

namespace searchlight {

namespace {

class Bytes {
public:
    template <class T>
    void value(T value) {
        bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
    void text(std::string_view text) { bytes_ += text; }
    std::string take() { return std::move(bytes_); }

private:
    std::string bytes_;
};

}  // namespace

std::string ptcBytes(const PointCloud& cloud) {
    static_assert(std::endian::native == std::endian::little, "the file is little-endian, and written as memory is");
    Bytes bytes;
    bytes.text("pptc");
    bytes.value(std::int32_t{0});
    bytes.value(static_cast<double>(cloud.positions.size()));
    Vec3f low, high;
    if (!cloud.positions.empty()) low = high = cloud.positions.front();
    for (const Vec3f p : cloud.positions) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    bytes.value(low);
    bytes.value(high);
    // World to eye and eye to screen: none, so unit matrices. The picture: none, but viewers divide by its size.
    for (int matrix = 0; matrix < 2; ++matrix)
        for (int i = 0; i < 16; ++i) bytes.value(i % 5 == 0 ? 1.0f : 0.0f);
    for (const float size : {640.0f, 480.0f, 1.0f}) bytes.value(size);
    const bool areas = !cloud.areas.empty();
    bytes.value(std::int32_t{areas});
    bytes.value(std::int32_t{areas});
    if (areas) bytes.text("float _area\n");
    for (std::size_t i = 0; i < cloud.positions.size(); ++i) {
        bytes.value(cloud.positions[i]);
        const PtcNormal normal = encodePtcNormal(cloud.normals.empty() ? Vec3f{} : cloud.normals[i]);
        bytes.value(normal.phi);
        bytes.value(normal.z);
        bytes.value(areas ? static_cast<float>(std::sqrt(cloud.areas[i] / std::numbers::pi)) : 0.0f);
        if (areas) bytes.value(cloud.areas[i]);
    }
    return bytes.take();
}

}  // namespace searchlight
