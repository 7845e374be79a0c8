#include "render/screen/screen_filter_gl.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "base/embedded.h"
#include "base/error.h"
#include "gl/context.h"
#include "render/screen/filter_pass.h"

namespace searchlight {

namespace {

using Texel = std::array<float, 4>;

// Samples in one dispatch: some 20 ms of a software driver.
constexpr std::size_t slice = 65'536;
constexpr unsigned group_size = 64;  // local_size_x of the pass

gl::Source passSource() {
    constexpr std::string_view file = "src/render/screen/screen_filter_gl.comp.glsl";
    gl::Source source;
    source.add("#version 450 core", "searchlight");
    source.add(embeddedText(file).value(), file);
    return source;
}

void fill(gl::Buffer& buffer, std::span<const Texel> texels) {
    buffer.reserve(texels.size_bytes());
    buffer.upload(texels);
}

}  // namespace

ScreenFilterGl::ScreenFilterGl(gl::Context& context)
    : context_(context),
      program_(context, passSource()),
      positions_(context),
      normals_(context),
      cells_(context),
      taps_(context),
      grid_(context),
      grid_between_(context),
      light_(context),
      between_(context),
      sums_(context) {}

void ScreenFilterGl::setSamples(const ScreenSamples& samples) {
    count_ = samples.count;
    if (count_ == 0) return;
    places_.resize(count_);
    normals_of_.resize(count_);
    for (std::size_t i = 0; i < count_; ++i) {
        places_[i] = {samples.position[0][i], samples.position[1][i], samples.position[2][i], 1};
        normals_of_[i] = {samples.normal[0][i], samples.normal[1][i], samples.normal[2][i], 0};
    }
    source_ = samples.source;
    cell_ = samples.cell;
    texels_.resize(samples.cells());
    for (std::size_t cell = 0; cell < texels_.size(); ++cell) texels_[cell] = {0, 0, 0, samples.depth[cell]};
    fill(normals_, normals_of_);
    samples_ = &samples;
    cells_.reserve(cell_.size() * sizeof(cell_[0]));
    cells_.upload<std::uint32_t>(cell_);
    // Where nothing is seen it stays empty.
    fill(grid_between_, texels_);
    between_.reserve(count_ * sizeof(Texel));
    program_.set("width", samples.width);
    program_.set("height", samples.height);
    program_.set("margin", ScreenSamples::margin);
    program_.set("standing", static_cast<int>(samples.standing));
    program_.set("focal", samples.focal);
}

std::vector<Rgbf> ScreenFilterGl::filter(std::span<const Rgbf> light, const Taps& taps,
                                         const ScreenFilterOptions& options) {
    assert(light.size() == count_ && (options.strength.empty() || options.strength.size() == count_));
    std::vector<Rgbf> result(count_);
    if (count_ == 0) return result;
    std::vector<Texel> given(count_);
    for (std::size_t i = 0; i < count_; ++i) {
        const Rgbf& value = light[source_[i]];
        given[i] = {value.r, value.g, value.b, 0};
        places_[i][3] = options.strength.empty() ? 1 : options.strength[source_[i]];
        if (i < cell_.size()) std::copy_n(given[i].begin(), 3, texels_[cell_[i]].begin());
    }
    fill(positions_, places_);
    fill(light_, given);
    fill(grid_, texels_);
    fill(sums_, std::vector<Texel>(count_));

    const std::vector<FilterTerm> terms = filterTerms(taps);
    std::vector<Texel> weights;
    for (const FilterTerm& term : terms)
        for (const FilterTap& tap : term.lines[0].taps)
            weights.push_back({tap.weight.r, tap.weight.g, tap.weight.b, tap.offset});
    if (!weights.empty())
        fill(taps_, weights);
    else
        taps_.reserve(sizeof(Texel));

    program_.set("surface_axes", options.axes == FilterAxes::screen ? 0 : 1);
    program_.set("turned", options.axes == FilterAxes::turned ? 1 : 0);
    program_.set("trust", static_cast<int>(options.trust));
    program_.set("kernel_width", static_cast<float>(options.width));
    program_.set("per_reach", perReach(taps, options));
    program_.set("fallback", static_cast<float>(options.fallback));
    program_.set("edge_on", FilterPass::edge_on);
    program_.set("nearest", FilterPass::nearest);
    int first_tap = 0;
    for (const FilterTerm& term : terms) {
        const int end_tap = first_tap + static_cast<int>(term.lines[0].taps.size());
        program_.set("first_tap", first_tap);
        program_.set("end_tap", end_tap);
        program_.set("scale", toDouble(term.scale));
        for (const bool last : {false, true}) {
            const FilterLine& line = term.lines[last ? 1 : 0];
            if (options.axes == FilterAxes::turned) {
                const auto turns = filterTurns(*samples_, options.frame, last);
                for (std::size_t i = 0; i < count_; ++i) normals_of_[i][3] = std::atan2(turns[1][i], turns[0][i]);
                fill(normals_, normals_of_);
            }
            program_.set("course", static_cast<int>(line.course(options.axes)));
            program_.set("cosine", line.cosine);
            program_.set("sine", line.sine);
            program_.set("middle", toDouble(line.middle));
            program_.set("last", last ? 1 : 0);
            if (last)
                dispatch(options, grid_between_, between_, sums_, grid_);
            else
                dispatch(options, grid_, light_, between_, grid_between_);
        }
        first_tap = end_tap;
    }
    std::vector<Texel> sums(count_);
    sums_.download<Texel>(sums);
    for (std::size_t i = 0; i < count_; ++i) result[source_[i]] = {sums[i][0], sums[i][1], sums[i][2]};
    return result;
}

void ScreenFilterGl::dispatch(const ScreenFilterOptions& options, const gl::Buffer& grid, const gl::Buffer& light,
                              const gl::Buffer& result, const gl::Buffer& grid_out) {
    for (std::size_t first = 0; first < count_; first += slice) {
        if (options.observer && options.observer->cancelled()) throw interruptedError();
        const std::size_t end = std::min(count_, first + slice);
        program_.set("first_sample", static_cast<int>(first));
        program_.set("end_sample", static_cast<int>(end));
        program_.dispatch(static_cast<unsigned>((end - first + group_size - 1) / group_size), {{0, positions_},
                                                                                               {1, normals_},
                                                                                               {2, cells_},
                                                                                               {3, grid},
                                                                                               {4, light},
                                                                                               {5, taps_},
                                                                                               {6, result},
                                                                                               {7, grid_out}});
    }
}

}  // namespace searchlight
