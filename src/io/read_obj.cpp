// Wavefront OBJ: v, vt, vn and f. Everything else (groups, materials, lines, free-form surfaces) is passed over.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <unordered_map>

#include "io/shape_formats.h"
#include "io/words.h"

namespace searchlight {

namespace {

constexpr std::uint32_t kNone = 0xFFFFFFFF;

struct Corner {
    std::uint32_t position = kNone, uv = kNone, normal = kNone;
    bool operator==(const Corner&) const = default;
};

struct CornerHash {
    std::size_t operator()(const Corner& corner) const {
        std::uint64_t hash = corner.position;
        for (const std::uint32_t part : {corner.uv, corner.normal}) {
            hash = (hash ^ part) * 0x9E3779B97F4A7C15u;
            hash ^= hash >> 29;
        }
        return static_cast<std::size_t>(hash);
    }
};

class ObjParser {
public:
    ObjParser(std::string_view text, const std::string& path)
        : text_(text), path_(path), at_(text.data()), end_(text.data() + text.size()) {}

    Shape parse() {
        while (at_ != end_) {
            line();
            at_ = std::find(at_, end_, '\n');
            if (at_ != end_) ++at_;
        }
        if (mesh_.positions.empty()) throw inputError("holds no vertices", "lines such as: v 0 1 0").at(path_);
        for (const auto& [largest, byte, what, have] : {std::tuple{largest_[0], largest_at_[0], "v", positionCount()},
                                                        std::tuple{largest_[1], largest_at_[1], "vt", uvs_.size()},
                                                        std::tuple{largest_[2], largest_at_[2], "vn", normals_.size()}})
            if (largest > have)
                throw errorAt(byte, fmt::format("a face uses {} {}", what, largest),
                              fmt::format("the file has {}", have));
        if (corners_.empty()) return cloud();
        return mesh();
    }

private:
    std::size_t positionCount() const { return mesh_.positions.size(); }

    Error errorAt(const char* place, std::string message, std::string hint = {}) const {
        return Words(text_, path_, 0)
            .errorAt(static_cast<std::size_t>(place - text_.data()), std::move(message), std::move(hint));
    }

    // Blanks, and the ends of lines that a backslash continues.
    void skipBlanks() {
        for (; at_ != end_; ++at_) {
            if (*at_ == ' ' || *at_ == '\t' || *at_ == '\r') continue;
            if (*at_ != '\\') return;
            const char* next = at_ + 1;
            if (next != end_ && *next == '\r') ++next;
            if (next == end_ || *next != '\n') return;
            at_ = next;
        }
    }

    bool atLineEnd() {
        skipBlanks();
        return at_ == end_ || *at_ == '\n' || *at_ == '#';
    }

    bool atWordEnd() const {
        return at_ == end_ || *at_ == ' ' || *at_ == '\t' || *at_ == '\r' || *at_ == '\n' || *at_ == '#' ||
               *at_ == '\\';
    }

    std::string_view word() const {
        const char* last = at_;
        while (last != end_ && static_cast<unsigned char>(*last) > ' ') ++last;
        return {at_, static_cast<std::size_t>(last - at_)};
    }

    bool keyword(std::string_view name) {
        const std::string_view rest(at_, static_cast<std::size_t>(end_ - at_));
        if (!rest.starts_with(name)) return false;
        const char* after = at_ + name.size();
        if (after != end_ && static_cast<unsigned char>(*after) > ' ' && *after != '\\') return false;
        at_ = after;
        return true;
    }

    void line() {
        if (atLineEnd()) return;
        if (*at_ == 'v') {
            if (keyword("v"))
                position();
            else if (keyword("vn"))
                normals_.push_back({number("vn x y z"), number("vn x y z"), number("vn x y z")});
            else if (keyword("vt"))
                uv();
        } else if (keyword("f")) {
            face();
        }
        // The rest of a line is passed over; a continued one is longer.
        while (!atLineEnd()) ++at_;
    }

    float number(std::string_view expected) {
        if (atLineEnd()) throw errorAt(at_, "the line ends too early", fmt::format("expected {}", expected));
        float value = 0;
        const char* last = readReal(at_, end_, value);
        const bool found = last != at_;
        const char* from = at_;
        at_ = last;
        if (!found || !atWordEnd()) {
            at_ = from;
            throw errorAt(at_, fmt::format("{} is no number", quotedWord(word())),
                          fmt::format("expected {}", expected));
        }
        return value;
    }

    void position() {
        const char* from = at_;
        const Vec3f p{number("v x y z"), number("v x y z"), number("v x y z")};
        if (!isFinite(p)) throw errorAt(from, "a position is not finite");
        mesh_.positions.push_back(p);
    }

    void uv() {
        const char* from = at_;
        Vec2f uv{number("vt u v"), 0};
        if (!atLineEnd()) uv.y = number("vt u v");
        if (!std::isfinite(uv.x) || !std::isfinite(uv.y)) throw errorAt(from, "a texture coordinate is not finite");
        uvs_.push_back(uv);
    }

    // The corner that begins at `from`.
    Error cornerError(const char* from) {
        at_ = from;
        return errorAt(from, fmt::format("{} is no corner of a face", quotedWord(word())),
                       "expected corners such as 1, 1/1, 1//1 or 1/1/1");
    }

    // One index of the corner that begins at `from`: counted from 1, or from -1 backwards. Those beyond what the file
    // has had so far are judged at its end.
    std::uint32_t index(std::size_t kind, std::size_t so_far, const char* from) {
        std::int64_t value = 0;
        const auto [last, status] = std::from_chars(at_, end_, value);
        if (status != std::errc{} || value == 0 || value > std::int64_t{kMostShapeBytes}) throw cornerError(from);
        const bool backwards = value < 0;
        // -(value + 1) does not overflow.
        const std::size_t back = backwards ? static_cast<std::size_t>(-(value + 1)) : 0;
        if (backwards && back >= so_far)
            throw errorAt(at_, fmt::format("a face uses {} {}", kNames[kind], value),
                          fmt::format("there are {} before this line", so_far));
        const std::size_t one_based = backwards ? so_far - back : static_cast<std::size_t>(value);
        if (one_based > so_far && one_based > largest_[kind]) {
            largest_[kind] = one_based;
            largest_at_[kind] = at_;
        }
        at_ = last;
        return static_cast<std::uint32_t>(one_based - 1);
    }

    void face() {
        const char* from = at_;
        const std::size_t first = corners_.size();
        while (!atLineEnd()) {
            const char* corner_at = at_;
            Corner corner;
            corner.position = index(0, positionCount(), corner_at);
            if (at_ != end_ && *at_ == '/') {
                ++at_;
                if (at_ == end_ || *at_ != '/') corner.uv = index(1, uvs_.size(), corner_at);
                if (at_ != end_ && *at_ == '/') {
                    ++at_;
                    corner.normal = index(2, normals_.size(), corner_at);
                }
            }
            if (!atWordEnd()) throw cornerError(corner_at);
            corners_.push_back(corner);
        }
        if (corners_.size() - first < 3)
            throw errorAt(from, fmt::format("a face has {} corners", corners_.size() - first), "3 or more");
        face_sizes_.push_back(static_cast<std::uint32_t>(corners_.size() - first));
    }

    Shape cloud() {
        PointCloud cloud;
        cloud.positions = std::move(mesh_.positions);
        if (normals_.size() == cloud.positions.size()) cloud.normals = std::move(normals_);
        finishCloud(cloud);
        return cloud;
    }

    Shape mesh() {
        // Positions keep their order and numbers: the first pair of uv and normal that a position is used with is its
        // own, each further pair is a new vertex at the end.
        std::vector<Corner> vertices(positionCount());
        std::unordered_map<Corner, std::uint32_t, CornerHash> further;
        const auto vertexOf = [&](const Corner& corner) {
            Corner& first = vertices[corner.position];
            if (first.position == kNone) first = corner;
            if (first == corner) return corner.position;
            const auto [found, is_new] = further.try_emplace(corner, static_cast<std::uint32_t>(vertices.size()));
            if (is_new) {
                vertices.push_back(corner);
                const Vec3f position = mesh_.positions[corner.position];
                mesh_.positions.push_back(position);
            }
            return found->second;
        };
        mesh_.triangles.reserve(corners_.size() - 2 * face_sizes_.size());
        std::vector<std::uint32_t> polygon;
        auto corner = corners_.begin();
        for (const std::uint32_t size : face_sizes_) {
            polygon.clear();
            for (std::uint32_t i = 0; i < size; ++i) polygon.push_back(vertexOf(*corner++));
            addPolygon(mesh_.positions, polygon, mesh_.triangles);
        }
        const auto gather = [&](const auto& values, std::uint32_t Corner::*part, auto& list) {
            if (std::ranges::all_of(vertices, [&](const Corner& vertex) { return vertex.*part == kNone; })) return;
            list.resize(vertices.size());
            for (std::size_t i = 0; i < vertices.size(); ++i)
                if (vertices[i].*part != kNone) list[i] = values[vertices[i].*part];
        };
        gather(uvs_, &Corner::uv, mesh_.uvs);
        gather(normals_, &Corner::normal, mesh_.normals);
        finishNormals(mesh_);
        return std::move(mesh_);
    }

    static constexpr std::array<const char*, 3> kNames{"v", "vt", "vn"};

    std::string_view text_;
    const std::string& path_;
    const char *at_, *end_;
    Mesh mesh_;
    std::vector<Vec2f> uvs_;
    std::vector<Vec3f> normals_;
    std::vector<Corner> corners_;
    std::vector<std::uint32_t> face_sizes_;
    std::array<std::size_t, 3> largest_{};
    std::array<const char*, 3> largest_at_{};
};

}  // namespace

Shape parseObj(std::string_view bytes, const std::string& path) { return ObjParser(bytes, path).parse(); }

}  // namespace searchlight
