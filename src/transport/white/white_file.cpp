#include "transport/white/white_file.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <type_traits>

#include "base/error.h"

namespace searchlight {

namespace {

static_assert(std::endian::native == std::endian::little, "the file is little-endian, and written as memory is");

constexpr std::string_view kMagic = "SLWHITE\n";

// FNV-1a over 64-bit words instead of bytes: every step is a bijection, so a change of one word always shows.
std::uint64_t checksum(std::string_view bytes) {
    std::uint64_t hash = 0xCBF29CE484222325u;
    for (std::size_t at = 0; at + 8 <= bytes.size(); at += 8) {
        std::uint64_t word;
        std::memcpy(&word, bytes.data() + at, 8);
        hash = (hash ^ word) * 0x100000001B3u;
    }
    return hash;
}

class Writer {
public:
    template <class T>
    void value(T value) {
        static_assert(sizeof(T) == 8);
        bytes_.append(reinterpret_cast<const char*>(&value), 8);
    }
    template <class T>
    void list(const std::vector<T>& values) {
        static_assert(std::is_trivially_copyable_v<T>);
        bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
        bytes_.resize((bytes_.size() + 7) / 8 * 8);
    }
    std::string finish() {
        value(checksum(bytes_));
        return std::move(bytes_);
    }

private:
    std::string bytes_{kMagic};
};

class Reader {
public:
    Reader(std::string_view bytes, std::string_view path) : bytes_(bytes), path_(path), at_(kMagic.size()) {}

    template <class T>
    T value() {
        static_assert(sizeof(T) == 8);
        T value;
        std::memcpy(&value, take(1, 8), 8);
        return value;
    }
    template <class T>
    std::vector<T> list(std::size_t count) {
        const char* from = take(count, sizeof(T));
        std::vector<T> values(count);
        if (count > 0) std::memcpy(values.data(), from, count * sizeof(T));
        return values;
    }
    bool atEnd() const { return at_ == bytes_.size(); }
    [[noreturn]] void fail(std::string what) const { throw inputError(std::move(what), "it can be deleted").at(path_); }

private:
    // Bytes are counted before memory is taken.
    const char* take(std::size_t count, std::size_t size) {
        const std::size_t left = bytes_.size() - at_;
        if (count > left / size) fail("the white table ends too early");
        const char* from = bytes_.data() + at_;
        at_ += std::min(left, (count * size + 7) / 8 * 8);
        return from;
    }

    std::string_view bytes_, path_;
    std::size_t at_;
};

template <class Table, class Visit>
void forEachHistogram(Table& table, Visit visit) {
    for (auto* tier : {&table.fine, &table.pilot})
        for (const WhiteView view : {WhiteView::path, WhiteView::collisions})
            for (auto& histogram : tier->exits[static_cast<std::size_t>(view)]) visit(tier->axes, view, histogram);
}

}  // namespace

std::string whiteTableBytes(const WhiteTable& table) {
    Writer writer;
    writer.value(kWhiteFileVersion);
    writer.value(table.key.g);
    writer.value(table.key.eta);
    writer.value(table.key.angle_deg);
    writer.value(table.key.walks);
    writer.value(table.key.seed);
    writer.value(table.collisions);
    writer.value(table.build_seconds);
    forEachHistogram(table, [&](const WhiteAxes&, WhiteView, const WhiteHistogram& histogram) {
        writer.value(static_cast<std::uint64_t>(histogram.moments[0].size()));
        writer.list(histogram.rows);
        for (const std::vector<float>& moment : histogram.moments) writer.list(moment);
    });
    for (const std::vector<WhiteShift>& columns : table.shift) writer.list(columns);
    return writer.finish();
}

std::uint64_t whiteFileVersion(std::string_view bytes) {
    if (!bytes.starts_with(kMagic) || bytes.size() < kMagic.size() + 8) return 0;
    std::uint64_t version;
    std::memcpy(&version, bytes.data() + kMagic.size(), 8);
    return version;
}

WhiteTable parseWhiteTable(std::string_view bytes, std::string_view path) {
    Reader whole(bytes, path);
    const std::uint64_t version = whiteFileVersion(bytes);
    if (version == 0) whole.fail("is no white table");
    if (version != kWhiteFileVersion) whole.fail("is a white table of another version");
    if (bytes.size() % 8 != 0 || bytes.size() < kMagic.size() + 72) whole.fail("the white table ends too early");
    const std::string_view body = bytes.substr(0, bytes.size() - 8);
    std::uint64_t stated;
    std::memcpy(&stated, bytes.data() + body.size(), 8);
    if (checksum(body) != stated) whole.fail("the white table is damaged");

    Reader reader(body, path);
    reader.value<std::uint64_t>();  // the version
    WhiteKey key;
    key.g = reader.value<double>();
    key.eta = reader.value<double>();
    key.angle_deg = reader.value<double>();
    key.walks = reader.value<std::uint64_t>();
    key.seed = reader.value<std::uint64_t>();
    WhiteTable table;
    try {
        table = emptyWhiteTable(key);
    } catch (const Error& error) {
        throw error.at(path);
    }
    table.collisions = reader.value<std::uint64_t>();
    table.build_seconds = reader.value<double>();
    forEachHistogram(table, [&](const WhiteAxes& axes, WhiteView view, WhiteHistogram& histogram) {
        const auto cells = reader.value<std::uint64_t>();
        histogram.rows = reader.list<WhiteHistogram::Row>(axes.radialSlots());
        std::uint64_t sum = 0;
        for (const auto& [first, count] : histogram.rows) {
            if (std::uint64_t{first} + count > axes.columns(view)) reader.fail("a row of the white table is too long");
            sum += count;
        }
        if (sum != cells) reader.fail("the rows of the white table do not add up");
        for (std::vector<float>& moment : histogram.moments) {
            moment = reader.list<float>(static_cast<std::size_t>(cells));
            for (const float value : moment)
                if (!std::isfinite(value)) reader.fail("the white table holds a number that is none");
        }
    });
    for (std::vector<WhiteShift>& columns : table.shift)
        columns = reader.list<WhiteShift>(table.fine.axes.columns(WhiteView::collisions));
    if (!reader.atEnd()) reader.fail("the white table does not end where it should");
    return table;
}

}  // namespace searchlight
