#include "gui/widgets/number_slider.h"

#include <QGridLayout>
#include <QLabel>
#include <QLineEdit>
#include <QMouseEvent>
#include <QPainter>
#include <QSignalBlocker>
#include <QStyle>
#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "gui/window/theme.h"

namespace searchlight::gui {

namespace {

constexpr int steps = 1000;  // of a slider: finer than a pixel

}  // namespace

QString numberText(double value) { return QString::number(value, 'g', 4); }

TrackSlider::TrackSlider(Theme& theme, QColor fill, QWidget* parent)
    : QSlider(Qt::Horizontal, parent), theme_(theme), fill_(fill) {
    setRange(0, steps);
    setSingleStep(steps / 100);
    setPageStep(steps / 10);
    setFocusPolicy(Qt::StrongFocus);
    setMinimumWidth(48);
    connect(&theme_, &Theme::changed, this, qOverload<>(&QWidget::update));
}

void TrackSlider::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    const Colors& colors = theme_.colors();
    constexpr double thick = 4, knob = 7;
    const double left = knob, right = width() - knob, y = height() / 2.0;
    const double x = left + (right - left) * (value() - minimum()) / std::max(1, maximum() - minimum());
    const QColor fill = !isEnabled() ? colors.muted : fill_.isValid() ? fill_ : colors.accent;
    painter.setPen(Qt::NoPen);
    painter.setBrush(colors.line);
    painter.drawRoundedRect(QRectF(left, y - thick / 2, right - left, thick), thick / 2, thick / 2);
    painter.setBrush(fill);
    painter.drawRoundedRect(QRectF(left, y - thick / 2, x - left, thick), thick / 2, thick / 2);
    if (hasFocus()) {
        QColor halo = fill;
        halo.setAlphaF(0.3F);
        painter.setBrush(halo);
        painter.drawEllipse(QPointF(x, y), knob + 3, knob + 3);
    }
    painter.setBrush(theme_.isDark() ? colors.text : colors.raised);
    painter.setPen(QPen(fill, 2));
    painter.drawEllipse(QPointF(x, y), knob - 1, knob - 1);
}

void TrackSlider::moveTo(double x) {
    constexpr double knob = 7;
    setValue(
        static_cast<int>(std::lround(steps * std::clamp((x - knob) / std::max(width() - 2 * knob, 1.0), 0.0, 1.0))));
}

void TrackSlider::mousePressEvent(QMouseEvent* event) {
    if (event->button() != Qt::LeftButton) return event->ignore();
    setSliderDown(true);
    moveTo(event->position().x());
}

void TrackSlider::mouseMoveEvent(QMouseEvent* event) {
    if (isSliderDown()) moveTo(event->position().x());
}

void TrackSlider::mouseReleaseEvent(QMouseEvent*) { setSliderDown(false); }

// A wheel over a form scrolls the form: values must not change by the way.
void TrackSlider::wheelEvent(QWheelEvent* event) { event->ignore(); }

NumberSlider::NumberSlider(Theme& theme, const QString& label, const QString& name, const QString& unit,
                           NumberRange range, QColor fill, QWidget* parent)
    : QWidget(parent), range_(range), unit_(unit) {
    auto* grid = new QGridLayout(this);
    grid->setContentsMargins(0, 0, 0, 0);
    grid->setHorizontalSpacing(Space::s);
    grid->setVerticalSpacing(2);
    int column = 0;
    if (!label.isEmpty()) {
        auto* text = new QLabel(label, this);
        text->setMinimumWidth(label.size() > 2 ? 92 : 14);
        text->setProperty("role", "muted");
        text->setToolTip(name);
        grid->addWidget(text, 0, column++);
    }
    slider_ = new TrackSlider(theme, fill, this);
    slider_->setAccessibleName(name);
    grid->addWidget(slider_, 0, column++);
    field_ = new QLineEdit(this);
    field_->setFixedWidth(76);
    field_->setAlignment(Qt::AlignRight);
    field_->setFont(theme.numberFont());
    field_->setProperty("number", true);
    field_->setAccessibleName(unit.isEmpty() ? name : tr("%1 in %2").arg(name, unit));
    field_->setToolTip(unit.isEmpty() ? name : tr("%1 in %2").arg(name, unit));
    grid->addWidget(field_, 0, column++);
    auto* unit_label = new QLabel(unit == QLatin1String("deg") ? QStringLiteral("°") : unit, this);
    unit_label->setProperty("role", "muted");
    unit_label->setFixedWidth(36);
    grid->addWidget(unit_label, 0, column);
    grid->setColumnStretch(label.isEmpty() ? 0 : 1, 1);
    problem_ = new QLabel(this);
    problem_->setProperty("role", "error");
    problem_->setWordWrap(true);
    problem_->setFont(theme.smallFont());
    problem_->hide();
    grid->addWidget(problem_, 1, 0, 1, column + 1);
    connect(slider_, &QSlider::valueChanged, this, [this](int position) {
        value_ = at(position);
        setProblem({});
        showText();
        emit edited(value_);
        // A key moves it by one step, which is a gesture of its own; the mouse says when it is done.
        if (!slider_->isSliderDown()) emit finished();
    });
    connect(slider_, &QSlider::sliderReleased, this, &NumberSlider::finished);
    connect(field_, &QLineEdit::editingFinished, this, &NumberSlider::typed);
    setValue(range.low);
}

double NumberSlider::at(int position) const {
    const double t = static_cast<double>(position) / steps;
    if (position == 0 && range_.logarithmic && range_.min < range_.low && !range_.exclusive) return range_.min;
    double value = range_.logarithmic ? range_.low * std::pow(range_.high / range_.low, t)
                                      : range_.low + t * (range_.high - range_.low);
    if (range_.whole) value = std::round(value);
    // What is shown is what is used: four digits.
    return std::clamp(numberText(value).toDouble(), range_.min, range_.max);
}

int NumberSlider::positionOf(double value) const {
    double t = 0;
    if (!range_.logarithmic)
        t = (value - range_.low) / (range_.high - range_.low);
    else if (value > 0)
        t = std::log(value / range_.low) / std::log(range_.high / range_.low);
    return static_cast<int>(std::lround(steps * std::clamp(t, 0.0, 1.0)));
}

void NumberSlider::setValue(double value) {
    value_ = value;
    const QSignalBlocker quiet(slider_);
    slider_->setValue(positionOf(value));
    setProblem({});
    if (!field_->hasFocus() || !field_->isModified()) showText();
}

void NumberSlider::showText() {
    // Counts are not written with exponents.
    const bool count = range_.whole && std::abs(value_) < 1e9;
    field_->setText(count ? QString::number(value_, 'f', 0) : numberText(value_));
}

void NumberSlider::setProblem(const QString& text) {
    problem_->setText(text);
    problem_->setVisible(!text.isEmpty());
    field_->setProperty("state", text.isEmpty() ? "" : "error");
    field_->style()->unpolish(field_);
    field_->style()->polish(field_);
}

void NumberSlider::typed() {
    if (!field_->isModified()) return;
    field_->setModified(false);
    const std::string text = field_->text().trimmed().replace(',', '.').toStdString();
    const std::optional<double> number = parseNumber(text);
    const bool low = number && (*number < range_.min || (range_.exclusive && *number == range_.min));
    if (!number || !std::isfinite(*number) || low || *number > range_.max ||
        (range_.whole && *number != std::floor(*number))) {
        const QString least = range_.exclusive ? tr("above %1") : tr("from %1");
        const QString most = range_.max < 1e12 ? tr(" to %1").arg(numberText(range_.max)) : QString();
        setProblem(tr("Expected a %1number %2%3.")
                       .arg(range_.whole ? tr("whole ") : QString(), least.arg(numberText(range_.min)), most));
        return;
    }
    setProblem({});
    if (*number != value_) {
        value_ = *number;
        const QSignalBlocker quiet(slider_);
        slider_->setValue(positionOf(value_));
        emit edited(value_);
        emit finished();
    }
    showText();
}

}  // namespace searchlight::gui
