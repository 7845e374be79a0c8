// Targets that read many formats can be given one: SEARCHLIGHT_FUZZ_FORMAT=.ply fuzz_shape CORPUS. Its inputs are then
// files of that format as they are. With SEARCHLIGHT_FUZZ_FORMAT=list the target prints the endings and does nothing.
#pragma once

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

namespace searchlight {

/// The ending that is asked for; "" when none is. Ends the program for "list", and for an ending that is not there.
inline std::string oneFormat(const std::vector<std::string>& endings) {
    const char* wish = std::getenv("SEARCHLIGHT_FUZZ_FORMAT");
    if (!wish) return {};
    const bool known = std::ranges::find(endings, wish) != endings.end();
    if (known) return wish;
    for (const std::string& ending : endings) std::printf("%s\n", ending.c_str());
    std::fflush(stdout);
    std::_Exit(std::string(wish) == "list" ? 0 : 2);
}

}  // namespace searchlight
