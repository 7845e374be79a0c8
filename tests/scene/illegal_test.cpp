// Every file of tests/illegal/materials and tests/illegal/scenes fails with the message that messages.csv beside it
// states, word for word.
#include <filesystem>
#include <functional>
#include <set>

#include "base/csv.h"
#include "base/error.h"
#include "base/files.h"
#include "scene/materials.h"
#include "scene/scene.h"

namespace searchlight {
namespace {

namespace fs = std::filesystem;

using Reader = std::function<void(std::string_view text, std::string_view path)>;

void expectMessages(const std::string& folder, const Reader& read) {
    const fs::path root = fs::path(SEARCHLIGHT_SOURCE_DIR) / "tests/illegal" / folder;
    const CsvTable expected = parseCsv(readFile(root / "messages.csv"), "messages.csv");
    std::set<std::string> listed{"messages.csv"};
    for (const std::vector<CsvCell>& row : expected.rows) {
        const std::string& file = row[0].text;
        listed.insert(file);
        std::string message = "no error";
        try {
            read(readFile(root / file), file);
        } catch (const Error& error) {
            message = error.what();
        }
        EXPECT_EQ(message, row[1].text);
    }
    for (const fs::directory_entry& entry : fs::directory_iterator(root))
        EXPECT_TRUE(listed.contains(entry.path().filename().string())) << entry.path() << " is not in messages.csv";
}

TEST(Illegal, EveryMaterialTableFailsWithItsMessage) {
    expectMessages("materials", [](auto text, auto path) { parseMaterials(text, path); });
}

TEST(Illegal, EverySceneFailsWithItsMessage) {
    expectMessages("scenes", [](auto text, auto path) { parseScene(text, path); });
}

}  // namespace
}  // namespace searchlight
