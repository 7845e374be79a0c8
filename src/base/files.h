// Files, read whole and written whole.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace searchlight {

/// The file's bytes. Throws an input Error when it is missing, a folder, unreadable, or larger than `max_bytes`.
std::string readFile(const std::filesystem::path& path, std::size_t max_bytes = std::size_t{1} << 28);

/// Writes aside and renames, so that a failure leaves the old file; a device or pipe is written directly. Throws an
/// input Error.
void writeFile(const std::filesystem::path& path, std::string_view bytes);

/// Throws what writeFile() would throw now, for work that ends long after; neither writes nor leaves anything.
void checkWritable(const std::filesystem::path& path);

/// Whether both paths lead to one file, or would once they are written.
bool sameFile(const std::filesystem::path& a, const std::filesystem::path& b);

/// Makes the folder and its parents. Throws an input Error.
void makeFolder(const std::filesystem::path& path);

}  // namespace searchlight
