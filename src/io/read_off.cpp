// OFF, with the prefixes ST, C and N of its first line.
#include <fmt/format.h>

#include "io/shape_formats.h"
#include "io/words.h"

namespace searchlight {

namespace {

// What comes after the position of a vertex; a colour is passed over.
struct VertexLine {
    bool uv = false, normal = false;
};

VertexLine parseHeader(Words& words) {
    const std::string_view whole = words.word("OFF");
    std::string_view word = whole;
    VertexLine line;
    const auto prefix = [&](std::string_view name) {
        if (!word.starts_with(name)) return false;
        word.remove_prefix(name.size());
        return true;
    };
    line.uv = prefix("ST");
    prefix("C");
    line.normal = prefix("N");
    if (word == "4OFF" || word == "nOFF" || word == "4nOFF")
        throw words.error("is an OFF file of another dimension",
                          "valid: OFF, COFF, NOFF, CNOFF, each also with ST before it");
    if (word != "OFF")
        throw words.error("is no OFF file", "the first word is OFF, COFF, NOFF or CNOFF, each also with ST before it");
    if (words.peek() == "BINARY") throw words.error("is a binary OFF file", "valid: text");
    return line;
}

}  // namespace

Shape parseOff(std::string_view bytes, const std::string& path) {
    Words words(bytes, path, '#');
    const VertexLine line = parseHeader(words);
    const std::size_t vertices = words.count("the number of vertices");
    const std::size_t faces = words.count("the number of faces");
    words.count("the number of edges");
    if (vertices == 0 || faces == 0) throw words.error("holds no vertices or no faces");
    // A vertex takes five characters and the end of its line, a face seven; the last may lack that end.
    const std::size_t left = words.bytesLeft() + 1;
    if (vertices > left / 6 || faces > left / 8)
        throw words.error(fmt::format("{} vertices and {} faces, but {} bytes are left", vertices, faces, left - 1),
                          "the file is cut off or damaged");

    Mesh mesh;
    mesh.positions.reserve(vertices);
    mesh.triangles.reserve(faces);
    const auto number = [&](std::string_view what) { return static_cast<float>(words.number(what)); };
    for (std::size_t i = 0; i < vertices; ++i) {
        mesh.positions.push_back({number("x"), number("y"), number("z")});
        if (!isFinite(mesh.positions.back())) throw words.error("a position is not finite");
        if (line.normal) mesh.normals.push_back({number("a normal"), number("a normal"), number("a normal")});
        // Texture coordinates are the last two; how many numbers a colour has before them is up to the file.
        std::array<float, 2> last{};
        for (std::string_view word; !(word = words.wordInLine()).empty();) {
            float value = 0;
            if (readReal(word.data(), word.data() + word.size(), value) == word.data() || !std::isfinite(value))
                throw words.error("a vertex has more on its line than numbers");
            last = {last[1], value};
        }
        if (line.uv) mesh.uvs.push_back({last[0], last[1]});
    }
    std::vector<std::uint32_t> corners;
    for (std::size_t i = 0; i < faces; ++i) {
        const std::size_t count = words.count("the number of corners");
        if (count < 3) throw words.error(fmt::format("a face has {} corners", count), "3 or more");
        if (count > words.bytesLeft())
            throw words.error(fmt::format("a face has {} corners, but {} bytes are left", count, words.bytesLeft()));
        corners.clear();
        for (std::size_t k = 0; k < count; ++k) {
            const std::size_t vertex = words.count("a vertex of a face");
            if (vertex >= vertices)
                throw words.error(fmt::format("a face uses vertex {}", vertex), fmt::format("0 to {}", vertices - 1));
            corners.push_back(static_cast<std::uint32_t>(vertex));
        }
        addPolygon(mesh.positions, corners, mesh.triangles);
        words.restOfLine();  // a colour
    }
    if (!words.peek().empty()) throw words.error("more data than the header states");
    finishNormals(mesh);
    return mesh;
}

}  // namespace searchlight
