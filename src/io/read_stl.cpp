// STL, text and binary. Its triangles share no vertices: equal positions become one.
#include <fmt/format.h>

#include <unordered_map>

#include "io/byte_reader.h"
#include "io/shape_formats.h"
#include "io/words.h"

namespace searchlight {

namespace {

struct PositionHash {
    std::size_t operator()(Vec3f p) const {
        std::uint64_t hash = 0;
        for (const float part : {p.x, p.y, p.z}) {
            hash = (hash ^ std::bit_cast<std::uint32_t>(part)) * 0x9E3779B97F4A7C15u;
            hash ^= hash >> 29;
        }
        return static_cast<std::size_t>(hash);
    }
};

class Welder {
public:
    explicit Welder(std::size_t triangles) {
        mesh_.triangles.reserve(triangles);
        // A closed mesh has half as many vertices as triangles.
        vertices_.reserve(triangles / 2);
    }

    void add(const std::array<Vec3f, 3>& corners) {
        std::array<std::uint32_t, 3> triangle;
        for (std::size_t i = 0; i < 3; ++i) {
            // -0 and 0 are one position.
            const Vec3f p{corners[i].x + 0.0f, corners[i].y + 0.0f, corners[i].z + 0.0f};
            const auto [found, is_new] = vertices_.try_emplace(p, static_cast<std::uint32_t>(mesh_.positions.size()));
            if (is_new) mesh_.positions.push_back(p);
            triangle[i] = found->second;
        }
        mesh_.triangles.push_back(triangle);
    }

    Mesh take() { return std::move(mesh_); }

private:
    Mesh mesh_;
    std::unordered_map<Vec3f, std::uint32_t, PositionHash> vertices_;
};

constexpr std::size_t kHeader = 84, kTriangle = 50;

Mesh parseBinary(std::string_view bytes, const std::string& path) {
    ByteReader reader(bytes, path, std::endian::little);
    reader.take(kHeader - 4, 1, "bytes of the header");
    const std::size_t count = reader.value<std::uint32_t>("the number of triangles");
    if (count == 0) throw reader.error(kHeader - 4, "holds no triangles");
    const std::size_t from = reader.at();
    const char* rows = reader.take(count, kTriangle, "triangles").data();
    if (reader.left() > 0) throw reader.error(reader.at(), "more data than the header states");
    Welder welder(count);
    for (std::size_t i = 0; i < count; ++i) {
        // The facet's normal is passed over: the corners say it.
        const auto corner = [&](std::size_t k) {
            const char* at = rows + i * kTriangle + 12 * (k + 1);
            const auto number = [&](std::size_t byte) { return loadValue<float>(at + byte, std::endian::little); };
            return Vec3f{number(0), number(4), number(8)};
        };
        const std::array<Vec3f, 3> corners{corner(0), corner(1), corner(2)};
        if (!isFinite(corners[0]) || !isFinite(corners[1]) || !isFinite(corners[2]))
            throw reader.error(from + i * kTriangle, "a position is not finite");
        welder.add(corners);
    }
    return welder.take();
}

Mesh parseText(std::string_view bytes, const std::string& path) {
    Words words(bytes, path, 0);
    // A facet has about 200 characters.
    Welder welder(bytes.size() / 200);
    const auto vector = [&](std::string_view what) {
        const double x = words.number(what), y = words.number(what), z = words.number(what);
        return Vec3f{static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
    };
    while (!words.peek().empty()) {
        words.expect("solid");
        words.restOfLine();
        while (true) {
            const std::string_view word = words.word("'facet' or 'endsolid'");
            if (word == "endsolid") break;
            if (word != "facet") throw words.error(quotedWord(word), "expected 'facet' or 'endsolid'");
            words.expect("normal");
            vector("a normal");
            words.expect("outer");
            words.expect("loop");
            std::array<Vec3f, 3> corners;
            for (Vec3f& corner : corners) {
                words.expect("vertex");
                corner = vector("a position");
                if (!isFinite(corner)) throw words.error("a position is not finite");
            }
            words.expect("endloop");
            words.expect("endfacet");
            welder.add(corners);
        }
        words.restOfLine();
    }
    Mesh mesh = welder.take();
    if (mesh.triangles.empty()) throw inputError("holds no triangles").at(path);
    return mesh;
}

}  // namespace

Shape parseStl(std::string_view bytes, const std::string& path) {
    // Binary files may begin with "solid" too; zeros and their size tell.
    bool binary = !bytes.starts_with("solid") || bytes.substr(0, 512).find('\0') != std::string_view::npos;
    if (bytes.size() >= kHeader) {
        const auto count = loadValue<std::uint32_t>(bytes.data() + kHeader - 4, std::endian::little);
        binary |= bytes.size() == kHeader + kTriangle * std::size_t{count};
    }
    return binary ? parseBinary(bytes, path) : parseText(bytes, path);
}

}  // namespace searchlight
