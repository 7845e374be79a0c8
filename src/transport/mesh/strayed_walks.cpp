#include "transport/mesh/strayed_walks.h"

#include <fmt/format.h>

#include "base/error.h"

namespace searchlight {

namespace {

constexpr double kMost = 1e-4;  // of all walks: far above what rounding does

[[noreturn]] void refuse(std::uint64_t strayed, std::uint64_t walks) {
    throw inputError(fmt::format("{} of {} walks left the mesh without crossing its surface", strayed, walks),
                     "a mesh that crosses or folds onto itself does not bound a body");
}

}  // namespace

void StrayedWalks::add(std::uint64_t strayed, std::uint64_t walks) {
    strayed_ += strayed;
    walks_ += walks;
    if (static_cast<double>(strayed_) > 2 * kMost * static_cast<double>(walks_) + 12) refuse(strayed_, walks_);
}

void StrayedWalks::check(std::uint64_t strayed, std::uint64_t walks) {
    if (static_cast<double>(strayed) > kMost * static_cast<double>(walks) + 3) refuse(strayed, walks);
}

}  // namespace searchlight
