// The ways to OpenGL on this machine, through EGL. Internal to this folder.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace searchlight::gl {

struct Platform {
    std::string name;        ///< "surfaceless", "device N"
    void* device = nullptr;  ///< EGLDeviceEXT; null: surfaceless
    bool hardware = false;   ///< a device that is not Mesa's software rasteriser
};

/// Every platform without a window. Throws a device Error when EGL or OpenGL is not installed.
std::vector<Platform> platforms();

/// The initialised display of a platform; it lives as long as the process. Throws a device Error.
void* openDisplay(const Platform& platform);

/// A 4.5 core debug context that reports resets where the driver can. Throws a device Error.
void* openContext(void* display);

}  // namespace searchlight::gl
