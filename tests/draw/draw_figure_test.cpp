#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>

#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "draw/draw.h"
#ifdef SEARCHLIGHT_QT
#include <QImage>
#endif

namespace searchlight {
namespace {

namespace fs = std::filesystem;

Figure example() {
    Figure figure;
    figure.title = "two\nlines";
    figure.caption = "A caption.";
    figure.x = {"Radius", "mm"};
    figure.y = {"Reflectance", "1/mm²", AxisScale::logarithmic};
    figure.series.push_back({.label = "a, \"b\"", .x = {0.1, 1. / 3}, .y = {1e-17, 2.5}, .color = 0});
    figure.series.push_back({.label = "tally",
                             .style = SeriesStyle::steps,
                             .x = {0, 1, 2},
                             .y = {0.5, 0.25},
                             .lower = {0.4, 0.2},
                             .upper = {0.6, 0.3}});
    figure.metadata = {{"seed", "7"}};
    return figure;
}

struct Folder {
    fs::path path = fs::temp_directory_path() / ("searchlight_draw_test_" + std::to_string(getpid()));
    Folder() { fs::create_directories(path); }
    ~Folder() { fs::remove_all(path); }
};

std::vector<std::string> csvFields(const std::string& line) {
    std::vector<std::string> fields(1);
    bool quoted = false;
    for (size_t i = 0; i < line.size(); ++i) {
        if (line[i] == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"')
            fields.back() += line[++i];
        else if (line[i] == '"')
            quoted = !quoted;
        else if (line[i] == ',' && !quoted)
            fields.emplace_back();
        else
            fields.back() += line[i];
    }
    return fields;
}

std::string errorOf(const Figure& figure, const fs::path& path) {
    try {
        drawFigure(figure, path);
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

TEST(FigureCsv, ReadsBackBitForBit) {
    const std::string csv = figureCsv(example());
    std::map<std::string, Series> read;
    bool header = true;
    for (const std::string_view line : split(csv, '\n')) {
        if (line.empty() || line[0] == '#') continue;
        const std::vector<std::string> fields = csvFields(std::string(line));
        ASSERT_EQ(fields.size(), 6u) << line;
        if (std::exchange(header, false)) {
            EXPECT_EQ(line, "series,x,x_end,y,lower,upper");
            continue;
        }
        Series& series = read[fields[0]];
        series.x.push_back(parseNumber(fields[1]).value());
        series.y.push_back(parseNumber(fields[3]).value());
        if (fields[4].empty()) continue;
        EXPECT_EQ(parseNumber(fields[2]), series.x.back() + 1);
        series.lower.push_back(parseNumber(fields[4]).value());
        series.upper.push_back(parseNumber(fields[5]).value());
    }
    const Figure figure = example();
    EXPECT_EQ(read.at("a, \"b\"").x, figure.series[0].x);
    EXPECT_EQ(read.at("a, \"b\"").y, figure.series[0].y);
    EXPECT_EQ(read.at("tally").x, (std::vector<double>{0, 1}));
    EXPECT_EQ(read.at("tally").lower, figure.series[1].lower);
    EXPECT_EQ(read.at("tally").upper, figure.series[1].upper);
}

TEST(FigureCsv, HeaderHoldsCaptionAxesAndMetadata) {
    EXPECT_THAT(figureCsv(example()), testing::StartsWith("# title: two\n"
                                                          "#   : lines\n"
                                                          "# caption: A caption.\n"
                                                          "# x: Radius [mm], shown linear\n"
                                                          "# y: Reflectance [1/mm²], shown logarithmic\n"
                                                          "# seed: 7\n"
                                                          "series,x,x_end,y,lower,upper\n"));
}

TEST(DrawFigure, EveryFormatOfThisBuildIsWrittenAndTheSameTwice) {
    const Folder folder;
    for (const std::string& ending : figureFormats()) {
        const fs::path path = folder.path / ("figure" + ending);
        drawFigure(example(), path);
        const std::string bytes = readFile(path);
        EXPECT_GT(bytes.size(), 100u);
        drawFigure(example(), path);
        EXPECT_EQ(readFile(path), bytes) << ending;
    }
    EXPECT_EQ(std::distance(fs::directory_iterator(folder.path), {}), static_cast<long>(figureFormats().size()))
        << "nothing is left aside";
}

TEST(DrawFigure, UnknownEndingsNameTheKnownOnes) {
    const std::string known = " (write " + join(figureFormats(), ", ") + ")";
    EXPECT_EQ(errorOf(example(), "a.jpg"), "a.jpg: a figure cannot be written as '.jpg'" + known);
    EXPECT_EQ(errorOf(example(), "plot"), "plot: a figure's file name needs an ending" + known);
}

TEST(DrawFigure, AFailureLeavesTheOldFile) {
    const Folder folder;
    const fs::path path = folder.path / "figure.svg";
    drawFigure(example(), path);
    const std::string before = readFile(path);
    EXPECT_THAT(errorOf({}, path), testing::StartsWith("the figure has nothing to show"));
    EXPECT_EQ(readFile(path), before);
}

#ifdef SEARCHLIGHT_QT

TEST(DrawFigure, PngIsTwiceTheLayoutHasTextAndMetadata) {
    const Folder folder;
    Figure figure = example();
    figure.title = "";
    figure.caption = "";
    figure.series.resize(1);
    figure.series[0].label = "";
    drawFigure(figure, folder.path / "bare.png");
    figure.caption = "mmmmmmmmmmmmmmmmmmmm";
    drawFigure(figure, folder.path / "text.png");
    const QImage bare(QString::fromStdString((folder.path / "bare.png").string()));
    const QImage text(QString::fromStdString((folder.path / "text.png").string()));
    ASSERT_FALSE(bare.isNull());
    EXPECT_EQ(bare.width(), 1280);
    EXPECT_EQ(text.text("seed"), "7");
    // The caption lies below everything of the bare figure: its ink is what it adds there.
    const auto ink = [](const QImage& image, int top) {
        long dark = 0;
        for (int y = top; y < image.height(); ++y)
            for (int x = 0; x < image.width(); ++x) dark += qGray(image.pixel(x, y)) < 128;
        return dark;
    };
    EXPECT_GT(ink(bare, 0), 2000) << "a frame alone is over 2 x 600 + 2 x 380 px of ink, at double size";
    EXPECT_GT(text.height(), bare.height());
    EXPECT_GT(ink(text, bare.height() - 20), 500) << "twenty letters at 22 pixels: no font was found";
}

TEST(DrawFigure, PdfEmbedsItsFontsAndNoDate) {
    const Folder folder;
    drawFigure(example(), folder.path / "a.pdf");
    const std::string pdf = readFile(folder.path / "a.pdf");
    EXPECT_THAT(pdf, testing::StartsWith("%PDF-"));
    EXPECT_THAT(pdf, testing::HasSubstr("/FontFile2"));
    EXPECT_THAT(pdf, testing::HasSubstr("/CreationDate (D:19700101000000"));
    EXPECT_THAT(pdf, testing::HasSubstr("seed: 7"));
}

#else

TEST(DrawFigure, WithoutQtPngAndPdfSayWhy) {
    EXPECT_EQ(errorOf(example(), "a.png"),
              "a.png: this build draws no .png: it was made without Qt (write .svg, .csv)");
    EXPECT_EQ(errorOf(example(), "a.pdf"),
              "a.pdf: this build draws no .pdf: it was made without Qt (write .svg, .csv)");
}

#endif

}  // namespace
}  // namespace searchlight
