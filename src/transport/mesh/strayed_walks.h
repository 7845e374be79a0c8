// Walks that left a mesh without crossing its surface, as they do where it crosses or folds onto itself.
#pragma once

#include <cstdint>

namespace searchlight {

/// Counts them in one job. Of walks in a mesh that bounds a body there are far fewer than one in 1e4, which bounds what
/// leaving them out changes.
class StrayedWalks {
public:
    /// Throws an input Error once there are so many that chance does not explain them: no need to walk on.
    void add(std::uint64_t strayed, std::uint64_t walks);

    /// Of a whole job: throws an input Error where they are more than one in 1e4.
    static void check(std::uint64_t strayed, std::uint64_t walks);

private:
    std::uint64_t strayed_ = 0, walks_ = 0;
};

}  // namespace searchlight
