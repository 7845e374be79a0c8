// Binary files, read with every count checked against the bytes that are left.
#pragma once

#include <fmt/format.h>

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>

#include "base/error.h"

namespace searchlight {

/// The value whose bytes stand at `from`, in the given order.
template <class T>
T loadValue(const char* from, std::endian order) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, from, sizeof(T));
    if (order != std::endian::native)
        for (std::size_t i = 0; i < sizeof(T) / 2; ++i) std::swap(bytes[i], bytes[sizeof(T) - 1 - i]);
    T value;
    std::memcpy(&value, bytes, sizeof(T));
    return value;
}

/// A walk through bytes in memory, which must outlive it. `what` names in messages what was expected.
class ByteReader {
public:
    ByteReader(std::string_view bytes, std::string_view path, std::endian order)
        : bytes_(bytes), path_(path), order_(order) {}

    std::size_t at() const { return at_; }
    std::string_view rest() const { return bytes_.substr(at_); }
    std::size_t left() const { return bytes_.size() - at_; }

    /// `count` items of `size` bytes, stepped over; an input Error when fewer are left, before memory is taken.
    std::string_view take(std::size_t count, std::size_t size, std::string_view what) {
        if (size > 0 && count > left() / size)
            throw error(at_,
                        fmt::format("{} {}{}, but {} bytes are left", count, what,
                                    size == 1 ? std::string() : fmt::format(" of {} bytes", size), left()),
                        "the file is cut off or damaged");
        const std::string_view taken = bytes_.substr(at_, count * size);
        at_ += count * size;
        return taken;
    }

    template <class T>
    T value(std::string_view what) {
        if (left() < sizeof(T))
            throw error(at_, fmt::format("the file ends before {}", what), "the file is cut off or damaged");
        const T value = loadValue<T>(bytes_.data() + at_, order_);
        at_ += sizeof(T);
        return value;
    }

    /// A signed 32-bit count that is not negative.
    std::size_t count(std::string_view what) {
        const std::size_t from = at_;
        const auto stated = value<std::int32_t>(what);
        if (stated < 0) throw error(from, fmt::format("{} is {}", what, stated), "a count of 0 or more");
        return static_cast<std::size_t>(stated);
    }

    /// An input Error at that byte of the file.
    Error error(std::size_t byte, std::string_view message, std::string hint = {}) const {
        return inputError(fmt::format("byte {}: {}", byte, message), std::move(hint)).at(path_);
    }

private:
    std::string_view bytes_, path_;
    std::endian order_;
    std::size_t at_ = 0;
};

}  // namespace searchlight
