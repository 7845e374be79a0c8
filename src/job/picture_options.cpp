#include "job/picture_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "base/error.h"
#include "base/text.h"
#include "io/image_file.h"

namespace searchlight {

PictureSize parsePictureSize(std::string_view text) {
    const std::vector<std::string_view> parts = split(text, 'x');
    const auto side = [&](std::size_t i) {
        const std::optional<double> number = parts.size() == 2 ? parseNumber(parts[i]) : std::nullopt;
        if (!number || *number != std::floor(*number) || *number < 1 || *number > 16384)
            throw usageError(fmt::format("'{}' is no value for size", text),
                             "expected WIDTHxHEIGHT, each a whole number from 1 to 16384");
        return static_cast<int>(*number);
    };
    return {side(0), side(1)};
}

void checkPictureEnding(const std::string& output) {
    if (output.empty()) return;
    const std::vector<std::string> endings = imageEndings();
    if (std::ranges::none_of(endings, [&](const std::string& ending) { return output.ends_with(ending); }))
        throw usageError(fmt::format("'{}' is no picture that can be written", output),
                         "valid endings: " + join(endings, ", "));
}

}  // namespace searchlight
