#include "io/cloud_builder.h"

#include <utility>

namespace searchlight {

CloudBuilder::CloudBuilder(std::span<const CloudAttribute> attributes) {
    for (std::size_t i = 0; i < attributes.size(); ++i) {
        const auto& [name, size] = attributes[i];
        if (size == 3 && (name == "position" || name == "P") && !position_) position_ = i;
        if (size == 3 && (name == "normal" || name == "N") && !normal_) normal_ = i;
        const std::optional<AreaRule> rule = areaRule(name);
        if (size != 1 || !rule || (area_ && *rule >= rule_)) continue;
        area_ = i;
        rule_ = *rule;
    }
}

PointCloud CloudBuilder::finish() {
    finishCloud(cloud_);
    return std::move(cloud_);
}

}  // namespace searchlight
