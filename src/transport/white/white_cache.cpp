#include "transport/white/white_cache.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cstdlib>
#include <system_error>
#include <vector>

#include "base/error.h"
#include "base/files.h"
#include "transport/walk/random.h"
#include "transport/white/white_file.h"

namespace searchlight {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kEnding = ".white";

std::string nameOf(const WhiteKey& key) {
    std::uint64_t hash = 0;
    for (const std::uint64_t word : {std::bit_cast<std::uint64_t>(key.g), std::bit_cast<std::uint64_t>(key.eta),
                                     std::bit_cast<std::uint64_t>(key.angle_deg), key.walks, key.seed})
        hash = SplitMix64(hash ^ word).next();
    return fmt::format("{:016x}{}", hash, kEnding);
}

struct Stored {
    fs::path path;
    fs::file_time_type used;
    std::uintmax_t bytes = 0;
};

// Makes room. Files that vanish meanwhile are another process's doing.
void evict(const WhiteCache& cache, const fs::path& keep) {
    std::error_code ignored;
    std::vector<Stored> files;
    std::uintmax_t sum = 0;
    for (const auto& entry : fs::directory_iterator(cache.folder, ignored)) {
        const std::string name = entry.path().filename().string();
        const bool is_partial = name.ends_with(".partial") && name.find(kEnding) != std::string::npos;
        if (!name.ends_with(kEnding) && !is_partial) continue;
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

}  // namespace

WhiteCache userWhiteCache() {
    WhiteCache cache;
    // The XDG base directories: a relative path is to be ignored.
    if (const char* xdg = std::getenv("XDG_CACHE_HOME"); xdg && fs::path(xdg).is_absolute())
        cache.folder = fs::path(xdg) / "searchlight";
    else if (const char* home = std::getenv("HOME"); home && *home)
        cache.folder = fs::path(home) / ".cache" / "searchlight";
    else
        throw inputError("there is no folder for white tables", "set XDG_CACHE_HOME or HOME");
    return cache;
}

CachedWhiteTable cachedWhiteTable(const WhiteKey& key, const WhiteCache& cache, int threads, Observer& observer) {
    CachedWhiteTable cached;
    cached.file = cache.folder / nameOf(key);
    bool may_write = true;
    std::error_code error;
    if (fs::exists(cached.file, error)) {
        std::string bytes;
        try {
            bytes = readFile(cached.file);
            WhiteTable table = parseWhiteTable(bytes, cached.file.string());
            if (table.key == key) {
                fs::last_write_time(cached.file, fs::file_time_type::clock::now(), error);
                cached.table = std::make_shared<const WhiteTable>(std::move(table));
                cached.hit = true;
                return cached;
            }
        } catch (const Error& unusable) {
            may_write = whiteFileVersion(bytes) <= kWhiteFileVersion;
            observer.log(LogLevel::warning, fmt::format("{}; the table is walked again", unusable.what()));
        }
    }
    cached.table = std::make_shared<const WhiteTable>(buildWhiteTable(key, threads, observer));
    if (!may_write) return cached;
    const std::string bytes = whiteTableBytes(*cached.table);
    if (bytes.size() > cache.max_bytes) return cached;
    try {
        makeFolder(cache.folder);
        writeFile(cached.file, bytes);
        evict(cache, cached.file);
    } catch (const Error& unwritten) {
        observer.log(LogLevel::warning, fmt::format("the white table is not kept: {}", unwritten.what()));
    }
    return cached;
}

}  // namespace searchlight
