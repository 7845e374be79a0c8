// Binary files by hand, for tests.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace searchlight {

class BinaryText {
public:
    explicit BinaryText(std::endian order) : order_(order) {}

    template <class T>
    BinaryText& add(std::initializer_list<T> values) {
        for (const T value : values) {
            std::string bytes(reinterpret_cast<const char*>(&value), sizeof value);
            if (order_ != std::endian::native) bytes.assign(bytes.rbegin(), bytes.rend());
            bytes_ += bytes;
        }
        return *this;
    }
    BinaryText& text(std::string_view text) {
        bytes_ += text;
        return *this;
    }
    BinaryText& zeros(std::size_t count) {
        bytes_.append(count, '\0');
        return *this;
    }
    const std::string& bytes() const { return bytes_; }
    operator std::string_view() const { return bytes_; }

private:
    std::endian order_;
    std::string bytes_;
};

}  // namespace searchlight
