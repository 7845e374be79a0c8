// How the window looks: colours by their role, type, spacing, icons; light and dark.
#pragma once

#include <QColor>
#include <QFont>
#include <QIcon>
#include <QObject>
#include <QString>

namespace searchlight::gui {

/// Distances in device-independent pixels: multiples of 4, so that edges align across docks.
struct Space {
    static constexpr int xs = 4, s = 8, m = 12, l = 16, xl = 24;
    static constexpr int row = 28;    ///< height of a control
    static constexpr int radius = 6;  ///< of corners
};

/// By role, never by hue.
struct Colors {
    QColor window;  ///< behind docks
    QColor panel;   ///< of a dock
    QColor raised;  ///< a control on a panel
    QColor hover;   ///< under the pointer
    QColor canvas;  ///< behind pictures: neutral, so that it does not tint what is judged on it
    QColor stage;   ///< the middle of the canvas
    QColor line;    ///< between things
    QColor text;
    QColor muted;   ///< units, hints
    QColor accent;  ///< what is chosen, and the filled part of sliders
    QColor on_accent;
    QColor error, warning, good;
};

class Theme : public QObject {
    Q_OBJECT

public:
    enum class Mode { system, light, dark };

    explicit Theme(QObject* parent = nullptr);

    /// Sets palette, style sheet and fonts of the application.
    void apply(Mode mode);
    Mode mode() const { return mode_; }
    bool isDark() const { return dark_; }
    const Colors& colors() const { return colors_; }

    QFont textFont() const;
    QFont headingFont() const;  ///< of a group within a dock
    QFont smallFont() const;    ///< units, hints
    QFont numberFont() const;   ///< digits of one width, for fields of numbers
    QFont codeFont() const;     ///< of the editor

    /// One of resources/icons/NAME.svg, in the colours of the theme.
    QIcon icon(const QString& name) const;

    /// A colour of figures on paper, lightened where the theme is dark.
    QColor onPanel(const QColor& color) const { return onPanel(color, dark_); }
    static QColor onPanel(const QColor& color, bool dark);
    /// The colour of a series, as the plot has it.
    QColor seriesColor(int index) const;

Q_SIGNALS:
    void changed();

private:
    Mode mode_ = Mode::system;
    bool dark_ = true;
    Colors colors_;
};

}  // namespace searchlight::gui
