#include "base/embedded.h"

#include <filesystem>

#include "base/files.h"

namespace searchlight {
namespace {

namespace fs = std::filesystem;

// Backslashes, brackets and semicolons must survive the way through CMake.
TEST(Embedded, EveryShippedTextIsEmbeddedByteForByte) {
    for (const char* folder : {"models", "physics", "data/materials"})
        for (const fs::directory_entry& entry : fs::directory_iterator(fs::path(SEARCHLIGHT_SOURCE_DIR) / folder)) {
            const std::string path = std::string(folder) + "/" + entry.path().filename().string();
            const auto text = embeddedText(path);
            ASSERT_TRUE(text.has_value()) << path;
            EXPECT_EQ(*text, readFile(entry.path())) << path;
        }
}

TEST(Embedded, UnknownPathHasNoText) { EXPECT_EQ(embeddedText("models/none.bssrdf"), std::nullopt); }

}  // namespace
}  // namespace searchlight
