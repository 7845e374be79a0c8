// Small valid files of every format that shape_fuzz, image_fuzz, atlas_fuzz and brdf_fuzz read, as corpora to start
// from: fuzz_seeds FOLDER writes FOLDER/shape.ply/*, FOLDER/image.exr/*, ...
#include <cstdio>
#include <filesystem>

#include "base/error.h"
#include "base/files.h"
#include "geometry/atlas/atlas_file.h"
#include "geometry/object.h"
#include "io/binary_text.h"
#include "io/image_file.h"
#include "io/shape_file.h"
#include "io/shape_formats.h"

namespace {

namespace fs = std::filesystem;
using namespace searchlight;

void seed(const fs::path& folder, const std::string& name, const std::string& bytes) {
    fs::create_directories(folder);
    writeFile(folder / name, bytes);
}

void images(const fs::path& folder) {
    Image picture(9, 5);  // long enough a row for the run lengths of RGBE
    for (std::size_t i = 0; i < picture.pixels.size(); ++i)
        picture.pixels[i] = {static_cast<float>(i), 0.5f, 2.0f - static_cast<float>(i % 4), i % 3 ? 1.0f : 0.25f};
    for (const std::string& ending : imageEndings())
        seed(folder / ("image" + ending), "small", imageBytes("a" + ending, {picture, {}, {}}));
}

// As the tests of src/io have them.
std::string pdb() {
    BinaryText file(std::endian::little);
    file.add<std::int32_t>({670}).add<std::uint16_t>({1, 0}).add<float>({1, 0}).add<std::uint32_t>({1, 1}).zeros(36);
    file.zeros(10).add<std::int32_t>({1}).add<std::uint32_t>({0, 0, 1}).zeros(16).text("position").zeros(1);
    file.add<std::int32_t>({1}).add<std::uint32_t>({12, 2, 1}).zeros(4).add<float>({1, 2, 3});
    return file.bytes();
}

std::string pdc() {
    BinaryText file(std::endian::big);
    file.text("PDC ").add<std::int32_t>({1, 1, 0, 0, 1, 2}).add<std::int32_t>({2}).text("id");
    file.add<std::int32_t>({1, 7}).add<std::int32_t>({8}).text("position").add<std::int32_t>({5});
    file.add<double>({1, 2, 3});
    return file.bytes();
}

std::string bgeo() {
    BinaryText file(std::endian::big);
    file.text("BgeoV").add<std::int32_t>({5, 1, 0, 0, 0, 1, 0, 0, 0});
    file.add<std::uint16_t>({1}).text("N").add<std::uint16_t>({3}).add<std::int32_t>({5}).zeros(12);
    file.add<float>({1, 2, 3, 1, 0, 0, 2});
    return file.bytes();
}

const std::string gltf =
    R"({"asset": {"version": "2.0"}, "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,)"
    R"(AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}], "bufferViews": [{"buffer": 0, "byteLength": 36}],)"
    R"( "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],)"
    R"( "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "nodes": [{"mesh": 0}]})";

std::string glb() {
    std::string json = gltf;
    json.resize((json.size() + 3) / 4 * 4, ' ');
    BinaryText file(std::endian::little);
    file.text("glTF").add<std::uint32_t>({2, static_cast<std::uint32_t>(20 + json.size())});
    file.add<std::uint32_t>({static_cast<std::uint32_t>(json.size()), 0x4E4F534A}).text(json);
    return file.bytes();
}

std::string stl() {
    BinaryText file(std::endian::little);
    file.zeros(80).add<std::uint32_t>({1}).add<float>({0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0}).zeros(2);
    return file.bytes();
}

void shapes(const fs::path& folder) {
    const Mesh mesh{.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                    .normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}},
                    .uvs = {{0, 0}, {1, 0}, {0, 1}},
                    .triangles = {{0, 1, 2}}};
    const PointCloud cloud{.positions = {{1, 2, 3}, {4, 5, 6}}, .normals = {{0, 0, 1}, {0, 1, 0}}, .areas = {1, 2}};
    const std::pair<const char*, std::string> files[] = {
        {".obj", objBytes(mesh)},
        {".ply", plyBytes(mesh)},
        {".ply", plyBytes(cloud)},
        {".ply",
         "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face "
         "1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"},
        {".ptc", ptcBytes(cloud)},
        {".off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"},
        {".stl", stl()},
        {".stl",
         "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
         "endfacet\nendsolid a\n"},
        {".gltf", gltf},
        {".glb", glb()},
        {".pda", "ATTRIBUTES\n id position normal\nTYPES\n I V V\nNUMBER_OF_PARTICLES: 1\nBEGIN DATA\n 0 1 2 3 0 0 5"},
        {".pdb", pdb()},
        {".pdc", pdc()},
        {".geo",
         "PGEOMETRY V5\nNPoints 2 NPrims 0\nNPointGroups 0 NPrimGroups 0\nNPointAttrib 1 NVertexAttrib 0 "
         "NPrimAttrib 0 NAttrib 0\nPointAttrib\nN 3 vector 0 0 0\n1 2 3 1 (0 0 2)\n4 5 6 1 (0 1 0)\n"},
        {".bgeo", bgeo()},
    };
    int number = 0;
    for (const auto& [ending, bytes] : files) {
        parseShape(bytes, std::string("seed") + ending);  // a seed that is not read leads nowhere
        seed(folder / (std::string("shape") + ending), std::to_string(number++), bytes);
    }
}

// Of a cuboid, whose twelve triangles atlas_fuzz reads.
void atlases(const fs::path& folder) {
    Observer observer;
    seed(folder / "atlas", "small",
         atlasBytes(makeAtlas(builtInObject("slab", -2), {.resolution = 64, .uvs = AtlasUvs::own}, observer)));
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) return std::fputs("usage: fuzz_seeds FOLDER\n", stderr), 2;
    try {
        images(argv[1]);
        shapes(argv[1]);
        atlases(argv[1]);
        seed(fs::path(argv[1]) / "brdf", "small",
             "analytic\n::begin parameters\nfloat gloss 0 1 .5\nbool on 1\ncolor tint 1 .5 0\n::end parameters\n"
             "::begin shader\nvec3 BRDF(vec3 L, vec3 V, vec3 N, vec3 X, vec3 Y) { return tint * gloss; }\n::end "
             "shader\n");
    } catch (const Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
    return 0;
}
