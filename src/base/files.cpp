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

void writeFile(const fs::path& path, std::string_view bytes) {
    const fs::path aside = path.string() + fmt::format(".{}.partial", getpid());
    const auto fail = [&](std::string_view why) {
        std::error_code ignored;
        fs::remove(aside, ignored);
        throw inputError(fmt::format("cannot be written: {}", why)).at(path.string());
    };
    if (fs::is_directory(path)) fail("is a folder");
    {
        std::ofstream stream(aside, std::ios::binary | std::ios::trunc);
        if (!stream) fail(std::strerror(errno));
        stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
        stream.flush();
        if (!stream) fail(std::strerror(errno));
    }
    std::error_code error;
    fs::rename(aside, path, error);
    if (error) fail(error.message());
}

void makeFolder(const fs::path& path) {
    std::error_code error;
    fs::create_directories(path, error);
    if (error || !fs::is_directory(path))
        throw inputError(fmt::format("cannot make this folder: {}", error ? error.message() : "a file is in the way"))
            .at(path.string());
}

}  // namespace searchlight
