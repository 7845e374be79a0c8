#include "base/files.h"

#include <unistd.h>

#include "base/error.h"

namespace searchlight {
namespace {

namespace fs = std::filesystem;

class Files : public testing::Test {
protected:
    void SetUp() override { fs::create_directories(folder_); }
    void TearDown() override { fs::remove_all(folder_); }

    template <class Call>
    std::string messageOf(const Call& call) {
        try {
            call();
        } catch (const Error& error) {
            EXPECT_EQ(error.kind, ErrorKind::input);
            return error.what();
        }
        return "no error";
    }

    fs::path folder_ = fs::temp_directory_path() / ("searchlight_files_" + std::to_string(getpid()));
};

TEST_F(Files, BytesComeBackAsTheyWere) {
    const std::string bytes("a\0b\r\n\xFF", 6);
    writeFile(folder_ / "a", bytes);
    EXPECT_EQ(readFile(folder_ / "a"), bytes);
    writeFile(folder_ / "a", "");
    EXPECT_EQ(readFile(folder_ / "a"), "");
}

TEST_F(Files, WritingLeavesNothingElseInTheFolder) {
    writeFile(folder_ / "a", "1");
    writeFile(folder_ / "a", "2");
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
}

// /dev/full takes no byte; the file that is written aside is a link to it.
TEST_F(Files, FailedWriteLeavesTheOldFile) {
    if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
    const fs::path path = folder_ / "a";
    writeFile(path, "old");
    fs::create_symlink("/dev/full", path.string() + "." + std::to_string(getpid()) + ".partial");
    EXPECT_EQ(messageOf([&] { writeFile(path, "new"); }),
              path.string() + ": cannot be written: No space left on device");
    EXPECT_EQ(readFile(path), "old");
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
}

// Renaming a file onto a device would replace the device.
TEST_F(Files, DevicesAreWrittenDirectly) {
    if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
    writeFile("/dev/null", "1");
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
    checkWritable("/dev/full");
    EXPECT_EQ(messageOf([&] { writeFile("/dev/full", "1"); }), "/dev/full: cannot be written: No space left on device");
}

TEST_F(Files, WhatCannotBeWrittenIsKnownBefore) {
    const fs::path path = folder_ / "a", missing = folder_ / "no" / "a", longer = folder_ / std::string(300, 'a');
    EXPECT_EQ(messageOf([&] { checkWritable(path); }), "no error");
    EXPECT_TRUE(fs::is_empty(folder_));
    writeFile(path, "old");
    EXPECT_EQ(messageOf([&] { checkWritable(path); }), "no error");
    EXPECT_EQ(readFile(path), "old");
    for (const fs::path& bad : {folder_, missing, longer, path / "b"}) {
        const std::string message = messageOf([&] { checkWritable(bad); });
        EXPECT_EQ(message, messageOf([&] { writeFile(bad, ""); }));
        EXPECT_NE(message, "no error") << bad;
    }
    EXPECT_EQ(messageOf([&] { checkWritable(longer); }), longer.string() + ": cannot be written: File name too long");
}

TEST_F(Files, OneFileHasManyNames) {
    EXPECT_TRUE(sameFile(folder_ / "a", folder_ / "." / "a"));
    EXPECT_TRUE(sameFile("a", fs::current_path() / "b" / ".." / "a"));
    EXPECT_FALSE(sameFile(folder_ / "a", folder_ / "b"));
    writeFile(folder_ / "a", "");
    EXPECT_FALSE(sameFile(folder_ / "a", folder_ / "b"));
    fs::create_hard_link(folder_ / "a", folder_ / "b");
    fs::create_symlink(folder_, folder_ / "c");
    EXPECT_TRUE(sameFile(folder_ / "a", folder_ / "b"));
    EXPECT_TRUE(sameFile(folder_ / "new", folder_ / "c" / "new"));
    EXPECT_FALSE(sameFile(std::string(5000, 'a'), folder_ / "a"));
}

TEST_F(Files, FaultsAreNamedWithTheirPath) {
    const std::string folder = folder_.string(), missing = (folder_ / "missing").string();
    EXPECT_EQ(messageOf([&] { readFile(missing); }), missing + ": no such file");
    EXPECT_EQ(messageOf([&] { readFile(folder_); }), folder + ": is a folder, expected a file");
    EXPECT_EQ(messageOf([&] { writeFile(folder_, ""); }), folder + ": cannot be written: is a folder");
    EXPECT_EQ(messageOf([&] { writeFile(folder_ / "no" / "a", ""); }),
              folder + "/no/a: cannot be written: No such file or directory");
    writeFile(folder_ / "a", "");
    EXPECT_EQ(messageOf([&] { makeFolder(folder_ / "a"); }), folder + "/a: cannot make this folder: Not a directory");
}

TEST_F(Files, FileLargerThanAllowedIsNotTakenIntoMemory) {
    writeFile(folder_ / "a", std::string((1 << 20) + 1, 'x'));
    EXPECT_EQ(messageOf([&] { readFile(folder_ / "a", 1 << 20); }),
              (folder_ / "a").string() + ": is larger than 1 MiB");
    EXPECT_EQ(messageOf([&] { readFile("/dev/zero", 1 << 20); }), "/dev/zero: is larger than 1 MiB");
}

TEST_F(Files, FolderIsMadeWithItsParents) {
    makeFolder(folder_ / "b" / "c");
    makeFolder(folder_ / "b" / "c");
    EXPECT_TRUE(fs::is_directory(folder_ / "b" / "c"));
}

}  // namespace
}  // namespace searchlight
