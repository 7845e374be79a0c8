#include <fmt/format.h>

#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "draw/draw.h"
#include "draw/figure_layout.h"
#include "draw/svg.h"
#ifdef SEARCHLIGHT_QT
#include "draw/paint_qt.h"
#endif

namespace searchlight {

namespace {

struct Format {
    std::string_view ending;
    std::string (*write)(const Figure&);  ///< null: needs Qt
};

#ifdef SEARCHLIGHT_QT
constexpr Format formats[] = {{".svg", figureSvg}, {".csv", figureCsv}, {".png", figurePng}, {".pdf", figurePdf}};
#else
constexpr Format formats[] = {{".svg", figureSvg}, {".csv", figureCsv}, {".png", nullptr}, {".pdf", nullptr}};
#endif

}  // namespace

std::string figureSvg(const Figure& figure) {
    return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n" + svgElement(layoutFigure(figure), figure);
}

std::vector<std::string> figureFormats() {
    std::vector<std::string> endings;
    for (const Format& format : formats)
        if (format.write) endings.emplace_back(format.ending);
    return endings;
}

void drawFigure(const Figure& figure, const std::filesystem::path& path) {
    const std::string ending = path.extension().string();
    const std::string hint = "write " + join(figureFormats(), ", ");
    for (const Format& format : formats) {
        if (format.ending != ending) continue;
        if (!format.write)
            throw usageError(fmt::format("this build draws no {}: it was made without Qt", ending), hint)
                .at(path.string());
        return writeFile(path, format.write(figure));
    }
    throw usageError(ending.empty() ? std::string("a figure's file name needs an ending")
                                    : fmt::format("a figure cannot be written as '{}'", ending),
                     hint)
        .at(path.string());
}

}  // namespace searchlight
