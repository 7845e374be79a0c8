// What the material dock shows of the material, and its change from coefficients to (Rdr, ld) and back.
#include <fmt/format.h>

#include <QLabel>
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "gui/material/material_dock.h"
#include "gui/material/material_edit.h"
#include "gui/material/preset_list.h"
#include "gui/widgets/number_slider.h"
#include "gui/widgets/segments.h"
#include "job/plot/subject.h"
#include "model/inversion.h"
#include "scene/scene_fields.h"

namespace searchlight::gui {

namespace {

void setSwatch(QLabel* swatch, QColor color) {
    swatch->setStyleSheet(QString("background: %1; border-radius: 4px;").arg(color.name()));
}

Rgb spread(const std::vector<double>& list) {
    if (list.empty()) return {};
    return list.size() < 3 ? Rgb{list[0], list[0], list[0]} : Rgb{list[0], list[1], list[2]};
}

}  // namespace

void MaterialDock::setParametrisation(bool inverted) {
    const std::shared_ptr<const State> state = desk_.workspace.snapshot();
    const TaskSpec spec{.lane = "material", .key = "form", .title = tr("Inverting"), .receiver = this};
    const auto work = [this, state, inverted](TaskContext& context) {
        Job job;
        job.scene = sceneOf(*state, state->active);
        const double scale = job.scene.material.scale;
        job.scene.material.scale = 1;
        const Medium medium = subjectOf(job, context.engine()).medium;
        SceneMaterial other;
        other.id.clear();
        other.scale = scale;
        other.eta = medium.eta;
        const auto list = [](Rgb value) { return std::vector<double>{value.r, value.g, value.b}; };
        if (inverted) {
            std::vector<std::string> settings;
            for (const auto& [name, value] : job.scene.model.parameters)
                settings.push_back(name + "=" + valueText(value));
            const LoadedModel loaded = context.engine().load(job.scene.model.id, settings, "auto", medium);
            const InversionTarget target = inversionTarget(*loaded.evaluator, loaded.model, loaded.parameters, medium);
            if (std::min({target.ld_mm.r, target.ld_mm.g, target.ld_mm.b}) < scene_format::least_ld_mm)
                throw inputError("these coefficients have no diffuse mean free path that could be told from 0",
                                 fmt::format("it is {:g} mm at least", scene_format::least_ld_mm));
            other.Rdr = list(target.Rdr);
            other.ld = list(target.ld_mm);
            other.g = {target.g};
        } else {
            other.sigma_a = list(medium.sigma_a);
            other.sigma_s = list(medium.sigma_s);
            other.g = list(medium.g);
        }
        context.publish([this, other, inverted] {
            edit(inverted ? tr("By Rdr and ld") : tr("By coefficients"), {},
                 [&](SceneMaterial& material) { material = other; });
        });
    };
    desk_.tasks.start(spec, work, [this](const Error& error) {
        desk_.notices.post(error);
        refresh();
    });
}

void MaterialDock::refresh() {
    const State& state = desk_.workspace.state();
    presets_->setCurrent(material().id);
    scope_->setCurrent(state.activeModel().material ? 1 : 0);
    form_->setCurrent(material().inverted() ? 1 : 0);
    SceneMaterial shown = material();
    try {
        shown = spelledOut(material());
    } catch (const Error& error) {
        problem_->setText(QString::fromUtf8(error.what()));
        problem_->show();
        return;
    }
    for (Group& group : groups_) {
        const std::vector<double>& list = shown.*group.member;
        const bool used = !list.empty();
        group.box->setVisible(used);
        if (!used) continue;
        for (std::size_t c = 0; c < 3; ++c) group.sliders[c]->setValue(list[std::min(c, list.size() - 1)]);
        setSwatch(group.swatch, swatchColor(spread(list)));
    }
    const auto mean = [](const std::vector<double>& list) {
        double sum = 0;
        for (const double each : list) sum += each;
        return list.empty() ? 0 : sum / static_cast<double>(list.size());
    };
    g_->setValue(mean(shown.g));
    eta_->setValue(shown.eta);
    stretch_->setValue(shown.scale);
    size_->setValue(state.scene.scale);
    const QString problem = whyImpossible(material());
    problem_->setText(problem);
    problem_->setVisible(!problem.isEmpty());
    refreshFacts();
}

void MaterialDock::refreshFacts() {
    const std::shared_ptr<const State> state = desk_.workspace.snapshot();
    const TaskSpec spec{.lane = "material", .key = "facts", .receiver = this};
    const auto work = [this, state](TaskContext& context) {
        Job job;
        job.scene = sceneOf(*state, state->active);
        const Subject subject = subjectOf(job, context.engine());
        const Rgb sigma_tp = subject.medium.sigmaTp();
        const double longest = 1 / std::max(std::min({sigma_tp.r, sigma_tp.g, sigma_tp.b}), 1e-12);
        QString text =
            tr("Light goes about %1 mm between changes of direction; the object is %2 of these long.")
                .arg(numberText(1 / sigma_tp.r) + ", " + numberText(1 / sigma_tp.g) + ", " + numberText(1 / sigma_tp.b))
                .arg(static_cast<int>(std::lround(std::min(job.scene.scale / longest, 1e9))));
        for (const std::string& note : subject.notes) text += "\n" + QString::fromStdString(note);
        context.publish([this, text] {
            facts_->setProperty("role", "muted");
            facts_->setText(text);
        });
    };
    desk_.tasks.start(spec, work, [this](const Error& error) { facts_->setText(QString::fromUtf8(error.what())); });
}

}  // namespace searchlight::gui
