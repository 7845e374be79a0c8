#include "geometry/rays.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstring>
#include <numeric>

#include "base/error.h"

namespace searchlight {

namespace {

constexpr unsigned packet_size = 8;

struct DeviceDeleter {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct SceneDeleter {
    void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using Device = std::unique_ptr<RTCDeviceTy, DeviceDeleter>;
using EmbreeScene = std::unique_ptr<RTCSceneTy, SceneDeleter>;

RTCRay toEmbree(const Ray& ray) {
    RTCRay out{};
    out.org_x = ray.origin.x, out.org_y = ray.origin.y, out.org_z = ray.origin.z;
    out.dir_x = ray.direction.x, out.dir_y = ray.direction.y, out.dir_z = ray.direction.z;
    out.tnear = ray.t_min, out.tfar = ray.t_max;
    out.mask = ~0u;
    return out;
}

void setLane(RTCRay8& packet, unsigned lane, const Ray& ray) {
    packet.org_x[lane] = ray.origin.x, packet.org_y[lane] = ray.origin.y, packet.org_z[lane] = ray.origin.z;
    packet.dir_x[lane] = ray.direction.x, packet.dir_y[lane] = ray.direction.y, packet.dir_z[lane] = ray.direction.z;
    packet.tnear[lane] = ray.t_min, packet.tfar[lane] = ray.t_max;
    packet.time[lane] = 0;
    packet.mask[lane] = ~0u;
    packet.id[lane] = lane;
    packet.flags[lane] = 0;
}

RTCIntersectContext makeContext(bool coherent) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    return context;
}

// Calls trace(valid, first, lanes) for each eight of `count` rays; the last packet is partly masked.
template <class Trace>
void forEachPacket(std::size_t count, const Trace& trace) {
    for (std::size_t first = 0; first < count; first += packet_size) {
        const unsigned lanes = static_cast<unsigned>(std::min<std::size_t>(packet_size, count - first));
        alignas(64) int valid[packet_size];
        for (unsigned lane = 0; lane < packet_size; ++lane) valid[lane] = lane < lanes ? -1 : 0;
        trace(valid, first, lanes);
    }
}

}  // namespace

struct RayScene::Impl {
    Device device;
    EmbreeScene scene;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<Vec3f> normals;
    float extent = 0;

    void check() const {
        const RTCError error = rtcGetDeviceError(device.get());
        if (error == RTC_ERROR_OUT_OF_MEMORY) throw deviceError("not enough memory to trace rays against the mesh");
        if (error != RTC_ERROR_NONE) throw deviceError("Embree cannot trace rays against the mesh");
    }
};

RayScene::RayScene(const Mesh& mesh) : impl_(std::make_unique<Impl>()) {
    if (mesh.triangles.empty()) throw inputError("a mesh without triangles: rays have nothing to hit");
    impl_->triangles = mesh.triangles;
    impl_->normals.reserve(mesh.triangles.size());
    for (const auto& [a, b, c] : mesh.triangles) {
        // In double: the edges of a sliver cancel in float.
        const Vec3 p = toDouble(mesh.positions[a]);
        impl_->normals.push_back(
            toFloat(normalize(cross(toDouble(mesh.positions[b]) - p, toDouble(mesh.positions[c]) - p))));
    }
    for (const Vec3f& p : mesh.positions)
        impl_->extent = std::max({impl_->extent, std::abs(p.x), std::abs(p.y), std::abs(p.z)});

    impl_->device.reset(rtcNewDevice(nullptr));
    if (!impl_->device) throw deviceError("Embree does not start");
    const RTCGeometry geometry = rtcNewGeometry(impl_->device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    // Embree's own copy of the vertices: it reads 16 bytes at the last one, which a shared buffer does not hold.
    auto* const vertices = static_cast<Vec3f*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3f), mesh.positions.size()));
    if (vertices) std::ranges::copy(mesh.positions, vertices);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, impl_->triangles.data(), 0,
                               sizeof(impl_->triangles[0]), impl_->triangles.size());
    rtcCommitGeometry(geometry);
    impl_->scene.reset(rtcNewScene(impl_->device.get()));
    rtcSetSceneFlags(impl_->scene.get(), RTC_SCENE_FLAG_ROBUST);
    rtcAttachGeometry(impl_->scene.get(), geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(impl_->scene.get());
    impl_->check();
}

RayScene::~RayScene() = default;
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;

std::optional<RayHit> RayScene::intersect(const Ray& ray) const {
    RTCIntersectContext context = makeContext(false);
    RTCRayHit query{};
    query.ray = toEmbree(ray);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(impl_->scene.get(), &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
    return RayHit{query.ray.tfar, query.hit.primID, query.hit.u, query.hit.v, impl_->normals[query.hit.primID]};
}

bool RayScene::occluded(const Ray& ray) const {
    RTCIntersectContext context = makeContext(false);
    RTCRay query = toEmbree(ray);
    rtcOccluded1(impl_->scene.get(), &context, &query);
    return query.tfar < 0;  // -infinity by Embree's convention
}

void RayScene::intersect(std::span<const Ray> rays, std::span<RayHit> results, bool coherent) const {
    assert(rays.size() == results.size());
    RTCIntersectContext context = makeContext(coherent);
    forEachPacket(rays.size(), [&](const int* valid, std::size_t first, unsigned lanes) {
        RTCRayHit8 packet;
        for (unsigned lane = 0; lane < lanes; ++lane) setLane(packet.ray, lane, rays[first + lane]);
        for (unsigned lane = 0; lane < packet_size; ++lane) packet.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect8(valid, impl_->scene.get(), &context, &packet);
        for (unsigned lane = 0; lane < lanes; ++lane) {
            RayHit& result = results[first + lane];
            if (packet.hit.geomID[lane] == RTC_INVALID_GEOMETRY_ID) {
                result = {std::numeric_limits<float>::infinity()};
                continue;
            }
            const std::uint32_t triangle = packet.hit.primID[lane];
            result = {packet.ray.tfar[lane], triangle, packet.hit.u[lane], packet.hit.v[lane],
                      impl_->normals[triangle]};
        }
    });
}

std::size_t RayScene::intersect(const RayColumns& rays, std::span<ListedHit> hits) const {
    assert(rays.count <= hits.size());
    RTCIntersectContext context = makeContext(false);
    RTCRayHit8 packet;
    std::fill_n(packet.ray.time, packet_size, 0.0f);
    std::fill_n(packet.ray.mask, packet_size, ~0u);
    std::fill_n(packet.ray.flags, packet_size, 0u);
    std::iota(packet.ray.id, packet.ray.id + packet_size, 0u);
    std::size_t found = 0;
    for (std::size_t first = 0; first < rays.count; first += packet_size) {
        const std::size_t lanes = std::min<std::size_t>(packet_size, rays.count - first);
        alignas(64) int valid[packet_size];
        for (std::size_t lane = 0; lane < packet_size; ++lane) valid[lane] = lane < lanes ? -1 : 0;
        const auto copy = [first](float* to, const float* from) {
            std::memcpy(to, from + first, packet_size * sizeof(float));
        };
        copy(packet.ray.org_x, rays.x), copy(packet.ray.org_y, rays.y), copy(packet.ray.org_z, rays.z);
        copy(packet.ray.dir_x, rays.dx), copy(packet.ray.dir_y, rays.dy), copy(packet.ray.dir_z, rays.dz);
        copy(packet.ray.tnear, rays.t_min);
        std::fill_n(packet.ray.tfar, packet_size, rays.t_max);
        std::fill_n(packet.hit.geomID, packet_size, RTC_INVALID_GEOMETRY_ID);
        rtcIntersect8(valid, impl_->scene.get(), &context, &packet);
        for (unsigned lane = 0; lane < lanes; ++lane) {
            if (packet.hit.geomID[lane] == RTC_INVALID_GEOMETRY_ID) continue;
            const std::uint32_t triangle = packet.hit.primID[lane];
            hits[found++] = {
                static_cast<std::uint32_t>(first) + lane,
                {packet.ray.tfar[lane], triangle, packet.hit.u[lane], packet.hit.v[lane], impl_->normals[triangle]}};
        }
    }
    return found;
}

void RayScene::occluded(std::span<const Ray> rays, std::span<std::uint8_t> results, bool coherent) const {
    assert(rays.size() == results.size());
    RTCIntersectContext context = makeContext(coherent);
    forEachPacket(rays.size(), [&](const int* valid, std::size_t first, unsigned lanes) {
        RTCRay8 packet;
        for (unsigned lane = 0; lane < lanes; ++lane) setLane(packet, lane, rays[first + lane]);
        rtcOccluded8(valid, impl_->scene.get(), &context, &packet);
        for (unsigned lane = 0; lane < lanes; ++lane) results[first + lane] = packet.tfar[lane] < 0;
    });
}

void RayScene::occluded(std::span<const Vec3f> origins, Vec3f direction, std::span<std::uint8_t> results) const {
    assert(origins.size() == results.size());
    RTCIntersectContext context = makeContext(true);
    RTCRay8 packet;
    for (unsigned lane = 0; lane < packet_size; ++lane) setLane(packet, lane, {{}, direction});
    forEachPacket(origins.size(), [&](const int* valid, std::size_t first, unsigned lanes) {
        for (unsigned lane = 0; lane < lanes; ++lane) {
            const Vec3f& origin = origins[first + lane];
            packet.org_x[lane] = origin.x, packet.org_y[lane] = origin.y, packet.org_z[lane] = origin.z;
            packet.tfar[lane] = std::numeric_limits<float>::infinity();
        }
        rtcOccluded8(valid, impl_->scene.get(), &context, &packet);
        for (unsigned lane = 0; lane < lanes; ++lane) results[first + lane] = packet.tfar[lane] < 0;
    });
}

float RayScene::extent() const { return impl_->extent; }

Vec3f RayScene::offsetOrigin(Vec3f position, Vec3f geometric_normal) const {
    // [WachterBinder2019] with its scene of size 1 scaled to the extent: the rounding of a point on a triangle is
    // that of the triangle's largest coordinates, so near 0 the offset must not shrink with the coordinate.
    const float near_zero = impl_->extent / 32;
    const float small_offset = impl_->extent / 65536;
    const auto moved = [&](float p, float n) {
        if (std::abs(p) < near_zero) return p + small_offset * n;
        const int ulps = static_cast<int>(256 * n);
        return std::bit_cast<float>(std::bit_cast<int>(p) + (p < 0 ? -ulps : ulps));
    };
    return {moved(position.x, geometric_normal.x), moved(position.y, geometric_normal.y),
            moved(position.z, geometric_normal.z)};
}

}  // namespace searchlight
