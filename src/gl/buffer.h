// A shader storage buffer.
#pragma once

#include <cstddef>
#include <span>

#include "gl/context.h"

namespace searchlight::gl {

class Buffer {
public:
    /// Holds `bytes` bytes, all zero. The context outlives the buffer.
    explicit Buffer(Context& context, std::size_t bytes = 0);
    ~Buffer();
    Buffer(const Buffer&) = delete;
    Buffer& operator=(const Buffer&) = delete;

    std::size_t size() const { return bytes_; }
    unsigned handle() const { return handle_; }

    /// Makes room for at least `bytes`; when that needs more memory, the contents are lost. Throws a device Error
    /// beyond what the device can bind.
    void reserve(std::size_t bytes);

    /// Sets bytes.size() bytes from `first_byte` on, which the buffer must hold.
    void upload(std::span<const std::byte> bytes, std::size_t first_byte = 0);

    /// Waits for the device, then copies out bytes.size() bytes from `first_byte` on.
    void download(std::span<std::byte> bytes, std::size_t first_byte = 0) const;

    template <typename T>
    void upload(std::span<const T> values, std::size_t first_byte = 0) {
        upload(std::as_bytes(values), first_byte);
    }
    template <typename T>
    void download(std::span<T> values, std::size_t first_byte = 0) const {
        download(std::as_writable_bytes(values), first_byte);
    }

private:
    Context& context_;
    unsigned handle_ = 0;
    std::size_t bytes_ = 0;
};

}  // namespace searchlight::gl
