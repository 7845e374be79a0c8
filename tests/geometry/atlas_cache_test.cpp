#include "geometry/atlas/atlas_cache.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "base/files.h"
#include "geometry/content_hash.h"
#include "geometry/object.h"

namespace searchlight {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

struct Warnings : Observer {
    std::vector<std::string> lines;
    void log(LogLevel level, std::string_view message) override {
        if (level == LogLevel::warning) lines.emplace_back(message);
    }
};

class AtlasCache : public testing::Test {
protected:
    void SetUp() override {
        std::string name = (fs::temp_directory_path() / "searchlight-atlas-XXXXXX").string();
        ASSERT_NE(mkdtemp(name.data()), nullptr);
        cache_ = atlasesBeside({.folder = fs::path(name) / "below", .ending = ".ptc"});
    }
    void TearDown() override { fs::remove_all(cache_.folder.parent_path()); }

    Atlas get(const AtlasOptions& options) { return cachedAtlas(mesh_, hash_, options, cache_, warnings_); }
    fs::path file() const { return atlasFile(cache_, hash_, options_); }

    static void expectEqual(const Atlas& a, const Atlas& b) {
        EXPECT_EQ(a.resolution, b.resolution);
        EXPECT_EQ(a.charts, b.charts);
        ASSERT_EQ(a.triangles.size(), b.triangles.size());
        for (std::size_t t = 0; t < a.triangles.size(); ++t)
            for (std::size_t k = 0; k < 3; ++k) {
                EXPECT_EQ(a.triangles[t][k].x, b.triangles[t][k].x);
                EXPECT_EQ(a.triangles[t][k].y, b.triangles[t][k].y);
            }
        EXPECT_EQ(a.report.charts, b.report.charts);
        EXPECT_EQ(a.report.stretch.largest_area, b.report.stretch.largest_area);
        EXPECT_EQ(a.report.fill, b.report.fill);
        EXPECT_EQ(a.report.fault, b.report.fault);
        EXPECT_EQ(a.report.from_file, b.report.from_file);
    }

    const Mesh mesh_ = builtInObject("slab", -2);
    const std::string hash_ = contentHash(mesh_);
    AtlasOptions options_{.resolution = 64, .uvs = AtlasUvs::own};
    CacheFolder cache_;
    Warnings warnings_;
};

TEST_F(AtlasCache, GivesBackWhatWasMade) {
    const Atlas made = makeAtlas(mesh_, options_, warnings_), first = get(options_);
    ASSERT_TRUE(fs::exists(file()));
    const std::string bytes = readFile(file());
    expectEqual(made, first);
    expectEqual(made, get(options_));
    EXPECT_EQ(readFile(file()), bytes);
    EXPECT_THAT(warnings_.lines, IsEmpty());
}

TEST_F(AtlasCache, KeepsOneFilePerKindOfAtlas) {
    get(options_);
    get({.resolution = 32, .uvs = AtlasUvs::own});
    get({.resolution = 64, .conformal = true, .uvs = AtlasUvs::own});
    get({.resolution = 64, .uvs = AtlasUvs::automatic});
    EXPECT_EQ(std::distance(fs::directory_iterator(cache_.folder), {}), 4);
}

TEST_F(AtlasCache, MakesADamagedFileAgain) {
    const Atlas made = get(options_);
    const std::string whole = readFile(file());
    std::string turned = whole;
    turned[whole.size() / 2] = static_cast<char>(turned[whole.size() / 2] ^ 1);
    for (const std::string& damaged : {std::string(), whole.substr(0, 60), turned, "searchlight-atlas/2\n" + whole}) {
        warnings_.lines.clear();
        writeFile(file(), damaged);
        expectEqual(made, get(options_));
        EXPECT_THAT(warnings_.lines, ElementsAre(HasSubstr("the atlas is made again")));
        EXPECT_EQ(readFile(file()), whole);
    }
}

TEST_F(AtlasCache, DoesWithoutAFolder) {
    writeFile(cache_.folder, "a file stands there");
    const Atlas made = get(options_);
    EXPECT_EQ(made.triangles.size(), mesh_.triangles.size());
    EXPECT_THAT(warnings_.lines, ElementsAre(HasSubstr("the atlas is not kept")));
}

}  // namespace
}  // namespace searchlight
