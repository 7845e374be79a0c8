#include "geometry/polygonise.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.h"
#include "geometry/vertex_normals.h"
#include "geometry/weld.h"

namespace searchlight {

namespace {

using Function = std::function<double(Vec3)>;

// Cells of a block along each axis: its values are taken together, or skipped together.
constexpr int block = 8;
constexpr int corners = block + 1;

struct Lattice {
    Vec3 low;
    double cell = 1;
    int blocks[3] = {};

    Vec3 at(int x, int y, int z) const { return low + cell * Vec3{double(x), double(y), double(z)}; }
};

struct Sample {
    Vec3 p;
    double f = 0;
};

// Where f changes sign between two corners. Always computed from the inner to the outer one, so that the cells that
// share an edge agree on every bit; away from the corners, so that edges that meet in one keep apart.
Vec3f crossing(const Sample& inside, const Sample& outside) {
    const double t = std::clamp(inside.f / (inside.f - outside.f), 0.05, 0.95);
    return toFloat(inside.p + t * (outside.p - inside.p));
}

void addTriangle(std::vector<Vec3f>& soup, Vec3f a, Vec3f b, Vec3f c, Vec3 outward) {
    const Vec3 p = toDouble(a), normal = cross(toDouble(b) - p, toDouble(c) - p);
    soup.push_back(a);
    soup.push_back(dot(normal, outward) < 0 ? c : b);
    soup.push_back(dot(normal, outward) < 0 ? b : c);
}

void cutTetrahedron(const std::array<Sample, 4>& corner, std::vector<Vec3f>& soup) {
    std::array<const Sample*, 4> in{}, out{};
    int inside = 0, outside = 0;
    for (const Sample& sample : corner) (sample.f < 0 ? in[inside++] : out[outside++]) = &sample;
    if (inside == 0 || outside == 0) return;
    Vec3 outward;
    for (int i = 0; i < outside; ++i) outward = outward + (1.0 / outside) * out[i]->p;
    for (int i = 0; i < inside; ++i) outward = outward - (1.0 / inside) * in[i]->p;
    if (inside == 1) {
        addTriangle(soup, crossing(*in[0], *out[0]), crossing(*in[0], *out[1]), crossing(*in[0], *out[2]), outward);
    } else if (inside == 3) {
        addTriangle(soup, crossing(*in[0], *out[0]), crossing(*in[1], *out[0]), crossing(*in[2], *out[0]), outward);
    } else {
        const Vec3f a = crossing(*in[0], *out[0]), b = crossing(*in[0], *out[1]), c = crossing(*in[1], *out[1]),
                    d = crossing(*in[1], *out[0]);
        addTriangle(soup, a, b, c, outward);
        addTriangle(soup, a, c, d, outward);
    }
}

// The six tetrahedra around the diagonal of a cube: those of neighbouring cubes share whole faces.
constexpr int tetrahedra[6][4] = {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}};

void cutBlock(const Function& f, const Lattice& lattice, const PolygoniseOptions& options, const int (&first)[3],
              std::vector<Vec3f>& soup) {
    const Vec3 middle = lattice.at(first[0] + block / 2, first[1] + block / 2, first[2] + block / 2);
    const double radius = std::sqrt(3.0) / 2 * block * lattice.cell;
    if (options.empty ? options.empty(middle, radius) : std::abs(f(middle)) > options.lipschitz * radius) return;
    std::vector<Sample> samples;
    samples.reserve(corners * corners * corners);
    for (int z = 0; z < corners; ++z)
        for (int y = 0; y < corners; ++y)
            for (int x = 0; x < corners; ++x) {
                const Vec3 p = lattice.at(first[0] + x, first[1] + y, first[2] + z);
                samples.push_back({p, f(p)});
            }
    for (int z = 0; z < block; ++z)
        for (int y = 0; y < block; ++y)
            for (int x = 0; x < block; ++x) {
                std::array<Sample, 8> cube;
                int inside = 0, known = 0;
                for (int c = 0; c < 8; ++c) {
                    cube[c] = samples[((z + (c >> 2)) * corners + y + (c >> 1 & 1)) * corners + x + (c & 1)];
                    inside += cube[c].f < 0;
                    known += !std::isnan(cube[c].f);
                }
                if (inside == 0 || inside == 8 || known < 8) continue;
                for (const int(&t)[4] : tetrahedra)
                    cutTetrahedron({cube[t[0]], cube[t[1]], cube[t[2]], cube[t[3]]}, soup);
            }
}

Mesh indexed(const std::vector<Vec3f>& soup) {
    const Weld weld = weldPositions(soup);
    Mesh mesh;
    mesh.positions.resize(weld.count);
    for (std::size_t i = 0; i < soup.size(); ++i) mesh.positions[weld.of[i]] = soup[i];
    for (std::size_t i = 0; i + 2 < soup.size(); i += 3)
        mesh.triangles.push_back({weld.of[i], weld.of[i + 1], weld.of[i + 2]});
    return mesh;
}

Vec3 gradient(const Function& f, Vec3 p, double h) {
    // Four points of a tetrahedron: two fewer than the six of central differences, and as exact.
    constexpr double signs[4][3] = {{1, -1, -1}, {-1, -1, 1}, {-1, 1, -1}, {1, 1, 1}};
    Vec3 sum;
    for (const auto& s : signs) {
        const Vec3 way{s[0], s[1], s[2]};
        sum = sum + f(p + h * way) * way;
    }
    return (1 / (4 * h)) * sum;
}

// The neighbours of every vertex in one list; at an open edge each vertex lacks one.
struct Ring {
    std::vector<std::uint32_t> starts, neighbours;

    explicit Ring(const Mesh& mesh) : starts(mesh.positions.size() + 1), neighbours(3 * mesh.triangles.size()) {
        for (const auto& triangle : mesh.triangles)
            for (const std::uint32_t v : triangle) ++starts[v + 1];
        for (std::size_t i = 1; i < starts.size(); ++i) starts[i] += starts[i - 1];
        std::vector<std::uint32_t> next(starts.begin(), starts.end() - 1);
        // In a closed mesh each neighbour follows the vertex in exactly one triangle.
        for (const auto& triangle : mesh.triangles)
            for (int k = 0; k < 3; ++k) neighbours[next[triangle[k]]++] = triangle[(k + 1) % 3];
    }

    Vec3 middle(const std::vector<Vec3f>& positions, std::size_t i) const {
        Vec3 sum;
        for (std::uint32_t k = starts[i]; k < starts[i + 1]; ++k) sum = sum + toDouble(positions[neighbours[k]]);
        return (1.0 / (starts[i + 1] - starts[i])) * sum;
    }
};

// Calls body(i) for every vertex.
void forEachVertex(const Mesh& mesh, int threads, const std::function<void(std::size_t)>& body) {
    constexpr std::size_t chunk = 1024;
    const std::size_t count = mesh.positions.size();
    parallelFor((count + chunk - 1) / chunk, threads, [&](std::size_t c) {
        for (std::size_t i = c * chunk; i < std::min(count, (c + 1) * chunk); ++i) body(i);
    });
}

// Each vertex moves towards the middle of its neighbours along the surface, and back onto it.
void smooth(const Function& f, const Ring& ring, Mesh& mesh, const PolygoniseOptions& options) {
    for (int round = 0; round < options.smoothing; ++round) {
        const std::vector<Vec3f> old = mesh.positions, normals = vertexNormals(mesh);
        forEachVertex(mesh, options.threads, [&](std::size_t i) {
            const Vec3 p = toDouble(old[i]), n = toDouble(normals[i]), way = ring.middle(old, i) - p;
            const Vec3 along = p + 0.6 * (way - dot(way, n) * n);
            // Half a cell: further from the surface the function's value is no distance any more.
            const double distance = f(along);
            const double off = std::isnan(distance) ? 0 : std::clamp(distance, -0.5 * options.cell, 0.5 * options.cell);
            mesh.positions[i] = toFloat(along - (off / options.lipschitz) * n);
        });
    }
}

// In a fold narrower than a triangle a step may turn one over: its corners then go to the middle of their neighbours.
void unfold(const Ring& ring, Mesh& mesh) {
    for (int round = 0; round < 4; ++round) {
        const std::vector<Vec3f> old = mesh.positions, normals = vertexNormals(mesh);
        bool found = false;
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
            const auto& [a, b, c] = mesh.triangles[t];
            const Vec3 sum = toDouble(normals[a]) + toDouble(normals[b]) + toDouble(normals[c]);
            if (dot(sum, triangleNormal(mesh, t)) > 0) continue;
            for (const std::uint32_t v : mesh.triangles[t]) mesh.positions[v] = toFloat(ring.middle(old, v));
            found = true;
        }
        if (!found) return;
    }
}

void addNormals(const Function& f, Mesh& mesh, const PolygoniseOptions& options) {
    mesh.normals = vertexNormals(mesh);
    forEachVertex(mesh, options.threads, [&](std::size_t i) {
        const Vec3 slope = gradient(f, toDouble(mesh.positions[i]), 0.2 * options.cell);
        // Where the two differ much, the function has details that the triangles do not.
        if (dot(slope, toDouble(mesh.normals[i])) > 0.8 * length(slope)) mesh.normals[i] = toFloat(normalize(slope));
    });
}

}  // namespace

Mesh polygonise(const Function& f, const PolygoniseOptions& options) {
    Lattice lattice{options.low, options.cell};
    const Vec3 size = options.high - options.low;
    const double sizes[3] = {size.x, size.y, size.z};
    for (int axis = 0; axis < 3; ++axis)
        lattice.blocks[axis] = std::max(1, static_cast<int>(std::ceil(sizes[axis] / (block * options.cell))));
    const std::size_t layer = std::size_t(lattice.blocks[0]) * lattice.blocks[1];
    const std::size_t count = layer * lattice.blocks[2];
    std::vector<std::vector<Vec3f>> soups(count);
    parallelFor(count, options.threads, [&](std::size_t b) {
        const int first[3] = {static_cast<int>(b % lattice.blocks[0]) * block,
                              static_cast<int>(b % layer / lattice.blocks[0]) * block,
                              static_cast<int>(b / layer) * block};
        cutBlock(f, lattice, options, first, soups[b]);
    });
    std::vector<Vec3f> soup;
    for (const std::vector<Vec3f>& part : soups) soup.insert(soup.end(), part.begin(), part.end());
    Mesh mesh = indexed(soup);
    const Ring ring(mesh);
    smooth(f, ring, mesh, options);
    unfold(ring, mesh);
    addNormals(f, mesh, options);
    return mesh;
}

}  // namespace searchlight
