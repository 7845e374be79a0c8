#include "geometry/point_cache.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>

#include "base/files.h"
#include "geometry/object.h"

namespace searchlight {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::IsEmpty;

struct Warnings : Observer {
    std::vector<std::string> lines;
    void log(LogLevel level, std::string_view message) override {
        if (level == LogLevel::warning) lines.emplace_back(message);
    }
};

class PointCache : public testing::Test {
protected:
    void SetUp() override {
        std::string name = (fs::temp_directory_path() / "searchlight-points-XXXXXX").string();
        ASSERT_NE(mkdtemp(name.data()), nullptr);
        cache_ = {.folder = fs::path(name) / "below", .ending = ".ptc"};
    }
    void TearDown() override { fs::remove_all(cache_.folder.parent_path()); }

    CachedPoints get(const PointOptions& options) {
        return cachedPoints(object_.mesh, object_.content_hash, options, cache_, warnings_);
    }

    Object object_ = placeObject({.object = "slab", .scale = 10});
    PointOptions options_{.count = 500};
    CacheFolder cache_;
    Warnings warnings_;
};

TEST_F(PointCache, SecondUseReadsTheSamePoints) {
    const CachedPoints first = get(options_), second = get(options_);
    EXPECT_FALSE(first.hit);
    EXPECT_TRUE(second.hit);
    EXPECT_EQ(first.cloud.positions, second.cloud.positions);
    EXPECT_EQ(first.cloud.normals, second.cloud.normals);
    EXPECT_EQ(first.cloud.areas, second.cloud.areas);
    EXPECT_THAT(warnings_.lines, IsEmpty());
}

TEST_F(PointCache, EveryPartOfTheKeyMakesOtherPointsButThreads) {
    get(options_);
    EXPECT_FALSE(get({.count = 501}).hit);
    EXPECT_FALSE(get({.count = 500, .method = PointMethod::turk}).hit);
    EXPECT_FALSE(get({.count = 500, .seed = 2}).hit);
    EXPECT_TRUE(get({.count = 500, .threads = 1}).hit);
    object_ = placeObject({.object = "slab", .scale = 11});
    EXPECT_FALSE(get(options_).hit);
}

TEST_F(PointCache, DamagedFilesAreMadeAgain) {
    const fs::path file = get(options_).file;
    const std::string bytes = readFile(file);
    std::string other_area = bytes;
    other_area[bytes.size() - 1] ^= 1;
    for (const std::string& damaged :
         {std::string(), bytes.substr(0, bytes.size() / 2), std::string("PLY"), other_area}) {
        warnings_.lines.clear();
        writeFile(file, damaged);
        EXPECT_FALSE(get(options_).hit);
        ASSERT_EQ(warnings_.lines.size(), 1u);
        EXPECT_THAT(warnings_.lines[0], HasSubstr("made again"));
        EXPECT_EQ(readFile(file), bytes);
    }
}

TEST_F(PointCache, PointsUsedLongestAgoMakeRoom) {
    const fs::path a = get(options_).file, b = get({.count = 500, .seed = 2}).file;
    fs::last_write_time(a, fs::file_time_type::clock::now() - std::chrono::hours(2));
    fs::last_write_time(b, fs::file_time_type::clock::now() - std::chrono::hours(1));
    EXPECT_TRUE(get(options_).hit);  // used now: no longer the oldest
    writeFile(cache_.folder / "notes.txt", "of someone else");
    cache_.max_bytes = fs::file_size(a) * 5 / 2;
    const fs::path c = get({.count = 500, .seed = 3}).file;
    EXPECT_TRUE(fs::exists(a));
    EXPECT_FALSE(fs::exists(b));
    EXPECT_TRUE(fs::exists(c));
    EXPECT_TRUE(fs::exists(cache_.folder / "notes.txt"));
}

TEST_F(PointCache, FolderThatCannotBeWrittenCostsAWarning) {
    const fs::path file = cache_.folder.parent_path() / "file";
    writeFile(file, "in the way");
    cache_.folder = file;
    EXPECT_EQ(get(options_).cloud.positions.size(), 500u);
    ASSERT_EQ(warnings_.lines.size(), 1u);
    EXPECT_THAT(warnings_.lines[0], HasSubstr("not kept"));
}

}  // namespace
}  // namespace searchlight
