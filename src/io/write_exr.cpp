#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <fmt/format.h>

#include <cassert>

#include "base/error.h"
#include "io/image_formats.h"

namespace searchlight {

namespace {

class MemoryStream final : public Imf::OStream {
public:
    MemoryStream() : OStream("the file") {}

    void write(const char bytes[], int count) override {
        const std::size_t end = at_ + static_cast<std::size_t>(count);
        if (end > bytes_.size()) bytes_.resize(end);
        bytes_.replace(at_, static_cast<std::size_t>(count), bytes, static_cast<std::size_t>(count));
        at_ = end;
    }
    std::uint64_t tellp() override { return at_; }
    void seekp(std::uint64_t position) override { at_ = position; }

    std::string take() { return std::move(bytes_); }

private:
    std::string bytes_;
    std::uint64_t at_ = 0;
};

void addLayer(Imf::Header& header, Imf::FrameBuffer& frame, const std::string& layer, const Image& image) {
    // OpenEXR's slices are for reading and writing, so they take the pixels without const; here they are read.
    char* const base = const_cast<char*>(reinterpret_cast<const char*>(image.pixels.data()));
    constexpr std::string_view components = "RGBA";
    for (std::size_t i = 0; i < components.size(); ++i) {
        const std::string channel = (layer.empty() ? "" : layer + ".") + components[i];
        header.channels().insert(channel, Imf::Channel(Imf::FLOAT));
        frame.insert(channel, Imf::Slice(Imf::FLOAT, base + i * sizeof(float), sizeof(Rgba),
                                         sizeof(Rgba) * static_cast<std::size_t>(image.width)));
    }
}

}  // namespace

std::string exrBytes(const ImageFile& file) {
    try {
        Imf::Header header(file.image.width, file.image.height);
        header.compression() = Imf::ZIP_COMPRESSION;
        Imf::FrameBuffer frame;
        addLayer(header, frame, "", file.image);
        for (const ImageLayer& layer : file.layers) {
            assert(layer.image.width == file.image.width && layer.image.height == file.image.height);
            addLayer(header, frame, layer.name, layer.image);
        }
        for (const auto& [key, value] : file.metadata)
            header.insert(std::string(exr_metadata) + key, Imf::StringAttribute(value));
        MemoryStream stream;
        {
            Imf::OutputFile output(stream, header, 0);
            output.setFrameBuffer(frame);
            output.writePixels(file.image.height);
        }
        return stream.take();
    } catch (const std::exception& error) {
        throw inputError(fmt::format("OpenEXR cannot write it: {}", error.what()));
    }
}

}  // namespace searchlight
