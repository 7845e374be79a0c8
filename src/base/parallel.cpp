#include "base/parallel.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>

namespace searchlight {

int hardwareThreads() { return tbb::this_task_arena::max_concurrency(); }

void parallelFor(std::size_t count, int threads, const std::function<void(std::size_t)>& body) {
    const auto loop = [&] { tbb::parallel_for(std::size_t{0}, count, body, tbb::simple_partitioner{}); };
    if (threads <= 0)
        loop();
    else
        tbb::task_arena(std::min(threads, hardwareThreads())).execute(loop);
}

}  // namespace searchlight
