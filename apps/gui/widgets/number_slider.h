// A number with its unit: a slider for the range that makes sense, a field for any number that is allowed.
#pragma once

#include <QColor>
#include <QSlider>
#include <QWidget>

class QLabel;
class QLineEdit;

namespace searchlight::gui {

class Theme;

/// A QSlider that is drawn as a filled track; `fill` invalid: the theme's accent.
class TrackSlider : public QSlider {
    Q_OBJECT

public:
    TrackSlider(Theme& theme, QColor fill, QWidget* parent = nullptr);
    QSize sizeHint() const override { return {120, 22}; }
    QSize minimumSizeHint() const override { return {48, 22}; }

protected:
    void paintEvent(QPaintEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;
    void wheelEvent(QWheelEvent* event) override;

private:
    void moveTo(double x);

    Theme& theme_;
    QColor fill_;
};

struct NumberRange {
    double min = 0, max = 1;   ///< that is allowed
    double low = 0, high = 1;  ///< that the slider covers
    bool logarithmic = false;  ///< needs 0 < low; the slider's left end is then `low`, or min where that is less
    bool whole = false;
    bool exclusive = false;  ///< min itself is not allowed
};

class NumberSlider : public QWidget {
    Q_OBJECT

public:
    /// `label` may be empty. `name` is what screen readers say.
    NumberSlider(Theme& theme, const QString& label, const QString& name, const QString& unit, NumberRange range,
                 QColor fill = {}, QWidget* parent = nullptr);

    double value() const { return value_; }
    /// Shows a value; emits nothing.
    void setValue(double value);
    /// Said in place, in red, until the next valid value; empty: none.
    void setProblem(const QString& text);

    QLineEdit* field() const { return field_; }
    TrackSlider* slider() const { return slider_; }

Q_SIGNALS:
    /// The user chose another value.
    void edited(double value);
    /// The mouse was released, the field left.
    void finished();

private:
    double at(int position) const;
    int positionOf(double value) const;
    void showText();
    void typed();

    NumberRange range_;
    QString unit_;
    double value_ = 0;
    TrackSlider* slider_;
    QLineEdit* field_;
    QLabel* problem_;
};

/// "0.0123", "1.5e-06": four digits, as short as they can be.
QString numberText(double value);

}  // namespace searchlight::gui
