#include "gui/material/material_edit.h"

#include <QPainter>
#include <QPixmap>
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/srgb.h"
#include "model/evaluator.h"
#include "scene/materials.h"

namespace searchlight::gui {

namespace {

std::vector<double> three(Rgb value) { return {value.r, value.g, value.b}; }

std::vector<double> three(const std::vector<double>& list) {
    return list.size() == 1 ? std::vector<double>(3, list.front()) : list;
}

QColor displayColor(Rgb linear) {
    const auto byte = [](double value) {
        return static_cast<int>(
            std::lround(255 * srgbFromLinear(std::clamp(std::isfinite(value) ? value : 0, 0.0, 1.0))));
    };
    return {byte(linear.r), byte(linear.g), byte(linear.b)};
}

}  // namespace

SceneMaterial spelledOut(const SceneMaterial& material) {
    SceneMaterial spelled = material;
    if (!material.id.empty()) {
        const Medium medium = findMaterial(material.id).medium;
        spelled.id.clear();
        spelled.sigma_a = three(medium.sigma_a);
        spelled.sigma_s = three(medium.sigma_s);
        spelled.g = three(medium.g);
        spelled.eta = medium.eta;
        return spelled;
    }
    for (auto* list : {&spelled.sigma_a, &spelled.sigma_s, &spelled.Rdr, &spelled.ld}) *list = three(*list);
    if (!material.inverted()) spelled.g = three(spelled.g);
    return spelled;
}

QColor swatchColor(Rgb value) {
    const double light = luminance(value);
    return displayColor(light > 0 ? 0.75 / light * value : Rgb{});
}

QColor appearanceColor(const Medium& medium) {
    static const Model model = loadModel("better_dipole");
    thread_local const std::unique_ptr<Evaluator> evaluator = makeNativeEvaluator(model);
    Rgb alpha;
    for (int c = 0; c < Rgb::channels; ++c) alpha[c] = medium.scatters(c) ? medium.alphaPrime()[c] : 0;
    evaluator->set(medium, {});
    return displayColor(evaluator->diffuseReflectance(alpha));
}

QIcon swatchIcon(QColor color) {
    QPixmap pixmap(32, 32);
    pixmap.setDevicePixelRatio(2);
    pixmap.fill(Qt::transparent);
    QPainter painter(&pixmap);
    painter.setRenderHint(QPainter::Antialiasing);
    painter.setPen(QPen(QColor(128, 128, 128, 90), 1));
    painter.setBrush(color);
    painter.drawEllipse(QRectF(1, 1, 14, 14));
    return QIcon(pixmap);
}

QString whyImpossible(const SceneMaterial& material) {
    try {
        if (!material.inverted()) resolveMaterial(material);
        return {};
    } catch (const Error& error) {
        return QString::fromUtf8(error.what());
    }
}

}  // namespace searchlight::gui
