// Widgets for a section of the scene's format: its table of fields (scene/scene_fields.h) becomes rows.
#pragma once

#include <QVBoxLayout>
#include <functional>

#include "gui/widgets/param_widget.h"
#include "gui/window/desk.h"
#include "gui/window/theme.h"
#include "scene/scene_fields.h"

namespace searchlight::gui {

/// The member of a field as a Param's value, and back.
template <class T>
ParamValue fieldValue(const scene_format::Field<T>& field, const T& object) {
    return std::visit(
        [&](auto member) -> ParamValue {
            using Value = std::decay_t<decltype(object.*member)>;
            if constexpr (std::is_same_v<Value, Vec3>)
                return std::vector<double>{(object.*member).x, (object.*member).y, (object.*member).z};
            else
                return object.*member;
        },
        field.member);
}

/// False, and nothing is changed, for a list that is no direction or position.
template <class T>
bool setField(const scene_format::Field<T>& field, T& object, const ParamValue& value) {
    return std::visit(
        [&](auto member) {
            using Value = std::decay_t<decltype(object.*member)>;
            if constexpr (std::is_same_v<Value, Vec3>) {
                const auto& list = std::get<std::vector<double>>(value);
                if (list.size() != 3) return false;
                object.*member = {list[0], list[1], list[2]};
            } else {
                object.*member = std::get<Value>(value);
            }
            return true;
        },
        field.member);
}

/// Appends a row per field to `column`. `object` gives the current values, null when there is none any more; `edit`
/// makes a change of one an edit of the workspace.
template <class T>
std::vector<std::function<void()>> addFields(
    Desk& desk, QVBoxLayout* column, const std::vector<scene_format::Field<T>>& fields,
    const std::function<const T*()>& object,
    const std::function<void(const QString& name, const std::function<void(T&)>& change)>& edit) {
    std::vector<std::function<void()>> refresh;
    for (const scene_format::Field<T>& field : fields) {
        auto* widget = new ParamWidget(desk.theme, field.param);
        column->addWidget(widget);
        const QString name = labelOf(field.param);
        QObject::connect(widget, &ParamWidget::edited, widget, [field, edit, name](const ParamValue& value) {
            edit(name, [&](T& changed) { setField(field, changed, value); });
        });
        QObject::connect(widget, &ParamWidget::finished, &desk.workspace, &Workspace::endGesture);
        refresh.push_back([widget, field, object] {
            if (const T* now = object()) widget->setValue(fieldValue(field, *now));
        });
    }
    return refresh;
}

}  // namespace searchlight::gui
