#include "progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/ranks.h"

namespace searchlight {

namespace {

std::string duration(double seconds) {
    if (seconds < 60) return fmt::format("{:.0f} s", seconds);
    if (seconds < 3600) return fmt::format("{:.0f} min {:02.0f} s", std::floor(seconds / 60), std::fmod(seconds, 60));
    return fmt::format("{:.1f} h", seconds / 3600);
}

std::string rate(double per_second) {
    if (per_second >= 1e6) return fmt::format("{:.1f} M", per_second / 1e6);
    if (per_second >= 1e3) return fmt::format("{:.1f} k", per_second / 1e3);
    return fmt::format("{:.1f} ", per_second);
}

}  // namespace

TerminalObserver::TerminalObserver(const std::atomic<bool>& interrupted)
    : interrupted_(interrupted), terminal_(rank() == 0 && isatty(STDERR_FILENO) != 0) {}

TerminalObserver::~TerminalObserver() { finish(); }

void TerminalObserver::progress(std::string_view task, std::uint64_t done, std::uint64_t total, std::string_view unit) {
    // mpirun's processes write into its pipe: there a line now and then, from one of them, says how far all are.
    const bool line = !terminal_ && rank() == 0 && rankCount() > 1;
    if ((!terminal_ && !line) || total == 0) return;
    const std::lock_guard lock(mutex_);
    const Clock::time_point now = Clock::now();
    if (task != task_ || done < start_done_) {
        task_ = task;
        start_ = shown_ = now;
        start_done_ = done;
        return;
    }
    using namespace std::chrono_literals;
    if (now - shown_ < (line ? 10s : 100ms)) return;
    shown_ = now;
    const double elapsed = std::chrono::duration<double>(now - start_).count();
    const double speed = static_cast<double>(done - start_done_) / elapsed;
    const double left = static_cast<double>(total - std::min(done, total)) / std::max(speed, 1e-9);
    if (line) {
        fmt::print(stderr, "{} {:.0f} %, {}{}/s, {} left\n", task,
                   100.0 * static_cast<double>(done) / static_cast<double>(total), rate(speed), unit, duration(left));
        return;
    }
    const double fraction = std::min(1.0, static_cast<double>(done) / static_cast<double>(total));
    constexpr int width = 28;
    const int filled = static_cast<int>(fraction * width);
    clearLine();
    fmt::print(stderr, "{} [{:#<{}}{:-<{}}] {:3.0f} %", task, "", filled, "", width - filled, 100 * fraction);
    // Until something is done, nothing is known of the rest.
    if (done > start_done_) fmt::print(stderr, "  {}{}/s  {} left", rate(speed), unit, duration(left));
    std::fflush(stderr);
    bar_ = true;
}

void TerminalObserver::log(LogLevel level, std::string_view message) {
    if (level == LogLevel::debug || (level == LogLevel::info && !terminal_) || rank() != 0) return;
    const std::lock_guard lock(mutex_);
    clearLine();
    fmt::print(stderr, "{}{}\n", level == LogLevel::warning ? "warning: " : "", message);
}

void TerminalObserver::finish() {
    const std::lock_guard lock(mutex_);
    clearLine();
}

void TerminalObserver::clearLine() {
    if (bar_) fmt::print(stderr, "\r\033[K");
    bar_ = false;
}

}  // namespace searchlight
