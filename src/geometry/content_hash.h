// A name for what a shape is made of, so that what was computed from it can be found again.
#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "scene/mesh.h"
#include "scene/point_cloud.h"

namespace searchlight {

/// 128 bits that change with every bit taken; not meant against forgery.
class ContentHash {
public:
    void take(std::uint64_t word) {
        a_ = mix(a_ ^ word);
        b_ = mix(b_ + 0x9E3779B97F4A7C15u + std::rotl(word, 32));
    }
    void take(double value) { take(std::bit_cast<std::uint64_t>(value)); }
    void take(std::string_view bytes);
    template <class T>
    void takeList(const std::vector<T>& list) {
        take(static_cast<std::uint64_t>(list.size()));
        take(std::string_view(reinterpret_cast<const char*>(list.data()), list.size() * sizeof(T)));
    }

    /// 32 hexadecimal digits.
    std::string text() const;

private:
    // The finalizer of [Steele2014]: a bijection.
    static std::uint64_t mix(std::uint64_t z) {
        z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
        z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
        return z ^ (z >> 31);
    }

    std::uint64_t a_ = 0x243F6A8885A308D3u, b_ = 0x13198A2E03707344u;  // digits of pi
};

/// Positions, normals, uvs and triangles; positions, normals and areas.
std::string contentHash(const Mesh& mesh);
std::string contentHash(const PointCloud& cloud);

}  // namespace searchlight
