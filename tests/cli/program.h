// Runs the built program in a folder of its own.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "base/files.h"

namespace searchlight {

struct Output {
    int exit_code = -1;
    std::string out, err;
};

class Program : public testing::Test {
protected:
    void SetUp() override {
        std::string name = (std::filesystem::temp_directory_path() / "searchlight-XXXXXX").string();
        ASSERT_NE(mkdtemp(name.data()), nullptr);
        folder_ = name;
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    /// `arguments` as a shell reads them; the working directory is folder(). `launcher` stands before the program.
    Output run(const std::string& arguments, const std::string& launcher = {}) const {
        const std::string command = "cd '" + folder_.string() + "' && " + launcher + " '" SEARCHLIGHT_PROGRAM "' " +
                                    arguments + " >.out 2>.err </dev/null";
        const int status = std::system(command.c_str());
        Output output;
        output.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
        output.out = readFile(folder_ / ".out");
        output.err = readFile(folder_ / ".err");
        std::filesystem::remove(folder_ / ".out");
        std::filesystem::remove(folder_ / ".err");
        return output;
    }

    /// run(), ended by Ctrl+C when it has something to show: how long that takes is not known.
    Output interrupt(const std::string& arguments) const {
        Output output;
        for (const char* seconds : {"2", "8", "32", "128"}) {
            output = run(arguments, std::string("timeout --preserve-status -s INT -k 60 ") + seconds);
            if (!output.out.empty()) break;
        }
        return output;
    }

    const std::filesystem::path& folder() const { return folder_; }

    /// Files that runs left behind.
    std::size_t fileCount() const {
        std::size_t count = 0;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_))
            count += entry.is_regular_file();
        return count;
    }

private:
    std::filesystem::path folder_;
};

}  // namespace searchlight
