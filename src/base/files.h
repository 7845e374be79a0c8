// Files, read whole and written whole.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace searchlight {

/// The file's bytes. Throws an input Error when it is missing, a folder, unreadable, or larger than `max_bytes`.
std::string readFile(const std::filesystem::path& path, std::size_t max_bytes = std::size_t{1} << 28);

/// Writes aside and renames, so that a failure leaves the old file. Throws an input Error.
void writeFile(const std::filesystem::path& path, std::string_view bytes);

/// Makes the folder and its parents. Throws an input Error.
void makeFolder(const std::filesystem::path& path);

}  // namespace searchlight
