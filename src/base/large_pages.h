// Memory for tables that are read all over: in pages of 2 MiB where the system has them, since finding the page of an
// address takes longer than the read itself when a table has many.
#pragma once

#include <cstddef>

namespace searchlight {

/// Memory for so many of a size, on a boundary of 64, in large pages when it fills one. Throws std::bad_alloc.
void* allocateLargePages(std::size_t count, std::size_t size);
void freeLargePages(void* memory);

/// For std::vector.
template <class T>
struct LargePages {
    static_assert(alignof(T) <= 64);
    using value_type = T;

    LargePages() = default;
    template <class U>
    LargePages(const LargePages<U>&) {}

    T* allocate(std::size_t n) { return static_cast<T*>(allocateLargePages(n, sizeof(T))); }
    void deallocate(T* memory, std::size_t) { freeLargePages(memory); }
    template <class U>
    bool operator==(const LargePages<U>&) const {
        return true;
    }
};

}  // namespace searchlight
