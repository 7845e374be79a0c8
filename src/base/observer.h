// How long work speaks to whoever started it. The library never prints; it calls these.
#pragma once

#include <cstdint>
#include <string_view>

namespace searchlight {

enum class LogLevel { debug, info, warning };

/// All members may be called from any thread, so an implementation locks.
class Observer {
public:
    virtual ~Observer() = default;

    /// `done` of `total` units ("walks", "queries") of `task` are finished.
    virtual void progress(std::string_view task, std::uint64_t done, std::uint64_t total, std::string_view unit) {
        (void)task, (void)done, (void)total, (void)unit;
    }
    virtual void log(LogLevel level, std::string_view message) { (void)level, (void)message; }

    /// Polled between chunks of work; true makes the work throw interruptedError().
    virtual bool cancelled() const { return false; }
};

}  // namespace searchlight
