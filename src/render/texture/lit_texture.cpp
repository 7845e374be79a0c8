#include "render/texture/lit_texture.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>

#include "geometry/atlas/atlas_cache.h"

namespace searchlight {

namespace {

using Clock = std::chrono::steady_clock;

double milliseconds(Clock::time_point since) {
    return std::chrono::duration<double, std::milli>(Clock::now() - since).count();
}

AtlasOptions atlasOptions(const ParamValues& options, int threads) {
    const std::string& uvs = std::get<std::string>(options.at("uvs"));
    return {.resolution = static_cast<int>(std::get<double>(options.at("atlas"))),
            .conformal = uvs == "conformal",
            .uvs = uvs == "automatic" ? AtlasUvs::automatic
                   : uvs == "file"    ? AtlasUvs::file
                                      : AtlasUvs::own,
            .threads = threads};
}

}  // namespace

std::uint64_t LitTexture::refresh(const RenderInput& input, const ParamValues& options,
                                  std::map<std::string, double>& stage_ms, Observer& observer) {
    const auto begin = Clock::now();
    if (refreshAtlas(input, options, observer)) stage_ms["atlas"] = milliseconds(begin);
    if (lit_ && light_of_ == input.versions.light) return version_;
    const auto light_begin = Clock::now();
    if (lit_)
        lit_->light(input, observer);
    else
        lit_.emplace(atlas_, map_, input, observer);
    light_of_ = input.versions.light;
    stage_ms["light"] = milliseconds(light_begin);
    return ++version_;
}

bool LitTexture::refreshAtlas(const RenderInput& input, const ParamValues& options, Observer& observer) {
    const std::string key =
        fmt::format("{} {} {}", input.versions.points, valueText(options.at("atlas")), valueText(options.at("uvs")));
    if (key == atlas_from_) return false;
    atlas_from_.clear();
    lit_.reset();
    const Object& object = *input.object;
    const AtlasOptions wanted = atlasOptions(options, input.threads);
    atlas_ = input.points_cache
                 ? cachedAtlas(object.mesh, object.content_hash, wanted, atlasesBeside(*input.points_cache), observer)
                 : makeAtlas(object.mesh, wanted, observer);
    map_ = mapTexels(input.object->mesh, atlas_);
    // Counting sort of cells by their texel.
    const auto texels = static_cast<std::size_t>(map_.resolution) * static_cast<std::size_t>(map_.resolution);
    first_cell_.assign(texels + 1, 0);
    for (const std::uint32_t texel : map_.texels) ++first_cell_[texel + 1];
    for (std::size_t i = 0; i < texels; ++i) first_cell_[i + 1] += first_cell_[i];
    std::vector<std::uint32_t> next(first_cell_.begin(), first_cell_.end() - 1);
    cells_.resize(map_.size());
    for (std::uint32_t cell = 0; cell < map_.size(); ++cell) cells_[next[map_.texels[cell]]++] = cell;
    atlas_from_ = key;
    return true;
}

Rgb LitTexture::lightAt(const SurfacePlace& place) const {
    const std::uint32_t chart = atlas_.charts[place.triangle];
    if (chart == no_triangle) return {};
    const FlatTriangle& flat = atlas_.triangles[place.triangle];
    const Vec2 at = flat[0] + place.u * (flat[1] - flat[0]) + place.v * (flat[2] - flat[0]);
    const double x = at.x - 0.5, y = at.y - 0.5, left = std::floor(x), low = std::floor(y);
    const std::span<const Rgbf> light = lit_->transmitted();
    Rgb sum;
    double weights = 0;
    for (int dy = 0; dy < 2; ++dy)
        for (int dx = 0; dx < 2; ++dx) {
            const int column = static_cast<int>(left) + dx, row = static_cast<int>(low) + dy;
            if (column < 0 || row < 0 || column >= map_.resolution || row >= map_.resolution) continue;
            const double weight = (dx ? x - left : 1 - (x - left)) * (dy ? y - low : 1 - (y - low));
            const auto texel = static_cast<std::size_t>(row) * static_cast<std::size_t>(map_.resolution) +
                               static_cast<std::size_t>(column);
            for (std::uint32_t i = first_cell_[texel]; i < first_cell_[texel + 1]; ++i) {
                const std::uint32_t cell = cells_[i];
                if (atlas_.charts[map_.pieces[map_.first_piece[cell]].triangle] != chart) continue;
                sum = sum + weight * toDouble(light[cell]);
                weights += weight;
            }
        }
    return weights > 0 ? (1 / weights) * sum : Rgb{};
}

}  // namespace searchlight
