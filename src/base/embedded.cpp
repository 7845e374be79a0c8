#include "base/embedded.h"

namespace searchlight {

std::optional<std::string_view> embeddedText(std::string_view path) {
    for (const EmbeddedFile& file : embeddedFiles())
        if (file.path == path) return file.text;
    return std::nullopt;
}

}  // namespace searchlight
