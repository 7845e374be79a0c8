#include "gui/kernel/manual_panel.h"

#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QVBoxLayout>

#include "gui/widgets/number_slider.h"
#include "gui/window/theme.h"

namespace searchlight::gui {

ManualPanel::ManualPanel(Theme& theme, QWidget* parent) : QWidget(parent) {
    auto* column = new QVBoxLayout(this);
    column->setContentsMargins(Space::s, Space::xs, Space::s, Space::xs);
    column->setSpacing(2);
    const auto add = [&](const QString& label, const QString& name, const QString& unit, const QString& object,
                         NumberRange range, QColor fill) {
        auto* slider = new NumberSlider(theme, label, name, unit, range, fill, this);
        slider->setObjectName(object);
        connect(slider, &NumberSlider::edited, this, &ManualPanel::edited);
        connect(slider, &NumberSlider::finished, this, &ManualPanel::finished);
        column->addWidget(slider);
        return slider;
    };
    const auto heading = [&](const QString& text) {
        auto* label = new QLabel(text, this);
        label->setProperty("role", "muted");
        column->addWidget(label);
    };
    static constexpr const char* channels[] = {"R", "G", "B"};
    const QColor fills[] = {"#d9534f", "#4caf6d", "#4c8fd9"};
    const NumberRange lengths{.min = 0, .max = 100, .low = 0.005, .high = 50, .logarithmic = true};
    const auto three = [&](std::array<NumberSlider*, 3>& sliders, const QString& title, const QString& object) {
        heading(title);
        for (std::size_t c = 0; c < 3; ++c)
            sliders[c] =
                add(QLatin1String(channels[c]), title + QLatin1Char(' ') + QLatin1String(channels[c]),
                    QStringLiteral("mm"), object + QLatin1Char('.') + QLatin1String(channels[c]), lengths, fills[c]);
    };
    // Above the sliders, which may be longer than the dock is high.
    auto* head = new QHBoxLayout;
    auto* title = new QLabel(tr("Two Gaussians"), this);
    title->setProperty("role", "heading");
    head->addWidget(title, 1);
    fit_ = new QPushButton(tr("Fit"), this);
    fit_->setObjectName(QStringLiteral("kernel.fit"));
    fit_->setToolTip(tr("Back to the two Gaussians that are nearest in pictures of edges"));
    connect(fit_, &QPushButton::clicked, this, &ManualPanel::fitWanted);
    head->addWidget(fit_);
    column->addLayout(head);
    weight_ = add(tr("Near part"), tr("Part of the near Gaussian"), {}, QStringLiteral("kernel.near_weight"),
                  {.min = 0, .max = 1, .low = 0, .high = 1}, {});
    weight_->setToolTip(tr("The near Gaussian's part of the energy"));
    three(near_, tr("Near, √τ"), QStringLiteral("kernel.near"));
    three(far_, tr("Far, √τ"), QStringLiteral("kernel.far"));
    column->addStretch(1);
}

void ManualPanel::setValues(const TwoGaussians& values, bool by_hand) {
    for (int c = 0; c < Rgb::channels; ++c) {
        near_[static_cast<std::size_t>(c)]->setValue(values.near_mm[c]);
        far_[static_cast<std::size_t>(c)]->setValue(values.far_mm[c]);
    }
    weight_->setValue(values.near_weight);
    fit_->setEnabled(by_hand);
}

TwoGaussians ManualPanel::values() const {
    return {{near_[0]->value(), near_[1]->value(), near_[2]->value()},
            {far_[0]->value(), far_[1]->value(), far_[2]->value()},
            weight_->value()};
}

}  // namespace searchlight::gui
