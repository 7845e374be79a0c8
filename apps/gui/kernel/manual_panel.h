// Sliders of the two Gaussians that are set by hand.
#pragma once

#include <QWidget>
#include <array>

#include "kernel/manual.h"

class QPushButton;

namespace searchlight::gui {

class NumberSlider;
class Theme;

class ManualPanel : public QWidget {
    Q_OBJECT

public:
    explicit ManualPanel(Theme& theme, QWidget* parent = nullptr);

    /// Shows numbers; emits nothing. `by_hand`: they are not the fitted ones.
    void setValues(const TwoGaussians& values, bool by_hand);
    TwoGaussians values() const;

Q_SIGNALS:
    void edited();
    /// The mouse was released, the field left.
    void finished();
    /// Back to the fit.
    void fitWanted();

private:
    std::array<NumberSlider*, 3> near_{}, far_{};
    NumberSlider* weight_;
    QPushButton* fit_;
};

}  // namespace searchlight::gui
