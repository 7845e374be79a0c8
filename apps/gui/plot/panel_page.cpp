#include "gui/plot/panel_page.h"

#include <QPainter>
#include <algorithm>

#include "base/error.h"
#include "draw/panel_layout.h"

namespace searchlight::gui {

namespace {

constexpr double margin = 10;

Drawing bestLayout(Figure& figure, QSize size, const Observer& observer) {
    double best = 0, best_page = 0;
    int best_columns = 1;
    for (int columns = 1; columns <= std::max(1, static_cast<int>(figure.panels.size())); ++columns)
        for (const double page : {0.0, 900.0, 800.0, 700.0, 600.0, 500.0}) {
            if (page > 0 && page < 200 * columns) continue;
            if (observer.cancelled()) throw interruptedError();
            figure.columns = columns;
            const Drawing drawing = layoutPanels(figure, page, false);
            const double scale = std::min(size.width() / drawing.width, size.height() / drawing.height);
            const double score = 1e4 * std::min(scale, 0.7) + scale * drawing.width;
            if (score <= best) continue;
            best = score;
            best_page = page;
            best_columns = columns;
        }
    figure.columns = best_columns;
    Drawing drawing = layoutPanels(figure, best_page);
    drawing.shapes.erase(drawing.shapes.begin());  // the paper
    return drawing;
}

}  // namespace

PanelPage makePanelPage(Figure figure, QSize size, double ratio, const InkFunction& ink, const Observer& observer) {
    PanelPage page;
    page.size = size;
    page.image = QImage(size * ratio, QImage::Format_ARGB32_Premultiplied);
    page.image.setDevicePixelRatio(ratio);
    page.image.fill(Qt::transparent);
    figure.caption.clear();
    try {
        Drawing drawing = bestLayout(figure, size, observer);
        page.scale =
            std::min((size.width() - 2 * margin) / drawing.width, (size.height() - 2 * margin) / drawing.height);
        page.offset = {0.5 * (size.width() - page.scale * drawing.width),
                       0.5 * (size.height() - page.scale * drawing.height)};
        QPainter painter(&page.image);
        painter.translate(page.offset);
        painter.scale(page.scale, page.scale);
        // What is white stands on a map's own colours.
        paintShapes(painter, drawing.shapes,
                    [&](std::string_view color) { return color == "#ffffff" ? std::string(color) : ink(color); });
        page.frames = std::move(drawing.frames);
    } catch (const Error& error) {
        if (error.kind == ErrorKind::interrupted) throw;
        page.problem = error.message;
    }
    return page;
}

}  // namespace searchlight::gui
