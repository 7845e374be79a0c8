// What the object view shows: pictures, and what is written over them.
#include <QLocale>
#include <QPainter>
#include <QPainterPath>
#include <algorithm>
#include <cmath>

#include "gui/view/object_view.h"
#include "gui/view/shown_image.h"
#include "gui/window/theme.h"

namespace searchlight::gui {

namespace {

constexpr int scale_top = 84;  // below the chips
constexpr QRgb difference_ground = qRgb(74, 75, 78), difference_text = qRgb(233, 232, 230);

const std::string& textOption(const State& state, const char* name) {
    return std::get<std::string>(optionOf(state, "view", name));
}

// "RMSE 12.3 %  ·  mean +1.2 %"; empty: not compared.
QString differenceText(const PictureDifference& differs) {
    if (differs.rms < 0) return {};
    // Three figures at most, and no more than a picture of 8 bits can tell.
    const auto percent = [](double value) {
        const double size = std::abs(100 * value);
        return QString::number(size, 'f', size < 1 ? 2 : size < 100 ? 1 : 0);
    };
    return QObject::tr("RMSE %1 %  \u00b7  mean %2%3 %")
        .arg(percent(differs.rms), differs.mean < 0 ? QStringLiteral("\u2212") : QStringLiteral("+"),
             percent(differs.mean));
}

}  // namespace

void ObjectView::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    const Colors& colors = desk_.theme.colors();
    // A little light behind the object, without colour.
    QRadialGradient stage(rect().center(), std::max(width(), height()) * 0.62);
    stage.setColorAt(0, colors.stage);
    stage.setColorAt(1, colors.canvas);
    painter.fillRect(rect(), stage);
    painter.setRenderHint(QPainter::SmoothPixmapTransform);
    const ViewPicture& shown = pictures_.shown();
    const QRectF whole(rect());
    const bool difference = comparing() && !wiping() && !shown.difference.isNull();
    // No difference is nearly white: on a dark ground in every theme.
    if (difference) painter.fillRect(rect(), QColor(difference_ground));
    painter.drawImage(whole, difference ? shown.difference : shown.a);
    if (wiping() && !shown.b.isNull()) {
        const QRectF side(wipeX(), 0, width() - wipeX(), height());
        painter.save();
        painter.setClipRect(side);
        painter.fillRect(side, stage);
        painter.drawImage(whole, shown.b);
        painter.restore();
    }
    paintLabels(painter);
    if (difference) paintScale(painter);
    if (hasFocus() && by_keys_) {
        painter.setPen(QPen(colors.accent, 1));
        painter.setBrush(Qt::NoBrush);
        painter.drawRect(QRectF(rect()).adjusted(0.5, 0.5, -0.5, -0.5));
    }
}

void ObjectView::paintLabels(QPainter& painter) {
    const Colors& colors = desk_.theme.colors();
    painter.setRenderHint(QPainter::Antialiasing);
    painter.setFont(desk_.theme.smallFont());
    const QFontMetrics metrics(painter.font());
    QColor ground = colors.panel;
    ground.setAlphaF(0.86F);
    const auto chip = [&](const QString& text, QPointF at, Qt::Alignment side, QColor dot) {
        const double wide = metrics.horizontalAdvance(text) + 2 * Space::m + (dot.isValid() ? 14 : 0);
        const double high = metrics.height() + Space::s;
        const QRectF box(side & Qt::AlignRight ? at.x() - wide : at.x(), at.y(), wide, high);
        painter.setPen(Qt::NoPen);
        painter.setBrush(ground);
        painter.drawRoundedRect(box, high / 2, high / 2);
        double x = box.left() + Space::m;
        if (dot.isValid()) {
            painter.setBrush(dot);
            painter.drawEllipse(QPointF(x + 4, box.center().y()), 4, 4);
            x += 14;
        }
        painter.setPen(colors.text);
        painter.drawText(QRectF(x, box.top(), wide, high), Qt::AlignVCenter | Qt::AlignLeft, text);
    };
    const ViewPicture& shown = pictures_.shown();
    const State& state = desk_.workspace.state();
    if (!shown.label_a.isEmpty()) {
        chip(shown.label_a, {Space::m, Space::m}, Qt::AlignLeft, desk_.theme.seriesColor(state.activeModel().color));
        if (comparing() && !shown.label_b.isEmpty()) {
            QString label = shown.label_b;
            if (shown.walks > 0)
                label += tr(", %1 M walks, \u00b1%2 % a pixel")
                             .arg(static_cast<double>(shown.walks) * 1e-6, 0, 'g', 2)
                             .arg(100 * shown.reference_error, 0, 'g', 2);
            else if (textOption(state, "against") == "reference")
                label += tr(", walking...");
            else if (shown.partly)
                label += pictures_.working() ? tr(", being summed...") : tr(", summed in part");
            QColor dot = colors.muted;
            const QString against = QString::fromStdString(textOption(state, "against"));
            if (against.startsWith("model ") && against.mid(6).toInt() < static_cast<int>(state.models.size()))
                dot = desk_.theme.seriesColor(state.models[static_cast<std::size_t>(against.mid(6).toInt())].color);
            chip(label, {width() - double(Space::m), Space::m}, Qt::AlignRight, dot);
            const QString differs = differenceText(shown.differs);
            if (!differs.isEmpty())
                chip(differs, {width() - double(Space::m), 2.0 * Space::m + metrics.height()}, Qt::AlignRight, {});
        }
    }
    if (wiping() && !shown.b.isNull()) {
        painter.setPen(QPen(colors.text, 1.5));
        painter.drawLine(QPointF(wipeX(), 0), QPointF(wipeX(), height()));
        painter.setBrush(colors.panel);
        painter.drawEllipse(QPointF(wipeX(), height() / 2.0), 13, 13);
        QPainterPath arrows;
        for (const int side : {-1, 1}) {
            arrows.moveTo(wipeX() + side * 4, height() / 2.0 - 4);
            arrows.lineTo(wipeX() + side * 8, height() / 2.0);
            arrows.lineTo(wipeX() + side * 4, height() / 2.0 + 4);
        }
        painter.setBrush(Qt::NoBrush);
        painter.drawPath(arrows);
    }
    // On a ground of its own: behind it may be a bright sky.
    const bool failed = !error_.isEmpty();
    constexpr int sides = 2 * (Space::m + Space::s), bottom = Space::m + Space::xs;
    const QString status = failed ? error_ : statusText(false);
    const QRectF text = painter.boundingRect(QRectF(0.5 * sides, 0, width() - sides, height() - bottom),
                                             Qt::AlignBottom | Qt::AlignLeft | Qt::TextWordWrap, status);
    painter.setPen(failed ? QPen(colors.error, 1) : QPen(Qt::NoPen));
    painter.setBrush(ground);
    painter.drawRoundedRect(text.adjusted(-Space::s, -Space::xs, Space::s, Space::xs), Space::radius, Space::radius);
    painter.setPen(failed ? colors.error : colors.muted);
    painter.drawText(text, Qt::AlignBottom | Qt::AlignLeft | Qt::TextWordWrap, status);
}

void ObjectView::paintScale(QPainter& painter) {
    const double scale = std::get<double>(optionOf(desk_.workspace.state(), "view", "difference_scale"));
    constexpr int wide = 160;
    const QRectF bar(width() - wide - 2.0 * Space::xl, scale_top, wide, 8);
    painter.setPen(Qt::NoPen);
    painter.setBrush(QColor(difference_ground).darker(140));
    painter.drawRoundedRect(bar.adjusted(-Space::l, -Space::s, Space::l, 26), Space::radius, Space::radius);
    for (int x = 0; x < wide; ++x)
        painter.fillRect(QRectF(bar.left() + x, bar.top(), 1, bar.height()),
                         QColor(differenceColor(2.0 * x / (wide - 1) - 1)));
    painter.setPen(QColor(difference_text));
    painter.setFont(desk_.theme.smallFont());
    const QRectF below = bar.adjusted(-Space::s, 12, Space::s, 20);
    painter.drawText(below, Qt::AlignLeft, tr("-%1 %").arg(scale, 0, 'g', 3));
    painter.drawText(below, Qt::AlignHCenter, "0");
    painter.drawText(below, Qt::AlignRight, tr("+%1 %").arg(scale, 0, 'g', 3));
}

QString ObjectView::statusText(bool spoken) const {
    const ViewPicture& shown = pictures_.shown();
    if (shown.a.isNull()) return tr("Preparing the object...");
    const State& state = desk_.workspace.state();
    const QString object = QString::fromStdString(state.scene.object).section('/', -1);
    QString text =
        tr("%1 of %2, %3 mm").arg(object, QString::fromStdString(shown.subject.name)).arg(state.scene.scale, 0, 'g', 4);
    if (shown.report.points > 0)  // not every technique has any
        text += tr("  \u00b7  %1 points").arg(QLocale().toString(static_cast<qulonglong>(shown.report.points)));
    text += tr("  \u00b7  %1 ms").arg(shown.ms, 0, 'f', 0);
    if (shown.report.technique.error_bound > 0)
        text += tr("  \u00b7  error at most %1 %").arg(100 * shown.report.technique.error_bound, 0, 'g', 2);
    if (shown.report.technique.standard_error > 0)
        text += tr("  \u00b7  standard error %1 %").arg(100 * shown.report.technique.standard_error, 0, 'g', 2);
    const QString differs = differenceText(shown.differs);
    // Written above, beside what it is the difference from; here for those who hear it.
    if (spoken && comparing() && !differs.isEmpty()) text += "  \u00b7  " + differs;
    return text;
}

}  // namespace searchlight::gui
