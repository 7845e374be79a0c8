#include "gui/plot/figure_ink.h"

#include <QColor>
#include <algorithm>

#include "gui/window/theme.h"

namespace searchlight::gui {

namespace {

QColor mixed(const QColor& a, const QColor& b, double t) {
    const auto lerp = [t](float x, float y) { return static_cast<float>(x + t * (static_cast<double>(y) - x)); };
    return QColor::fromRgbF(lerp(a.redF(), b.redF()), lerp(a.greenF(), b.greenF()), lerp(a.blueF(), b.blueF()));
}

}  // namespace

InkFunction figureInk(const Theme& theme) {
    const QColor paper = theme.colors().panel, text = theme.colors().text;
    return [paper, text, dark = theme.isDark()](std::string_view name) {
        const QColor color(QString::fromUtf8(name.data(), static_cast<qsizetype>(name.size())));
        // #1a1a1a is ink, white is paper; what lies between keeps its place between text and panel.
        if (color.hslSaturationF() < 0.05f)
            return mixed(text, paper, std::clamp((color.lightnessF() - 0.1) / 0.9, 0.0, 1.0)).name().toStdString();
        return Theme::onPanel(color, dark).name().toStdString();
    };
}

}  // namespace searchlight::gui
