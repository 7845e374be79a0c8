#include "gui/lights/lights_dock.h"

#include <QCheckBox>
#include <QFileDialog>
#include <QFileInfo>
#include <QGridLayout>
#include <QLabel>
#include <QScrollArea>
#include <QSignalBlocker>
#include <QToolButton>
#include <QVBoxLayout>

#include "gui/lights/light_modes.h"
#include "gui/lights/section_form.h"
#include "gui/lights/thumbnail.h"
#include "gui/window/theme.h"

namespace searchlight::gui {

namespace {

QLabel* heading(const QString& text, QWidget* parent) {
    auto* label = new QLabel(text, parent);
    label->setProperty("role", "heading");
    return label;
}

// The light of that kind at that place; null when the list has another by now.
template <class T>
const T* lightAt(const Workspace& workspace, std::size_t index) {
    const std::vector<Light>& lights = workspace.state().scene.lights;
    return index < lights.size() ? std::get_if<T>(&lights[index]) : nullptr;
}

// What a card is built for: kind and picture.
std::string shapeOf(const std::vector<Light>& lights) {
    std::string text;
    for (const Light& light : lights) {
        text += std::to_string(light.index());
        if (const auto* directional = std::get_if<DirectionalLight>(&light)) text += directional->filter;
        if (const auto* environment = std::get_if<EnvironmentLight>(&light)) text += environment->path;
        text += '\n';
    }
    return text;
}

}  // namespace

LightsDock::LightsDock(Desk& desk, QWidget* parent) : QWidget(parent), desk_(desk) {
    auto* column = new QVBoxLayout(this);
    column->setContentsMargins(Space::m, Space::m, Space::m, Space::m);
    column->setSpacing(Space::m);
    column->addWidget(makeModes());
    auto* holder = new QWidget(this);
    cards_ = new QVBoxLayout(holder);
    cards_->setContentsMargins(0, 0, 0, 0);
    cards_->setSpacing(Space::s);
    column->addWidget(holder);
    column->addWidget(makeSurroundings());
    column->addStretch(1);
    connect(&desk_.workspace, &Workspace::changed, this, [this](Change change) {
        if (change.has(Part::lights)) rebuild();
        if (change.any({Part::lights, Part::surround})) refresh();
    });
    rebuild();
    refresh();
}

QWidget* LightsDock::makeModes() {
    auto* box = new QWidget(this);
    auto* grid = new QGridLayout(box);
    grid->setContentsMargins(0, 0, 0, 0);
    grid->setSpacing(Space::xs);
    const auto modes = lightModes();
    for (std::size_t i = 0; i < modes.size(); ++i) {
        auto* button = new QToolButton(box);
        button->setToolButtonStyle(Qt::ToolButtonTextUnderIcon);
        button->setIconSize({28, 28});
        button->setText(tr(modes[i].title));
        button->setToolTip(tr(modes[i].doc));
        button->setAccessibleName(tr("Light: %1").arg(tr(modes[i].title)));
        button->setAccessibleDescription(tr(modes[i].doc));
        button->setCheckable(true);
        button->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
        button->setFocusPolicy(Qt::StrongFocus);
        const auto draw = [this, button, name = modes[i].icon] { button->setIcon(desk_.theme.icon(name)); };
        draw();
        connect(&desk_.theme, &Theme::changed, button, draw);
        connect(button, &QToolButton::clicked, this, [this, i] { choose(static_cast<int>(i)); });
        grid->addWidget(button, static_cast<int>(i) / 3, static_cast<int>(i) % 3);
        modes_.push_back(button);
    }
    return box;
}

void LightsDock::choose(int mode) {
    const LightMode& chosen = lightModes()[static_cast<std::size_t>(mode)];
    QString picture;
    if (chosen.needs) {
        // The picture of the environment that is there serves the other mode of an environment.
        const auto* environment = lightAt<EnvironmentLight>(desk_.workspace, 0);
        if (environment && mode >= 4)
            picture = QString::fromStdString(environment->path);
        else
            picture = askForPicture(tr(chosen.needs));
        if (picture.isEmpty()) return refresh();
    }
    desk_.workspace.edit(tr("Light: %1").arg(tr(chosen.title)), {},
                         [&](State& state) { state.scene.lights = chosen.make(picture.toStdString()); });
    refresh();
}

QString LightsDock::askForPicture(const QString& title) {
    return QFileDialog::getOpenFileName(this, title, {}, tr("Pictures (*.hdr *.exr *.pfm *.png)"));
}

void LightsDock::addPicture(QVBoxLayout* column, std::size_t index, bool filter) {
    const auto path = [this, index, filter]() -> std::string {
        if (filter) {
            const auto* light = lightAt<DirectionalLight>(desk_.workspace, index);
            return light ? light->filter : std::string();
        }
        const auto* light = lightAt<EnvironmentLight>(desk_.workspace, index);
        return light ? light->path : std::string();
    };
    auto* thumbnail = new Thumbnail(desk_, QString::fromStdString(path()), this);
    column->addWidget(thumbnail);
    connect(thumbnail, &Thumbnail::clicked, this, [this, index, filter] {
        const QString picture = askForPicture(tr("Picture"));
        if (picture.isEmpty()) return;
        desk_.workspace.edit(tr("Picture of the light"), {}, [&](State& state) {
            Light& light = state.scene.lights[index];
            if (auto* directional = std::get_if<DirectionalLight>(&light); directional && filter)
                directional->filter = picture.toStdString();
            else if (auto* environment = std::get_if<EnvironmentLight>(&light))
                environment->path = picture.toStdString();
        });
    });
}

QWidget* LightsDock::makeCard(std::size_t index) {
    auto* card = new QFrame(this);
    card->setObjectName("card");
    auto* column = new QVBoxLayout(card);
    column->setContentsMargins(Space::m, Space::s, Space::m, Space::m);
    column->setSpacing(Space::xs);
    const Light& light = desk_.workspace.state().scene.lights[index];
    static const char* const titles[] = {"Directional light", "Environment", "Point light"};
    auto* head = new QHBoxLayout;
    head->addWidget(heading(tr(titles[light.index()]), card));
    head->addStretch(1);
    auto* remove = new QToolButton(card);
    remove->setIcon(desk_.theme.icon("close"));
    remove->setIconSize({12, 12});
    remove->setToolTip(tr("Remove this light"));
    remove->setAccessibleName(tr("Remove light %1").arg(index + 1));
    connect(remove, &QToolButton::clicked, this, [this, index] {
        desk_.workspace.edit(tr("Remove light"), {}, [&](State& state) {
            if (index < state.scene.lights.size())
                state.scene.lights.erase(state.scene.lights.begin() + static_cast<std::ptrdiff_t>(index));
        });
    });
    head->addWidget(remove);
    column->addLayout(head);
    const auto add = [&]<class T>(const std::vector<scene_format::Field<T>>& fields) {
        const auto rows = addFields<T>(
            desk_, column, fields, [this, index] { return lightAt<T>(desk_.workspace, index); },
            [this, index](const QString& name, const std::function<void(T&)>& change) {
                desk_.workspace.edit(tr("Light: %1").arg(name), QString("light %1 %2").arg(index).arg(name),
                                     [&](State& state) {
                                         if (index >= state.scene.lights.size()) return;
                                         if (auto* changed = std::get_if<T>(&state.scene.lights[index]))
                                             change(*changed);
                                     });
            });
        refresh_cards_.insert(refresh_cards_.end(), rows.begin(), rows.end());
    };
    if (std::holds_alternative<DirectionalLight>(light)) {
        if (!std::get<DirectionalLight>(light).filter.empty()) addPicture(column, index, true);
        add(scene_format::directional_fields);
    } else if (std::holds_alternative<EnvironmentLight>(light)) {
        addPicture(column, index, false);
        add(scene_format::environment_fields);
    } else {
        add(scene_format::point_fields);
    }
    return card;
}

void LightsDock::rebuild() {
    const std::string shape = shapeOf(desk_.workspace.state().scene.lights);
    if (shape == built_for_) return;
    built_for_ = shape;
    refresh_cards_.clear();
    while (QLayoutItem* item = cards_->takeAt(0)) {
        // Of a widget that may be telling of its edit.
        if (item->widget()) {
            item->widget()->hide();
            item->widget()->deleteLater();
        }
        delete item;
    }
    for (std::size_t i = 0; i < desk_.workspace.state().scene.lights.size(); ++i) cards_->addWidget(makeCard(i));
}

QWidget* LightsDock::makeSurroundings() {
    auto* box = new QWidget(this);
    auto* column = new QVBoxLayout(box);
    column->setContentsMargins(0, 0, 0, 0);
    column->setSpacing(Space::xs);
    column->addWidget(heading(tr("Surroundings"), box));
    const auto optional = [&]<class T>(const QString& title, std::optional<T> Scene::*member,
                                       const std::vector<scene_format::Field<T>>& fields) {
        auto* check = new QCheckBox(title, box);
        column->addWidget(check);
        auto* rows = new QWidget(box);
        auto* inner = new QVBoxLayout(rows);
        inner->setContentsMargins(Space::xl, 0, 0, 0);
        inner->setSpacing(Space::xs);
        column->addWidget(rows);
        connect(check, &QCheckBox::toggled, this, [this, member, title](bool on) {
            desk_.workspace.edit(title, {}, [&](State& state) {
                if (on)
                    state.scene.*member = T{};
                else
                    (state.scene.*member).reset();
            });
        });
        const auto refreshes = addFields<T>(
            desk_, inner, fields,
            [this, member]() -> const T* {
                const auto& value = desk_.workspace.state().scene.*member;
                return value ? &*value : nullptr;
            },
            [this, member, title](const QString& name, const std::function<void(T&)>& change) {
                desk_.workspace.edit(title + ": " + name, title + name, [&](State& state) {
                    if (state.scene.*member) change(*(state.scene.*member));
                });
            });
        refresh_rest_.insert(refresh_rest_.end(), refreshes.begin(), refreshes.end());
        refresh_rest_.push_back([this, check, rows, member] {
            const bool on = (desk_.workspace.state().scene.*member).has_value();
            const QSignalBlocker quiet(check);
            check->setChecked(on);
            rows->setVisible(on);
        });
    };
    optional.operator()<Coat>(tr("Coat on the surface"), &Scene::coat, scene_format::coat_fields);
    optional.operator()<Ground>(tr("Ground"), &Scene::ground, scene_format::ground_fields);
    auto* check = new QCheckBox(tr("Backdrop"), box);
    column->addWidget(check);
    auto* backdrop = new ParamWidget(desk_.theme, scene_format::backdrop_param, box);
    column->addWidget(backdrop);
    connect(check, &QCheckBox::toggled, this, [this](bool on) {
        desk_.workspace.edit(tr("Backdrop"), {}, [&](State& state) {
            if (on)
                state.scene.backdrop = Rgb{0.05, 0.05, 0.05};
            else
                state.scene.backdrop.reset();
        });
    });
    connect(backdrop, &ParamWidget::edited, this, [this](const ParamValue& value) {
        desk_.workspace.edit(tr("Backdrop"), "backdrop",
                             [&](State& state) { state.scene.backdrop = std::get<Rgb>(value); });
    });
    connect(backdrop, &ParamWidget::finished, &desk_.workspace, &Workspace::endGesture);
    refresh_rest_.push_back([this, check, backdrop] {
        const std::optional<Rgb>& value = desk_.workspace.state().scene.backdrop;
        const QSignalBlocker quiet(check);
        check->setChecked(value.has_value());
        backdrop->setVisible(value.has_value());
        if (value) backdrop->setValue(*value);
    });
    return box;
}

void LightsDock::refresh() {
    const int mode = modeOf(desk_.workspace.state().scene.lights);
    for (std::size_t i = 0; i < modes_.size(); ++i) modes_[i]->setChecked(static_cast<int>(i) == mode);
    for (const auto& each : refresh_cards_) each();
    for (const auto& each : refresh_rest_) each();
}

QWidget* makeLightsDock(Desk& desk) {
    auto* area = new QScrollArea;
    area->setObjectName("panel");
    area->setWidgetResizable(true);
    area->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
    area->setMinimumWidth(300);
    area->setWidget(new LightsDock(desk));
    return area;
}

}  // namespace searchlight::gui
