#include "base/cache_folder.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <system_error>
#include <vector>

#include "base/error.h"

namespace searchlight {

namespace fs = std::filesystem;

namespace {

struct Stored {
    fs::path path;
    fs::file_time_type used;
    std::uintmax_t bytes = 0;
};

}  // namespace

fs::path userCacheFolder(std::string_view what) {
    // The XDG base directories: a relative path is to be ignored.
    if (const char* xdg = std::getenv("XDG_CACHE_HOME"); xdg && fs::path(xdg).is_absolute())
        return fs::path(xdg) / "searchlight";
    if (const char* home = std::getenv("HOME"); home && *home) return fs::path(home) / ".cache" / "searchlight";
    throw inputError("there is no folder for " + std::string(what), "set XDG_CACHE_HOME or HOME");
}

void makeRoom(const CacheFolder& cache, const fs::path& keep) {
    // Files that vanish meanwhile are another process's doing.
    std::error_code ignored;
    std::vector<Stored> files;
    std::uintmax_t sum = 0;
    for (const auto& entry : fs::directory_iterator(cache.folder, ignored)) {
        const std::string name = entry.path().filename().string();
        const bool is_partial = name.ends_with(".partial") && name.find(cache.ending) != std::string::npos;
        if (!name.ends_with(cache.ending) && !is_partial) continue;
        std::error_code gone;
        const Stored file{entry.path(), entry.last_write_time(gone), entry.file_size(gone)};
        if (gone) continue;
        if (is_partial) {  // of a process that died: writing takes seconds
            if (fs::file_time_type::clock::now() - file.used > std::chrono::hours(24)) fs::remove(file.path, ignored);
            continue;
        }
        sum += file.bytes;
        if (file.path != keep) files.push_back(file);
    }
    std::ranges::sort(files, {}, &Stored::used);
    for (const Stored& file : files) {
        if (sum <= cache.max_bytes) break;
        fs::remove(file.path, ignored);
        sum -= file.bytes;
    }
}

void touchFile(const fs::path& file) {
    std::error_code ignored;
    fs::last_write_time(file, fs::file_time_type::clock::now(), ignored);
}

}  // namespace searchlight
