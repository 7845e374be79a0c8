// What holds for all formats: endings, packing, writing and reading back, and the meshes that everybody renders.
#include "io/shape_file.h"

#include <zlib.h>

#include <filesystem>
#include <fstream>

#include "base/csv.h"
#include "base/error.h"
#include "base/files.h"
#include "base/text.h"

namespace searchlight {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

// A file in a folder of its own that is removed with the test.
class ShapeFile : public testing::Test {
protected:
    ShapeFile()
        : folder_(fs::path(testing::TempDir()) /
                  ("searchlight_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()))) {
        makeFolder(folder_);
    }
    ~ShapeFile() override { fs::remove_all(folder_); }
    std::string path(const std::string& name) const { return (folder_ / name).string(); }

private:
    fs::path folder_;
};

// A strip of a torus: numbers without short decimals, with normals and uvs if wanted.
Mesh someMesh(bool normals, bool uvs) {
    Mesh mesh;
    for (std::uint32_t i = 0; i < 200; ++i) {
        const double a = 0.13 * i, b = 0.7 * i, r = 3 + std::cos(b);
        mesh.positions.push_back(toFloat(Vec3{r * std::cos(a), r * std::sin(a), 1e-3 * std::sin(b)}));
        if (normals) mesh.normals.push_back(toFloat(normalize(Vec3{std::cos(a), std::sin(a), std::sin(b)})));
        if (uvs) mesh.uvs.push_back({static_cast<float>(a / 3), static_cast<float>(-b / 7)});
        if (i >= 2) mesh.triangles.push_back({i - 2, i - 1, i});
    }
    return mesh;
}

PointCloud someCloud(bool normals, bool areas) {
    PointCloud cloud{.positions = someMesh(false, false).positions};
    if (normals) cloud.normals = someMesh(true, false).normals;
    if (normals) cloud.normals[7] = {};  // one that nobody knows
    for (std::size_t i = 0; areas && i < cloud.positions.size(); ++i)
        cloud.areas.push_back(0.1f * static_cast<float>(i));
    return cloud;
}

TEST_F(ShapeFile, MeshesAreReadAsTheyWereWritten) {
    for (const char* name : {"a.obj", "a.ply", "A.PLY"})
        for (const bool normals : {false, true})
            for (const bool uvs : {false, true}) {
                const Mesh mesh = someMesh(normals, uvs);
                writeMesh(path(name), mesh);
                const Mesh read = readMesh(path(name));
                EXPECT_EQ(read.positions, mesh.positions) << name;
                EXPECT_EQ(read.normals, mesh.normals) << name;
                EXPECT_EQ(read.uvs, mesh.uvs) << name;
                EXPECT_EQ(read.triangles, mesh.triangles) << name;
            }
}

TEST_F(ShapeFile, CloudsAreReadAsTheyWereWritten) {
    for (const char* name : {"a.ptc", "a.ply"})
        for (const bool normals : {false, true})
            for (const bool areas : {false, true}) {
                const PointCloud cloud = someCloud(normals, areas);
                writePointCloud(path(name), cloud);
                const PointCloud read = readPointCloud(path(name));
                EXPECT_EQ(read.positions, cloud.positions) << name;
                EXPECT_EQ(read.areas, cloud.areas) << name;
                ASSERT_EQ(read.normals.size(), cloud.normals.size()) << name;
                for (std::size_t i = 0; i < read.normals.size(); ++i) {
                    // PTC keeps 16 bits of azimuth and height: half a step of each, 4.8e-5 rad and 1.5e-5. Near a pole
                    // the height's step moves the normal by more, sqrt(2 * 3e-5) at most.
                    const double error = length(toDouble(read.normals[i]) - toDouble(cloud.normals[i]));
                    const bool steep = std::abs(cloud.normals[i].z) > 0.99;
                    EXPECT_LE(error, path(name).ends_with(".ply") ? 0 : steep ? 8e-3 : 1.3e-4) << name << " " << i;
                }
            }
}

// What is coarse once stays as it is: written again it is the same file.
TEST_F(ShapeFile, PtcNormalsDoNotDrift) {
    writePointCloud(path("a.ptc"), someCloud(true, true));
    writePointCloud(path("b.ptc"), readPointCloud(path("a.ptc")));
    EXPECT_EQ(readFile(path("a.ptc")), readFile(path("b.ptc")));
}

TEST_F(ShapeFile, PackedFilesAreUnpacked) {
    const Mesh mesh = someMesh(true, false);
    writeMesh(path("a.ply"), mesh);
    const std::string bytes = readFile(path("a.ply"));
    // In two members, as appending to a .gz file makes them.
    for (const auto& [part, mode] : {std::pair{bytes.substr(0, 500), "wb"}, std::pair{bytes.substr(500), "ab"}}) {
        gzFile file = gzopen(path("a.ply.gz").c_str(), mode);
        gzwrite(file, part.data(), static_cast<unsigned>(part.size()));
        gzclose(file);
    }
    EXPECT_EQ(readMesh(path("a.ply.gz")).positions, mesh.positions);

    const std::string packed = readFile(path("a.ply.gz"));
    const auto message = [](std::string_view damaged) -> std::string {
        try {
            parseShape(damaged, "a.ply.gz");
        } catch (const Error& error) {
            return error.what();
        }
        return "no error";
    };
    EXPECT_THAT(message(packed.substr(0, packed.size() / 2)), HasSubstr(": the packed data is cut off (gzip)"));
    EXPECT_EQ(message("ply\n"), "a.ply.gz: byte 2: incorrect header check (gzip)");
    EXPECT_EQ(message(""), "a.ply.gz: byte 0: the packed data is cut off (gzip)");
    std::string flipped = packed;
    flipped[packed.size() - 6] ^= 1;
    EXPECT_THAT(message(flipped), HasSubstr("incorrect data check (gzip)"));
}

// 80 MB of blanks in 80 kB.
TEST_F(ShapeFile, ABombIsRefused) {
    const std::string blanks(std::size_t{1} << 20, ' ');
    gzFile file = gzopen(path("a.obj.gz").c_str(), "wb9");
    for (int i = 0; i < 80; ++i) gzwrite(file, blanks.data(), static_cast<unsigned>(blanks.size()));
    gzclose(file);
    try {
        readShape(path("a.obj.gz"));
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), HasSubstr("unpacks to more than 64 MiB (gzip)"));
    }
}

TEST_F(ShapeFile, EndingsAreNamedWhenOneIsUnknown) {
    const auto message = [](const auto& attempt) -> std::pair<ErrorKind, std::string> {
        try {
            attempt();
        } catch (const Error& error) {
            return {error.kind, error.what()};
        }
        return {ErrorKind::device, "no error"};
    };
    EXPECT_EQ(message([] { parseShape("x", "a.fbx"); }),
              std::pair(ErrorKind::input,
                        std::string("a.fbx: '.fbx' is no ending of a mesh or point cloud (valid: .obj, .ply, .gltf, "
                                    ".glb, .off, .stl, .ptc, .pda, .pdb, .pdc, .geo, .bgeo, each also with .gz)")));
    EXPECT_EQ(message([] { parseShape("x", "folder.obj/a"); }).second.substr(0, 17), "folder.obj/a: '' ");
    EXPECT_EQ(message([&] { writeMesh(path("a.stl"), someMesh(false, false)); }),
              std::pair(ErrorKind::usage,
                        path("a.stl") + ": '.stl' is no ending that a mesh is written with (valid: .obj, .ply)"));
    EXPECT_EQ(
        message([&] { writePointCloud(path("a.bgeo"), someCloud(false, false)); }),
        std::pair(ErrorKind::usage,
                  path("a.bgeo") + ": '.bgeo' is no ending that a point cloud is written with (valid: .ptc, .ply)"));
    EXPECT_FALSE(fs::exists(path("a.stl")));
}

TEST_F(ShapeFile, AMeshIsNoPointCloud) {
    writeFile(path("cloud.obj"), "v 0 0 0\n");
    writeMesh(path("mesh.obj"), someMesh(false, false));
    EXPECT_THROW(readMesh(path("cloud.obj")), Error);
    EXPECT_THROW(readPointCloud(path("mesh.obj")), Error);
    EXPECT_EQ(readPointCloud(path("cloud.obj")).positions.size(), 1u);
    EXPECT_THROW(readShape(path("absent.obj")), Error);
}

// Scans and models from elsewhere, against a table made with another reader. Volume and area see every triangle and its
// orientation; the table has five digits.
TEST(SharedMeshes, AreReadWhole) {
    const fs::path folder = SEARCHLIGHT_SOURCE_DIR "/../shared/data/meshes";
    if (!fs::exists(folder / "mesh_table.csv")) GTEST_SKIP() << folder << " is not there";
    // The header has a name for every column; commas separate, and the boxes hold blanks.
    std::ifstream table(folder / "mesh_table.csv");
    std::string line;
    std::getline(table, line);
    int meshes = 0;
    while (std::getline(table, line)) {
        const std::vector<std::string_view> row = split(line, ',');
        const auto number = [&](std::size_t column) { return parseNumber(row[column]).value_or(-1); };
        const Mesh mesh = readMesh((folder / row[0]).string());
        SCOPED_TRACE(row[0]);
        const bool uv = row[13] == "yes", normals = row[14] == "yes";
        EXPECT_EQ(mesh.triangles.size(), number(5));
        EXPECT_EQ(mesh.uvs.empty(), !uv);
        EXPECT_EQ(mesh.normals.empty(), !normals);
        // Seams of the texture make more vertices.
        if (uv) {
            EXPECT_GT(mesh.positions.size(), number(2));
        } else {
            EXPECT_EQ(mesh.positions.size(), number(2));
        }
        double volume = 0, area = 0;
        for (const auto& [i, j, k] : mesh.triangles) {
            const Vec3 a = toDouble(mesh.positions[i]), b = toDouble(mesh.positions[j]),
                       c = toDouble(mesh.positions[k]);
            const Vec3 normal = cross(b - a, c - a);
            volume += dot(a, normal) / 6;
            area += length(normal) / 2;
        }
        EXPECT_NEAR(area / number(16), 1, 1e-4);
        if (row[6] == "yes") {
            EXPECT_NEAR(volume / number(15), 1, 1e-4);
        }
        ++meshes;
    }
    EXPECT_GE(meshes, 20);
}

}  // namespace
}  // namespace searchlight
