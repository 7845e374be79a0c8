// White tables on disk, so that a medium is walked once.
#pragma once

#include <filesystem>
#include <memory>

#include "base/observer.h"
#include "transport/white/white.h"

namespace searchlight {

struct WhiteCache {
    std::filesystem::path folder;                        ///< made when needed
    std::uintmax_t max_bytes = std::uintmax_t{1} << 28;  ///< of all tables; those used longest ago go first
};

/// $XDG_CACHE_HOME/searchlight, or ~/.cache/searchlight. Throws an input Error when neither variable is set.
WhiteCache userWhiteCache();

struct CachedWhiteTable {
    std::shared_ptr<const WhiteTable> table;
    bool hit = false;            ///< read, not walked
    std::filesystem::path file;  ///< where it is kept; may not exist, if the folder cannot be written
};

/// Reads the table, or walks it and writes it. Safe beside other processes: files appear whole, by renaming. A damaged
/// file is replaced, one of a newer version left alone; both, and a folder that cannot be written, are logged as
/// warnings. Throws what buildWhiteTable throws.
CachedWhiteTable cachedWhiteTable(const WhiteKey& key, const WhiteCache& cache, int threads, Observer& observer);

}  // namespace searchlight
