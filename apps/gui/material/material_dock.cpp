#include "gui/material/material_dock.h"

#include <QCheckBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QScrollArea>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "gui/material/material_edit.h"
#include "gui/material/model_parameters.h"
#include "gui/material/preset_list.h"
#include "gui/widgets/number_slider.h"
#include "gui/widgets/segments.h"
#include "gui/window/theme.h"

namespace searchlight::gui {

namespace {

constexpr double unlimited = 1e30;
const char* const channel_colors[] = {"#d9534f", "#4caf6d", "#4c8fd9"};

QLabel* heading(const QString& text, QWidget* parent) {
    auto* label = new QLabel(text, parent);
    label->setProperty("role", "heading");
    return label;
}

QFrame* rule(QWidget* parent) {
    auto* line = new QFrame(parent);
    line->setObjectName("rule");
    return line;
}

}  // namespace

MaterialDock::MaterialDock(Desk& desk, QWidget* parent) : QWidget(parent), desk_(desk) {
    auto* column = new QVBoxLayout(this);
    column->setContentsMargins(Space::m, Space::m, Space::m, Space::m);
    column->setSpacing(Space::s);

    presets_ = new PresetList(desk_, this);
    column->addWidget(presets_);
    connect(presets_, &PresetList::chosen, this, [this](const QString& id) {
        edit(tr("Material"), {}, [&](SceneMaterial& material) {
            const double scale = material.scale;
            material = {};
            material.id = id.toStdString();
            material.scale = scale;
        });
    });

    scope_ = new Segments(tr("Applies to"), {tr("All models"), tr("This model only")}, this);
    scope_->setToolTips({tr("One material for all models"), tr("The active model has a material of its own")});
    column->addWidget(scope_);
    connect(scope_, &Segments::chosen, this, [this](int chosen) {
        desk_.workspace.edit(chosen == 1 ? tr("A material of its own") : tr("One material for all"), {},
                             [&](State& state) {
                                 ModelSlot& slot = state.models[static_cast<std::size_t>(state.active)];
                                 if (chosen == 1)
                                     slot.material = state.scene.material;
                                 else
                                     slot.material.reset();
                             });
    });

    column->addWidget(rule(this));
    form_ = new Segments(tr("Described by"), {tr("\u03c3a and \u03c3s"), tr("Rdr and ld")}, this);
    form_->setToolTips({tr("Absorption and scattering coefficients, 1/mm"),
                        tr("Total diffuse reflectance and diffuse mean free path, inverted by the active model")});
    column->addWidget(form_);
    connect(form_, &Segments::chosen, this, [this](int chosen) { setParametrisation(chosen == 1); });

    together_ = new QCheckBox(tr("Move R, G, B together"), this);
    together_->setToolTip(tr("One slider keeps the ratio of the three channels"));
    groups_[0] = makeGroup(tr("Absorption \u03c3a"), tr("absorption coefficient"), "1/mm", 1e-4, 100, unlimited,
                           &SceneMaterial::sigma_a);
    groups_[1] = makeGroup(tr("Scattering \u03c3s"), tr("scattering coefficient, not reduced"), "1/mm", 1e-3, 1000,
                           unlimited, &SceneMaterial::sigma_s);
    groups_[2] = makeGroup(tr("Reflectance Rdr"), tr("total diffuse reflectance"), {}, 0, 1, 1, &SceneMaterial::Rdr);
    groups_[3] = makeGroup(tr("Mean free path ld"), tr("diffuse mean free path"), "mm", 1e-2, 100, unlimited,
                           &SceneMaterial::ld);
    column->addWidget(together_);
    problem_ = new QLabel(this);
    problem_->setProperty("role", "error");
    problem_->setWordWrap(true);
    problem_->setAccessibleName(tr("Why the material is impossible"));
    problem_->hide();
    column->addWidget(problem_);

    column->addWidget(rule(this));
    g_ = makeNumber(tr("Anisotropy g"), tr("mean cosine of the phase function, all channels"), {}, -0.999, 0.999, -0.99,
                    0.99, false);
    connect(g_, &NumberSlider::edited, this,
            [this](double value) { edit(tr("Anisotropy"), "material.g", [&](SceneMaterial& m) { m.g = {value}; }); });
    eta_ = makeNumber(tr("Index \u03b7"), tr("refractive index, inside over outside"), {}, 0.25, 4, 1, 2, false);
    connect(eta_, &NumberSlider::edited, this, [this](double value) {
        edit(tr("Refractive index"), "material.eta", [&](SceneMaterial& m) { m.eta = value; });
    });
    stretch_ = makeNumber(tr("Thin or dense"), tr("lengths of the medium times this, so coefficients divided by it"),
                          "\u00d7", 1e-6, 1e6, 0.01, 100, true);
    connect(stretch_, &NumberSlider::edited, this, [this](double value) {
        desk_.workspace.edit(tr("Scale of the medium"), "material.scale", [&](State& state) {
            ModelSlot& slot = state.models[static_cast<std::size_t>(state.active)];
            (slot.material ? *slot.material : state.scene.material).scale = value;
        });
    });
    size_ = makeNumber(tr("Object size"), tr("length of the object's longest side"), "mm", 1e-6, 1e6, 1, 1000, true);
    connect(size_, &NumberSlider::edited, this, [this](double value) {
        desk_.workspace.edit(tr("Object size"), "scene.scale", [&](State& state) { state.scene.scale = value; });
    });
    for (NumberSlider* each : {g_, eta_, stretch_, size_})
        connect(each, &NumberSlider::finished, &desk_.workspace, &Workspace::endGesture);

    facts_ = new QLabel(this);
    facts_->setProperty("role", "muted");
    facts_->setWordWrap(true);
    facts_->setFont(desk_.theme.smallFont());
    facts_->setAccessibleName(tr("What follows from the material"));
    column->addWidget(facts_);
    column->addWidget(rule(this));
    column->addWidget(new ModelParameters(desk_, this));
    column->addStretch(1);

    connect(&desk_.workspace, &Workspace::changed, this, [this](Change change) {
        if (change.any({Part::material, Part::models, Part::active, Part::object, Part::parameters})) refresh();
    });
    refresh();
}

MaterialDock::Group MaterialDock::makeGroup(const QString& title, const QString& doc, const QString& unit, double low,
                                            double high, double max, std::vector<double> SceneMaterial::*member) {
    Group group;
    group.member = member;
    group.box = new QWidget(this);
    auto* column = new QVBoxLayout(group.box);
    column->setContentsMargins(0, Space::xs, 0, 0);
    column->setSpacing(2);
    auto* head = new QHBoxLayout;
    head->setSpacing(Space::s);
    QLabel* text = heading(title, group.box);
    text->setToolTip(doc);
    head->addWidget(text);
    head->addStretch(1);
    group.swatch = new QLabel(group.box);
    group.swatch->setFixedSize(36, 14);
    group.swatch->setToolTip(tr("Its colour, at one lightness"));
    group.swatch->setAccessibleName(tr("Colour of %1").arg(doc));
    head->addWidget(group.swatch);
    column->addLayout(head);
    const bool logarithmic = low > 0;
    static const char* const names[] = {"R", "G", "B"};
    for (int c = 0; c < 3; ++c) {
        const NumberRange range{.min = 0,
                                .max = max,
                                .low = low,
                                .high = high,
                                .logarithmic = logarithmic,
                                .exclusive = member == &SceneMaterial::Rdr || member == &SceneMaterial::ld};
        auto* slider = new NumberSlider(desk_.theme, names[c], doc + " " + names[c], unit, range,
                                        QColor(channel_colors[c]), group.box);
        slider->setObjectName(QString("%1.%2").arg(doc, names[c]));
        group.sliders[static_cast<std::size_t>(c)] = slider;
        column->addWidget(slider);
        connect(slider, &NumberSlider::edited, this, [this, member, c, title](double value) {
            for (const Group& each : groups_)
                if (each.member == member) channelEdited(each, c, value, title);
        });
        connect(slider, &NumberSlider::finished, &desk_.workspace, &Workspace::endGesture);
    }
    layout()->addWidget(group.box);
    return group;
}

NumberSlider* MaterialDock::makeNumber(const QString& title, const QString& doc, const QString& unit, double min,
                                       double max, double low, double high, bool logarithmic) {
    const NumberRange range{.min = min, .max = max, .low = low, .high = high, .logarithmic = logarithmic};
    auto* slider = new NumberSlider(desk_.theme, title, doc, unit, range, {}, this);
    layout()->addWidget(slider);
    return slider;
}

const SceneMaterial& MaterialDock::material() const {
    const State& state = desk_.workspace.state();
    const auto& own = state.activeModel().material;
    return own ? *own : state.scene.material;
}

void MaterialDock::edit(const QString& text, const QString& gesture,
                        const std::function<void(SceneMaterial&)>& change) {
    desk_.workspace.edit(text, gesture, [&](State& state) {
        ModelSlot& slot = state.models[static_cast<std::size_t>(state.active)];
        SceneMaterial& material = slot.material ? *slot.material : state.scene.material;
        if (!gesture.isEmpty()) material = spelledOut(material);
        change(material);
    });
}

void MaterialDock::channelEdited(const Group& group, int channel, double value, const QString& title) {
    const auto member = group.member;
    // The sliders of the other description are hidden, and have nothing to say.
    if ((spelledOut(material()).*member).empty()) return;
    edit(title, title, [&](SceneMaterial& material) {
        std::vector<double>& list = material.*member;
        if (list.size() != 3) list.assign(3, list.empty() ? value : list.front());
        const double before = list[static_cast<std::size_t>(channel)];
        const bool scale = together_->isChecked() && before > 0 && value > 0;
        const double most = member == &SceneMaterial::Rdr ? 1 : unlimited;
        if (scale)
            for (double& each : list) each = std::min(each * value / before, most);
        list[static_cast<std::size_t>(channel)] = value;
    });
}

QWidget* makeMaterialDock(Desk& desk) {
    auto* area = new QScrollArea;
    area->setObjectName("panel");
    area->setWidgetResizable(true);
    area->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
    area->setMinimumWidth(300);
    area->setWidget(new MaterialDock(desk));
    return area;
}

}  // namespace searchlight::gui
