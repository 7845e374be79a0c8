#include "transport/white/white_cache.h"

#include <fmt/format.h>

#include <bit>
#include <system_error>

#include "base/cache_folder.h"
#include "base/error.h"
#include "base/files.h"
#include "base/random.h"
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

}  // namespace

WhiteCache userWhiteCache() {
    WhiteCache cache;
    cache.folder = userCacheFolder("white tables");
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
                touchFile(cached.file);
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
        makeRoom({cache.folder, std::string(kEnding), cache.max_bytes}, cached.file);
    } catch (const Error& unwritten) {
        observer.log(LogLevel::warning, fmt::format("the white table is not kept: {}", unwritten.what()));
    }
    return cached;
}

}  // namespace searchlight
