#include "gui/widgets/flow_row.h"

#include <algorithm>

#include "gui/window/theme.h"

namespace searchlight::gui {

FlowRow::~FlowRow() { qDeleteAll(items_); }

QLayoutItem* FlowRow::takeAt(int index) { return index >= 0 && index < items_.size() ? items_.takeAt(index) : nullptr; }

QSize FlowRow::sizeHint() const {
    int width = 0;
    for (const QLayoutItem* item : items_)
        if (!item->isEmpty()) width += item->sizeHint().width() + (width > 0 ? Space::s : 0);
    const QMargins around = contentsMargins();
    return {width + around.left() + around.right(), Space::row + around.top() + around.bottom()};
}

QSize FlowRow::minimumSize() const {
    int width = 0;
    for (const QLayoutItem* item : items_)
        if (!item->isEmpty()) width = std::max(width, item->minimumSize().width());
    const QMargins around = contentsMargins();
    return {width + around.left() + around.right(), Space::row + around.top() + around.bottom()};
}

void FlowRow::setGeometry(const QRect& rect) {
    QLayout::setGeometry(rect);
    place(rect, true);
}

int FlowRow::place(const QRect& rect, bool move) const {
    const QMargins around = contentsMargins();
    const int width = rect.width() - around.left() - around.right();
    int y = rect.top() + around.top();
    QList<QLayoutItem*> row;
    int taken = 0;
    const auto finish = [&] {
        if (row.isEmpty()) return;
        const auto expands = [](const QLayoutItem* item) { return item->expandingDirections() & Qt::Horizontal; };
        const auto takers = static_cast<int>(std::ranges::count_if(row, expands));
        int x = rect.left() + around.left(), spare = std::max(0, width - taken), left = takers;
        for (QLayoutItem* item : row) {
            int wide = std::min(item->sizeHint().width(), width);
            if (expands(item) && left > 0) {
                const int share = spare / left--;
                wide += share;
                spare -= share;
            }
            if (move) item->setGeometry({x, y, wide, Space::row});
            x += wide + Space::s;
        }
        y += Space::row + Space::xs;
        row.clear();
        taken = 0;
    };
    for (QLayoutItem* item : items_) {
        if (item->isEmpty()) continue;
        const int wide = item->sizeHint().width();
        if (!row.isEmpty() && taken + Space::s + wide > width) finish();
        taken += wide + (row.isEmpty() ? 0 : Space::s);
        row << item;
    }
    finish();
    return y - Space::xs + around.bottom() - rect.top();
}

}  // namespace searchlight::gui
