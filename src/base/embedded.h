// What ships inside the executable: models, physics, material tables. Nothing is looked for by working directory.
#pragma once

#include <optional>
#include <span>
#include <string_view>

namespace searchlight {

struct EmbeddedFile {
    std::string_view path;  ///< below the repository root, such as "models/dipole.bssrdf"
    std::string_view text;
};

/// Every embedded file, in path order within a folder.
std::span<const EmbeddedFile> embeddedFiles();

/// The text of one embedded file; nothing when there is none of that path.
std::optional<std::string_view> embeddedText(std::string_view path);

}  // namespace searchlight
