// Progress on a terminal: a bar, the rate, the time left. In a pipe: silence, but for warnings.
#pragma once

#include <atomic>
#include <chrono>
#include <mutex>
#include <string>

#include "base/observer.h"

namespace searchlight {

class TerminalObserver : public Observer {
public:
    /// `interrupted` is polled by cancelled().
    explicit TerminalObserver(const std::atomic<bool>& interrupted);
    ~TerminalObserver() override;

    void progress(std::string_view task, std::uint64_t done, std::uint64_t total, std::string_view unit) override;
    void log(LogLevel level, std::string_view message) override;
    bool cancelled() const override { return interrupted_; }

    /// Clears the bar.
    void finish();

private:
    void clearLine();

    using Clock = std::chrono::steady_clock;
    const std::atomic<bool>& interrupted_;
    const bool terminal_;
    std::mutex mutex_;
    std::string task_;
    Clock::time_point start_, shown_;
    std::uint64_t start_done_ = 0;
    bool bar_ = false;
};

}  // namespace searchlight
