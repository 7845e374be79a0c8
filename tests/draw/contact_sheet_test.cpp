#include "draw/contact_sheet.h"

#include <filesystem>

#include "base/error.h"
#include "base/files.h"
#include "well_formed.h"

#ifdef SEARCHLIGHT_QT
#include <QImage>
#endif

namespace searchlight {
namespace {

using testing::HasSubstr;

// One red pixel.
const std::string red_png(
    "\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\1\0\0\0\1\10\2\0\0\0\x90wS\xde\0\0\0\fIDATx\x9c"
    "c\xf8\xcf\xc0\0\0\3\1\1\0\xc9\xfe\x92\xef\0\0\0\0IEND\xae"
    "B`\x82",
    69);

ContactSheet example() {
    ContactSheet sheet;
    sheet.title = "Materials & models";
    sheet.caption = "One exposure for all.";
    sheet.column_title = "Model";
    sheet.row_title = "Material";
    sheet.columns = {"dipole", "normalized_diffusion", "x"};
    sheet.rows = {"Marble", "<Skin>"};
    sheet.cells.resize(6);
    for (SheetCell& cell : sheet.cells) cell.png = red_png;
    sheet.picture_width = 100;
    sheet.picture_height = 80;
    return sheet;
}

size_t count(std::string_view text, std::string_view part) {
    size_t found = 0;
    for (size_t at = text.find(part); at != std::string_view::npos; at = text.find(part, at + 1)) ++found;
    return found;
}

TEST(ContactSheet, AScaleOfColoursStandsBesideThePictures) {
    ContactSheet sheet = example();
    const std::string without = sheetSvg(sheet);
    sheet.color = Axis{"difference", "%", AxisScale::logarithmic, 0.1, 100};
    const std::string with = sheetSvg(sheet);
    EXPECT_EQ(xmlProblem(with), "");
    EXPECT_EQ(count(without, "difference"), 0u);
    EXPECT_EQ(count(with, "difference (%)"), 1u);
    EXPECT_EQ(count(with, "<image "), 7u);
}

TEST(ContactSheet, IsOneSvgWithItsPicturesInside) {
    const std::string svg = sheetSvg(example());
    EXPECT_EQ(xmlProblem(svg), "");
    EXPECT_EQ(count(svg, "<image "), 6u);
    // By `base64` of coreutils.
    EXPECT_THAT(svg,
                HasSubstr("href=\"data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR4nGP4"
                          "z8AAAAMBAQDJ/pLvAAAAAElFTkSuQmCC\""));
    for (const char* text :
         {">dipole<", ">Marble<", ">&lt;Skin&gt;<", ">Model<", ">Material<", ">Materials &amp; models<"})
        EXPECT_THAT(svg, HasSubstr(text));
}

TEST(ContactSheet, LongIdsAreBrokenAtUnderscores) {
    ContactSheet sheet = example();
    EXPECT_THAT(sheetSvg(sheet), HasSubstr(">normalized_<")) << "wider than a picture of 100 px";
    sheet.picture_width = 200;
    EXPECT_THAT(sheetSvg(sheet), HasSubstr(">normalized_diffusion<"));
}

TEST(ContactSheet, ACellWithoutPictureStaysEmpty) {
    ContactSheet sheet = example();
    sheet.cells[4].png.clear();
    sheet.cells[4].note = "12 s";
    const std::string svg = sheetSvg(sheet);
    EXPECT_EQ(count(svg, "<image "), 5u);
    EXPECT_THAT(svg, HasSubstr(">12 s<"));
}

TEST(ContactSheet, AnotherEndingIsRefused) {
    try {
        drawSheet(example(), "sheet.gif");
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind, ErrorKind::usage);
        EXPECT_EQ(error.message, "a contact sheet cannot be written as '.gif'");
    }
}

#ifdef SEARCHLIGHT_QT

TEST(ContactSheet, BitmapsHaveTwoPixelsForEachPxAndShowThePictures) {
    const std::filesystem::path folder = std::filesystem::path(testing::TempDir());
    for (const char* name : {"sheet.png", "sheet.jpg"}) {
        const std::filesystem::path path = folder / name;
        drawSheet(example(), path);
        QImage image;
        ASSERT_TRUE(image.load(QString::fromStdString(path.string())));
        EXPECT_GE(image.width(), 2 * 3 * 100);
        int red = 0;
        for (int y = 0; y < image.height(); ++y)
            for (int x = 0; x < image.width(); ++x) {
                const QColor color = image.pixelColor(x, y);
                red += color.red() > 240 && color.green() < 20 && color.blue() < 20;
            }
        // JPEG smears edges, 8 pixels wide at most.
        EXPECT_NEAR(red, 6 * 200 * 160, 6 * 2 * 8 * (200 + 160)) << name;
        std::filesystem::remove(path);
    }
}

#endif

}  // namespace
}  // namespace searchlight
