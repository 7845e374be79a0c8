// PLY in its three encodings: a mesh when it has faces (or triangle strips), else a point cloud.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "base/text.h"
#include "io/byte_reader.h"
#include "io/shape_formats.h"
#include "io/words.h"

namespace searchlight {

namespace {

enum class Scalar { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

std::optional<Scalar> scalarNamed(std::string_view name) {
    static constexpr std::array<std::array<std::string_view, 2>, 8> names{{{"char", "int8"},
                                                                           {"uchar", "uint8"},
                                                                           {"short", "int16"},
                                                                           {"ushort", "uint16"},
                                                                           {"int", "int32"},
                                                                           {"uint", "uint32"},
                                                                           {"float", "float32"},
                                                                           {"double", "float64"}}};
    for (std::size_t i = 0; i < names.size(); ++i)
        if (name == names[i][0] || name == names[i][1]) return static_cast<Scalar>(i);
    return std::nullopt;
}

constexpr std::size_t sizeOf(Scalar type) {
    constexpr std::array<std::size_t, 8> sizes{1, 1, 2, 2, 4, 4, 4, 8};
    return sizes[static_cast<std::size_t>(type)];
}

bool isWhole(Scalar type) { return type < Scalar::float32; }

struct Property {
    std::string name;
    Scalar type = Scalar::float32;
    std::optional<Scalar> count_type;  ///< of a list
};

struct Element {
    std::string name;
    std::size_t count = 0;
    std::vector<Property> properties;

    // No row is smaller; text needs a digit and a blank for each property.
    std::size_t leastBytes(bool ascii) const {
        std::size_t bytes = 0;
        for (const Property& property : properties)
            bytes += ascii ? 2 : sizeOf(property.count_type.value_or(property.type));
        return bytes;
    }
};

struct Header {
    enum class Encoding { ascii, little, big } encoding = Encoding::ascii;
    std::vector<Element> elements;
    std::size_t bytes = 0;
};

class HeaderParser {
public:
    HeaderParser(std::string_view bytes, const std::string& path) : words_(bytes, path, 0), size_(bytes.size()) {}

    Header parse() {
        if (words_.wordInLine() != "ply") throw words_.error("is no PLY file", "the first line is: ply");
        endLine();
        words_.expect("format");
        const std::string_view encoding = words_.wordInLine();
        if (encoding == "binary_little_endian")
            header_.encoding = Header::Encoding::little;
        else if (encoding == "binary_big_endian")
            header_.encoding = Header::Encoding::big;
        else if (encoding != "ascii")
            throw words_.error(fmt::format("{} is no PLY encoding", quotedWord(encoding)),
                               "valid: ascii, binary_little_endian, binary_big_endian");
        if (const std::string_view version = words_.wordInLine(); version != "1.0")
            throw words_.error(fmt::format("PLY version {}", quotedWord(version)), "valid: 1.0");
        endLine();
        while (line()) {
        }
        header_.bytes = size_ - words_.bytesLeft();
        return std::move(header_);
    }

private:
    void endLine() {
        if (!trim(words_.restOfLine()).empty()) throw words_.error("words after the end of a header line");
    }

    // False after end_header.
    bool line() {
        const std::string_view keyword = words_.word("end_header");
        if (keyword == "comment" || keyword == "obj_info") {
            words_.restOfLine();
            return true;
        }
        if (keyword == "end_header") {
            endLine();
            return false;
        }
        if (keyword == "element") {
            Element element;
            element.name = words_.wordInLine();
            element.count = words_.count("the number of elements");
            header_.elements.push_back(std::move(element));
        } else if (keyword == "property") {
            property();
        } else {
            throw words_.error(fmt::format("unknown header line {}", quotedWord(keyword)),
                               "valid: comment, obj_info, element, property, end_header");
        }
        endLine();
        return true;
    }

    void property() {
        if (header_.elements.empty()) throw words_.error("a property before the first element");
        Property property;
        std::string_view type = words_.wordInLine();
        if (type == "list") {
            property.count_type = scalar(words_.wordInLine());
            if (!isWhole(*property.count_type)) throw words_.error("the count of a list has a whole type");
            type = words_.wordInLine();
        }
        property.type = scalar(type);
        property.name = words_.wordInLine();
        if (property.name.empty()) throw words_.error("a property without a name");
        header_.elements.back().properties.push_back(std::move(property));
    }

    Scalar scalar(std::string_view name) const {
        if (const std::optional<Scalar> type = scalarNamed(name)) return *type;
        throw words_.error(fmt::format("{} is no PLY type", quotedWord(name)),
                           "valid: char, uchar, short, ushort, int, uint, float, double, int8 to float64");
    }

    Words words_;
    std::size_t size_;
    Header header_;
};

// The scalars after the header, whatever their encoding.
class Scalars {
public:
    Scalars(std::string_view bytes, const std::string& path, const Header& header)
        : ascii_(header.encoding == Header::Encoding::ascii),
          words_(bytes, path, 0),
          reader_(bytes, path, header.encoding == Header::Encoding::big ? std::endian::big : std::endian::little) {
        if (ascii_)
            words_.skip(header.bytes);
        else
            reader_.take(header.bytes, 1, "header");
    }

    double next(Scalar type, std::string_view what) {
        if (ascii_) {
            const double value = words_.number(what);
            if (isWhole(type) && value != std::floor(value))
                throw words_.error(fmt::format("{} is not whole", value), fmt::format("expected {}", what));
            return value;
        }
        at_ = reader_.at();
        switch (type) {
            case Scalar::int8: return reader_.value<std::int8_t>(what);
            case Scalar::uint8: return reader_.value<std::uint8_t>(what);
            case Scalar::int16: return reader_.value<std::int16_t>(what);
            case Scalar::uint16: return reader_.value<std::uint16_t>(what);
            case Scalar::int32: return reader_.value<std::int32_t>(what);
            case Scalar::uint32: return reader_.value<std::uint32_t>(what);
            case Scalar::float32: return reader_.value<float>(what);
            case Scalar::float64: return reader_.value<double>(what);
        }
        return 0;
    }

    /// The count of a list whose items are then known to fit into the file.
    std::size_t listCount(const Property& property) {
        const double count = next(*property.count_type, property.name);
        if (!(count >= 0)) throw error(fmt::format("a list of {} items", count), "0 or more");
        const std::size_t least = ascii_ ? 2 : sizeOf(property.type);
        if (count > static_cast<double>(room()) / static_cast<double>(least))
            throw error(fmt::format("a list of {} items, but {} bytes are left", count, bytesLeft()));
        return static_cast<std::size_t>(count);
    }

    /// At the scalar that was read last.
    Error error(std::string message, std::string hint = {}) const {
        return ascii_ ? words_.error(std::move(message), std::move(hint))
                      : reader_.error(at_, message, std::move(hint));
    }

    /// Rows are counted before memory is taken for them.
    void expectRows(const Element& element) {
        const std::size_t least = element.leastBytes(ascii_);
        if (least == 0 || element.count <= room() / least) return;
        at_ = reader_.at();
        throw error(
            fmt::format("{} rows of {}, but {} bytes are left", element.count, quotedWord(element.name), bytesLeft()),
            "the file is cut off or damaged");
    }

    void expectEnd() {
        at_ = reader_.at();
        if (ascii_ ? !words_.peek().empty() : !trim(reader_.rest()).empty())
            throw error("more data than the header states");
    }

private:
    // The last line of a text may lack its end.
    std::size_t room() const { return bytesLeft() + (ascii_ ? 1 : 0); }
    std::size_t bytesLeft() const { return ascii_ ? words_.bytesLeft() : reader_.left(); }

    bool ascii_;
    Words words_;
    ByteReader reader_;
    std::size_t at_ = 0;
};

// What the properties of a vertex become. A file may call its texture coordinates one of four ways.
enum Slot { kX, kY, kZ, kNormalX, kNormalY, kNormalZ, kU, kV, kSize, kNowhere };

Slot slotOf(std::string_view name) {
    static constexpr std::pair<std::string_view, Slot> slots[] = {
        {"x", kX}, {"y", kY}, {"z", kZ}, {"nx", kNormalX},  {"ny", kNormalY},  {"nz", kNormalZ},  {"u", kU},
        {"v", kV}, {"s", kU}, {"t", kV}, {"texture_u", kU}, {"texture_v", kV}, {"texture_s", kU}, {"texture_t", kV}};
    for (const auto& [slot_name, slot] : slots)
        if (name == slot_name) return slot;
    return kNowhere;
}

class PlyBody {
public:
    PlyBody(std::string_view bytes, const std::string& path, const Header& header)
        : path_(path), header_(header), scalars_(bytes, path, header) {}

    Shape parse() {
        for (const Element& element : header_.elements) {
            scalars_.expectRows(element);
            if (element.name == "vertex")
                vertices(element);
            else if (element.name == "face" || element.name == "tristrips")
                faces(element);
            else
                skip(element);
        }
        scalars_.expectEnd();
        if (cloud_.positions.empty()) throw inputError("holds no vertices", "element vertex with x, y and z").at(path_);
        if (mesh_.triangles.empty()) {
            finishCloud(cloud_);
            return std::move(cloud_);
        }
        mesh_.positions = std::move(cloud_.positions);
        mesh_.normals = std::move(cloud_.normals);
        finishNormals(mesh_);
        return std::move(mesh_);
    }

private:
    void skipProperty(const Property& property) {
        const std::size_t count = property.count_type ? scalars_.listCount(property) : 1;
        for (std::size_t i = 0; i < count; ++i) scalars_.next(property.type, property.name);
    }

    void skip(const Element& element) {
        if (element.properties.empty()) return;
        for (std::size_t i = 0; i < element.count; ++i)
            for (const Property& property : element.properties) skipProperty(property);
    }

    void vertices(const Element& element) {
        if (!cloud_.positions.empty()) throw inputError("has two elements 'vertex'").at(path_);
        std::vector<Slot> slots;
        std::array<bool, kNowhere + 1> has{};
        std::optional<AreaRule> rule;
        for (const Property& property : element.properties) {
            slots.push_back(property.count_type ? kNowhere : slotOf(property.name));
            const std::optional<AreaRule> found = areaRule(property.name);
            if (found && !property.count_type && (!rule || *found < *rule)) {
                rule = found;
                std::ranges::replace(slots, kSize, kNowhere);
                slots.back() = kSize;
            }
            has[slots.back()] = true;
        }
        if (!has[kX] || !has[kY] || !has[kZ]) throw inputError("vertices without x, y and z").at(path_);
        const bool normals = has[kNormalX] && has[kNormalY] && has[kNormalZ], uvs = has[kU] && has[kV];
        cloud_.positions.reserve(element.count);
        if (normals) cloud_.normals.reserve(element.count);
        if (uvs) mesh_.uvs.reserve(element.count);
        if (rule) cloud_.areas.reserve(element.count);
        std::array<float, kNowhere + 1> values{};
        for (std::size_t i = 0; i < element.count; ++i) {
            for (std::size_t k = 0; k < slots.size(); ++k) {
                const Property& property = element.properties[k];
                if (property.count_type)
                    skipProperty(property);
                else
                    values[slots[k]] = static_cast<float>(scalars_.next(property.type, property.name));
            }
            cloud_.positions.push_back({values[kX], values[kY], values[kZ]});
            if (!isFinite(cloud_.positions.back())) throw scalars_.error("a position is not finite");
            if (normals) cloud_.normals.push_back({values[kNormalX], values[kNormalY], values[kNormalZ]});
            if (uvs) mesh_.uvs.push_back({values[kU], values[kV]});
            if (uvs && !(std::isfinite(values[kU]) && std::isfinite(values[kV])))
                throw scalars_.error("a texture coordinate is not finite");
            if (!rule) continue;
            const std::optional<float> area = areaOf(*rule, values[kSize]);
            if (!area) throw scalars_.error("an area or radius is negative or not finite");
            cloud_.areas.push_back(*area);
        }
    }

    void faces(const Element& element) {
        if (element.count == 0) return;
        if (cloud_.positions.empty())
            throw inputError(fmt::format("the element '{}' stands before the vertices", element.name)).at(path_);
        const auto isIndices = [](const Property& property) {
            return property.name == "vertex_indices" || property.name == "vertex_index";
        };
        const auto indices = std::ranges::find_if(element.properties, isIndices);
        if (indices == element.properties.end() || !indices->count_type || !isWhole(indices->type))
            throw inputError(fmt::format("the element '{}' has no list of vertices", element.name),
                             "property list uchar int vertex_indices")
                .at(path_);
        const bool strips = element.name == "tristrips";
        if (!strips) mesh_.triangles.reserve(mesh_.triangles.size() + element.count);
        for (std::size_t i = 0; i < element.count; ++i)
            for (const Property& property : element.properties) {
                if (&property != &*indices)
                    skipProperty(property);
                else if (strips)
                    strip(property);
                else
                    polygon(property);
            }
    }

    std::uint32_t vertex(double index) const {
        const std::size_t count = cloud_.positions.size();
        if (!(index >= 0 && index < static_cast<double>(count)))
            throw scalars_.error(fmt::format("a face uses vertex {}", index), fmt::format("0 to {}", count - 1));
        return static_cast<std::uint32_t>(index);
    }

    void polygon(const Property& property) {
        const std::size_t count = scalars_.listCount(property);
        if (count < 3) throw scalars_.error(fmt::format("a face has {} corners", count), "3 or more");
        corners_.clear();
        for (std::size_t i = 0; i < count; ++i) corners_.push_back(vertex(scalars_.next(property.type, property.name)));
        addPolygon(cloud_.positions, corners_, mesh_.triangles);
    }

    // Strips in one list end at -1; every other triangle of a strip is the other way round.
    void strip(const Property& property) {
        const std::size_t count = scalars_.listCount(property);
        corners_.clear();
        for (std::size_t i = 0; i < count; ++i) {
            const double index = scalars_.next(property.type, property.name);
            if (index == -1) {
                corners_.clear();
                continue;
            }
            corners_.push_back(vertex(index));
            const std::size_t n = corners_.size();
            if (n < 3) continue;
            const std::size_t odd = n % 2 == 0 ? 1 : 0;
            mesh_.triangles.push_back({corners_[n - 3 + odd], corners_[n - 2 - odd], corners_[n - 1]});
        }
    }

    const std::string& path_;
    const Header& header_;
    Scalars scalars_;
    PointCloud cloud_;  // the vertices, until it is known whether there are faces
    Mesh mesh_;
    std::vector<std::uint32_t> corners_;
};

}  // namespace

Shape parsePly(std::string_view bytes, const std::string& path) {
    const Header header = HeaderParser(bytes, path).parse();
    return PlyBody(bytes, path, header).parse();
}

}  // namespace searchlight
