// A folder of results that can be made again: it may lose any file at any time, and keeps below a size.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace searchlight {

struct CacheFolder {
    std::filesystem::path folder;  ///< made when needed
    std::string ending;            ///< of its files, with the dot; others are left alone
    std::uintmax_t max_bytes = std::uintmax_t{1} << 28;
};

/// $XDG_CACHE_HOME/searchlight, or ~/.cache/searchlight. Throws an input Error that names `what` is to be kept when
/// neither variable is set.
std::filesystem::path userCacheFolder(std::string_view what);

/// Removes the files used longest ago, all but `keep`, until the folder fits again, and what a process that died while
/// writing left behind. Other processes may do the same at once. Never throws.
void makeRoom(const CacheFolder& cache, const std::filesystem::path& keep);

/// Notes that the file was of use now.
void touchFile(const std::filesystem::path& file);

}  // namespace searchlight
