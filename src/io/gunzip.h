// Files that end in .gz.
#pragma once

#include <string>
#include <string_view>

namespace searchlight {

/// The bytes inside a gzip file, of one member or several. An input Error for what is damaged, cut off, or unpacks to
/// more than 64 MiB and 100 times its own size, which no shape does.
std::string gunzip(std::string_view bytes, const std::string& path);

}  // namespace searchlight
