#include "gui/material/model_parameters.h"

#include <QLabel>
#include <QVBoxLayout>

#include "base/error.h"
#include "gui/window/theme.h"
#include "model/model.h"

namespace searchlight::gui {

ModelParameters::ModelParameters(Desk& desk, QWidget* parent) : QWidget(parent), desk_(desk) {
    column_ = new QVBoxLayout(this);
    column_->setContentsMargins(0, 0, 0, 0);
    column_->setSpacing(Space::xs);
    title_ = new QLabel(this);
    title_->setProperty("role", "heading");
    title_->setWordWrap(true);
    column_->addWidget(title_);
    connect(&desk_.workspace, &Workspace::changed, this, [this](Change change) {
        if (change.any({Part::models, Part::active})) rebuild();
        if (change.any({Part::models, Part::active, Part::parameters})) show();
    });
    connect(&desk_.workspace, &Workspace::modelFileChanged, this, [this](const QString&) {
        built_for_.clear();
        rebuild();
        show();
    });
    rebuild();
    show();
}

void ModelParameters::rebuild() {
    const std::string& id = desk_.workspace.state().activeModel().model.id;
    if (id == built_for_) return;
    built_for_ = id;
    // A widget may be in the middle of telling of its edit.
    for (ParamWidget* widget : widgets_) widget->deleteLater();
    widgets_.clear();
    try {
        const Model model = loadModel(id);
        title_->setText(QString::fromStdString(model.file.title));
        title_->setToolTip(QString::fromStdString(id));
        for (const Param& param : model.file.parameters) {
            auto* widget = new ParamWidget(desk_.theme, param, this);
            column_->addWidget(widget);
            widgets_.push_back(widget);
            const QString text = QString::fromStdString(param.name);
            connect(widget, &ParamWidget::edited, this, [this, name = param.name, text](const ParamValue& value) {
                desk_.workspace.edit(text, "model." + text, [&](State& state) {
                    state.models[static_cast<std::size_t>(state.active)].model.parameters[name] = value;
                });
            });
            connect(widget, &ParamWidget::finished, &desk_.workspace, &Workspace::endGesture);
        }
    } catch (const Error& error) {
        title_->setText(QString::fromUtf8(error.what()));
    }
    setVisible(!widgets_.empty());
}

void ModelParameters::show() {
    const ParamValues& values = desk_.workspace.state().activeModel().model.parameters;
    for (ParamWidget* widget : widgets_) {
        try {
            // A file may hold a value in another shape: 1 for 1.0, one number for three.
            const ParamValue value = parseValue(widget->param(), valueText(valueOf(widget->param(), values)));
            if (value != widget->value()) widget->setValue(value);
        } catch (const Error&) {
            widget->setValue(widget->param().value);
        }
    }
}

}  // namespace searchlight::gui
