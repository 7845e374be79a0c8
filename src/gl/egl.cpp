#include "gl/egl.h"

#include <dlfcn.h>
#include <epoxy/egl.h>
#include <fmt/format.h>

#include <array>

#include "base/error.h"
#include "base/text.h"

namespace searchlight::gl {

namespace {

bool canLoad(const char* library) {
    void* handle = dlopen(library, RTLD_LAZY | RTLD_LOCAL);
    if (handle) dlclose(handle);
    return handle != nullptr;
}

// epoxy ends the process when a library or a function is missing, so both are asked for first.
void requireLibraries() {
    if (!canLoad("libEGL.so.1"))
        throw deviceError("OpenGL cannot be reached: libEGL.so.1 is not installed",
                          "apt install libegl1 libgl1-mesa-dri libopengl0");
    if (!canLoad("libOpenGL.so.0") && !canLoad("libGL.so.1"))
        throw deviceError("OpenGL cannot be reached: neither libOpenGL.so.0 nor libGL.so.1 is installed",
                          "apt install libopengl0");
}

bool lists(const char* extensions, std::string_view name) {
    if (!extensions) return false;
    for (const std::string_view extension : split(extensions, ' '))
        if (extension == name) return true;
    return false;
}

// The display's client extensions; null when EGL has no vendor library behind it.
const char* clientExtensions() { return eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS); }

std::string eglErrorText() {
    switch (const EGLint code = eglGetError()) {
        case EGL_NOT_INITIALIZED: return "the driver did not start";
        case EGL_BAD_ALLOC: return "out of memory";
        case EGL_BAD_MATCH: return "not supported by the driver";
        default: return fmt::format("EGL error 0x{:x}", code);
    }
}

}  // namespace

std::vector<Platform> platforms() {
    requireLibraries();
    const char* extensions = clientExtensions();
    std::vector<Platform> found;
    if (lists(extensions, "EGL_EXT_platform_device") &&
        (lists(extensions, "EGL_EXT_device_enumeration") || lists(extensions, "EGL_EXT_device_base"))) {
        std::array<EGLDeviceEXT, 64> devices;
        EGLint count = 0;
        if (!eglQueryDevicesEXT(static_cast<EGLint>(devices.size()), devices.data(), &count)) count = 0;
        for (int i = 0; i < count; ++i) {
            const bool software =
                lists(eglQueryDeviceStringEXT(devices[i], EGL_EXTENSIONS), "EGL_MESA_device_software");
            found.push_back({fmt::format("device {}", i), devices[i], !software});
        }
    }
    if (lists(extensions, "EGL_MESA_platform_surfaceless")) found.push_back({"surfaceless", nullptr, false});
    if (found.empty())
        throw deviceError("OpenGL cannot be reached: EGL has no driver that works without a window",
                          "apt install libegl1 libgl1-mesa-dri");
    return found;
}

void* openDisplay(const Platform& platform) {
    const EGLenum kind = platform.device ? EGL_PLATFORM_DEVICE_EXT : EGL_PLATFORM_SURFACELESS_MESA;
    const EGLDisplay display = eglGetPlatformDisplayEXT(kind, platform.device, nullptr);
    if (display == EGL_NO_DISPLAY || !eglInitialize(display, nullptr, nullptr))
        throw deviceError(fmt::format("OpenGL on {}: {}", platform.name, eglErrorText()),
                          platform.hardware ? "is this user allowed to open /dev/dri?" : "apt install libgl1-mesa-dri");
    return display;
}

void* openContext(void* display) {
    const char* extensions = eglQueryString(display, EGL_EXTENSIONS);
    if (!lists(extensions, "EGL_KHR_create_context") || !lists(extensions, "EGL_KHR_surfaceless_context") ||
        !lists(extensions, "EGL_KHR_no_config_context"))
        throw deviceError("the driver has no OpenGL context without a window", "apt install libgl1-mesa-dri");
    eglBindAPI(EGL_OPENGL_API);
    // clang-format off
    std::vector<EGLint> attributes = {EGL_CONTEXT_MAJOR_VERSION_KHR, 4, EGL_CONTEXT_MINOR_VERSION_KHR, 5,
                                      EGL_CONTEXT_OPENGL_PROFILE_MASK_KHR, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT_KHR,
                                      EGL_CONTEXT_FLAGS_KHR, EGL_CONTEXT_OPENGL_DEBUG_BIT_KHR, EGL_NONE};
    // clang-format on
    const std::vector<EGLint> plain = attributes;
    if (lists(extensions, "EGL_EXT_create_context_robustness")) {
        attributes.back() = EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY_EXT;
        attributes.insert(attributes.end(), {EGL_LOSE_CONTEXT_ON_RESET_EXT, EGL_NONE});
    }
    // Some drivers list the extension for OpenGL ES alone.
    EGLContext context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes.data());
    if (context == EGL_NO_CONTEXT) context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, plain.data());
    if (context == EGL_NO_CONTEXT)
        throw deviceError("the driver has no OpenGL 4.5 core context: " + eglErrorText(),
                          "a newer driver, or SEARCHLIGHT_GL=surfaceless for Mesa's llvmpipe");
    return context;
}

}  // namespace searchlight::gl
