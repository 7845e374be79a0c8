// Flights of many walks side by side, and where they meet a surface: what lanes hand to a body and take back.
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>

namespace searchlight {

/// Straight flights, mm. Up to a vector behind the last one may be read.
struct Flights {
    static constexpr std::size_t kMost = 256, kRoom = kMost + 16;

    alignas(64) float x[kRoom] = {}, y[kRoom] = {}, z[kRoom] = {};     ///< where they begin
    alignas(64) float dx[kRoom] = {}, dy[kRoom] = {}, dz[kRoom] = {};  ///< to the end of what is to be tested
    alignas(64) float begin[kRoom] = {};  ///< of that, the part that is known to meet nothing
    std::size_t count = 0;
};

/// The nearest hits of those flights that meet something, in their order.
struct FlightHits {
    static constexpr std::size_t kRoom = Flights::kRoom;

    alignas(64) std::int32_t flight[kRoom] = {};
    alignas(64) std::int32_t triangle[kRoom] = {};
    alignas(64) float u[kRoom] = {}, v[kRoom] = {};                    ///< barycentric, as RayHit has them
    alignas(64) float nx[kRoom] = {}, ny[kRoom] = {}, nz[kRoom] = {};  ///< outward normal, unit
    alignas(64) float x[kRoom] = {}, y[kRoom] = {}, z[kRoom] = {};     ///< position, mm
    alignas(64) float inside_x[kRoom] = {}, inside_y[kRoom] = {}, inside_z[kRoom] = {};  ///< moved inwards
    std::size_t count = 0;
    /// Flights that met the surface from outside without having left.
    std::int32_t lost[Flights::kMost] = {};
    std::size_t lost_count = 0;

    /// Puts one hit in the place of another.
    void move(std::size_t from, std::size_t to) {
        flight[to] = flight[from], triangle[to] = triangle[from];
        for (float* of : {u, v, nx, ny, nz, x, y, z, inside_x, inside_y, inside_z}) of[to] = of[from];
    }
};

}  // namespace searchlight
