#include "render/texture/texture_gl.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>

#include "base/embedded.h"
#include "gl/context.h"
#include "render/radial_table_gl.h"

namespace searchlight {

namespace {

using Texel = std::array<float, 4>;
constexpr unsigned group_size = 64;  // local_size_x of the passes

unsigned groupsFor(std::size_t invocations) {
    return static_cast<unsigned>((invocations + group_size - 1) / group_size);
}

gl::Source passSource(std::string_view file) {
    gl::Source source;
    source.add("#version 450 core", "searchlight");
    source.add(embeddedText(file).value(), file);
    return source;
}

}  // namespace

TextureGl::TextureGl(gl::Context& context)
    : context_(context),
      pyramid_(context, passSource("src/render/texture/texture_gl.pyramid.comp.glsl")),
      choose_(context, passSource("src/render/texture/texture_gl.choose.comp.glsl")),
      sum_(context, hierarchicalPassGl("src/render/texture/texture_gl.sum.comp.glsl")),
      sums_(context),
      along_(context),
      choices_(context),
      receivers_(context),
      exitance_(context),
      radial_(context),
      samples_(context) {}

std::vector<CellChoice> TextureGl::choose(std::span<const double> weights, std::span<const double> along) {
    int levels = 0;
    std::size_t leaves = 1, first = 0;
    for (; leaves < weights.size(); leaves *= 4, ++levels) first = 4 * first + 1;
    // One scale for all: areas and light may be far from 1.
    const double most = *std::ranges::max_element(weights);
    std::vector<float> lowest(leaves);
    std::ranges::transform(weights, lowest.begin(), [&](double weight) { return static_cast<float>(weight / most); });
    sums_.reserve((first + leaves) * sizeof(float));
    sums_.upload<float>(lowest, first * sizeof(float));
    std::size_t below = first, count = leaves;
    for (int level = levels - 1; level >= 0; --level) {
        const std::size_t here = (below - 1) / 4;
        count /= 4;
        pyramid_.set("first", static_cast<int>(here));
        pyramid_.set("below", static_cast<int>(below));
        pyramid_.set("count", static_cast<int>(count));
        pyramid_.dispatch(groupsFor(count), {{0, sums_}});
        below = here;
    }
    const std::vector<float> numbers(along.begin(), along.end());
    fill<float>(along_, numbers);
    choices_.reserve(along.size() * sizeof(Texel));
    choose_.set("levels", levels);
    choose_.set("count", static_cast<int>(along.size()));
    choose_.dispatch(groupsFor(along.size()), {{0, sums_}, {1, along_}, {2, choices_}});
    std::vector<Texel> found(along.size());
    choices_.download<Texel>(found);
    std::vector<CellChoice> choices;
    for (const Texel& texel : found)
        choices.push_back({std::bit_cast<std::uint32_t>(texel[0]),
                           std::clamp(static_cast<double>(texel[1]), 0.0, 1 - 0x1p-24), texel[2]});
    return choices;
}

void TextureGl::setSamples(const PointCloud& points, std::span<const Rgbf> transmitted) {
    std::vector<Texel> texels;
    for (std::size_t i = 0; i < transmitted.size(); ++i) {
        const Vec3f p = points.positions[i];
        const Rgbf flux = toFloat(double(points.areas[i]) * toDouble(transmitted[i]));
        texels.push_back({p.x, p.y, p.z, 0});
        texels.push_back({flux.r, flux.g, flux.b, 0});
    }
    samples_.upload(context_, texels);
    sample_count_ = static_cast<int>(transmitted.size());
}

void TextureGl::setProfile(const Profile& profile, double cell_area_mm2, double area_mm2) {
    const RadialTableGl table = makeRadialTableGl(RadialKernel(profile, cell_area_mm2), area_mm2);
    table_entries_ = table.entries();
    table_first_bits_ = table.firstBits();
    table_offset_ = table.offset;
    radial_.upload(context_, table.texels);
}

void TextureGl::setReceivers(std::span<const Vec3f> receivers) {
    std::vector<Texel> texels;
    texels.reserve(receivers.size());
    for (const Vec3f p : receivers) texels.push_back({p.x, p.y, p.z, 0});
    fill<Texel>(receivers_, texels);
}

void TextureGl::sum(std::size_t first, std::span<Rgbf> exitance) {
    exitance_.reserve(exitance.size() * sizeof(Texel));
    sum_.set("table_last", table_entries_ - 1);
    sum_.set("table_first_bits", table_first_bits_);
    sum_.set("table_offset", static_cast<float>(table_offset_));
    sum_.set("first_receiver", static_cast<int>(first));
    sum_.set("receiver_count", static_cast<int>(exitance.size()));
    sum_.set("sample_count", sample_count_);
    sum_.dispatch(groupsFor(exitance.size()), {{0, receivers_}, {1, exitance_}},
                  {{0, *radial_.texture}, {3, *samples_.texture}});
    std::vector<Texel> sums(exitance.size());
    exitance_.download<Texel>(sums);
    for (std::size_t i = 0; i < sums.size(); ++i) exitance[i] = {sums[i][0], sums[i][1], sums[i][2]};
}

}  // namespace searchlight
