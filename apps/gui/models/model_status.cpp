#include "gui/models/model_status.h"

#include <cstring>

namespace searchlight::gui {

ModelStatus& ModelStatus::of(Workspace& workspace) {
    auto* known = workspace.findChild<ModelStatus*>(QString(), Qt::FindDirectChildrenOnly);
    return known ? *known : *new ModelStatus(&workspace);
}

void ModelStatus::set(const std::string& id, std::optional<Error> problem) {
    const auto known = problems_.find(id);
    if (!problem) {
        if (known == problems_.end()) return;
        problems_.erase(known);
    } else if (known != problems_.end()) {
        if (std::strcmp(known->second.what(), problem->what()) == 0) return;
        known->second = *problem;
    } else {
        problems_.emplace(id, *problem);
    }
    emit changed();
}

const Error* ModelStatus::problem(const std::string& id) const {
    const auto known = problems_.find(id);
    return known == problems_.end() ? nullptr : &known->second;
}

}  // namespace searchlight::gui
