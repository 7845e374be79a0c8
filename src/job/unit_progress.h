// Progress of work that consists of jobs: what each of them says about itself is not passed on.
#pragma once

#include <atomic>
#include <string>

#include "base/observer.h"

namespace searchlight {

class UnitProgress : public Observer {
public:
    /// `total` units ("frames", "cells") are to come. `observer` outlives this.
    UnitProgress(Observer& observer, std::string unit, std::uint64_t total)
        : observer_(observer), unit_(std::move(unit)), total_(total) {
        say();
    }

    /// One more is done.
    void finish() {
        ++done_;
        say();
    }

    // A sign of life: the time that is left is reckoned anew.
    void progress(std::string_view, std::uint64_t, std::uint64_t, std::string_view) override { say(); }
    void log(LogLevel level, std::string_view message) override { observer_.log(level, message); }
    bool cancelled() const override { return observer_.cancelled(); }

private:
    void say() { observer_.progress(unit_, done_, total_, unit_); }

    Observer& observer_;
    const std::string unit_;
    std::atomic<std::uint64_t> done_ = 0;
    const std::uint64_t total_;
};

}  // namespace searchlight
