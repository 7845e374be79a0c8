#include "transport/white/white_cache.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <cstring>

#include "base/error.h"
#include "base/files.h"
#include "transport/white/white_file.h"

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

class Cache : public testing::Test {
protected:
    void SetUp() override {
        std::string name = (fs::temp_directory_path() / "searchlight-white-XXXXXX").string();
        ASSERT_NE(mkdtemp(name.data()), nullptr);
        cache_.folder = fs::path(name) / "below";
    }
    void TearDown() override { fs::remove_all(cache_.folder.parent_path()); }

    CachedWhiteTable get(const WhiteKey& key) { return cachedWhiteTable(key, cache_, 1, warnings_); }

    // What a curve is made of, without the time that it took.
    static std::string contents(WhiteTable table) {
        table.build_seconds = 0;
        return whiteTableBytes(table);
    }
    std::size_t files() const {
        std::size_t count = 0;
        for ([[maybe_unused]] const auto& entry : fs::directory_iterator(cache_.folder)) ++count;
        return count;
    }

    WhiteKey key_{.eta = 1.3, .walks = 500, .seed = 2};
    WhiteCache cache_;
    Warnings warnings_;
};

std::string refusal(std::string_view bytes) {
    try {
        parseWhiteTable(bytes, "t.white");
    } catch (const Error& error) {
        EXPECT_EQ(error.kind, ErrorKind::input);
        EXPECT_EQ(error.file, "t.white");
        return error.message;
    }
    return "accepted";
}

TEST_F(Cache, SecondUseReadsTheSameTable) {
    const CachedWhiteTable first = get(key_), second = get(key_);
    EXPECT_FALSE(first.hit);
    EXPECT_TRUE(second.hit);
    EXPECT_TRUE(second.table->key == key_);
    EXPECT_EQ(contents(*first.table), contents(*second.table));
    EXPECT_THAT(warnings_.lines, IsEmpty());
}

TEST_F(Cache, EveryPartOfTheKeyMakesAnotherTable) {
    get(key_);
    for (int part = 0; part < 5; ++part) {
        WhiteKey other = key_;
        if (part == 0) other.g = 0.1;
        if (part == 1) other.eta = 1.31;
        if (part == 2) other.angle_deg = 1;
        if (part == 3) other.walks = 501;
        if (part == 4) other.seed = 3;
        EXPECT_FALSE(get(other).hit) << part;
    }
    EXPECT_EQ(files(), 6u);
}

TEST_F(Cache, DamagedFilesAreWalkedAgainAndReplaced) {
    const CachedWhiteTable sound = get(key_);
    const std::string bytes = readFile(sound.file);
    const auto damage = [&](const std::string& what, const std::string& damaged) {
        warnings_.lines.clear();
        writeFile(sound.file, damaged);
        const CachedWhiteTable again = get(key_);
        EXPECT_FALSE(again.hit) << what;
        ASSERT_EQ(warnings_.lines.size(), 1u) << what;
        EXPECT_THAT(warnings_.lines[0], HasSubstr("walked again"));
        EXPECT_EQ(contents(*again.table), contents(*sound.table));
        EXPECT_TRUE(get(key_).hit) << what;
    };
    std::string flipped = bytes;
    flipped[flipped.size() / 2] ^= 1;
    damage("a flipped bit", flipped);
    damage("half a file", bytes.substr(0, bytes.size() / 2));
    damage("a file of another kind", "P6 1 1 255 ");
    damage("an empty file", "");
}

TEST_F(Cache, NewerVersionIsRefusedAndLeftAlone) {
    const CachedWhiteTable sound = get(key_);
    std::string newer = readFile(sound.file);
    newer[8] = 2;
    writeFile(sound.file, newer);
    EXPECT_EQ(refusal(newer), "is a white table of another version");
    EXPECT_FALSE(get(key_).hit);
    EXPECT_FALSE(get(key_).hit);
    EXPECT_EQ(readFile(sound.file), newer);
    EXPECT_EQ(warnings_.lines.size(), 2u);
}

TEST_F(Cache, ParserRefusesEveryTruncationAndEveryFlippedByte) {
    Observer observer;
    const std::string bytes = whiteTableBytes(buildWhiteTable({.walks = 1}, 1, observer));
    EXPECT_EQ(refusal(bytes), "accepted");
    for (std::size_t size = 0; size < bytes.size(); size += size < 300 ? 1 : 101)
        EXPECT_NE(refusal(std::string_view(bytes).substr(0, size)), "accepted") << size;
    for (std::size_t at = 0; at < bytes.size(); at += at < 300 ? 1 : 101) {
        std::string flipped = bytes;
        flipped[at] ^= 0x10;
        EXPECT_NE(refusal(flipped), "accepted") << at;
    }
    EXPECT_NE(refusal(bytes + std::string(8, '\0')), "accepted");
}

// A row that claims more cells than there are, under a checksum that is right.
TEST_F(Cache, ParserRefusesCountsThatDoNotFit) {
    Observer observer;
    WhiteTable table = buildWhiteTable({.walks = 100}, 1, observer);
    table.fine.exits[0][1].rows[5] = {0, 4000};
    EXPECT_EQ(refusal(whiteTableBytes(table)), "a row of the white table is too long");
    table.fine.exits[0][1].rows[5] = {0, 400};
    EXPECT_EQ(refusal(whiteTableBytes(table)), "the rows of the white table do not add up");
    table.fine.exits[0][1].rows.clear();
    EXPECT_NE(refusal(whiteTableBytes(table)), "accepted");
    table = buildWhiteTable({.walks = 100}, 1, observer);
    table.key.g = 2;
    EXPECT_EQ(refusal(whiteTableBytes(table)), "g is 2");
    table.key.g = 0;
    table.fine.exits[0][1].moments[1].at(0) = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(refusal(whiteTableBytes(table)), "the white table holds a number that is none");
}

TEST_F(Cache, TwoProcessesAtOnceLeaveOneSoundFile) {
    fs::create_directories(cache_.folder);
    std::vector<pid_t> children;
    for (int i = 0; i < 2; ++i) {
        const pid_t child = fork();
        ASSERT_GE(child, 0);
        if (child == 0) {
            // Threads do not survive a fork: the child walks on its own one.
            Observer silent;
            for (int round = 0; round < 5; ++round) {
                fs::remove(cachedWhiteTable(key_, cache_, 1, silent).file);
                cachedWhiteTable(key_, cache_, 1, silent);
            }
            _exit(0);
        }
        children.push_back(child);
    }
    for (const pid_t child : children) {
        int status = -1;
        ASSERT_EQ(waitpid(child, &status, 0), child);
        EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
    }
    get(key_);
    EXPECT_TRUE(get(key_).hit);
    EXPECT_EQ(files(), 1u);
    EXPECT_THAT(warnings_.lines, IsEmpty());
}

TEST_F(Cache, TablesUsedLongestAgoMakeRoom) {
    const auto keyOf = [&](std::uint64_t seed) {
        WhiteKey key = key_;
        key.seed = seed;
        return key;
    };
    const auto hoursAgo = [](const fs::path& path, int hours) {
        fs::last_write_time(path, fs::file_time_type::clock::now() - std::chrono::hours(hours));
    };
    const CachedWhiteTable a = get(keyOf(1)), b = get(keyOf(2)), c = get(keyOf(3));
    hoursAgo(a.file, 3), hoursAgo(b.file, 2), hoursAgo(c.file, 1);
    EXPECT_TRUE(get(keyOf(1)).hit);  // used now: no longer the oldest
    const fs::path stranger = cache_.folder / "notes.txt", partial = cache_.folder / "0.white.1.partial";
    writeFile(stranger, "of someone else");
    writeFile(partial, "of a process that died");
    hoursAgo(stranger, 100), hoursAgo(partial, 100);
    cache_.max_bytes = 3 * fs::file_size(a.file) + fs::file_size(a.file) / 2;
    const CachedWhiteTable d = get(keyOf(4));
    EXPECT_TRUE(fs::exists(a.file));
    EXPECT_FALSE(fs::exists(b.file));
    EXPECT_TRUE(fs::exists(c.file));
    EXPECT_TRUE(fs::exists(d.file));
    EXPECT_TRUE(fs::exists(stranger));
    EXPECT_FALSE(fs::exists(partial));
}

TEST_F(Cache, FolderThatCannotBeWrittenCostsAWarning) {
    writeFile(cache_.folder.parent_path() / "file", "in the way");
    cache_.folder = cache_.folder.parent_path() / "file";
    EXPECT_NE(get(key_).table, nullptr);
    ASSERT_EQ(warnings_.lines.size(), 1u);
    EXPECT_THAT(warnings_.lines[0], HasSubstr("not kept"));
}

TEST_F(Cache, FolderFollowsTheXdgVariables) {
    const auto folder = [](const char* xdg, const char* home) {
        setenv("XDG_CACHE_HOME", xdg, 1);
        setenv("HOME", home, 1);
        return userWhiteCache().folder;
    };
    const std::string old_xdg = std::getenv("XDG_CACHE_HOME") ? std::getenv("XDG_CACHE_HOME") : "",
                      old_home = std::getenv("HOME") ? std::getenv("HOME") : "";
    EXPECT_EQ(folder("/a", "/b"), "/a/searchlight");
    EXPECT_EQ(folder("relative", "/b"), "/b/.cache/searchlight");
    EXPECT_EQ(folder("", "/b"), "/b/.cache/searchlight");
    EXPECT_THROW(folder("", ""), Error);
    setenv("XDG_CACHE_HOME", old_xdg.c_str(), 1);
    setenv("HOME", old_home.c_str(), 1);
}

}  // namespace
}  // namespace searchlight
