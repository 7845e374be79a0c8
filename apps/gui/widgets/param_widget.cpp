#include "gui/widgets/param_widget.h"

#include <QCheckBox>
#include <QComboBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QLineEdit>
#include <QSignalBlocker>
#include <QVBoxLayout>
#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.h"
#include "gui/widgets/number_slider.h"
#include "gui/window/theme.h"

namespace searchlight::gui {

namespace {

constexpr int label_width = 92;

QLabel* label(const Param& param, QWidget* parent) {
    auto* text = new QLabel(labelOf(param), parent);
    text->setMinimumWidth(label_width);
    text->setProperty("role", "muted");
    text->setToolTip(QString::fromStdString(param.doc));
    return text;
}

QHBoxLayout* rowOf(ParamWidget* widget) {
    auto* row = new QHBoxLayout(widget);
    row->setContentsMargins(0, 0, 0, 0);
    row->setSpacing(Space::s);
    return row;
}

}  // namespace

QString labelOf(const Param& param) {
    QString text = QString::fromStdString(param.name);
    const QString unit = QString::fromStdString(param.unit);
    // The unit stands behind the number.
    if (!unit.isEmpty() && text.endsWith('_' + unit)) text.chop(unit.size() + 1);
    text.replace('_', ' ');
    if (text == "brdf") return text.toUpper();
    // A symbol is not a word.
    if (text.size() > 3) text[0] = text[0].toUpper();
    return text;
}

NumberRange sliderRange(const Param& param) {
    NumberRange range{.min = param.min, .max = param.max, .low = param.min, .high = param.max};
    if (range.min == 0 && range.max == 0) range = {.min = -1e30, .max = 1e30, .low = -1, .high = 1};
    range.whole = param.type == ParamType::integer;
    range.exclusive = param.exclusive;
    const double* standard = std::get_if<double>(&param.value);
    const double about = standard && *standard > 0 ? *standard : 1;
    // Beyond four decades about the default nobody turns a knob; a field takes the rest.
    if (range.high > about * 1e4) range.high = about * 1e3;
    if (range.low < -about * 1e4) range.low = -about * 1e3;
    range.logarithmic = range.min >= 0 && range.high >= 100 * std::max(range.low, about * 1e-2);
    // Counts from 1 to a million have decades as lengths have; those that may be 0 keep it in reach.
    if (range.whole) range.logarithmic = range.low >= 1 && range.high >= 1000 * range.low;
    if (range.logarithmic && range.low <= about * 1e-4) range.low = std::min(about * 1e-3, range.high / 1e3);
    return range;
}

ParamWidget::ParamWidget(Theme& theme, Param param, QWidget* parent)
    : QWidget(parent), param_(std::move(param)), value_(param_.value) {
    setObjectName("param." + QString::fromStdString(param_.name));
    setToolTip(QString::fromStdString(param_.doc));
    setAccessibleName(labelOf(param_));
    setAccessibleDescription(QString::fromStdString(param_.doc));
    switch (param_.type) {
        case ParamType::number:
        case ParamType::integer: makeNumber(theme); break;
        case ParamType::toggle: makeToggle(); break;
        case ParamType::choice: makeChoice(); break;
        case ParamType::color: makeChannels(theme, true); break;
        case ParamType::channels: makeChannels(theme, false); break;
        case ParamType::text:
        case ParamType::path:
        case ParamType::numbers: makeText(theme); break;
    }
    show_(value_);
}

void ParamWidget::setValue(const ParamValue& value) {
    value_ = value;
    show_(value);
}

void ParamWidget::change(ParamValue value) {
    if (value == value_) return;
    value_ = std::move(value);
    emit edited(value_);
}

void ParamWidget::makeNumber(Theme& theme) {
    auto* row = rowOf(this);
    auto* number = new NumberSlider(theme, labelOf(param_), labelOf(param_), QString::fromStdString(param_.unit),
                                    sliderRange(param_), {}, this);
    row->addWidget(number);
    connect(number, &NumberSlider::edited, this, [this](double value) { change(value); });
    connect(number, &NumberSlider::finished, this, &ParamWidget::finished);
    show_ = [number](const ParamValue& value) { number->setValue(std::get<double>(value)); };
}

void ParamWidget::makeToggle() {
    auto* row = rowOf(this);
    auto* box = new QCheckBox(labelOf(param_), this);
    box->setAccessibleName(labelOf(param_));
    row->addWidget(box);
    connect(box, &QCheckBox::toggled, this, [this](bool on) {
        change(on);
        emit finished();
    });
    show_ = [box](const ParamValue& value) {
        const QSignalBlocker quiet(box);
        box->setChecked(std::get<bool>(value));
    };
}

void ParamWidget::makeChoice() {
    auto* row = rowOf(this);
    row->addWidget(label(param_, this));
    auto* box = new QComboBox(this);
    box->setAccessibleName(labelOf(param_));
    for (const std::string& choice : param_.choices)
        box->addItem(QString::fromStdString(choice).replace('_', ' '), QString::fromStdString(choice));
    row->addWidget(box, 1);
    connect(box, &QComboBox::activated, this, [this, box] {
        change(box->currentData().toString().toStdString());
        emit finished();
    });
    show_ = [box](const ParamValue& value) {
        const QSignalBlocker quiet(box);
        box->setCurrentIndex(box->findData(QString::fromStdString(std::get<std::string>(value))));
    };
}

void ParamWidget::makeText(Theme& theme) {
    auto* column = new QVBoxLayout(this);
    column->setContentsMargins(0, 0, 0, 0);
    column->setSpacing(2);
    auto* row = new QHBoxLayout;
    row->setSpacing(Space::s);
    row->addWidget(label(param_, this));
    auto* field = new QLineEdit(this);
    field->setAccessibleName(labelOf(param_));
    field->setFont(theme.numberFont());
    row->addWidget(field, 1);
    column->addLayout(row);
    auto* problem = new QLabel(this);
    problem->setProperty("role", "error");
    problem->setWordWrap(true);
    problem->hide();
    column->addWidget(problem);
    connect(field, &QLineEdit::editingFinished, this, [this, field, problem] {
        try {
            ParamValue value = parseValue(param_, field->text().toStdString());
            problem->hide();
            change(std::move(value));
            emit finished();
        } catch (const Error& error) {
            problem->setText(QString::fromUtf8(error.what()));
            problem->show();
        }
    });
    show_ = [field, problem](const ParamValue& value) {
        field->setText(QString::fromStdString(valueText(value)));
        problem->hide();
    };
}

void ParamWidget::makeChannels(Theme& theme, bool color) {
    auto* column = new QVBoxLayout(this);
    column->setContentsMargins(0, 0, 0, 0);
    column->setSpacing(2);
    column->addWidget(label(param_, this));
    std::array<NumberSlider*, 3> sliders{};
    static constexpr const char* names[] = {"R", "G", "B"};
    const QColor fills[] = {"#d9534f", "#4caf6d", "#4c8fd9"};
    for (std::size_t c = 0; c < 3; ++c) {
        sliders[c] = new NumberSlider(theme, names[c], labelOf(param_) + " " + names[c],
                                      QString::fromStdString(param_.unit), sliderRange(param_), fills[c], this);
        column->addWidget(sliders[c]);
    }
    for (NumberSlider* slider : sliders) {
        connect(slider, &NumberSlider::edited, this, [this, sliders, color] {
            const double r = sliders[0]->value(), g = sliders[1]->value(), b = sliders[2]->value();
            if (color)
                change(Rgb{r, g, b});
            else
                change(std::vector<double>{r, g, b});
        });
        connect(slider, &NumberSlider::finished, this, &ParamWidget::finished);
    }
    show_ = [sliders, color](const ParamValue& value) {
        for (std::size_t c = 0; c < 3; ++c) {
            if (color) {
                sliders[c]->setValue(std::get<Rgb>(value)[static_cast<int>(c)]);
                continue;
            }
            const auto& list = std::get<std::vector<double>>(value);
            if (!list.empty()) sliders[c]->setValue(list[std::min(c, list.size() - 1)]);
        }
    };
}

}  // namespace searchlight::gui
