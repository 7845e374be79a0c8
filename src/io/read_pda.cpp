// PDA, Maya's particles as text.
#include <fmt/format.h>

#include "io/cloud_builder.h"
#include "io/words.h"

namespace searchlight {

Shape parsePda(std::string_view bytes, const std::string& path) {
    Words words(bytes, path, 0);
    words.expect("ATTRIBUTES");
    std::vector<CloudAttribute> attributes;
    while (true) {
        const std::string_view word = words.word("TYPES");
        if (word == "TYPES") break;
        attributes.push_back({std::string(word)});
    }
    std::size_t row_size = 0;
    for (CloudAttribute& attribute : attributes) {
        const std::string_view type = words.word("a type for each attribute");
        if (type != "V" && type != "R" && type != "I")
            throw words.error(fmt::format("{} is no type of {}", quotedWord(type), quotedWord(attribute.name)),
                              "valid: V (vector), R (real), I (integer)");
        attribute.size = type == "V" ? 3 : 1;
        row_size += attribute.size;
    }
    words.expect("NUMBER_OF_PARTICLES:");
    const std::size_t count = words.count("the number of particles");
    if (count == 0) throw words.error("holds no particles");
    CloudBuilder cloud(attributes);
    if (!cloud.hasPositions()) throw words.error("no attribute 'position' of type V");
    words.expect("BEGIN");
    words.expect("DATA");
    // The last number may lack the blank behind it.
    if (count > (words.bytesLeft() + 1) / (2 * row_size))
        throw words.error(fmt::format("{} particles, but {} bytes are left", count, words.bytesLeft()),
                          "the file is cut off or damaged");

    std::vector<float> row(row_size);
    for (std::size_t i = 0; i < count; ++i) {
        for (float& number : row) number = static_cast<float>(words.number("a number of a particle"));
        const auto complaint = cloud.add([&](std::size_t a, std::size_t k) {
            for (std::size_t before = 0; before < a; ++before) k += attributes[before].size;
            return row[k];
        });
        if (complaint) throw words.error(std::string(*complaint));
    }
    if (!words.peek().empty()) throw words.error("more data than the header states");
    return cloud.finish();
}

}  // namespace searchlight
