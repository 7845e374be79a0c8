#include <fmt/compile.h>
#include <fmt/format.h>

#include <iterator>

#include "io/shape_formats.h"

namespace searchlight {

// Numbers are the shortest that read back as the same float.
std::string objBytes(const Mesh& mesh) {
    fmt::memory_buffer text;
    auto out = std::back_inserter(text);
    for (const Vec3f p : mesh.positions) fmt::format_to(out, FMT_COMPILE("v {} {} {}\n"), p.x, p.y, p.z);
    for (const Vec2f uv : mesh.uvs) fmt::format_to(out, FMT_COMPILE("vt {} {}\n"), uv.x, uv.y);
    for (const Vec3f n : mesh.normals) fmt::format_to(out, FMT_COMPILE("vn {} {} {}\n"), n.x, n.y, n.z);
    for (const std::array<std::uint32_t, 3>& triangle : mesh.triangles) {
        text.push_back('f');
        for (const std::uint32_t vertex : triangle) {
            const std::size_t i = std::size_t{vertex} + 1;
            if (mesh.uvs.empty() && mesh.normals.empty())
                fmt::format_to(out, FMT_COMPILE(" {}"), i);
            else if (mesh.normals.empty())
                fmt::format_to(out, FMT_COMPILE(" {}/{}"), i, i);
            else if (mesh.uvs.empty())
                fmt::format_to(out, FMT_COMPILE(" {}//{}"), i, i);
            else
                fmt::format_to(out, FMT_COMPILE(" {}/{}/{}"), i, i, i);
        }
        text.push_back('\n');
    }
    return fmt::to_string(text);
}

}  // namespace searchlight
