#include "render/light_view/light_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/parallel.h"
#include "light/single_lights.h"

namespace searchlight {

namespace {

// What is seen at less has no area that a texel could tell.
constexpr double least_cosine = 0.05;
// Places on triangles that are not seen stand no further apart than this part of the object's longest side.
constexpr double grazed_spacing = 1.0 / 128;
// A point light nearer to the object's centre, in radii of its bounding sphere, would need a map wider than 110
// degrees.
constexpr double least_distance = 1.22;

// What a map sees, texel by texel.
struct Seen {
    std::vector<std::size_t> cells;  // where in LightMap::cells
    std::vector<Vec3f> positions, normals, geometric;
};

struct LightView {
    LightMap map;
    Seen seen;
};

Vec3 inMap(const LightMap& map, Vec3 position) {
    const Vec3 v = position - map.origin;
    const double x = dot(v, map.right), y = dot(v, map.up), z = dot(v, map.forward);
    return map.central ? Vec3{x / z, y / z, 1 / z} : Vec3{x, y, z};
}

// From the surface at `position` to the light.
Vec3 towardsLight(const LightMap& map, Vec3 position) {
    return map.central ? normalize(map.origin - position) : -1 * map.forward;
}

LightMap frameOf(bool central, Vec3 origin, Vec3 forward) {
    const Vec3 other = std::abs(forward.y) < 0.9 ? Vec3{0, 1, 0} : Vec3{1, 0, 0};
    const Vec3 right = normalize(cross(forward, other));
    return {.central = central, .origin = origin, .right = right, .up = cross(right, forward), .forward = forward};
}

void fitTo(const Mesh& mesh, int resolution, LightMap& map) {
    constexpr double far = std::numeric_limits<double>::infinity();
    double low_u = far, high_u = -far, low_v = far, high_v = -far;
    for (const Vec3f& vertex : mesh.positions) {
        const Vec3 at = inMap(map, toDouble(vertex));
        low_u = std::min(low_u, at.x), high_u = std::max(high_u, at.x);
        low_v = std::min(low_v, at.y), high_v = std::max(high_v, at.y);
    }
    const double side = std::max({high_u - low_u, high_v - low_v, 1e-6 * std::abs(high_u)}) / resolution;
    map.texel = static_cast<float>(side);
    map.u0 = static_cast<float>(low_u);
    map.v0 = static_cast<float>(low_v);
    const auto texels = [&](double extent) {
        return std::clamp(static_cast<int>(std::ceil(extent / side - 1e-4)), 1, resolution);
    };
    map.width = texels(high_u - low_u);
    map.height = texels(high_v - low_v);
    map.cells.assign(
        static_cast<std::size_t>(map.width + 2) * static_cast<std::size_t>(map.height + 2) * LightMap::floats, 0.0f);
}

Vec3f shadingNormal(const Mesh& mesh, const RayHit& hit) {
    const auto& [a, b, c] = mesh.triangles[hit.triangle];
    const double u = hit.u, v = hit.v;
    const Vec3 sum =
        (1 - u - v) * toDouble(mesh.normals[a]) + u * toDouble(mesh.normals[b]) + v * toDouble(mesh.normals[c]);
    const double size = length(sum);
    return size > 1e-6 ? toFloat((1 / size) * sum) : hit.normal;
}

// A row of texels. Depth is linear in u and v on the plane that was hit.
void lookAlong(const Object& object, const RayScene& rays, int y, LightMap& map, Seen& seen) {
    const double side = map.texel, radius = boundingRadius(object);
    std::vector<Ray> lines;
    for (int x = 0; x < map.width; ++x) {
        const double u = map.u0 + (x + 0.5) * side, v = map.v0 + (y + 0.5) * side;
        const Vec3 across = u * map.right + v * map.up;
        lines.push_back(map.central
                            ? Ray{toFloat(map.origin), toFloat(map.forward + across)}
                            : Ray{toFloat(map.origin + across - 1.1 * radius * map.forward), toFloat(map.forward)});
    }
    std::vector<RayHit> hits(lines.size());
    rays.intersect(lines, hits, true);
    for (int x = 0; x < map.width; ++x) {
        const auto k = static_cast<std::size_t>(x);
        if (!std::isfinite(hits[k].t)) continue;
        const Vec3 position = toDouble(lines[k].origin) + hits[k].t * toDouble(lines[k].direction);
        const Vec3 normal = toDouble(hits[k].normal);
        if (dot(normal, towardsLight(map, position)) < least_cosine) continue;
        const double along = dot(normal, map.forward), over_u = dot(normal, map.right), over_v = dot(normal, map.up);
        // From afar n (u, v, z) is constant; from a point n (u, v, 1) / h is 1/z.
        const double h = dot(normal, position - map.origin), scale = map.central ? side / h : -side / along;
        float* cell = &map.cells[map.cellAt(x, y)];
        cell[0] = static_cast<float>(inMap(map, position).z);
        cell[1] = static_cast<float>(scale * over_u);
        cell[2] = static_cast<float>(scale * over_v);
        cell[3] = 1;
        seen.cells.push_back(map.cellAt(x, y));
        seen.positions.push_back(toFloat(position));
        seen.normals.push_back(shadingNormal(object.mesh, hits[k]));
        seen.geometric.push_back(hits[k].normal);
    }
}

LightView viewOf(LightMap map, const RenderInput& input, int resolution, const Observer& observer) {
    LightView view{std::move(map), {}};
    fitTo(input.object->mesh, resolution, view.map);
    std::vector<Seen> rows(static_cast<std::size_t>(view.map.height));
    parallelFor(rows.size(), input.threads, [&](std::size_t y) {
        if (observer.cancelled()) throw interruptedError();
        lookAlong(*input.object, *input.rays, static_cast<int>(y), view.map, rows[y]);
    });
    const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
    for (const Seen& row : rows) {
        append(view.seen.cells, row.cells);
        append(view.seen.positions, row.positions);
        append(view.seen.normals, row.normals);
        append(view.seen.geometric, row.geometric);
    }
    return view;
}

// Whether a place is what a map sees there: not behind its patch by more than that rises within a texel.
bool sees(const LightMap& map, Vec3 position) {
    const Vec3 at = inMap(map, position);
    const double column = (at.x - map.u0) / map.texel, row = (at.y - map.v0) / map.texel;
    if (!(column >= 0 && column < map.width && row >= 0 && row < map.height)) return false;
    const float* cell = &map.cells[map.cellAt(static_cast<int>(column), static_cast<int>(row))];
    if (cell[3] == 0) return false;
    const double across = column - std::floor(column) - 0.5, up = row - std::floor(row) - 0.5;
    const double depth = cell[0] + across * cell[1] + up * cell[2];
    return at.z < depth + map.texel * (1 + 0.5 * (std::abs(cell[1]) + std::abs(cell[2])) / map.texel);
}

// What of `seen` counts.
template <class Counts>
Seen chosen(const Seen& seen, const Counts& counts) {
    Seen some;
    for (std::size_t k = 0; k < seen.cells.size(); ++k) {
        if (!counts(k)) continue;
        some.cells.push_back(seen.cells[k]);
        some.positions.push_back(seen.positions[k]);
        some.normals.push_back(seen.normals[k]);
        some.geometric.push_back(seen.geometric[k]);
    }
    return some;
}

// The light of `scene` on `seen`, into its map. False when all is dark.
bool lightUp(const RenderInput& input, const Scene& scene, const Seen& seen, LightMap& map, Observer& observer) {
    if (seen.cells.empty()) return false;
    IrradianceOptions options = input.light;
    options.beams = false;
    const std::vector<Rgbf> transmitted =
        computeIrradiance({seen.positions, seen.normals}, scene, *input.object, input.rays, options, observer)
            .transmitted;
    bool lit = false;
    for (std::size_t k = 0; k < seen.cells.size(); ++k) {
        if (transmitted[k] == Rgbf{}) continue;
        const Vec3 position = toDouble(seen.positions[k]), normal = toDouble(seen.geometric[k]);
        // dA is du dv over the cosine; from a point z^3 / h du dv, with h the distance of its plane from the point.
        const double area = map.central ? 1 / dot(normal, position - map.origin) : 1 / dot(normal, map.forward);
        const Rgbf light = toFloat(std::abs(area) * toDouble(transmitted[k]));
        float* cell = &map.cells[seen.cells[k]];
        cell[4] = light.r;
        cell[5] = light.g;
        cell[6] = light.b;
        lit = true;
    }
    return lit;
}

// Places on the triangles that a view does not see but whose corners may be lit: middles of equal parts.
PointCloud grazedPlaces(const Object& object, const LightMap& map) {
    const Mesh& mesh = object.mesh;
    PointCloud places;
    for (const auto& triangle : mesh.triangles) {
        std::array<Vec3, 3> p, n;
        for (std::size_t k = 0; k < 3; ++k) {
            p[k] = toDouble(mesh.positions[triangle[k]]);
            n[k] = toDouble(mesh.normals[triangle[k]]);
        }
        const Vec3 twice = cross(p[1] - p[0], p[2] - p[0]), to_light = towardsLight(map, p[0]);
        const double area = 0.5 * length(twice);
        if (!(area > 0) || dot(twice, to_light) >= 2 * area * least_cosine) continue;
        if (std::ranges::none_of(n, [&](Vec3 corner) { return dot(corner, to_light) > 0; })) continue;
        const double longest = std::max({length(p[1] - p[0]), length(p[2] - p[1]), length(p[0] - p[2])});
        const int parts =
            std::clamp(static_cast<int>(std::ceil(longest / (grazed_spacing * object.longest_mm))), 1, 64);
        const auto add = [&](double u, double v) {
            const auto at = [&](const std::array<Vec3, 3>& of) {
                return of[0] + u * (of[1] - of[0]) + v * (of[2] - of[0]);
            };
            const Vec3 normal = at(n);
            const double size = length(normal);
            if (!(size > 1e-6)) return;
            places.positions.push_back(toFloat(at(p)));
            places.normals.push_back(toFloat((1 / size) * normal));
            places.areas.push_back(static_cast<float>(area / (parts * parts)));
        };
        for (int i = 0; i < parts; ++i)
            for (int j = 0; i + j < parts; ++j) {
                add((i + 1 / 3.0) / parts, (j + 1 / 3.0) / parts);
                if (i + j + 1 < parts) add((i + 2 / 3.0) / parts, (j + 2 / 3.0) / parts);
            }
    }
    return places;
}

void addGrazed(const RenderInput& input, const Scene& scene, const LightMap& map, Observer& observer, LightMaps& to) {
    const PointCloud places = grazedPlaces(*input.object, map);
    if (places.positions.empty()) return;
    IrradianceOptions options = input.light;
    options.beams = false;
    const std::vector<Rgbf> light =
        computeIrradiance({places.positions, places.normals}, scene, *input.object, input.rays, options, observer)
            .transmitted;
    for (std::size_t i = 0; i < light.size(); ++i) {
        if (light[i] == Rgbf{}) continue;
        to.grazed.positions.push_back(places.positions[i]);
        to.grazed.normals.push_back(places.normals[i]);
        to.grazed.areas.push_back(places.areas[i]);
        to.grazed_light.push_back(light[i]);
    }
}

// Where a light looks from, if it does.
struct Place {
    bool has_view = false;
    LightMap frame;
};

Place placeOf(const Light& light, const Object& object) {
    if (const auto* directional = std::get_if<DirectionalLight>(&light)) {
        if (directional->angle_deg > 0) return {};
        return {true, frameOf(false, {}, -1 * normalize(directional->direction))};
    }
    if (const auto* point = std::get_if<PointLight>(&light)) {
        const Vec3 origin = object.longest_mm * point->position;
        if (length(origin) < least_distance * boundingRadius(object)) return {};
        return {true, frameOf(true, origin, normalize(-1 * origin))};
    }
    return {};
}

std::vector<Vec3> cubeDirections() {
    std::vector<Vec3> directions{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    for (const double x : {-1.0, 1.0})
        for (const double y : {-1.0, 1.0})
            for (const double z : {-1.0, 1.0}) directions.push_back(normalize({x, y, z}));
    return directions;
}

}  // namespace

LightMaps lightMaps(const RenderInput& input, int resolution, Observer& observer) {
    LightMaps result;
    Scene spread = *input.scene;
    spread.lights.clear();
    for (const Light& light : input.scene->lights) {
        const Place place = placeOf(light, *input.object);
        if (!place.has_view) {
            spread.lights.push_back(light);
            continue;
        }
        ++result.views;
        Scene scene = *input.scene;
        scene.lights = {light};
        LightView view = viewOf(place.frame, input, resolution, observer);
        addGrazed(input, scene, view.map, observer, result);
        result.texels += view.seen.cells.size();
        if (lightUp(input, scene, view.seen, view.map, observer)) result.maps.push_back(std::move(view.map));
    }
    result.spread_lights = static_cast<int>(spread.lights.size());
    if (spread.lights.empty()) return result;
    std::vector<LightView> views;
    for (const Vec3& direction : cubeDirections())
        views.push_back(viewOf(frameOf(false, {}, -1 * direction), input, resolution, observer));
    result.views += static_cast<int>(views.size());
    for (std::size_t i = 0; i < views.size(); ++i) {
        if (observer.cancelled()) throw interruptedError();
        const auto countsHere = [&](std::size_t k) {
            const Vec3 normal = toDouble(views[i].seen.geometric[k]), position = toDouble(views[i].seen.positions[k]);
            const double here = -dot(normal, views[i].map.forward);
            for (std::size_t j = 0; j < views.size(); ++j) {
                const double there = -dot(normal, views[j].map.forward);
                // Of two that see it alike the first has it.
                if ((there > here || (there == here && j < i)) && sees(views[j].map, position)) return false;
            }
            return true;
        };
        const Seen here = chosen(views[i].seen, countsHere);
        result.texels += here.cells.size();
        // The other views read this one's depth, not its light.
        LightMap lit = views[i].map;
        if (lightUp(input, spread, here, lit, observer)) result.maps.push_back(std::move(lit));
        observer.progress("light maps", i + 1, views.size(), "views");
    }
    return result;
}

}  // namespace searchlight
