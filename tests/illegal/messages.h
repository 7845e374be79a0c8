// Every file of tests/illegal/<folder> fails with the message that messages.csv beside it states, word for word.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <string_view>

#include "base/csv.h"
#include "base/error.h"
#include "base/files.h"

namespace searchlight {

inline void expectMessages(const std::string& folder,
                           const std::function<void(std::string_view text, std::string_view path)>& read) {
    const std::filesystem::path root = std::filesystem::path(SEARCHLIGHT_SOURCE_DIR) / "tests/illegal" / folder;
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
    for (const auto& entry : std::filesystem::directory_iterator(root))
        EXPECT_TRUE(listed.contains(entry.path().filename().string())) << entry.path() << " is not in messages.csv";
}

}  // namespace searchlight
