// The widget of a Param: what a model, a technique or a dock declares becomes what a person turns.
#pragma once

#include <QWidget>
#include <functional>

#include "base/param.h"

namespace searchlight::gui {

class Theme;

/// What a person reads: words instead of underscores, without the unit.
QString labelOf(const Param& param);

/// One row, label included. Every ParamType has one.
class ParamWidget : public QWidget {
    Q_OBJECT

public:
    ParamWidget(Theme& theme, Param param, QWidget* parent = nullptr);

    const Param& param() const { return param_; }
    const ParamValue& value() const { return value_; }
    /// Shows a value; emits nothing.
    void setValue(const ParamValue& value);

Q_SIGNALS:
    /// The user chose another value, within the range.
    void edited(const searchlight::ParamValue& value);
    void finished();

private:
    void makeNumber(Theme& theme);
    void makeToggle();
    void makeChoice();
    void makeText(Theme& theme);
    void makeChannels(Theme& theme, bool color);
    void change(ParamValue value);

    Param param_;
    ParamValue value_;
    std::function<void(const ParamValue&)> show_;
};

/// The range of a slider for a Param: logarithmic where the range spans decades.
struct NumberRange;
NumberRange sliderRange(const Param& param);

}  // namespace searchlight::gui
