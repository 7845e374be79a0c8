// What the object is made of: presets, coefficients or (Rdr, ld), scale, and the model's own parameters.
#pragma once

#include <QWidget>
#include <array>

#include "gui/window/desk.h"
#include "scene/scene.h"

class QCheckBox;
class QLabel;

namespace searchlight::gui {

class NumberSlider;
class PresetList;
class Segments;

class MaterialDock : public QWidget {
    Q_OBJECT

public:
    explicit MaterialDock(Desk& desk, QWidget* parent = nullptr);

private:
    /// Three sliders of one quantity, with its swatch.
    struct Group {
        QWidget* box = nullptr;
        QLabel* swatch = nullptr;
        std::array<NumberSlider*, 3> sliders{};
        std::vector<double> SceneMaterial::*member = nullptr;
    };

    Group makeGroup(const QString& title, const QString& doc, const QString& unit, double low, double high, double max,
                    std::vector<double> SceneMaterial::*member);
    NumberSlider* makeNumber(const QString& title, const QString& doc, const QString& unit, double min, double max,
                             double low, double high, bool logarithmic);
    const SceneMaterial& material() const;
    void edit(const QString& text, const QString& gesture, const std::function<void(SceneMaterial&)>& change);
    void channelEdited(const Group& group, int channel, double value, const QString& title);
    void setParametrisation(bool inverted);
    void refresh();
    void refreshFacts();

    Desk& desk_;
    PresetList* presets_;
    Segments* scope_;
    Segments* form_;
    QCheckBox* together_;
    std::array<Group, 4> groups_;
    NumberSlider *g_, *eta_, *stretch_, *size_;
    QLabel* problem_;
    QLabel* facts_;
};

QWidget* makeMaterialDock(Desk& desk);

}  // namespace searchlight::gui
