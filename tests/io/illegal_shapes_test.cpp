// Meshes and clouds that are damaged, cut off, or lie about their size: refused with a place and a reason, before
// memory is taken. Text files stand in tests/illegal/shapes; binary ones are made here.
#include "base/error.h"
#include "binary_text.h"
#include "illegal/messages.h"
#include "io/shape_file.h"

namespace searchlight {
namespace {

std::string messageOf(std::string_view bytes, const std::string& path) {
    try {
        parseShape(bytes, path);
    } catch (const Error& error) {
        EXPECT_EQ(error.kind, ErrorKind::input);
        return error.what();
    }
    return "no error";
}

constexpr const char* kCut = " (the file is cut off or damaged)";

TEST(IllegalShapes, SayWhatIsWrong) {
    expectMessages("shapes", [](auto text, auto path) { parseShape(text, std::string(path)); });
}

TEST(IllegalShapes, BinaryPly) {
    const std::string head =
        "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    const auto file = [&](std::uint8_t corners, std::int32_t last, float x = 0) {
        return BinaryText(std::endian::little)
            .text(head)
            .add<float>({x, 0, 0, 1, 0, 0, 0, 1, 0})
            .add<std::uint8_t>({corners})
            .add<std::int32_t>({0, 1, last})
            .bytes();
    };
    ASSERT_EQ(head.size(), 169u);
    EXPECT_EQ(messageOf(file(3, 2), "a.ply"), "no error");
    EXPECT_EQ(messageOf(file(3, 2) + "\n", "a.ply"), "no error") << "some writers end with a line";
    EXPECT_EQ(messageOf(file(3, 2) + "x", "a.ply"), "a.ply: byte 218: more data than the header states");
    EXPECT_EQ(messageOf(file(3, 3), "a.ply"), "a.ply: byte 214: a face uses vertex 3 (0 to 2)");
    EXPECT_EQ(messageOf(file(3, -1), "a.ply"), "a.ply: byte 214: a face uses vertex -1 (0 to 2)");
    EXPECT_EQ(messageOf(file(2, 2), "a.ply"), "a.ply: byte 205: a face has 2 corners (3 or more)");
    EXPECT_EQ(messageOf(file(200, 2), "a.ply"), "a.ply: byte 205: a list of 200 items, but 12 bytes are left");
    EXPECT_EQ(messageOf(file(3, 2, NAN), "a.ply"), "a.ply: byte 177: a position is not finite");
    EXPECT_EQ(messageOf(file(3, 2).substr(0, 205), "a.ply"),
              "a.ply: byte 205: 1 rows of 'face', but 0 bytes are left" + std::string(kCut));
    EXPECT_EQ(messageOf(file(3, 2).substr(0, 199), "a.ply"),
              "a.ply: byte 169: 3 rows of 'vertex', but 30 bytes are left" + std::string(kCut));
    EXPECT_EQ(messageOf(file(3, 2).substr(0, 209), "a.ply"),
              "a.ply: byte 205: a list of 3 items, but 3 bytes are left");
}

TEST(IllegalShapes, BinaryStl) {
    const auto file = [](std::uint32_t count, float x) {
        return BinaryText(std::endian::little)
            .zeros(80)
            .add<std::uint32_t>({count})
            .add<float>({0, 0, 1, 0, 0, 0, x, 0, 0, 0, 1, 0})
            .zeros(2)
            .bytes();
    };
    EXPECT_EQ(messageOf(file(1, 1), "a.stl"), "no error");
    EXPECT_EQ(messageOf(file(0, 1), "a.stl"), "a.stl: byte 80: holds no triangles");
    EXPECT_EQ(messageOf(file(4294967295u, 1), "a.stl"),
              "a.stl: byte 84: 4294967295 triangles of 50 bytes, but 50 bytes are left" + std::string(kCut));
    EXPECT_EQ(messageOf(file(1, 1) + " ", "a.stl"), "a.stl: byte 134: more data than the header states");
    EXPECT_EQ(messageOf(file(1, INFINITY), "a.stl"), "a.stl: byte 84: a position is not finite");
    EXPECT_EQ(messageOf("not solid", "a.stl"),
              "a.stl: byte 0: 80 bytes of the header, but 9 bytes are left" + std::string(kCut));
}

struct PtcFields {
    std::string magic = "pptc";
    std::int32_t version = 0;
    double points = 1;
    std::int32_t variables = 1, size = 1;
    std::string variable = "float a\n";
    float x = 0, radius = 1;
};

std::string ptc(const PtcFields& fields) {
    return BinaryText(std::endian::little)
        .text(fields.magic)
        .add<std::int32_t>({fields.version})
        .add<double>({fields.points})
        .zeros(24 + 128 + 12)
        .add<std::int32_t>({fields.variables, fields.size})
        .text(fields.variable)
        .add<float>({fields.x, 0, 0, 0, fields.radius, 0})
        .bytes();
}

TEST(IllegalShapes, Ptc) {
    EXPECT_EQ(messageOf(ptc({}), "a.ptc"), "no error");
    EXPECT_EQ(messageOf(ptc({.magic = "ppct"}), "a.ptc"), "a.ptc: byte 0: is no PTC file (the first bytes are: pptc)");
    EXPECT_EQ(messageOf(ptc({.version = 3}), "a.ptc"), "a.ptc: byte 4: PTC version 3 (valid: 0, 1, 2)");
    EXPECT_EQ(messageOf(ptc({.version = -1}), "a.ptc"), "a.ptc: byte 4: PTC version -1 (valid: 0, 1, 2)");
    for (const auto& [points, text] : {std::pair{0.0, "0"}, std::pair{0.5, "0.5"}, std::pair{-1.0, "-1"},
                                       std::pair<double, const char*>{NAN, "nan"}})
        EXPECT_EQ(messageOf(ptc({.points = points}), "a.ptc"),
                  "a.ptc: byte 8: " + std::string(text) + " points (a whole number of 1 or more)");
    EXPECT_EQ(messageOf(ptc({.points = 1e300}), "a.ptc"),
              "a.ptc: byte 196: 1e+300 points of 24 bytes, but 24 bytes are left" + std::string(kCut));
    EXPECT_EQ(messageOf(ptc({.points = 2}), "a.ptc"),
              "a.ptc: byte 196: 2 points of 24 bytes, but 24 bytes are left" + std::string(kCut));
    EXPECT_EQ(messageOf(ptc({.variables = -1}), "a.ptc"),
              "a.ptc: byte 180: the number of variables is -1 (a count of 0 or more)");
    EXPECT_EQ(messageOf(ptc({.variables = 9}), "a.ptc"),
              "a.ptc: byte 196: the file ends before the name of a variable");
    EXPECT_EQ(messageOf(ptc({.size = 2}), "a.ptc"),
              "a.ptc: byte 184: the data of a point has 2 numbers, its variables 1");
    EXPECT_EQ(messageOf(ptc({.variable = "half a\n"}), "a.ptc"),
              "a.ptc: byte 188: 'half' is no type of a variable (valid: float, point, vector, normal, color, matrix)");
    EXPECT_EQ(messageOf(ptc({.x = NAN}), "a.ptc"), "a.ptc: byte 196: a position is not finite");
    EXPECT_EQ(messageOf(ptc({.radius = -1}), "a.ptc"), "a.ptc: byte 196: an area or radius is negative or not finite");
    EXPECT_EQ(messageOf(ptc({}).substr(0, 100), "a.ptc"),
              "a.ptc: byte 16: 41 numbers of the header of 4 bytes, but 84 bytes are left" + std::string(kCut));
}

struct PdbFields {
    std::uint32_t magic = 670, points = 1, channels = 1, point_bytes = 12;
    std::string name = std::string("position") + '\0';
    float x = 0;
};

std::string pdb(const PdbFields& fields) {
    return BinaryText(std::endian::little)
        .add<std::uint32_t>({fields.magic})
        .zeros(12)
        .add<std::uint32_t>({fields.points, fields.channels})
        .zeros(36 + 6 + 4)
        .add<std::int32_t>({1})
        .zeros(28)
        .text(fields.name)
        .add<std::uint32_t>({1, fields.point_bytes})
        .zeros(12)
        .add<float>({fields.x, 0, 0})
        .bytes();
}

TEST(IllegalShapes, Pdb) {
    EXPECT_EQ(messageOf(pdb({}), "a.pdb"), "no error");
    EXPECT_EQ(messageOf(pdb({.magic = 671}), "a.pdb"), "a.pdb: byte 0: is no PDB file (the first number is 670)");
    EXPECT_EQ(messageOf(pdb({.magic = 0x9E020000}), "a.pdb"),
              "a.pdb: byte 0: is a PDB file of a big-endian machine (valid: little-endian)");
    EXPECT_EQ(messageOf(pdb({.points = 0}), "a.pdb"), "a.pdb: byte 16: holds no particles");
    EXPECT_EQ(messageOf(pdb({.points = 2}), "a.pdb"),
              "a.pdb: byte 131: 2 values of 'position' of 12 bytes, but 12 bytes are left" + std::string(kCut));
    EXPECT_EQ(messageOf(pdb({.points = 4000000000u}), "a.pdb"),
              "a.pdb: byte 16: the number of particles is -294967296 (a count of 0 or more)");
    EXPECT_EQ(messageOf(pdb({.channels = 2}), "a.pdb"),
              "a.pdb: byte 143: 6 bytes of an attribute, but 0 bytes are left" + std::string(kCut));
    EXPECT_EQ(messageOf(pdb({.point_bytes = 8}), "a.pdb"), "a.pdb: byte 139: no attribute 'position' of three numbers");
    EXPECT_EQ(messageOf(pdb({.x = NAN}), "a.pdb"), "a.pdb: byte 143: particle 0: a position is not finite");
    EXPECT_EQ(messageOf(pdb({}).substr(0, 105), "a.pdb"),
              "a.pdb: byte 102: the file ends before the end of an attribute's name");
}

std::string pdc(std::int32_t points, std::int32_t type, double x, const std::string& more = {}) {
    return BinaryText(std::endian::big)
        .text("PDC ")
        .add<std::int32_t>({1, 1, 0, 0, points, 1, 8})
        .text("position")
        .add<std::int32_t>({type})
        .add<double>({x, 0, 0})
        .text(more)
        .bytes();
}

TEST(IllegalShapes, Pdc) {
    EXPECT_EQ(messageOf(pdc(1, 5, 0), "a.pdc"), "no error");
    EXPECT_EQ(messageOf("PDB ", "a.pdc"), "a.pdc: byte 0: is no PDC file (the first bytes are: PDC and a blank)");
    EXPECT_EQ(messageOf(pdc(0, 5, 0), "a.pdc"), "a.pdc: byte 20: holds no particles");
    EXPECT_EQ(messageOf(pdc(-1, 5, 0), "a.pdc"),
              "a.pdc: byte 20: the number of particles is -1 (a count of 0 or more)");
    EXPECT_EQ(messageOf(pdc(2, 5, 0), "a.pdc"),
              "a.pdc: byte 44: 2 values of 'position' of 24 bytes, but 24 bytes are left" + std::string(kCut));
    EXPECT_EQ(messageOf(pdc(1, 6, 0), "a.pdc"),
              "a.pdc: byte 40: 6 is no type of an attribute (valid: 0 (integer), 1 (integers), 2 (double), 3 "
              "(doubles), 4 (vector), 5 (vectors))");
    EXPECT_EQ(messageOf(pdc(3, 3, 0), "a.pdc"), "a.pdc: byte 68: no attribute 'position' of vectors");
    EXPECT_EQ(messageOf(pdc(1, 5, 1e300), "a.pdc"), "a.pdc: byte 44: particle 0: a position is not finite");
    EXPECT_EQ(messageOf(pdc(1, 5, 0, "x"), "a.pdc"), "a.pdc: byte 68: more data than the header states");
}

std::string bgeo(std::int32_t version, std::int32_t points, std::int32_t type, float x) {
    return BinaryText(std::endian::big)
        .text("BgeoV")
        .add<std::int32_t>({version, points, 0, 0, 0, 1, 0, 0, 0})
        .add<std::uint16_t>({1})
        .text("a")
        .add<std::uint16_t>({1})
        .add<std::int32_t>({type})
        .add<float>({0, x, 0, 0, 1, 0})
        .bytes();
}

TEST(IllegalShapes, Bgeo) {
    EXPECT_EQ(messageOf(bgeo(5, 1, 0, 0), "a.bgeo"), "no error");
    EXPECT_EQ(messageOf("\x7FNSJb", "a.bgeo"),
              "a.bgeo: byte 0: is a BGEO file of Houdini 12 or later, which is binary JSON (save it from Houdini as "
              ".bhclassic, renamed to .bgeo)");
    EXPECT_EQ(messageOf("bgeoV", "a.bgeo"), "a.bgeo: byte 0: is no BGEO file (the first bytes are: BgeoV)");
    EXPECT_EQ(messageOf(bgeo(6, 1, 0, 0), "a.bgeo"), "a.bgeo: byte 5: BGEO version 6 (valid: 5)");
    EXPECT_EQ(messageOf(bgeo(5, 0, 0, 0), "a.bgeo"), "a.bgeo: byte 9: holds no points");
    EXPECT_EQ(messageOf(bgeo(5, 2, 0, 0), "a.bgeo"),
              "a.bgeo: byte 54: 2 points of 20 bytes, but 20 bytes are left" + std::string(kCut));
    EXPECT_EQ(messageOf(bgeo(5, 1, 2, 0), "a.bgeo"),
              "a.bgeo: byte 46: 2 is no type of a point attribute (valid: 0 (float), 1 (int), 4 (index), 5 (vector))");
    EXPECT_EQ(messageOf(bgeo(5, 1, 0, INFINITY), "a.bgeo"), "a.bgeo: byte 54: a position is not finite");
    EXPECT_EQ(messageOf(bgeo(5, 1, 0, 0).substr(0, 20), "a.bgeo"),
              "a.bgeo: byte 13: 3 counts of the header of 4 bytes, but 7 bytes are left" + std::string(kCut));
}

}  // namespace
}  // namespace searchlight
