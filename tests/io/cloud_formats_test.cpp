// Files of each particle format, written here by hand, mean what their readers elsewhere take them for.
#include "base/error.h"
#include "binary_text.h"
#include "io/shape_file.h"

namespace searchlight {
namespace {

using testing::ElementsAre;
using testing::FloatEq;

PointCloud parseCloud(std::string_view bytes, const std::string& path) {
    return std::get<PointCloud>(parseShape(bytes, path));
}

// Two points with a variable of three numbers and, if wanted, an area.
std::string ptc(int version, bool area) {
    BinaryText file(std::endian::little);
    file.text("pptc").add<std::int32_t>({version}).add<double>({2}).add<float>({0, 0, 0, 4, 5, 6});
    if (version >= 1) file.zeros(16);
    if (version >= 2) file.zeros(4 + 128);
    file.zeros(128).add<float>({640, 480, 1}).add<std::int32_t>({1 + area, 3 + area});
    file.text("color _radiosity\n").text(area ? "float _area\n" : "");
    if (version >= 1) file.zeros(8);
    // phi = -pi/2 points along -x; z = 65535 is the pole, whatever phi is.
    file.add<float>({1, 2, 3}).add<std::uint16_t>({0, 65535}).add<float>({2, .1f, .2f, .3f});
    if (area) file.add<float>({7});
    file.add<float>({4, 5, 6}).add<std::uint16_t>({65535, 65535}).add<float>({1, .1f, .2f, .3f});
    if (area) file.add<float>({8});
    return file.bytes();
}

TEST(Ptc, ReadsThreeVersions) {
    for (const int version : {0, 1, 2}) {
        const PointCloud cloud = parseCloud(ptc(version, false), "a.ptc");
        EXPECT_THAT(cloud.positions, ElementsAre(Vec3f{1, 2, 3}, Vec3f{4, 5, 6}));
        EXPECT_THAT(cloud.normals, ElementsAre(Vec3f{0, 0, 1}, Vec3f{0, 0, 0}));
        EXPECT_THAT(cloud.areas, ElementsAre(FloatEq(4 * M_PIf), FloatEq(M_PIf)));
    }
}

TEST(Ptc, ItsAreaSaysMoreThanItsRadius) {
    EXPECT_THAT(parseCloud(ptc(1, true), "a.ptc").areas, ElementsAre(7.0f, 8.0f));
}

TEST(Pda, ReadsAttributesInAnyOrder) {
    const PointCloud cloud = parseCloud(
        "ATTRIBUTES\n id radiusPP position normal\nTYPES\n I R V V\nNUMBER_OF_PARTICLES: 2\nBEGIN DATA\n"
        " 0 2 1 2 3 0 0 5\n 1 1 4 5 6 0 1 0",
        "a.pda");
    EXPECT_THAT(cloud.positions, ElementsAre(Vec3f{1, 2, 3}, Vec3f{4, 5, 6}));
    EXPECT_THAT(cloud.normals, ElementsAre(Vec3f{0, 0, 1}, Vec3f{0, 1, 0}));
    EXPECT_THAT(cloud.areas, ElementsAre(FloatEq(4 * M_PIf), FloatEq(M_PIf)));
}

// Structures as two compilers lay them out: pointers of 4 bytes, and of 8 with the padding before them.
std::string pdb(bool wide) {
    BinaryText file(std::endian::little);
    file.add<std::int32_t>({670}).add<std::uint16_t>({1, 0}).add<float>({1, 0}).add<std::uint32_t>({2, 3}).zeros(32);
    file.zeros(wide ? 8 : 4);
    const auto channel = [&](std::string_view name, std::int32_t type, std::uint32_t point_bytes) {
        file.zeros(6).zeros(wide ? 8 : 4).add<std::int32_t>({type}).add<std::uint32_t>({0, 0, 1});
        file.zeros(wide ? 8 + 24 : 4 + 12).text(name).zeros(1);
        file.add<std::int32_t>({type}).add<std::uint32_t>({point_bytes, 2, 1}).zeros(wide ? 8 : 4);
    };
    channel("id", 3, 4);
    file.add<std::int32_t>({5, 6});
    channel("position", 1, 12);
    file.add<float>({1, 2, 3, 4, 5, 6});
    channel("radiusPP", 2, 4);
    file.add<float>({2, 1});
    return file.bytes();
}

TEST(Pdb, Reads32And64Bits) {
    for (const bool wide : {false, true}) {
        const PointCloud cloud = parseCloud(pdb(wide), "a.pdb");
        EXPECT_THAT(cloud.positions, ElementsAre(Vec3f{1, 2, 3}, Vec3f{4, 5, 6}));
        EXPECT_THAT(cloud.areas, ElementsAre(FloatEq(4 * M_PIf), FloatEq(M_PIf)));
        EXPECT_TRUE(cloud.normals.empty());
    }
}

TEST(Pdc, ReadsAllSixTypes) {
    BinaryText file(std::endian::big);
    file.text("PDC ").add<std::int32_t>({1, 1, 0, 0, 2, 6});
    file.add<std::int32_t>({5}).text("count").add<std::int32_t>({0, 9});
    file.add<std::int32_t>({2}).text("id").add<std::int32_t>({1, 7, 8});
    file.add<std::int32_t>({4}).text("time").add<std::int32_t>({2}).add<double>({0.5});
    file.add<std::int32_t>({8}).text("radiusPP").add<std::int32_t>({3}).add<double>({2, 1});
    file.add<std::int32_t>({6}).text("normal").add<std::int32_t>({4}).add<double>({0, 0, 1});
    file.add<std::int32_t>({8}).text("position").add<std::int32_t>({5}).add<double>({1, 2, 3, 4, 5, 6});
    const PointCloud cloud = parseCloud(file, "a.pdc");
    EXPECT_THAT(cloud.positions, ElementsAre(Vec3f{1, 2, 3}, Vec3f{4, 5, 6}));
    EXPECT_THAT(cloud.areas, ElementsAre(FloatEq(4 * M_PIf), FloatEq(M_PIf)));
    EXPECT_TRUE(cloud.normals.empty()) << "one vector for all particles is no normal of each";
}

TEST(Geo, ReadsPointsAndTheirAttributes) {
    const PointCloud cloud = parseCloud(
        "PGEOMETRY V5\nNPoints 2 NPrims 1\nNPointGroups 0 NPrimGroups 0\n"
        "NPointAttrib 3 NVertexAttrib 0 NPrimAttrib 0 NAttrib 0\nPointAttrib\n"
        "N 3 vector 0 0 0\nname 1 index 2 \"a (b\" c\npscale 1 float 1\n"
        "1 2 3 1 (0 0 2\t0\t2)\n4 5 6 1 (0 1 0\t1\t1)\nPart 2 0 1\nbeginExtra\nendExtra\n",
        "a.geo");
    EXPECT_THAT(cloud.positions, ElementsAre(Vec3f{1, 2, 3}, Vec3f{4, 5, 6}));
    EXPECT_THAT(cloud.normals, ElementsAre(Vec3f{0, 0, 1}, Vec3f{0, 1, 0}));
    EXPECT_THAT(cloud.areas, ElementsAre(FloatEq(4 * M_PIf), FloatEq(M_PIf)));
    const PointCloud bare = parseCloud(
        "PGEOMETRY V5\nNPoints 2 NPrims 0\nNPointGroups 0 NPrimGroups 0\n"
        "NPointAttrib 0 NVertexAttrib 0 NPrimAttrib 0 NAttrib 0\n1 2 3 1\n4 5 6 1\n",
        "a.geo");
    EXPECT_EQ(bare.positions, cloud.positions);
}

TEST(Bgeo, ReadsPointsAndTheirAttributes) {
    BinaryText file(std::endian::big);
    file.text("BgeoV").add<std::int32_t>({5, 2, 1, 0, 0, 3, 0, 0, 0});
    file.add<std::uint16_t>({1}).text("N").add<std::uint16_t>({3}).add<std::int32_t>({5}).zeros(12);
    file.add<std::uint16_t>({4}).text("name").add<std::uint16_t>({1}).add<std::int32_t>({4, 1});
    file.add<std::uint16_t>({3}).text("one");
    file.add<std::uint16_t>({5}).text("width").add<std::uint16_t>({1}).add<std::int32_t>({0}).zeros(4);
    file.add<float>({1, 2, 3, 1, 0, 0, 2}).add<std::int32_t>({0}).add<float>({4});
    file.add<float>({4, 5, 6, 1, 0, 1, 0}).add<std::int32_t>({0}).add<float>({2});
    file.text("primitives and all that");
    const PointCloud cloud = parseCloud(file, "a.bgeo");
    EXPECT_THAT(cloud.positions, ElementsAre(Vec3f{1, 2, 3}, Vec3f{4, 5, 6}));
    EXPECT_THAT(cloud.normals, ElementsAre(Vec3f{0, 0, 1}, Vec3f{0, 1, 0}));
    EXPECT_THAT(cloud.areas, ElementsAre(FloatEq(4 * M_PIf), FloatEq(M_PIf)));
}

}  // namespace
}  // namespace searchlight
