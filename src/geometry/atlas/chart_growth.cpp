#include "geometry/atlas/chart_growth.h"

#include <algorithm>
#include <limits>
#include <queue>
#include <tuple>
#include <unordered_set>

namespace searchlight {

namespace {

constexpr std::uint32_t none = no_triangle;
constexpr double infinity = std::numeric_limits<double>::infinity();

// How much of a way across flat surface counts, beside the turning: with 1 charts ignore creases, with 0.1 they follow
// every dent.
constexpr double flat_weight = 0.3;

struct Offer {
    double cost;
    std::uint32_t face, chart;
    bool operator>(const Offer& other) const {
        return std::tie(cost, face, chart) > std::tie(other.cost, other.face, other.chart);
    }
};
using Offers = std::priority_queue<Offer, std::vector<Offer>, std::greater<>>;

class Growth {
public:
    Growth(const SurfaceGraph& surface, std::span<const std::uint32_t> faces)
        : surface_(surface), inside_(surface.triangles.size()), owner_(surface.triangles.size(), none) {
        for (const std::uint32_t face : faces)
            if (surface.areas[face] > 0) {
                inside_[face] = 1;
                faces_.push_back(face);
            }
    }

    std::vector<ChartFaces> charts(std::size_t count) {
        if (faces_.empty()) return {};
        std::vector<std::uint32_t> seeds = farthestSeeds(count);
        std::vector<Vec3> normals;
        for (const std::uint32_t seed : seeds) normals.push_back(surface_.normals[seed]);
        constexpr int rounds = 4;
        for (int round = 0;; ++round) {
            grow(seeds, normals);
            if (round + 1 == rounds) break;
            normals = meanNormals(seeds.size());
            seeds = middles(seeds);
        }
        return gathered(growRest(seeds.size()));
    }

private:
    // Each seed as far from those before it as can be; those on parts that none has reached come first.
    std::vector<std::uint32_t> farthestSeeds(std::size_t count) const {
        std::vector<double> distance(owner_.size(), infinity);
        // The first one stands at an end of the surface, not where the file happens to begin.
        spread(distance, faces_.front());
        std::vector<std::uint32_t> seeds;
        std::vector<std::uint8_t> taken(owner_.size());  // two sides of a sheet are no distance apart
        for (bool first = true; seeds.size() < faces_.size(); first = false) {
            const auto reached = [&](std::uint32_t face) {
                return taken[face] || (first && distance[face] == infinity) ? -1.0 : distance[face];
            };
            const std::uint32_t farthest = *std::ranges::max_element(faces_, {}, reached);
            if (seeds.size() >= count && distance[farthest] < infinity) break;
            if (first) std::ranges::fill(distance, infinity);
            seeds.push_back(farthest);
            taken[farthest] = 1;
            spread(distance, farthest);
        }
        return seeds;
    }

    void spread(std::vector<double>& distance, std::uint32_t from) const {
        Offers open;
        distance[from] = 0;
        open.push({0, from, 0});
        while (!open.empty()) {
            const Offer next = open.top();
            open.pop();
            if (next.cost > distance[next.face]) continue;
            for (const std::uint32_t other : surface_.neighbours[next.face]) {
                if (other == none || !inside_[other]) continue;
                const double way = next.cost + step(next.face, other, surface_.normals[next.face]);
                if (way >= distance[other]) continue;
                distance[other] = way;
                open.push({way, other, 0});
            }
        }
    }

    double step(std::uint32_t from, std::uint32_t to, Vec3 normal) const {
        return length(surface_.centres[to] - surface_.centres[from]) *
               (flat_weight + 1 - dot(normal, surface_.normals[to]));
    }

    static std::uint64_t key(std::uint32_t chart, std::uint32_t vertex) {
        return static_cast<std::uint64_t>(chart) << 32 | vertex;
    }

    // Whether the chart with this face is a disc, when without it is one.
    bool keepsDisc(std::uint32_t face, std::uint32_t chart) const {
        int shared = 0, last = 0;
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t other = surface_.neighbours[face][static_cast<std::size_t>(k)];
            if (other != none && inside_[other] && owner_[other] == chart) ++shared, last = k;
        }
        if (shared == 1)  // the corner off the shared side must be new, or the border would meet itself there
            return !vertices_.contains(key(chart, surface_.triangles[face][static_cast<std::size_t>((last + 2) % 3)]));
        return shared == 2;
    }

    void take(std::uint32_t face, std::uint32_t chart, double cost, Vec3 normal, Offers& offers) {
        owner_[face] = chart;
        for (const std::uint32_t vertex : surface_.triangles[face]) vertices_.insert(key(chart, vertex));
        for (const std::uint32_t other : surface_.neighbours[face])
            if (other != none && inside_[other] && owner_[other] == none)
                offers.push({cost + step(face, other, normal), other, chart});
    }

    void work(Offers& offers, std::span<const Vec3> normals, std::uint32_t first_chart) {
        while (!offers.empty()) {
            const Offer offer = offers.top();
            offers.pop();
            if (owner_[offer.face] != none || !keepsDisc(offer.face, offer.chart)) continue;
            take(offer.face, offer.chart, offer.cost, normals[offer.chart - first_chart], offers);
        }
    }

    void grow(std::span<const std::uint32_t> seeds, std::span<const Vec3> normals) {
        for (const std::uint32_t face : faces_) owner_[face] = none;
        vertices_.clear();
        Offers offers;
        for (std::uint32_t chart = 0; chart < seeds.size(); ++chart)
            take(seeds[chart], chart, 0, normals[chart], offers);
        work(offers, normals, 0);
    }

    // Returns how many charts there are then.
    std::size_t growRest(std::size_t count) {
        for (const std::uint32_t face : faces_) {
            if (owner_[face] != none) continue;
            Offers offers;
            const auto chart = static_cast<std::uint32_t>(count++);
            const Vec3 normal = surface_.normals[face];
            take(face, chart, 0, normal, offers);
            work(offers, {&normal, 1}, chart);
        }
        return count;
    }

    std::vector<Vec3> meanNormals(std::size_t count) const {
        std::vector<Vec3> sums(count);
        for (const std::uint32_t face : faces_)
            if (owner_[face] != none)
                sums[owner_[face]] = sums[owner_[face]] + surface_.areas[face] * surface_.normals[face];
        for (Vec3& sum : sums)
            if (const double size = length(sum); size > 0) sum = (1 / size) * sum;
        return sums;
    }

    // The face of each chart that is farthest from its border; the old seed where the chart has no border.
    std::vector<std::uint32_t> middles(std::span<const std::uint32_t> seeds) const {
        std::vector<double> distance(owner_.size(), infinity);
        Offers open;
        for (const std::uint32_t face : faces_)
            if (std::ranges::any_of(surface_.neighbours[face], [&](std::uint32_t other) {
                    return other == none || !inside_[other] || owner_[other] != owner_[face];
                }))
                distance[face] = 0, open.push({0, face, 0});
        while (!open.empty()) {
            const Offer next = open.top();
            open.pop();
            if (next.cost > distance[next.face]) continue;
            for (const std::uint32_t other : surface_.neighbours[next.face]) {
                if (other == none || !inside_[other] || owner_[other] != owner_[next.face]) continue;
                const double way = next.cost + length(surface_.centres[other] - surface_.centres[next.face]);
                if (way < distance[other]) distance[other] = way, open.push({way, other, 0});
            }
        }
        std::vector<std::uint32_t> middle(seeds.begin(), seeds.end());
        for (const std::uint32_t face : faces_) {
            const std::uint32_t chart = owner_[face];
            if (chart != none && distance[face] < infinity && distance[face] > distance[middle[chart]])
                middle[chart] = face;
        }
        return middle;
    }

    std::vector<ChartFaces> gathered(std::size_t count) const {
        std::vector<ChartFaces> charts(count);
        for (const std::uint32_t face : faces_) charts[owner_[face]].push_back(face);
        return charts;
    }

    const SurfaceGraph& surface_;
    std::vector<std::uint8_t> inside_;
    std::vector<std::uint32_t> owner_, faces_;
    std::unordered_set<std::uint64_t> vertices_;  // of each chart
};

// One border that meets no vertex twice, and no handle: a disc.
bool isDisc(const SurfaceGraph& surface, std::span<const std::uint32_t> owner, const ChartFaces& a, const ChartFaces& b,
            std::uint32_t chart_a, std::uint32_t chart_b) {
    std::unordered_set<std::uint32_t> vertices, starts;
    std::size_t border = 0, sides = 0;
    for (const ChartFaces* part : {&a, &b})
        for (const std::uint32_t face : *part)
            for (std::size_t k = 0; k < 3; ++k) {
                vertices.insert(surface.triangles[face][k]);
                ++sides;
                const std::uint32_t other = surface.neighbours[face][k];
                if (other != none && (owner[other] == chart_a || owner[other] == chart_b)) continue;
                ++border;
                if (!starts.insert(surface.triangles[face][k]).second) return false;
            }
    const std::size_t edges = (sides + border) / 2, faces = a.size() + b.size();
    return border > 0 && vertices.size() + faces == edges + 1;
}

}  // namespace

std::vector<ChartFaces> growCharts(const SurfaceGraph& surface, std::span<const std::uint32_t> faces,
                                   std::size_t count) {
    return Growth(surface, faces).charts(count);
}

void mergeSmallCharts(const SurfaceGraph& surface, std::vector<ChartFaces>& charts, std::size_t fewest_faces) {
    std::vector<std::uint32_t> owner(surface.triangles.size(), none);
    for (std::uint32_t chart = 0; chart < charts.size(); ++chart)
        for (const std::uint32_t face : charts[chart]) owner[face] = chart;
    for (std::uint32_t chart = 0; chart < charts.size(); ++chart) {
        if (charts[chart].size() >= fewest_faces) continue;
        std::vector<std::pair<double, std::uint32_t>> beside;  // length of common border, chart
        for (const std::uint32_t face : charts[chart])
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t other = surface.neighbours[face][k];
                if (other == none || owner[other] == none || owner[other] == chart) continue;
                const auto& corners = surface.triangles[face];
                const double side = length(surface.positions[corners[(k + 1) % 3]] - surface.positions[corners[k]]);
                const auto known = std::ranges::find(beside, owner[other], &std::pair<double, std::uint32_t>::second);
                if (known == beside.end())
                    beside.emplace_back(side, owner[other]);
                else
                    known->first += side;
            }
        std::ranges::sort(beside, std::greater<>());
        for (const auto& [side, other] : beside) {
            if (!isDisc(surface, owner, charts[chart], charts[other], chart, other)) continue;
            for (const std::uint32_t face : charts[chart]) owner[face] = other;
            charts[other].insert(charts[other].end(), charts[chart].begin(), charts[chart].end());
            charts[chart].clear();
            break;
        }
    }
    std::erase_if(charts, [](const ChartFaces& chart) { return chart.empty(); });
}

}  // namespace searchlight
