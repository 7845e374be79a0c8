#include "base/large_pages.h"

#include <sys/mman.h>

#include <cstdlib>
#include <limits>
#include <new>

namespace searchlight {

void* allocateLargePages(std::size_t count, std::size_t size) {
    constexpr std::size_t page = std::size_t{2} << 20, line = 64;
    if (count > (std::numeric_limits<std::size_t>::max() - page) / size) throw std::bad_alloc();
    const std::size_t bytes = count * size, boundary = bytes >= page ? page : line;
    const std::size_t rounded = (bytes + boundary - 1) / boundary * boundary;
    void* const memory = std::aligned_alloc(boundary, rounded);
    if (!memory) throw std::bad_alloc();
    // Advice: where it is not taken, the pages are small.
    if (boundary == page) madvise(memory, rounded, MADV_HUGEPAGE);
    return memory;
}

void freeLargePages(void* memory) { std::free(memory); }

}  // namespace searchlight
