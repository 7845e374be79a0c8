#include "gui/window/theme.h"

#include <QApplication>
#include <QFile>
#include <QFontDatabase>
#include <QFontInfo>
#include <QIconEngine>
#include <QPainter>
#include <QPalette>
#include <QStyleFactory>
#include <QSvgRenderer>
#include <QToolTip>
#include <algorithm>
#include <cstdlib>

#include "draw/palette.h"

// A static library's resources are registered by name, outside of any namespace.
static void registerResources() { Q_INIT_RESOURCE(searchlight); }

namespace searchlight::gui {

namespace {

// Neutral greys, a shade warm, so that skin and marble are judged beside something that has no opinion; one accent, the
// colour of light that has been through a hand.
Colors darkColors() {
    Colors c;
    c.window = "#121315";
    c.panel = "#1a1b1e";
    c.raised = "#26282c";
    c.hover = "#303338";
    c.canvas = "#111214";
    c.stage = "#2b2c2f";
    c.line = "#2e3035";
    c.text = "#e9e8e6";
    c.muted = "#a09f9b";
    c.accent = "#f2a354";
    c.on_accent = "#1d1206";
    c.error = "#ff7b72";
    c.warning = "#e8c05a";
    c.good = "#6fcf97";
    return c;
}

Colors lightColors() {
    Colors c;
    c.window = "#e9e8e5";
    c.panel = "#f8f7f5";
    c.raised = "#ffffff";
    c.hover = "#efede9";
    c.canvas = "#cfcecb";
    c.stage = "#f0efec";
    c.line = "#d6d4cf";
    c.text = "#1c1b1a";
    c.muted = "#66635e";
    c.accent = "#b4560a";
    c.on_accent = "#ffffff";
    c.error = "#b3261e";
    c.warning = "#8a6100";
    c.good = "#1b7a47";
    return c;
}

QString firstFamily(std::initializer_list<const char*> wanted, QFontDatabase::SystemFont otherwise) {
    const QStringList families = QFontDatabase::families();
    for (const char* name : wanted)
        if (families.contains(QString::fromLatin1(name))) return QString::fromLatin1(name);
    return QFontDatabase::systemFont(otherwise).family();
}

QPalette paletteOf(const Colors& c) {
    QPalette palette;
    palette.setColor(QPalette::Window, c.window);
    palette.setColor(QPalette::WindowText, c.text);
    palette.setColor(QPalette::Base, c.raised);
    palette.setColor(QPalette::AlternateBase, c.panel);
    palette.setColor(QPalette::Text, c.text);
    palette.setColor(QPalette::PlaceholderText, c.muted);
    palette.setColor(QPalette::Button, c.raised);
    palette.setColor(QPalette::ButtonText, c.text);
    palette.setColor(QPalette::BrightText, c.error);
    palette.setColor(QPalette::Highlight, c.accent);
    palette.setColor(QPalette::HighlightedText, c.on_accent);
    palette.setColor(QPalette::ToolTipBase, c.raised);
    palette.setColor(QPalette::ToolTipText, c.text);
    palette.setColor(QPalette::Link, c.accent);
    palette.setColor(QPalette::Mid, c.line);
    palette.setColor(QPalette::Midlight, c.hover);
    palette.setColor(QPalette::Dark, c.line);
    palette.setColor(QPalette::Shadow, c.window);
    for (const auto role : {QPalette::WindowText, QPalette::Text, QPalette::ButtonText})
        palette.setColor(QPalette::Disabled, role, c.muted);
    return palette;
}

// The style sheet of resources/searchlight.qss with @roles replaced.
QString styleSheetOf(const Colors& c, bool dark) {
    QFile file(":/searchlight.qss");
    if (!file.open(QIODevice::ReadOnly)) return {};
    QString text = QString::fromUtf8(file.readAll());
    const std::pair<const char*, QColor> roles[] = {
        {"@window", c.window}, {"@panel", c.panel},   {"@raised", c.raised},
        {"@hover", c.hover},   {"@canvas", c.canvas}, {"@line", c.line},
        {"@text", c.text},     {"@muted", c.muted},   {"@on_accent", c.on_accent},
        {"@accent", c.accent}, {"@error", c.error},   {"@warning", c.warning},
        {"@good", c.good}};
    for (const auto& [role, color] : roles) text.replace(QLatin1String(role), color.name());
    return text.replace("@mode", dark ? "dark" : "light");
}

/// Draws one of our SVG files in one colour, sharp at every scale.
class SvgIcon : public QIconEngine {
public:
    SvgIcon(QString path, QColor color, QColor disabled, QColor on)
        : path_(std::move(path)), color_(color), disabled_(disabled), on_(on) {}

    void paint(QPainter* painter, const QRect& rect, QIcon::Mode mode, QIcon::State state) override {
        QFile file(path_);
        if (!file.open(QIODevice::ReadOnly)) return;
        const QColor color = mode == QIcon::Disabled ? disabled_ : state == QIcon::On ? on_ : color_;
        QByteArray svg = file.readAll();
        svg.replace("#000000", color.name().toLatin1());
        QSvgRenderer(svg).render(painter, rect);
    }
    QPixmap pixmap(const QSize& size, QIcon::Mode mode, QIcon::State state) override {
        QPixmap pixmap(size);
        pixmap.fill(Qt::transparent);
        QPainter painter(&pixmap);
        paint(&painter, QRect({}, size), mode, state);
        return pixmap;
    }
    QIconEngine* clone() const override { return new SvgIcon(*this); }

private:
    QString path_;
    QColor color_, disabled_, on_;
};

bool systemIsDark() { return QApplication::palette().color(QPalette::Window).lightness() < 128; }

}  // namespace

Theme::Theme(QObject* parent) : QObject(parent) {
    registerResources();
    colors_ = darkColors();
}

void Theme::apply(Mode mode) {
    // The desktop's own answer, before ours hides it.
    static const bool system_dark = systemIsDark();
    mode_ = mode;
    dark_ = mode == Mode::dark || (mode == Mode::system && system_dark);
    colors_ = dark_ ? darkColors() : lightColors();
    QApplication::setStyle(QStyleFactory::create("Fusion"));
    QApplication::setPalette(paletteOf(colors_));
    QToolTip::setPalette(paletteOf(colors_));
    QApplication::setFont(textFont());
    qApp->setStyleSheet(styleSheetOf(colors_, dark_));
    emit changed();
}

QFont Theme::textFont() const {
    QFont font(firstFamily({"Inter", "Noto Sans", "DejaVu Sans"}, QFontDatabase::GeneralFont));
    font.setPixelSize(13);
    return font;
}

QFont Theme::headingFont() const {
    QFont font = textFont();
    font.setPixelSize(12);
    font.setWeight(QFont::DemiBold);
    return font;
}

QFont Theme::smallFont() const {
    QFont font = textFont();
    font.setPixelSize(12);
    return font;
}

QFont Theme::numberFont() const {
    QFont font = codeFont();
    font.setPixelSize(12);
    return font;
}

QFont Theme::codeFont() const {
    QFont font(firstFamily({"JetBrains Mono", "DejaVu Sans Mono"}, QFontDatabase::FixedFont));
    font.setPixelSize(13);
    font.setStyleHint(QFont::Monospace);
    return font;
}

QIcon Theme::icon(const QString& name) const {
    QColor disabled = colors_.muted;
    disabled.setAlphaF(0.5F);
    return QIcon(new SvgIcon(":/icons/" + name + ".svg", colors_.text, disabled, colors_.accent));
}

QColor Theme::onPanel(const QColor& color, bool dark) {
    if (!dark || color.lightnessF() >= 0.6F) return color;
    return QColor::fromHslF(color.hslHueF(), std::min(color.hslSaturationF(), 0.85F), 0.6F);
}

QColor Theme::seriesColor(int index) const {
    const std::string_view name = searchlight::seriesColor(index);
    return onPanel(QColor(QString::fromLatin1(name.data(), static_cast<qsizetype>(name.size()))));
}

}  // namespace searchlight::gui
