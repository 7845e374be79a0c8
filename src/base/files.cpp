#include "base/files.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

#include "base/error.h"

namespace searchlight {

namespace fs = std::filesystem;

std::string readFile(const fs::path& path, std::size_t max_bytes) {
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (!fs::exists(status)) throw inputError("no such file").at(path.string());
    if (fs::is_directory(status)) throw inputError("is a folder, expected a file").at(path.string());
    std::ifstream stream(path, std::ios::binary);
    if (!stream && errno == EINTR) throw interruptedError();  // while a pipe waits for its writer
    if (!stream) throw inputError(fmt::format("cannot be read: {}", std::strerror(errno))).at(path.string());
    std::string bytes;
    // Read in pieces: a pipe or device has no size to trust.
    char piece[1 << 16];
    while (stream.read(piece, sizeof piece) || stream.gcount() > 0) {
        bytes.append(piece, static_cast<std::size_t>(stream.gcount()));
        if (bytes.size() > max_bytes)
            throw inputError(fmt::format("is larger than {} MiB", max_bytes >> 20)).at(path.string());
    }
    return bytes;
}

namespace {

fs::path aside(const fs::path& path) { return path.string() + fmt::format(".{}.partial", getpid()); }

[[noreturn]] void failToWrite(const fs::path& path, std::string_view why) {
    std::error_code ignored;
    fs::remove(aside(path), ignored);
    throw inputError(fmt::format("cannot be written: {}", why)).at(path.string());
}

// Devices and pipes are written as they stand: to rename a file onto one would replace it.
bool takesBytesOnly(const fs::path& path) {
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    return fs::is_character_file(status) || fs::is_fifo(status) || fs::is_socket(status);
}

std::ofstream openToWrite(const fs::path& path, const fs::path& opened) {
    std::error_code error;
    if (fs::is_directory(path, error)) failToWrite(path, "is a folder");
    std::ofstream stream(opened, std::ios::binary | std::ios::trunc);
    if (!stream) failToWrite(path, std::strerror(errno));
    return stream;
}

}  // namespace

void writeFile(const fs::path& path, std::string_view bytes) {
    const bool directly = takesBytesOnly(path);
    const fs::path opened = directly ? path : aside(path);
    {
        std::ofstream stream = openToWrite(path, opened);
        stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
        stream.flush();
        if (!stream) failToWrite(path, std::strerror(errno));
    }
    if (directly) return;
    std::error_code error;
    fs::rename(opened, path, error);
    if (error) failToWrite(path, error.message());
}

void checkWritable(const fs::path& path) {
    if (takesBytesOnly(path)) return;
    openToWrite(path, aside(path));
    std::error_code ignored;
    fs::remove(aside(path), ignored);
}

bool sameFile(const fs::path& a, const fs::path& b) {
    std::error_code error;
    if (fs::equivalent(a, b, error)) return true;
    const auto whole = [&](const fs::path& path) { return fs::weakly_canonical(fs::absolute(path, error), error); };
    const fs::path one = whole(a), other = whole(b);
    return !one.empty() && one == other;
}

void makeFolder(const fs::path& path) {
    std::error_code error;
    fs::create_directories(path, error);
    std::error_code unknown;
    if (error || !fs::is_directory(path, unknown))
        throw inputError(fmt::format("cannot make this folder: {}", error ? error.message() : "a file is in the way"))
            .at(path.string());
}

}  // namespace searchlight
