// GEO, the points of Houdini's older text format. Its primitives are passed over.
#include <fmt/format.h>

#include "io/cloud_builder.h"
#include "io/words.h"

namespace searchlight {

namespace {

// A text in quotes may hold blanks.
void skipText(Words& words) {
    std::string_view word = words.word("a text of an index attribute");
    if (!word.starts_with('"')) return;
    if (word.size() == 1) word = words.word("the closing quote");
    while (!word.ends_with('"')) word = words.word("the closing quote");
}

CloudAttribute parseAttribute(Words& words) {
    CloudAttribute attribute;
    attribute.name = words.word("the name of a point attribute");
    attribute.size = words.count("the size of a point attribute");
    const std::string_view type = words.word("the type of a point attribute");
    if (type == "index") {
        const std::size_t texts = words.count("the number of texts");
        for (std::size_t i = 0; i < texts; ++i) skipText(words);
    } else if (type == "float" || type == "int" || type == "vector") {
        for (std::size_t i = 0; i < attribute.size; ++i) words.number("a default value");
    } else {
        throw words.error(fmt::format("{} is no type of a point attribute", quotedWord(type)),
                          "valid: float, int, vector, index");
    }
    return attribute;
}

}  // namespace

Shape parseGeo(std::string_view bytes, const std::string& path) {
    Words words(bytes, path, 0, "()");
    words.expect("PGEOMETRY");
    words.expect("V5");
    std::size_t points = 0, attributes_stated = 0;
    for (const std::string_view key : {"NPoints", "NPrims", "NPointGroups", "NPrimGroups", "NPointAttrib",
                                       "NVertexAttrib", "NPrimAttrib", "NAttrib"}) {
        words.expect(key);
        const std::size_t count = words.count("a count");
        if (key == "NPoints") points = count;
        if (key == "NPoints" && count == 0) throw words.error("holds no points");
        if (key == "NPointAttrib") attributes_stated = count;
    }
    // Every row begins with x, y, z and a weight, which is 1 for all but splines.
    std::vector<CloudAttribute> attributes{{"P", 3}, {"Pw", 1}};
    std::size_t row_size = 4;
    if (attributes_stated > 0) words.expect("PointAttrib");
    for (std::size_t i = 0; i < attributes_stated; ++i) {
        attributes.push_back(parseAttribute(words));
        if (attributes.back().size > words.bytesLeft()) throw words.error("a point attribute is larger than the file");
        row_size += attributes.back().size;
    }
    // The last number may lack the blank behind it.
    if (row_size > words.bytesLeft() || points > (words.bytesLeft() + 1) / (2 * row_size))
        throw words.error(fmt::format("{} points, but {} bytes are left", points, words.bytesLeft()),
                          "the file is cut off or damaged");

    CloudBuilder cloud(attributes);
    std::vector<float> row(row_size);
    for (std::size_t i = 0; i < points; ++i) {
        for (std::size_t k = 0; k < row_size; ++k) {
            if (k == 4) words.expect("(");
            row[k] = static_cast<float>(words.number("a number of a point"));
        }
        if (row_size > 4) words.expect(")");
        const auto complaint = cloud.add([&](std::size_t a, std::size_t k) {
            for (std::size_t before = 0; before < a; ++before) k += attributes[before].size;
            return row[k];
        });
        if (complaint) throw words.error(std::string(*complaint));
    }
    return cloud.finish();
}

}  // namespace searchlight
