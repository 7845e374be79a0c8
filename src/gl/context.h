// OpenGL 4.5 core without a window. GL itself stays inside this folder: no header here includes it.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace searchlight::gl {

struct ContextInfo {
    std::string vendor, renderer, version, glsl_version;
    std::string platform;   ///< "surfaceless", or "device N" as EGL counts them
    bool hardware = false;  ///< false: the driver computes on the CPU
};

/// One OpenGL context, made through EGL. Any thread may make it and any thread may use it, but only one at a time;
/// what is made in it (Buffer, Program) is used under the same rule and dies before it.
class Context {
public:
    /// `platform`: "surfaceless", "device" (the first hardware device), a device number, or empty: what the
    /// environment variable SEARCHLIGHT_GL says, else hardware devices first, then surfaceless.
    /// Throws a device Error that names the missing piece.
    explicit Context(std::string_view platform = {});
    ~Context();
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    const ContextInfo& info() const { return info_; }

    /// Makes this the calling thread's context; costs nothing when it is already. Throws a device Error when another
    /// thread holds it.
    void makeCurrent();

    /// The same without the Error: false when it did not work.
    bool tryMakeCurrent() noexcept;

    /// Gives the context up on this thread, so that another may take it.
    void release();

    /// Throws a device Error when the driver reported an error since the last checkpoint, or the context is lost.
    void checkpoint();

    /// Waits until the device has done everything so far, then reads its clock in ms. Only differences mean something.
    double finish();

    /// The GPU was reset or taken away: everything in this context is gone, a new one must be made.
    bool lost();

    /// From now on it is lost(): what a GPU that is reset does to it.
    void abandon() { lost_ = true; }

private:
    struct Messages;

    void* display_ = nullptr;
    void* context_ = nullptr;
    ContextInfo info_;
    std::unique_ptr<Messages> messages_;
    bool lost_ = false;
};

/// One way to OpenGL that was tried.
struct DeviceReport {
    std::string platform;  ///< as in ContextInfo, or "EGL" when the search ended before any platform
    bool works = false;
    ContextInfo info;     ///< when it works
    std::string problem;  ///< when it does not
    std::string hint;     ///< what mends it
};

/// Tries every platform and device of this machine; never throws for what is missing.
std::vector<DeviceReport> probe();

}  // namespace searchlight::gl
