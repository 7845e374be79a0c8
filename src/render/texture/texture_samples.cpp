#include "render/texture/texture_samples.h"

#include "render/texture/cell_choice.h"

namespace searchlight {

namespace {

// The part of the samples that goes by area alone.
constexpr double by_area = 0.1;

double brightness(Rgbf light) {
    return (static_cast<double>(light.r) + static_cast<double>(light.g) + static_cast<double>(light.b)) / 3;
}

}  // namespace

LitAtlas::LitAtlas(const Atlas& atlas, const TexelMap& map, const RenderInput& input, Observer& observer)
    : atlas_(atlas),
      map_(map),
      places_(prepareLitPoints({map.cells.positions, map.cells.normals}, *input.object, input.rays, input.light.normals,
                               input.light.threads, observer)) {
    light(input, observer);
}

void LitAtlas::light(const RenderInput& input, Observer& observer) {
    IrradianceOptions options = input.light;
    options.beams = false;
    transmitted_ = computeIrradiance(places_, *input.scene, *input.object, input.rays, options, observer).transmitted;
    double squares = 0;
    area_mm2_ = power_ = 0;
    for (std::size_t i = 0; i < map_.size(); ++i) {
        const double area = map_.cells.areas[i], light = brightness(transmitted_[i]);
        area_mm2_ += area;
        power_ += area * light;
        squares += area * light * light;
    }
    lit_area_mm2_ = squares > 0 ? power_ * power_ / squares : area_mm2_;
}

TextureSamples LitAtlas::draw(const RenderInput& input, const TextureSampleOptions& options, TextureGl* device,
                              Observer& observer) const {
    TextureSamples samples{.lit_area_mm2 = lit_area_mm2_};
    if (!(power_ > 0)) {
        samples.dark = true;
        return samples;
    }
    const double flat = options.own_light ? by_area : 0;
    std::vector<double> weights(map_.size());
    for (std::size_t i = 0; i < weights.size(); ++i)
        weights[i] = map_.cells.areas[i] * ((1 - flat) * brightness(transmitted_[i]) / power_ + flat / area_mm2_);
    std::vector<SampleNumbers> numbers;
    std::vector<double> along;
    for (std::size_t k = 0; k < options.count; ++k) {
        numbers.push_back(sampleNumbers(k, options.count, options.seed));
        along.push_back(numbers.back().along);
    }
    std::vector<std::uint32_t> cells;
    for (std::size_t k = 0;
         const CellChoice& choice : device ? device->choose(weights, along) : CellChooser(weights).choose(along)) {
        const SurfaceSample place = sampleCell(input.object->mesh, atlas_, map_, choice.cell, choice.inside,
                                               numbers[k].across, numbers[k].around);
        ++k;
        cells.push_back(choice.cell);
        samples.points.positions.push_back(place.position);
        samples.points.normals.push_back(place.normal);
        samples.points.areas.push_back(static_cast<float>(map_.cells.areas[choice.cell] /
                                                          (static_cast<double>(options.count) * choice.probability)));
    }
    if (!options.own_light && !options.beams) {
        for (const std::uint32_t cell : cells) samples.irradiance.transmitted.push_back(transmitted_[cell]);
        return samples;
    }
    PointCloud middles;
    for (const std::uint32_t cell : cells) {
        middles.positions.push_back(map_.cells.positions[cell]);
        middles.normals.push_back(map_.cells.normals[cell]);
    }
    const PointCloud& lit = options.own_light ? samples.points : middles;
    IrradianceOptions light = input.light;
    light.beams = options.beams;
    samples.irradiance =
        computeIrradiance({lit.positions, lit.normals}, *input.scene, *input.object, input.rays, light, observer);
    return samples;
}

}  // namespace searchlight
