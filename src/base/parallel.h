// The only door to threads.
#pragma once

#include <cstddef>
#include <functional>

namespace searchlight {

/// Hardware threads that parallel work uses by default.
int hardwareThreads();

/// Calls body(i) for i in [0, count) on up to `threads` threads (0: all). The first exception is rethrown here.
void parallelFor(std::size_t count, int threads, const std::function<void(std::size_t)>& body);

}  // namespace searchlight
