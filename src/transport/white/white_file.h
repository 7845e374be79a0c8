// The file of a white table; docs/white-cache.md has the layout.
#pragma once

#include <string>
#include <string_view>

#include "transport/white/white.h"

namespace searchlight {

inline constexpr std::uint64_t kWhiteFileVersion = 1;

/// The bytes that parseWhiteTable reads back as the same table.
std::string whiteTableBytes(const WhiteTable& table);

/// Throws an input Error that names `path` for bytes that are no white table, are damaged, or come from another
/// version. Takes no more memory than a few times the size of the bytes.
WhiteTable parseWhiteTable(std::string_view bytes, std::string_view path);

/// The version that a file claims; 0: it is no white table.
std::uint64_t whiteFileVersion(std::string_view bytes);

}  // namespace searchlight
