// Files of each mesh format, written here by hand, mean what their specifications say.
#include <numeric>

#include "base/error.h"
#include "binary_text.h"
#include "io/shape_file.h"

namespace searchlight {
namespace {

using testing::ElementsAre;
using Triangle = std::array<std::uint32_t, 3>;

Mesh parseMesh(std::string_view bytes, const std::string& path) { return std::get<Mesh>(parseShape(bytes, path)); }

double areaOf(const Mesh& mesh, const Triangle& triangle) {
    const Vec3 a = toDouble(mesh.positions[triangle[0]]), b = toDouble(mesh.positions[triangle[1]]),
               c = toDouble(mesh.positions[triangle[2]]);
    return 0.5 * cross(b - a, c - a).z;
}

TEST(Obj, ReadsFacesOfEveryKind) {
    const Mesh mesh = parseMesh(
        "# a comment\nmtllib none.mtl\no thing\n"
        "v 0 0 0\nv 1 0 0 1.0\nv +1 1 0\r\nv 0 1e0 0.0 .5 .5 .5\n"
        "g group\nusemtl red\ns off\n"
        "f 1 2 3\nf -4 -2 -1 # the other half\n",
        "a.obj");
    EXPECT_THAT(mesh.positions, ElementsAre(Vec3f{0, 0, 0}, Vec3f{1, 0, 0}, Vec3f{1, 1, 0}, Vec3f{0, 1, 0}));
    EXPECT_THAT(mesh.triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}));
    EXPECT_TRUE(mesh.normals.empty());
    EXPECT_TRUE(mesh.uvs.empty());
}

TEST(Obj, ABackslashContinuesALine) {
    const Mesh mesh = parseMesh("v 0 0 \\\n 0\nv 1 0 0\nv 0 1 0\nf 1 \\\r\n2\\\n 3\n", "a.obj");
    EXPECT_THAT(mesh.triangles, ElementsAre(Triangle{0, 1, 2}));
}

TEST(Obj, AFaceMayStandBeforeItsVertices) {
    const Mesh mesh = parseMesh("f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0", "a.obj");
    EXPECT_THAT(mesh.triangles, ElementsAre(Triangle{0, 1, 2}));
}

TEST(Obj, AVertexWithTwoTextureCoordinatesStandsTwice) {
    const Mesh mesh = parseMesh(
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0.5 0.25\n"
        "f 1/1 2/2 3/3\nf 1/4 3/3 4/1\n",
        "a.obj");
    EXPECT_THAT(mesh.positions,
                ElementsAre(Vec3f{0, 0, 0}, Vec3f{1, 0, 0}, Vec3f{1, 1, 0}, Vec3f{0, 1, 0}, Vec3f{0, 0, 0}));
    EXPECT_THAT(mesh.uvs, ElementsAre(Vec2f{0, 0}, Vec2f{1, 0}, Vec2f{1, 1}, Vec2f{0, 0}, Vec2f{0.5f, 0.25f}));
    EXPECT_THAT(mesh.triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{4, 2, 3}));
}

TEST(Obj, NormalsBecomeUnitAndMissingOnesTheMeanOfTheirTriangles) {
    const Mesh mesh =
        parseMesh("v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 2\nvn nan 0 0\nvn 0 0 0\nf 1//1 2//2 3//3\n", "a.obj");
    EXPECT_THAT(mesh.normals, ElementsAre(Vec3f{0, 0, 1}, Vec3f{0, 0, 1}, Vec3f{0, 0, 1}));
    EXPECT_TRUE(parseMesh("v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 0\nf 1//1 2//1 3//1\n", "a.obj").normals.empty());
}

TEST(Obj, WithoutFacesIsAPointCloud) {
    const auto cloud = std::get<PointCloud>(parseShape("v 1 2 3\nv 4 5 6\nvn 0 3 0\nvn 0 0 1\n", "a.OBJ"));
    EXPECT_THAT(cloud.positions, ElementsAre(Vec3f{1, 2, 3}, Vec3f{4, 5, 6}));
    EXPECT_THAT(cloud.normals, ElementsAre(Vec3f{0, 1, 0}, Vec3f{0, 0, 1}));
    EXPECT_TRUE(cloud.areas.empty());
}

// Ears, not a fan: every triangle of an arrow head and of a star keeps the polygon's orientation, and their areas add
// up to it.
TEST(Polygons, ConcaveOnesAreCutWithoutOverlap) {
    const Mesh arrow = parseMesh("v 0 0 0\nv 2 -1 0\nv 0.5 0 0\nv 2 1 0\nf 2 3 4 1\n", "a.obj");
    ASSERT_EQ(arrow.triangles.size(), 2u);
    for (const Triangle& triangle : arrow.triangles)
        EXPECT_FLOAT_EQ(static_cast<float>(areaOf(arrow, triangle)), 0.25f);

    std::string star;
    double shoelace = 0;
    Vec3 previous;
    for (int i = 0; i <= 14; ++i) {
        const double angle = i * M_PI / 7, r = i % 2 == 0 ? 2 : 0.7;
        const Vec3 p{r * std::cos(angle), r * std::sin(angle), 0};
        if (i < 14) star += "v " + std::to_string(p.x) + " " + std::to_string(p.y) + " 0\n";
        if (i > 0) shoelace += 0.5 * cross(previous, p).z;
        previous = p;
    }
    const Mesh mesh = parseMesh(star + "f 1 2 3 4 5 6 7 8 9 10 11 12 13 14\n", "a.obj");
    ASSERT_EQ(mesh.triangles.size(), 12u);
    double sum = 0;
    for (const Triangle& triangle : mesh.triangles) {
        EXPECT_GT(areaOf(mesh, triangle), 0);
        sum += areaOf(mesh, triangle);
    }
    EXPECT_NEAR(sum, shoelace, 1e-5);  // six digits in the text
}

TEST(Polygons, WithManyCornersBecomeFans) {
    std::string text, face = "f";
    for (int i = 0; i < 1000; ++i) {
        text +=
            "v " + std::to_string(std::cos(i * M_PI / 500)) + " " + std::to_string(std::sin(i * M_PI / 500)) + " 0\n";
        face.append(" ").append(std::to_string(i + 1));
    }
    EXPECT_EQ(parseMesh(text + face, "a.obj").triangles.size(), 998u);
}

constexpr const char* kPlyText =
    "ply\nformat ascii 1.0\ncomment by hand\nobj_info none\nelement vertex 4\nproperty double x\nproperty float32 y\n"
    "property float z\nproperty float nx\nproperty float ny\nproperty float nz\nproperty uchar red\n"
    "property float s\nproperty float t\nelement face 2\nproperty list uchar int vertex_index\nproperty uchar flags\n"
    "element edge 1\nproperty int a\nproperty int b\nend_header\n"
    "0 0 0 0 0 1 255 0 0\n1 0 0 0 0 1 255 1 0\n1 1 0 0 0 1 255 1 1\n0 1 0 0 0 1 255 0 1\n"
    "3 0 1 2 7\n4 0 1 2 3 7\n0 1\n";

TEST(Ply, ReadsText) {
    const Mesh mesh = parseMesh(kPlyText, "a.ply");
    EXPECT_THAT(mesh.positions, ElementsAre(Vec3f{0, 0, 0}, Vec3f{1, 0, 0}, Vec3f{1, 1, 0}, Vec3f{0, 1, 0}));
    EXPECT_THAT(mesh.normals, testing::Each(Vec3f{0, 0, 1}));
    EXPECT_THAT(mesh.uvs, ElementsAre(Vec2f{0, 0}, Vec2f{1, 0}, Vec2f{1, 1}, Vec2f{0, 1}));
    EXPECT_THAT(mesh.triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 1, 2}, Triangle{0, 2, 3}));
}

// All eight types, lists that are passed over, and both byte orders.
TEST(Ply, ReadsEveryTypeInBothByteOrders) {
    for (const auto& [order, name] : {std::pair{std::endian::little, "little"}, std::pair{std::endian::big, "big"}}) {
        BinaryText file(order);
        file.text("ply\r\nformat binary_" + std::string(name) +
                  "_endian 1.0\r\nelement vertex 3\r\nproperty char x\r\n"
                  "property uchar a\r\nproperty short y\r\nproperty ushort b\r\nproperty list uchar double c\r\n"
                  "property int z\r\nproperty uint d\r\nproperty float u\r\nproperty double v\r\n"
                  "element face 1\r\nproperty list short uint vertex_indices\r\nend_header\r\n");
        for (int i = 0; i < 3; ++i) {
            file.add<std::int8_t>({static_cast<std::int8_t>(-i)}).add<std::uint8_t>({200});
            file.add<std::int16_t>({static_cast<std::int16_t>(-300 * i)}).add<std::uint16_t>({60000});
            file.add<std::uint8_t>({2}).add<double>({1, 2});
            file.add<std::int32_t>({100000 * i * i}).add<std::uint32_t>({4000000000u});
            file.add<float>({0.5f * static_cast<float>(i)}).add<double>({0.25 * i});
        }
        file.add<std::int16_t>({3}).add<std::uint32_t>({2, 1, 0});
        const Mesh mesh = parseMesh(file, "a.ply");
        EXPECT_THAT(mesh.positions, ElementsAre(Vec3f{0, 0, 0}, Vec3f{-1, -300, 100000}, Vec3f{-2, -600, 400000}));
        EXPECT_THAT(mesh.uvs, ElementsAre(Vec2f{0, 0}, Vec2f{0.5f, 0.25f}, Vec2f{1, 0.5f}));
        EXPECT_THAT(mesh.triangles, ElementsAre(Triangle{2, 1, 0}));
    }
}

TEST(Ply, StripsAlternateAndRestart) {
    const Mesh mesh = parseMesh(
        "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n"
        "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
        "0 0 0 0 1 0 1 0 0 1 1 0 2 2 0\n8 0 2 1 3 -1 3 4 2\n",
        "a.ply");
    EXPECT_THAT(mesh.triangles, ElementsAre(Triangle{0, 2, 1}, Triangle{1, 2, 3}, Triangle{3, 4, 2}));
}

TEST(Ply, WithoutFacesIsAPointCloud) {
    const std::string head =
        "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n";
    const auto cloud = [&](const std::string& rest) { return std::get<PointCloud>(parseShape(head + rest, "a.ply")); };
    const PointCloud radii = cloud(
        "property float radius\nproperty float nx\nproperty float ny\nproperty float nz\n"
        "element face 0\nproperty list uchar int vertex_indices\nend_header\n"
        "0 0 0 2 0 0 3\n1 0 0 1 nan 0 0\n");
    EXPECT_THAT(radii.areas, ElementsAre(testing::FloatEq(4 * M_PIf), testing::FloatEq(M_PIf)));
    EXPECT_THAT(radii.normals, ElementsAre(Vec3f{0, 0, 1}, Vec3f{0, 0, 0}));
    EXPECT_THAT(cloud("property float width\nproperty float area\nend_header\n0 0 0 2 5\n1 0 0 2 6\n").areas,
                ElementsAre(5.0f, 6.0f));
    EXPECT_THAT(cloud("property float width\nend_header\n0 0 0 2\n1 0 0 2\n").areas,
                testing::Each(testing::FloatEq(M_PIf)));
    EXPECT_TRUE(cloud("property float radius\nend_header\n0 0 0 0\n1 0 0 0\n").areas.empty());
}

TEST(Off, ReadsItsVariants) {
    const Mesh plain =
        parseMesh("OFF # comment\n# another\n4 1 0\n0 0 0\n1 0 0 255 0 0\n1 1 0\n0 1 0\n\n4 0 1 2 3 1 0 0\n", "a.off");
    EXPECT_EQ(plain.positions.size(), 4u);
    EXPECT_THAT(plain.triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}));
    const Mesh rich = parseMesh(
        "STCNOFF 3 1 0\n0 0 0 0 0 2 9 9 9 9 0.5 0.25\n1 0 0 0 0 1 9 9 9 0 0\n0 1 0 0 0 1 9 1 1\n3 0 1 2\n", "a.off");
    EXPECT_THAT(rich.normals, testing::Each(Vec3f{0, 0, 1}));
    EXPECT_THAT(rich.uvs, ElementsAre(Vec2f{0.5f, 0.25f}, Vec2f{0, 0}, Vec2f{1, 1}));
}

TEST(Stl, TextAndBinaryAreWeldedAlike) {
    const Mesh text = parseMesh(
        "solid a square\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   vertex 1 1 0\n  "
        "endloop\n"
        " endfacet\nfacet normal 0 0 1\nouter loop\nvertex -0 0 0\nvertex 1 1 0\nvertex 0 1 0\nendloop\nendfacet\n"
        "endsolid a square\n",
        "a.stl");
    // This header begins as a text would.
    BinaryText file(std::endian::little);
    file.text("solid").zeros(75).add<std::uint32_t>({2});
    file.add<float>({0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 1, 0}).add<std::uint16_t>({0});
    file.add<float>({0, 0, 1, -0.0f, 0, 0, 1, 1, 0, 0, 1, 0}).add<std::uint16_t>({0});
    const Mesh binary = parseMesh(file, "a.stl");
    EXPECT_THAT(binary.positions, ElementsAre(Vec3f{0, 0, 0}, Vec3f{1, 0, 0}, Vec3f{1, 1, 0}, Vec3f{0, 1, 0}));
    EXPECT_THAT(binary.triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}));
    EXPECT_EQ(text.positions, binary.positions);
    EXPECT_EQ(text.triangles, binary.triangles);
}

}  // namespace
}  // namespace searchlight
