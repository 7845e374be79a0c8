#include "gui/kernel/picture_row.h"

#include <QPainter>
#include <algorithm>

#include "gui/window/theme.h"

namespace searchlight::gui {

namespace {

constexpr int title_height = 20, note_height = 18;

// Columns that leave the largest squares.
int columnsFor(int panels, int width, int height) {
    int best = 1;
    double best_side = 0;
    for (int columns = 1; columns <= panels; ++columns) {
        const int rows = (panels + columns - 1) / columns;
        const double side = std::min(static_cast<double>(width) / columns,
                                     static_cast<double>(height) / rows - title_height - note_height);
        if (side <= best_side) continue;
        best_side = side;
        best = columns;
    }
    return best;
}

}  // namespace

PictureRow::PictureRow(Theme& theme, QWidget* parent) : QWidget(parent), theme_(theme) {
    connect(&theme_, &Theme::changed, this, qOverload<>(&QWidget::update));
}

void PictureRow::setPanels(QList<Panel> panels) {
    panels_ = std::move(panels);
    QStringList heard;
    for (const Panel& panel : panels_) heard << panel.title + QStringLiteral(": ") + panel.note;
    setAccessibleDescription(heard.join(QStringLiteral("; ")));
    update();
}

void PictureRow::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    const Colors& colors = theme_.colors();
    painter.fillRect(rect(), colors.canvas);
    painter.setRenderHint(QPainter::SmoothPixmapTransform);
    const int count = static_cast<int>(panels_.size());
    if (count == 0) return;
    const int columns = columnsFor(count, width(), height()), rows = (count + columns - 1) / columns;
    const double wide = static_cast<double>(width()) / columns, high = static_cast<double>(height()) / rows;
    const double side = std::max(8.0, std::min(wide - Space::s, high - title_height - note_height - Space::xs));
    // Together in the middle, not far from each other.
    const double step = std::min(wide, side + 4 * Space::l), left = 0.5 * (width() - columns * step);
    for (int i = 0; i < count; ++i) {
        const Panel& panel = panels_[i];
        const QRectF cell(left + (i % columns) * step, (i / columns) * high, step, high);
        const QRectF place(cell.center().x() - 0.5 * side,
                           cell.top() + title_height + 0.5 * (high - title_height - note_height - side), side, side);
        const auto write = [&](const QRectF& line, const QFont& font, const QColor& color, const QString& text) {
            painter.setFont(font);
            painter.setPen(color);
            painter.drawText(line, Qt::AlignCenter,
                             painter.fontMetrics().elidedText(text, Qt::ElideRight, static_cast<int>(line.width())));
        };
        write({cell.left() + 2, place.top() - title_height, step - 4, title_height}, theme_.textFont(), colors.text,
              panel.title);
        painter.drawImage(place, panel.picture);
        write({cell.left() + 2, place.bottom(), step - 4, note_height}, theme_.smallFont(), colors.muted, panel.note);
    }
}

}  // namespace searchlight::gui
