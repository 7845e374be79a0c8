// glTF 2.0, as text or GLB: all triangles of the default scene in one mesh, moved to where their nodes are. Skins and
// morph targets are passed over: a mesh is read in the pose that it is stored in.
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <numeric>

#include "io/byte_reader.h"
#include "io/gltf_file.h"
#include "io/shape_formats.h"

namespace searchlight {

namespace {

using nlohmann::json;

// Nodes may show one mesh many times over: a small file must not ask for all memory.
constexpr std::size_t kMostCorners = std::size_t{1} << 26;

// y = linear x + offset
struct Placement {
    std::array<Vec3, 3> columns{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
    Vec3 offset;

    Vec3 linear(Vec3 p) const { return p.x * columns[0] + p.y * columns[1] + p.z * columns[2]; }
    Vec3 operator()(Vec3 p) const { return linear(p) + offset; }
    double determinant() const { return dot(columns[0], cross(columns[1], columns[2])); }

    // A normal is moved by the cofactors, which are the inverse transpose but for the determinant's size and sign.
    Vec3 normal(Vec3 n) const {
        const double sign = determinant() < 0 ? -1 : 1;
        return sign * (n.x * cross(columns[1], columns[2]) + n.y * cross(columns[2], columns[0]) +
                       n.z * cross(columns[0], columns[1]));
    }

    Placement after(const Placement& first) const {
        return {{linear(first.columns[0]), linear(first.columns[1]), linear(first.columns[2])}, (*this)(first.offset)};
    }
};

enum Component { kByte = 5120, kUnsignedByte, kShort, kUnsignedShort, kUnsignedInt = 5125, kFloat };

struct Accessor {
    const char* first = nullptr;
    std::size_t count = 0, stride = 0, components = 1;
    std::size_t component_type = kFloat;
    bool normalized = false;

    double value(std::size_t i, std::size_t component) const {
        const auto load = [&]<class T>(T) {
            return loadValue<T>(first + i * stride + component * sizeof(T), std::endian::little);
        };
        switch (component_type) {
            case kByte: return normalized ? std::max(load(std::int8_t{}) / 127.0, -1.0) : load(std::int8_t{});
            case kUnsignedByte: return load(std::uint8_t{}) / (normalized ? 255.0 : 1.0);
            case kShort: return normalized ? std::max(load(std::int16_t{}) / 32767.0, -1.0) : load(std::int16_t{});
            case kUnsignedShort: return load(std::uint16_t{}) / (normalized ? 65535.0 : 1.0);
            case kUnsignedInt: return load(std::uint32_t{});
            default: return load(float{});
        }
    }
    Vec3 vector(std::size_t i) const { return {value(i, 0), value(i, 1), value(i, 2)}; }
};

class GltfReader {
public:
    GltfReader(std::string_view bytes, const std::string& path) : file_(bytes, path) {}

    Mesh read() {
        refuseExtensions();
        for (const std::size_t root : roots()) place(root);
        if (mesh_.triangles.empty()) throw file_.error("", "holds no triangles");
        if (any_uvs_) mesh_.uvs.resize(mesh_.positions.size());
        if (any_normals_) mesh_.normals.resize(mesh_.positions.size());
        finishNormals(mesh_);
        return std::move(mesh_);
    }

private:
    // Those that say where triangles are; what changes materials, lights and textures is passed over.
    void refuseExtensions() const {
        const auto list = file_.root().find("extensionsRequired");
        if (list == file_.root().end()) return;
        if (!list->is_array()) throw file_.error("/extensionsRequired", "is no list");
        for (std::size_t i = 0; i < list->size(); ++i) {
            const std::string name = (*list)[i].is_string() ? (*list)[i].get<std::string>() : (*list)[i].dump();
            const auto starts = [&](std::string_view prefix) { return name.starts_with(prefix); };
            if (name != "KHR_mesh_quantization" && !starts("KHR_materials_") && !starts("KHR_texture_") &&
                !starts("KHR_lights_") && !starts("EXT_texture_"))
                throw file_.error(fmt::format("/extensionsRequired/{}", i),
                                  fmt::format("{} cannot be read", name.substr(0, 80)), "export without compression");
        }
    }

    std::vector<std::size_t> indexList(const json& object, const std::string& pointer, const char* key) const {
        std::vector<std::size_t> indices;
        const auto list = object.find(key);
        if (list == object.end()) return indices;
        const std::string place = fmt::format("{}/{}", pointer, key);
        if (!list->is_array()) throw file_.error(place, "is no list");
        for (std::size_t i = 0; i < list->size(); ++i) {
            const json& index = (*list)[i];
            if (!index.is_number_unsigned() || index.get<std::uint64_t>() >= file_.count("nodes"))
                throw file_.error(fmt::format("{}/{}", place, i), "is no node",
                                  fmt::format("there are {}", file_.count("nodes")));
            indices.push_back(index.get<std::size_t>());
        }
        return indices;
    }

    // Of the default scene, of the first one, or, without scenes, all nodes that are nobody's child.
    std::vector<std::size_t> roots() const {
        const std::optional<std::size_t> scene = file_.number(file_.root(), "", "scene");
        if (scene || file_.count("scenes") > 0) {
            const json& object = file_.entry("scenes", scene.value_or(0), "/scene");
            return indexList(object, fmt::format("/scenes/{}", scene.value_or(0)), "nodes");
        }
        std::vector<bool> child(file_.count("nodes"));
        for (std::size_t i = 0; i < child.size(); ++i) {
            const std::string pointer = fmt::format("/nodes/{}", i);
            for (const std::size_t index : indexList(file_.entry("nodes", i, pointer), pointer, "children"))
                child[index] = true;
        }
        std::vector<std::size_t> found;
        for (std::size_t i = 0; i < child.size(); ++i)
            if (!child[i]) found.push_back(i);
        return found;
    }

    // The node and what hangs below it.
    void place(std::size_t root) {
        seen_.resize(file_.count("nodes"));
        std::vector<std::pair<std::size_t, Placement>> open{{root, {}}};
        while (!open.empty()) {
            const auto [index, parent] = open.back();
            open.pop_back();
            const std::string pointer = fmt::format("/nodes/{}", index);
            const json& node = file_.entry("nodes", index, pointer);
            if (seen_[index]) throw file_.error(pointer, "is a child twice");
            seen_[index] = true;
            const Placement placement = parent.after(placementOf(node, pointer));
            if (const auto mesh = file_.number(node, pointer, "mesh")) addMesh(*mesh, pointer + "/mesh", placement);
            for (const std::size_t child : indexList(node, pointer, "children")) open.emplace_back(child, placement);
        }
    }

    std::optional<std::vector<double>> numbers(const json& object, const std::string& pointer, const char* key,
                                               std::size_t count) const {
        const auto list = object.find(key);
        if (list == object.end()) return std::nullopt;
        const auto isNumber = [](const json& value) { return value.is_number(); };
        if (!list->is_array() || list->size() != count || !std::ranges::all_of(*list, isNumber))
            throw file_.error(fmt::format("{}/{}", pointer, key), fmt::format("is no list of {} numbers", count));
        return list->get<std::vector<double>>();
    }

    Placement placementOf(const json& node, const std::string& pointer) const {
        Placement placement;
        if (const auto m = numbers(node, pointer, "matrix", 16)) {
            const auto column = [&](std::size_t i) { return Vec3{(*m)[4 * i], (*m)[4 * i + 1], (*m)[4 * i + 2]}; };
            return {{column(0), column(1), column(2)}, column(3)};
        }
        if (const auto q = numbers(node, pointer, "rotation", 4)) {
            const Vec3 v{(*q)[0], (*q)[1], (*q)[2]};
            const double w = (*q)[3];
            for (Vec3& axis : placement.columns) {
                const Vec3 t = 2 * cross(v, axis);
                axis = axis + w * t + cross(v, t);
            }
        }
        if (const auto s = numbers(node, pointer, "scale", 3))
            for (std::size_t i = 0; i < 3; ++i) placement.columns[i] = (*s)[i] * placement.columns[i];
        if (const auto t = numbers(node, pointer, "translation", 3)) placement.offset = {(*t)[0], (*t)[1], (*t)[2]};
        return placement;
    }

    void addMesh(std::size_t index, const std::string& user, const Placement& placement) {
        const json& mesh = file_.entry("meshes", index, user);
        const auto primitives = mesh.find("primitives");
        if (primitives == mesh.end() || !primitives->is_array())
            throw file_.error(fmt::format("/meshes/{}", index), "has no list 'primitives'");
        for (std::size_t i = 0; i < primitives->size(); ++i) {
            const std::string pointer = fmt::format("/meshes/{}/primitives/{}", index, i);
            if (!(*primitives)[i].is_object()) throw file_.error(pointer, "is no object");
            addPrimitive((*primitives)[i], pointer, placement);
        }
    }

    void addPrimitive(const json& primitive, const std::string& pointer, const Placement& placement) {
        const std::size_t mode = file_.number(primitive, pointer, "mode").value_or(4);
        if (mode < 4) return;  // points and lines
        if (mode > 6) throw file_.error(pointer + "/mode", fmt::format("{} is no mode", mode), "valid: 0 to 6");
        const auto attributes = primitive.find("attributes");
        if (attributes == primitive.end() || !attributes->is_object())
            throw file_.error(pointer, "has no object 'attributes'");
        const std::string place = pointer + "/attributes";
        const auto attribute = [&](const char* key, std::size_t components) -> std::optional<Accessor> {
            const auto index = file_.number(*attributes, place, key);
            if (!index) return std::nullopt;
            return accessor(*index, fmt::format("{}/{}", place, key), components);
        };
        const auto positions = attribute("POSITION", 3), normals = attribute("NORMAL", 3),
                   uvs = attribute("TEXCOORD_0", 2);
        if (!positions) throw file_.error(pointer, "has no POSITION");
        for (const auto& other : {normals, uvs})
            if (other && other->count != positions->count) throw file_.error(place, "attributes of different counts");

        const std::size_t first = mesh_.positions.size();
        reserve(first + positions->count, place);
        for (std::size_t i = 0; i < positions->count; ++i) {
            mesh_.positions.push_back(toFloat(placement(positions->vector(i))));
            if (!isFinite(mesh_.positions.back()))
                throw file_.error(place, fmt::format("position {} is not finite", i));
        }
        if (normals) {
            any_normals_ = true;
            mesh_.normals.resize(first);
            for (std::size_t i = 0; i < normals->count; ++i)
                mesh_.normals.push_back(toFloat(placement.normal(normals->vector(i))));
        }
        if (uvs) {
            any_uvs_ = true;
            mesh_.uvs.resize(first);
            for (std::size_t i = 0; i < uvs->count; ++i) {
                // In glTF v points down.
                mesh_.uvs.push_back({static_cast<float>(uvs->value(i, 0)), static_cast<float>(1 - uvs->value(i, 1))});
                if (!std::isfinite(mesh_.uvs.back().x) || !std::isfinite(mesh_.uvs.back().y))
                    throw file_.error(place, fmt::format("texture coordinate {} is not finite", i));
            }
        }
        addTriangles(corners(primitive, pointer, positions->count), mode, first, placement.determinant() < 0);
    }

    void reserve(std::size_t total, const std::string& pointer) const {
        if (total > kMostCorners)
            throw file_.error(pointer,
                              fmt::format("the file unfolds to more than {} vertices or corners", kMostCorners));
    }

    std::vector<std::uint32_t> corners(const json& primitive, const std::string& pointer, std::size_t vertices) {
        std::vector<std::uint32_t> indices;
        const auto index = file_.number(primitive, pointer, "indices");
        if (!index) {
            indices.resize(vertices);
            std::iota(indices.begin(), indices.end(), 0u);
            return indices;
        }
        const std::string place = pointer + "/indices";
        const Accessor list = accessor(*index, place, 1);
        if (list.component_type != kUnsignedByte && list.component_type != kUnsignedShort &&
            list.component_type != kUnsignedInt)
            throw file_.error(place, "indices are unsigned whole numbers");
        reserve(3 * mesh_.triangles.size() + list.count, place);
        indices.reserve(list.count);
        for (std::size_t i = 0; i < list.count; ++i) {
            const double vertex = list.value(i, 0);
            if (vertex >= static_cast<double>(vertices))
                throw file_.error(place, fmt::format("index {} is vertex {}", i, vertex),
                                  fmt::format("0 to {}", static_cast<double>(vertices) - 1));
            indices.push_back(static_cast<std::uint32_t>(vertex));
        }
        return indices;
    }

    void addTriangles(const std::vector<std::uint32_t>& corners, std::size_t mode, std::size_t first, bool mirrored) {
        const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
            const auto vertex = [&](std::size_t i) { return static_cast<std::uint32_t>(first + corners[i]); };
            mesh_.triangles.push_back({vertex(a), vertex(mirrored ? c : b), vertex(mirrored ? b : c)});
        };
        for (std::size_t i = 0; i + 2 < corners.size(); i += mode == 4 ? 3 : 1) {
            if (mode == 6)
                add(0, i + 1, i + 2);
            else if (mode == 5 && i % 2 == 1)
                add(i + 1, i, i + 2);
            else
                add(i, i + 1, i + 2);
        }
    }

    Accessor accessor(std::size_t index, const std::string& user, std::size_t components) {
        const json& object = file_.entry("accessors", index, user);
        const std::string pointer = fmt::format("/accessors/{}", index);
        if (object.contains("sparse"))
            throw file_.error(pointer, "is sparse, which cannot be read", "export without sparse accessors");
        Accessor accessor;
        accessor.count = file_.requiredNumber(object, pointer, "count");
        accessor.component_type = file_.requiredNumber(object, pointer, "componentType");
        accessor.components = components;
        accessor.normalized = object.value("normalized", json(false)) == json(true);
        static constexpr std::array<std::string_view, 4> types{"", "SCALAR", "VEC2", "VEC3"};
        if (object.value("type", json()) != json(types[components]))
            throw file_.error(pointer, fmt::format("the type is not {}", types[components]),
                              fmt::format("used by {}", user));
        std::size_t component_bytes = 4;
        switch (accessor.component_type) {
            case kByte:
            case kUnsignedByte: component_bytes = 1; break;
            case kShort:
            case kUnsignedShort: component_bytes = 2; break;
            case kUnsignedInt:
            case kFloat: break;
            default: throw file_.error(pointer, fmt::format("{} is no componentType", accessor.component_type));
        }
        const std::size_t view_index = file_.requiredNumber(object, pointer, "bufferView");
        const json& view = file_.entry("bufferViews", view_index, pointer);
        const std::string place = fmt::format("/bufferViews/{}", view_index);
        const std::string_view buffer = file_.buffer(file_.requiredNumber(view, place, "buffer"), place);
        const std::size_t from = file_.number(view, place, "byteOffset").value_or(0);
        const std::size_t size = file_.requiredNumber(view, place, "byteLength");
        if (from > buffer.size() || size > buffer.size() - from)
            throw file_.error(place, "reaches beyond its buffer",
                              fmt::format("the buffer has {} bytes", buffer.size()));
        const std::size_t element = components * component_bytes;
        accessor.stride = file_.number(view, place, "byteStride").value_or(element);
        if (accessor.stride < element || accessor.stride > 252)
            throw file_.error(place, fmt::format("byteStride {}", accessor.stride), fmt::format("{} to 252", element));
        const std::size_t offset = file_.number(object, pointer, "byteOffset").value_or(0);
        if (accessor.count == 0) throw file_.error(pointer, "count is 0", "1 or more");
        if (offset > size || (accessor.count - 1) * accessor.stride + element > size - offset)
            throw file_.error(pointer, fmt::format("{} elements reach beyond the buffer view", accessor.count),
                              fmt::format("{} has {} bytes", place, size));
        accessor.first = buffer.data() + from + offset;
        return accessor;
    }

    GltfFile file_;
    Mesh mesh_;
    std::vector<bool> seen_;
    bool any_normals_ = false, any_uvs_ = false;
};

}  // namespace

Shape parseGltf(std::string_view bytes, const std::string& path) { return GltfReader(bytes, path).read(); }

}  // namespace searchlight
