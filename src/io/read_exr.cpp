// OpenEXR files: what is in memory here is always float RGBA over the display window.
#include <ImathBox.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfPartType.h>
#include <ImfStringAttribute.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <map>

#include "base/error.h"
#include "base/text.h"
#include "io/image_formats.h"

namespace searchlight {

namespace {

class MemoryStream final : public Imf::IStream {
public:
    explicit MemoryStream(std::string_view bytes) : IStream("the file"), bytes_(bytes) {}

    bool read(char target[], int count) override {
        if (count < 0 || at_ > bytes_.size() || static_cast<std::size_t>(count) > bytes_.size() - at_)
            throw inputError(fmt::format("the file ends at byte {}, in the middle of its data", bytes_.size()));
        std::memcpy(target, bytes_.data() + at_, static_cast<std::size_t>(count));
        at_ += static_cast<std::size_t>(count);
        return at_ < bytes_.size();
    }
    std::uint64_t tellg() override { return at_; }
    void seekg(std::uint64_t position) override { at_ = position; }

private:
    std::string_view bytes_;
    std::uint64_t at_ = 0;
};

// Where a channel of the file goes: a component of a layer ("": the picture itself), or all of R, G and B.
struct Target {
    std::string layer;
    int component = 0;  // 0 to 3
    bool grey = false;
};

Target targetOf(const std::string& channel) {
    const std::size_t dot = channel.rfind('.');
    const std::string layer = dot == std::string::npos ? "" : channel.substr(0, dot);
    const std::string name = dot == std::string::npos ? channel : channel.substr(dot + 1);
    constexpr std::string_view components = "RGBA";
    if (name.size() == 1 && components.find(name[0]) != std::string_view::npos)
        return {layer, static_cast<int>(components.find(name[0])), false};
    if (name == "Y") return {layer, 0, true};
    return {channel, 0, true};  // "Z", "object.id": a grey layer of its own
}

// Of data that the compression can bring forth from a byte, at most. zlib reaches 1032; DWA keeps one value of 64
// before it.
double bytesPerByte(Imf::Compression compression) {
    const bool dwa = compression == Imf::DWAA_COMPRESSION || compression == Imf::DWAB_COMPRESSION;
    return dwa ? 64. * 1040 : 1040;
}

struct Window {
    double width, height;
    explicit Window(const Imath::Box2i& box)
        : width(static_cast<double>(box.max.x) - box.min.x + 1),
          height(static_cast<double>(box.max.y) - box.min.y + 1) {}
};

std::string listed(const Imf::ChannelList& channels) {
    std::vector<std::string> names;
    for (auto i = channels.begin(); i != channels.end() && names.size() < 12; ++i) names.emplace_back(i.name());
    return join(names, ", ");
}

// Channels by layer; throws for what cannot be a picture.
std::map<std::string, std::vector<std::pair<std::string, Target>>> layersOf(const Imf::Header& header) {
    std::map<std::string, std::vector<std::pair<std::string, Target>>> layers;
    const Imf::ChannelList& channels = header.channels();
    for (auto i = channels.begin(); i != channels.end(); ++i) {
        if (i.channel().xSampling != 1 || i.channel().ySampling != 1)
            throw inputError(fmt::format("channel {} is subsampled", i.name()),
                             "expected one sample per pixel, not luminance with chroma");
        const Target target = targetOf(i.name());
        layers[target.layer].emplace_back(i.name(), target);
    }
    if (!layers.contains(""))
        throw inputError("no channels R, G, B or Y", fmt::format("the file has {}", listed(channels)));
    // Y beside R, G and B is a layer of its own.
    for (auto& [name, members] : layers) {
        const auto coloured = [](const auto& member) { return !member.second.grey && member.second.component < 3; };
        if (std::ranges::any_of(members, coloured))
            std::erase_if(members, [](const auto& member) { return member.second.grey; });
    }
    return layers;
}

void checkHeader(const Imf::Header& header, std::size_t layers, std::size_t bytes) {
    if (header.hasType() && (header.type() == Imf::DEEPSCANLINE || header.type() == Imf::DEEPTILE))
        throw inputError("the file holds deep data", "expected a flat picture");
    const Window data(header.dataWindow()), display(header.displayWindow());
    double bytes_per_pixel = 0;
    for (auto i = header.channels().begin(); i != header.channels().end(); ++i)
        bytes_per_pixel += i.channel().type == Imf::HALF ? 2 : 4;
    checkSize(data.width, data.height, static_cast<double>(bytes),
              bytesPerByte(header.compression()) / bytes_per_pixel);
    checkSize(display.width, display.height, static_cast<double>(bytes), max_pixels);
    const double wanted = std::max(data.width * data.height, display.width * display.height);
    if (wanted * static_cast<double>(layers) > max_pixels)
        throw inputError(fmt::format("{} layers of {:.0f} x {:.0f} pixels", layers, display.width, display.height),
                         fmt::format("at most {:.0f} pixels are read, all layers together", max_pixels));
    if (display.width * display.height > 64 * data.width * data.height)
        throw inputError(
            fmt::format("the display window, {:.0f} x {:.0f}, is more than 64 times the data window, {:.0f} "
                        "x {:.0f}",
                        display.width, display.height, data.width, data.height));
}

// The picture of the data window within the display window; what lies outside the data is transparent.
Image placed(Image&& data, const Imath::Box2i& data_window, const Imath::Box2i& display_window) {
    if (data_window == display_window) return std::move(data);
    const Window display(display_window);
    Image image(static_cast<int>(display.width), static_cast<int>(display.height));
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const std::int64_t from_x = static_cast<std::int64_t>(x) + display_window.min.x - data_window.min.x;
            const std::int64_t from_y = static_cast<std::int64_t>(y) + display_window.min.y - data_window.min.y;
            if (from_x >= 0 && from_x < data.width && from_y >= 0 && from_y < data.height)
                image.at(x, y) = data.at(static_cast<int>(from_x), static_cast<int>(from_y));
        }
    }
    return image;
}

ImageFile readPart(Imf::MultiPartInputFile& input, std::size_t bytes) {
    const Imf::Header& header = input.header(0);
    auto layers = layersOf(header);
    checkHeader(header, layers.size(), bytes);
    const Imath::Box2i window = header.dataWindow();
    const Window size(window);
    const int width = static_cast<int>(size.width), height = static_cast<int>(size.height);

    Imf::InputPart part(input, 0);
    Imf::FrameBuffer frame;
    std::map<std::string, Image> images;
    for (const auto& [name, members] : layers) {
        Image& image = images.emplace(name, Image(width, height, {0, 0, 0, 1})).first->second;
        // OpenEXR addresses a pixel as base + x stride + y stride, with x and y of the data window.
        for (const auto& [channel, target] : members) {
            char* const base = reinterpret_cast<char*>(image.pixels.data()) -
                               (static_cast<std::ptrdiff_t>(window.min.y) * width + window.min.x) *
                                   static_cast<std::ptrdiff_t>(sizeof(Rgba)) +
                               target.component * static_cast<std::ptrdiff_t>(sizeof(float));
            frame.insert(channel,
                         Imf::Slice(Imf::FLOAT, base, sizeof(Rgba), sizeof(Rgba) * static_cast<std::size_t>(width)));
        }
    }
    part.setFrameBuffer(frame);
    part.readPixels(window.min.y, window.max.y);

    ImageFile file;
    for (auto& [name, image] : images) {
        const auto& members = layers[name];
        if (std::ranges::any_of(members, [](const auto& member) { return member.second.grey; }))
            for (Rgba& pixel : image.pixels) pixel.g = pixel.b = pixel.r;
        image = placed(std::move(image), window, header.displayWindow());
        if (name.empty())
            file.image = std::move(image);
        else
            file.layers.push_back({name, std::move(image)});
    }
    for (auto i = header.begin(); i != header.end(); ++i) {
        const auto* text = dynamic_cast<const Imf::StringAttribute*>(&i.attribute());
        std::string_view name = i.name();
        if (!text || name == "type" || name == "name" || name == "view") continue;
        if (name.starts_with(exr_metadata)) name.remove_prefix(exr_metadata.size());
        file.metadata.emplace_back(name, text->value());
    }
    return file;
}

}  // namespace

ImageFile parseExr(std::string_view bytes) {
    if (!bytes.starts_with("\x76\x2f\x31\x01"))
        throw inputError("is no OpenEXR file", "expected the bytes 76 2f 31 01 at its start");
    checkExrHeaders(bytes);
    try {
        MemoryStream stream(bytes);
        Imf::MultiPartInputFile input(stream, 0, false);
        return readPart(input, bytes.size());
    } catch (const Error&) {
        throw;
    } catch (const std::exception& error) {
        throw inputError(fmt::format("OpenEXR cannot read it: {}", error.what()));
    }
}

}  // namespace searchlight
