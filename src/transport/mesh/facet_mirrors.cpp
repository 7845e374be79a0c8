// Beams behind mirrors: images of those that enter.
#include <algorithm>
#include <cmath>
#include <limits>

#include "transport/mesh/entry.h"
#include "transport/mesh/facet_beams.h"
#include "transport/mesh/facet_geometry.h"
#include "transport/walk/fresnel.h"

namespace searchlight {

namespace {

constexpr double kEnough = 1e-4;  // of the light: what may be left out
// Images cost time at each collision as their lists are long: against those of the beams that enter, and in all
// (256 MiB of references and of beams).
constexpr double kImagesPerDirect = 32, kMostImages = 1 << 26;
constexpr std::size_t kMostBeams = 256, kSomeBeams = 4096, kMostBeamsInAll = 1 << 21;

}  // namespace

FacetBeams::Frame FacetBeams::frameOf(const Beam& beam) const {
    const auto [a, b, c] = cornersOf(body_.mesh(), beam.triangle);
    Frame frame{
        a, b - a, c - a,
        grazes(beam) ? -1.0 * unitNormal(body_.mesh(), beam.triangle) : directionAt(beam, (1 / 3.0) * (a + b + c))};
    for (const std::uint32_t facet : mirrorsOf(beam)) {
        const Vec3 normal = unitNormal(body_.mesh(), facet);
        frame = {imageOf(body_.mesh(), facet, frame.corner), reflected(frame.side, normal),
                 reflected(frame.other, normal), reflected(frame.direction, normal)};
    }
    return frame;
}

Sweep FacetBeams::sweepOf(const Beam& beam) const {
    if (beam.disc) return sweepOfDisc(beam);
    const auto corners = cornersOf(body_.mesh(), beam.triangle);
    Box facet{corners[0], corners[0]}, directions{};
    for (int i = 0; i < 3; ++i) {
        Vec3 d = directionAt(beam, corners[i]);
        for (const std::uint32_t mirror : mirrorsOf(beam)) d = reflected(d, unitNormal(body_.mesh(), mirror));
        if (i == 0) directions = {d, d};
        facet.hold(corners[i]);
        directions.hold(d);
    }
    const Vec3 bend = bendOf(beam) * Vec3{1, 1, 1};
    directions = {directions.low - bend, directions.high + bend};
    if (beam.order == 0) return {facet, directions, reach_mm_};

    // Where it meets the last mirror: within that, and where its own outline comes to.
    const auto last = cornersOf(body_.mesh(), mirrorsOf(beam).back());
    Box mirror{last[0], last[0]};
    for (const Vec3& corner : last) mirror.hold(corner);
    const Frame frame = frameOf(beam);
    const Vec3 normal = unitNormal(body_.mesh(), mirrorsOf(beam).back());
    const double along = dot(frame.direction, normal);
    if (beam.parallel && std::abs(along) > 1e-6) {
        Box outline{};
        bool first = true;
        for (const float u : {beam.low[0], beam.high[0]})
            for (const float v : {beam.low[1], beam.high[1]}) {
                const Vec3 from =
                    frame.corner + static_cast<double>(u) * frame.side + static_cast<double>(v) * frame.other;
                const Vec3 there = from + (dot(last[0] - from, normal) / along) * frame.direction;
                if (first) outline = {there, there};
                first = false;
                outline.hold(there);
            }
        mirror = mirror.both(outline);
    }
    return {mirror, directions, static_cast<double>(beam.end - beam.begin)};
}

// The image of a beam in a facet that it meets; nothing where it does not.
std::optional<FacetBeams::Beam> FacetBeams::behind(const Beam& beam, const Frame& frame, std::uint32_t facet) const {
    if (beam.order > 0 && mirrorsOf(beam).back() == facet) return {};
    const Vec3 normal = unitNormal(body_.mesh(), facet);
    const double cosine = dot(frame.direction, normal);
    if (!(cosine > -turnOf(beam))) return {};
    double low[4], high[4];  // of u, v, u + v and t at the corners
    for (int i = 0; i < 4; ++i) low[i] = std::numeric_limits<double>::infinity(), high[i] = -low[i];
    for (const Vec3& corner : cornersOf(body_.mesh(), facet)) {
        double at[4];
        for (const int row : {0, 1, 2})
            at[row == 2 ? 3 : row] = dot(toDouble(beam.rows[row]), corner) + static_cast<double>(beam.constants[row]);
        at[2] = at[0] + at[1];
        for (int i = 0; i < 4; ++i) low[i] = std::min(low[i], at[i]), high[i] = std::max(high[i], at[i]);
    }
    Beam image = beam;
    // Behind light from a point t is not known so well.
    if (beam.parallel) {
        image.begin = std::max(beam.begin, static_cast<float>(low[3]));
        image.part *= static_cast<float>(internalReflectance(medium_.eta, std::min(1.0, cosine)));
        const double mfps = std::log(static_cast<double>(image.part) / kWeakestImage);
        image.end = std::min(beam.end, static_cast<float>(mfps / medium_.sigma_t));
    }
    if (!(high[3] > static_cast<double>(beam.begin)) || image.begin >= image.end) return {};
    const double margin = kFacetMargin + static_cast<double>(beam.slack) * high[3];
    for (int i = 0; i < 3; ++i) {
        image.low[i] = std::max(beam.low[i], static_cast<float>(low[i] - margin));
        image.high[i] = std::min(beam.high[i], static_cast<float>(high[i] + margin));
        if (image.low[i] >= image.high[i]) return {};
    }
    return image;
}

// The images of the beams from `first` on. False, and nothing, when they get more than `most` beams.
bool FacetBeams::addOrder(const CellLists& facets, std::uint32_t first, std::size_t most) {
    const auto end = static_cast<std::uint32_t>(beams_.size());
    const std::size_t mirrors = mirrors_.size();
    std::vector<std::uint32_t> seen(body_.mesh().triangles.size(), 0);
    for (std::uint32_t i = first; i < end; ++i) {
        const Beam beam = beams_[i];
        if (beam.disc) continue;
        const Frame frame = frameOf(beam);
        cells_.forEach(sweepOf(beam), [&](std::size_t cell, double) {
            for (const std::uint32_t facet : facets.at(cell)) {
                if (seen[facet] == i + 1) continue;
                seen[facet] = i + 1;
                std::optional<Beam> image = behind(beam, frame, facet);
                if (!image) continue;
                image->mirrors = static_cast<std::uint32_t>(mirrors_.size());
                for (std::size_t k = 0; k < beam.order; ++k) mirrors_.push_back(mirrors_[beam.mirrors + k]);
                mirrors_.push_back(facet);
                ++image->order;
                if (setRows(*image, frameOf(*image))) beams_.push_back(*image);
            }
        });
        if (beams_.size() > most) {
            beams_.resize(end);
            mirrors_.resize(mirrors);
            return false;
        }
    }
    return true;
}

void FacetBeams::addOrders(std::size_t most) {
    const Mesh& mesh = body_.mesh();
    const auto facets = CellLists::of(
        cells_, 0, static_cast<std::uint32_t>(mesh.triangles.size()),
        [&](std::uint32_t facet) {
            const auto corners = cornersOf(mesh, facet);
            Box box{corners[0], corners[0]};
            for (const Vec3& corner : corners) box.hold(corner);
            return Sweep{box, {}, 0};
        },
        kMostImages);
    if (!facets) return;
    const auto direct = static_cast<std::uint32_t>(beams_.size());
    const double most_refs = std::min(kMostImages, kImagesPerDirect * static_cast<double>(direct_.size()));
    const std::size_t most_beams = std::min(kMostBeamsInAll, kSomeBeams + kMostBeams * beams_.size());
    std::uint32_t first = 0;
    while (orders_ < most && mirrored_[orders_] > kEnough) {
        const auto next = static_cast<std::uint32_t>(beams_.size());
        if (!addOrder(*facets, first, most_beams)) return;
        std::optional<CellLists> lists = CellLists::of(
            cells_, direct, static_cast<std::uint32_t>(beams_.size()),
            [&](std::uint32_t i) { return sweepOf(beams_[i]); }, most_refs);
        if (!lists) {
            beams_.resize(next);
            return;
        }
        images_ = std::move(*lists);
        first = next;
        ++orders_;
    }
}

// The legs of light that enters in a beam, and the part of it that its mirrors leave.
double FacetBeams::throughMirrors(const Beam& beam, const Arrival& light,
                                  std::array<Leg, kMostOrders + 1>& legs) const {
    Vec3 from = light.entry, direction = light.direction;
    double part = 1;
    const auto mirrors = mirrorsOf(beam);
    for (std::size_t i = 0; i < mirrors.size(); ++i) {
        const Vec3 normal = unitNormal(body_.mesh(), mirrors[i]);
        const double cosine = std::min(1.0, dot(direction, normal));
        const double height = dot(cornersOf(body_.mesh(), mirrors[i])[0] - from, normal);
        if (!(cosine > 0 && height > 0)) return 0;
        from = from + (height / cosine) * direction;
        legs[i] = {from, direction};
        part *= internalReflectance(medium_.eta, cosine);
        direction = reflected(direction, normal);
    }
    legs[mirrors.size()] = {from, direction};
    return part;
}

void FacetBeams::measureMirrored() {
    constexpr std::uint64_t candidates = 8192;  // knows the part to a few percent of itself
    const Illumination light = &lights_;
    // No candidate meets the roulette.
    EntrySource<MeshBody> source(body_, light, {channel_, medium_.eta, 1e-9 * body_.area()}, candidates, SplitMix64(1));
    double all = 0;
    for (Entry entry; source.next(entry);) {
        double weight = static_cast<double>(entry.weight);
        all += weight;
        if (!entry.single) continue;
        Vec3f from = entry.position;
        Vec3 direction = toDouble(entry.direction);
        for (double& sum : mirrored_) {
            const auto hit = body_.rays().intersect({from, toFloat(direction)});
            if (!hit) break;
            const Vec3 normal = toDouble(hit->normal);
            const double cosine = std::min(1.0, dot(direction, normal)), way = static_cast<double>(hit->t);
            if (!(cosine > 0)) break;
            weight *= std::exp(-medium_.sigma_t * way) * internalReflectance(medium_.eta, cosine);
            sum += weight;
            from = body_.below({toDouble(from) + way * direction, normal});
            direction = reflected(direction, normal);
        }
    }
    for (double& sum : mirrored_) sum = all > 0 ? sum / all : 0;
}

}  // namespace searchlight
