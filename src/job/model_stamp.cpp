#include "job/model_stamp.h"

#include <fmt/format.h>

#include <filesystem>

#include "model/sum_model.h"

namespace searchlight {

std::string modelStamp(const std::string& id) {
    std::string stamp;
    for (const std::string& part : partNames(id)) {
        std::error_code failed;
        const auto time = std::filesystem::last_write_time(part, failed);
        if (failed) continue;
        const auto size = std::filesystem::file_size(part, failed);
        stamp += fmt::format("{} {} {};", part, time.time_since_epoch().count(), failed ? 0 : size);
    }
    return stamp;
}

}  // namespace searchlight
