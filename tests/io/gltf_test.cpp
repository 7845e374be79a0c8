#include "base/error.h"
#include "base/files.h"
#include "binary_text.h"
#include "io/shape_file.h"

namespace searchlight {
namespace {

using testing::ElementsAre;
using Triangle = std::array<std::uint32_t, 3>;

// Positions, normals and texture coordinates of a right triangle, and its three indices as bytes.
std::string triangleBuffer() {
    BinaryText buffer(std::endian::little);
    buffer.add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}).add<float>({0, 0, 1, 0, 0, 1, 0, 0, 1});
    buffer.add<float>({0, 1, 1, 1, 0, 0}).add<std::uint8_t>({0, 1, 2, 0});
    return buffer.bytes();
}

// `buffer` and `nodes` are JSON: the one buffer's members, and the list of nodes with its scene.
std::string triangleJson(const std::string& buffer, const std::string& nodes, const std::string& more = {}) {
    return R"({"asset": {"version": "2.0"}, "buffers": [{)" + buffer + R"("byteLength": 100}],
"bufferViews": [{"buffer": 0, "byteLength": 72}, {"buffer": 0, "byteOffset": 72, "byteLength": 24},
  {"buffer": 0, "byteOffset": 96, "byteLength": 3}],
"accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
  {"bufferView": 0, "byteOffset": 36, "componentType": 5126, "count": 3, "type": "VEC3"},
  {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC2"},
  {"bufferView": 2, "componentType": 5121, "count": 3, "type": "SCALAR"}],
"meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2}, "indices": 3}]},
  {"primitives": [{"attributes": {"POSITION": 0}, "mode": 5}, {"attributes": {"POSITION": 0}, "mode": 1}]}],
)" + nodes +
           more + "}";
}

std::string glb(std::string json, const std::string& binary) {
    json.resize((json.size() + 3) / 4 * 4, ' ');
    BinaryText file(std::endian::little);
    file.text("glTF").add<std::uint32_t>({2, static_cast<std::uint32_t>(28 + json.size() + binary.size())});
    file.add<std::uint32_t>({static_cast<std::uint32_t>(json.size()), 0x4E4F534A}).text(json);
    file.add<std::uint32_t>({static_cast<std::uint32_t>(binary.size()), 0x004E4942}).text(binary);
    return file.bytes();
}

Mesh parseTriangle(const std::string& nodes) {
    return std::get<Mesh>(parseShape(glb(triangleJson("", nodes), triangleBuffer()), "a.glb"));
}

std::string messageOf(std::string_view bytes, const std::string& path = "a.gltf") {
    try {
        parseShape(bytes, path);
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

TEST(Gltf, ReadsATriangle) {
    const Mesh mesh = parseTriangle(R"("nodes": [{"mesh": 0}])");
    EXPECT_THAT(mesh.positions, ElementsAre(Vec3f{0, 0, 0}, Vec3f{1, 0, 0}, Vec3f{0, 1, 0}));
    EXPECT_THAT(mesh.normals, testing::Each(Vec3f{0, 0, 1}));
    EXPECT_THAT(mesh.uvs, ElementsAre(Vec2f{0, 0}, Vec2f{1, 0}, Vec2f{0, 1})) << "v points down in glTF";
    EXPECT_THAT(mesh.triangles, ElementsAre(Triangle{0, 1, 2}));
}

// Scale, then a quarter turn about z, then a translation; the parent's matrix moves along x.
TEST(Gltf, NodesPlaceTheirMeshes) {
    const Mesh mesh = parseTriangle(
        R"("scene": 0, "scenes": [{"nodes": [1]}], "nodes": [{"mesh": 0, "scale": [2, 3, 1],
        "rotation": [0, 0, 0.7071067811865476, 0.7071067811865476], "translation": [0, 0, 5]},
        {"children": [0], "matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 10,0,0,1]}, {"mesh": 0}])");
    ASSERT_EQ(mesh.positions.size(), 3u) << "the third node is in no scene";
    const Vec3f expected[] = {{10, 0, 5}, {10, 2, 5}, {7, 0, 5}};
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(mesh.positions[i].x, expected[i].x, 1e-5);  // rounding of a float near 10
        EXPECT_NEAR(mesh.positions[i].y, expected[i].y, 1e-5);
        EXPECT_NEAR(mesh.positions[i].z, expected[i].z, 1e-5);
    }
}

TEST(Gltf, AMirroredMeshStaysOutward) {
    const Mesh mesh = parseTriangle(R"("nodes": [{"mesh": 0, "scale": [-1, 1, 1]}])");
    EXPECT_THAT(mesh.triangles, ElementsAre(Triangle{0, 2, 1}));
    EXPECT_THAT(mesh.normals, testing::Each(Vec3f{0, 0, 1}));
}

TEST(Gltf, PrimitivesAreMerged) {
    const Mesh mesh = parseTriangle(R"("nodes": [{"mesh": 0}, {"mesh": 1, "translation": [0, 0, 1]}])");
    EXPECT_THAT(mesh.triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{3, 4, 5}));
    EXPECT_EQ(mesh.positions[3], (Vec3f{0, 0, 1}));
    EXPECT_THAT(mesh.normals, testing::Each(Vec3f{0, 0, 1})) << "where a primitive has none, its triangles' own";
    EXPECT_EQ(mesh.uvs.size(), 6u);
}

TEST(Gltf, BuffersAreDataOrFilesBesideIt) {
    const std::string nodes = R"("nodes": [{"mesh": 0}])";
    const std::string data =
        "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/AAAAAAAAAAAAAIA/AAAAAAAAAAAAAIA/"
        "AAAAAAAAgD8AAIA/AACAPwAAAAAAAAAAAAECAA==";
    const std::string uri = R"("uri": "data:application/octet-stream;base64,)" + data + R"(", )";
    EXPECT_EQ(std::get<Mesh>(parseShape(triangleJson(uri, nodes), "a.gltf")).uvs.size(), 3u);

    const std::filesystem::path folder = testing::TempDir() + "searchlight_gltf";
    makeFolder(folder / "sub");
    writeFile(folder / "sub/the buffer.bin", triangleBuffer());
    const std::string beside = triangleJson(R"("uri": "sub/the%20buffer.bin", )", nodes);
    EXPECT_EQ(std::get<Mesh>(parseShape(beside, (folder / "a.gltf").string())).triangles.size(), 1u);
    std::filesystem::remove_all(folder);
}

TEST(Gltf, NoBufferComesFromElsewhere) {
    for (const std::string uri : {"../secret.bin", "sub/../../secret.bin", "/etc/passwd", "file:///etc/passwd",
                                  "http://example.org/a.bin", "..\\\\secret.bin", "%2e%2e/secret.bin", ""}) {
        const std::string message =
            messageOf(triangleJson(R"("uri": ")" + uri + R"(", )", R"("nodes": [{"mesh": 0}])"));
        EXPECT_THAT(message, testing::StartsWith("a.gltf:1:51: /buffers/0/uri: '")) << uri;
        EXPECT_THAT(message, testing::EndsWith("is refused (a file in the same folder or below it)"));
    }
}

TEST(Gltf, RefusesByName) {
    const std::string nodes = R"("nodes": [{"mesh": 0}])";
    const auto with = [&](const std::string& more) {
        return messageOf(glb(triangleJson("", nodes, more), triangleBuffer()));
    };
    EXPECT_EQ(with(R"(, "extensionsRequired": ["KHR_materials_unlit", "KHR_mesh_quantization"])"), "no error");
    EXPECT_EQ(
        with(R"(, "extensionsRequired": ["KHR_draco_mesh_compression"])"),
        "a.gltf:10:48: /extensionsRequired/0: KHR_draco_mesh_compression cannot be read (export without compression)");
    std::string sparse = triangleJson("", nodes);
    sparse.insert(sparse.find("\"bufferView\": 0"), R"("sparse": {}, )");
    EXPECT_EQ(messageOf(glb(sparse, triangleBuffer())),
              "a.gltf:4:15: /accessors/0: is sparse, which cannot be read (export without sparse accessors)");
}

struct Damage {
    const char *from, *to, *message;
};

// One thing after another is replaced in a file that is valid.
TEST(Gltf, SaysWhatIsWrong) {
    const std::string json = triangleJson("", R"("scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}])");
    const Damage damages[] = {
        {R"("version": "2.0")", R"("version": "1.0")",
         R"(a.gltf:1:23: /asset/version: glTF version "1.0" (valid: 2.0))"},
        {R"("asset")", R"("assets")", R"(a.gltf:1:1: is no glTF file (expected "asset": {"version": "2.0"}))"},
        {R"("byteLength": 100)", R"("byteLength": 101)", "a.gltf:1:43: /buffers/0: states 101 bytes, but has 100"},
        {R"("byteLength": 100)", R"("byteLength": -1)",
         "a.gltf:1:58: /buffers/0/byteLength: -1 is no valid number (a whole number of 0 or more)"},
        {R"("byteLength": 72)", R"("byteLength": 101)",
         "a.gltf:2:17: /bufferViews/0: reaches beyond its buffer (the buffer has 100 bytes)"},
        {R"("byteLength": 72)", R"("byteLength": 71)",
         "a.gltf:5:3: /accessors/1: 3 elements reach beyond the buffer view (/bufferViews/0 has 71 bytes)"},
        {R"("byteLength": 72)", R"("byteLength": 72, "byteStride": 8)",
         "a.gltf:2:17: /bufferViews/0: byteStride 8 (12 to 252)"},
        {R"("componentType": 5126)", R"("componentType": 5130)", "a.gltf:4:15: /accessors/0: 5130 is no componentType"},
        {R"("count": 3)", R"("count": 0)", "a.gltf:4:15: /accessors/0: count is 0 (1 or more)"},
        {R"("count": 3)", R"("count": 2)",
         "a.gltf:8:43: /meshes/0/primitives/0/attributes: attributes of different counts"},
        {R"("type": "VEC3")", R"("type": "VEC2")",
         "a.gltf:4:15: /accessors/0: the type is not VEC3 (used by /meshes/0/primitives/0/attributes/POSITION)"},
        {R"("POSITION": 0)", R"("POSITION": 9)",
         "a.gltf:8:56: /meshes/0/primitives/0/attributes/POSITION: 9 of accessors (there are 4)"},
        {R"("POSITION": 0, )", "", "a.gltf:8:28: /meshes/0/primitives/0: has no POSITION"},
        {R"("indices": 3)", R"("indices": 2)",
         "a.gltf:6:3: /accessors/2: the type is not SCALAR (used by /meshes/0/primitives/0/indices)"},
        {R"("indices": 3)", R"("mode": 1)", "a.gltf:1:1: holds no triangles"},
        {R"("indices": 3)", R"("mode": 7)", "a.gltf:8:98: /meshes/0/primitives/0/mode: 7 is no mode (valid: 0 to 6)"},
        {R"([{"nodes": [0]}])", R"([{"nodes": [1]}])", "a.gltf:10:23: /scenes/0/nodes/0: is no node (there are 1)"},
        {R"([{"nodes": [0]}])", R"([{"nodes": [0, 0]}])", "a.gltf:10:42: /nodes/0: is a child twice"},
        {R"([{"mesh": 0}])", R"([{"mesh": 0, "children": [0]}])", "a.gltf:10:39: /nodes/0: is a child twice"},
        {R"([{"mesh": 0}])", R"([{"mesh": 2}])", "a.gltf:10:48: /nodes/0/mesh: 2 of meshes (there are 2)"},
        {R"([{"mesh": 0}])", R"([{"mesh": 0, "scale": [1, 2]}])",
         "a.gltf:10:60: /nodes/0/scale: is no list of 3 numbers"},
        {R"([{"mesh": 0}])", R"([{"mesh": 0, "scale": [1e200, 1, 1]}])",
         "a.gltf:8:43: /meshes/0/primitives/0/attributes: position 1 is not finite"},
    };
    for (const Damage& damage : damages) {
        std::string damaged = json;
        ASSERT_NE(json.find(damage.from), std::string::npos) << damage.from;
        damaged.replace(json.find(damage.from), std::string_view(damage.from).size(), damage.to);
        EXPECT_EQ(messageOf(glb(damaged, triangleBuffer())), damage.message) << damage.to;
    }
    std::string buffer = triangleBuffer();
    buffer[97] = 3;
    EXPECT_EQ(messageOf(glb(json, buffer)),
              "a.gltf:8:101: /meshes/0/primitives/0/indices: index 1 is vertex 3 (0 to 2)");
}

TEST(Gltf, SaysWhatIsWrongWithAContainer) {
    const std::string file = glb(triangleJson("", R"("nodes": [{"mesh": 0}])"), triangleBuffer());
    const auto with = [&](std::size_t at, char value) {
        std::string damaged = file;
        damaged[at] = value;
        return messageOf(damaged, "a.glb");
    };
    EXPECT_EQ(with(4, 1), "a.glb: byte 4: GLB version 1 (valid: 2)");
    EXPECT_EQ(with(16, 'K'), "a.glb: byte 16: the first chunk, and no other, is JSON");
    EXPECT_EQ(messageOf(file.substr(0, 200), "a.glb"),
              "a.glb: byte 8: states " + std::to_string(file.size()) + " bytes, but the file has 200");
    EXPECT_EQ(messageOf("glTF", "a.glb"),
              "a.glb: byte 4: the file ends before the version (the file is cut off or damaged)");
    EXPECT_EQ(messageOf(std::string_view("glTF\2\0\0\0\14\0\0\0", 12), "a.glb"), "a.glb: byte 12: no JSON chunk");
}

}  // namespace
}  // namespace searchlight
