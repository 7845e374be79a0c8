#include "draw/report.h"

#include "well_formed.h"

namespace searchlight {
namespace {

using testing::HasSubstr;
using testing::Not;

Report example() {
    Report report;
    report.title = "skin1 <& co>";
    report.summary = "The summary.";
    ReportSection section;
    section.heading = "Errors";
    section.paragraphs = {"One & two."};
    section.tables.push_back({"In numbers",
                              {"Model", "RMS, %", "Total", "Remark"},
                              {{"dipole", "-12.3 %", "0.31", "1 of 2 fits"}, {"better", ">1000 %", "—", ""}}});
    Figure figure;
    figure.title = "A figure";
    figure.series.push_back({.label = "line", .x = {0, 1}, .y = {0, 1}, .color = 0});
    section.figures = {figure, figure};
    report.sections = {section};
    report.metadata = {{"seed", "1"}};
    return report;
}

TEST(ReportHtml, IsWellFormed) { EXPECT_EQ(xmlProblem(reportHtml(example()), {"meta"}), ""); }

TEST(ReportHtml, SheetsOfPicturesStandInside) {
    Report report = example();
    ContactSheet sheet;
    sheet.title = "Nine pictures";
    sheet.columns = {"one"};
    sheet.rows = {"two"};
    sheet.cells.resize(1);
    report.sections.front().sheets.push_back(sheet);
    EXPECT_EQ(xmlProblem(reportHtml(report), {"meta"}), "");
    EXPECT_THAT(reportHtml(report), HasSubstr("Nine pictures"));
}

TEST(ReportHtml, LoadsNothingAndRunsNothing) {
    const std::string html = reportHtml(example());
    for (const char* loader :
         {"src=", "href=", "@import", "url(", "<script", "<link", "<iframe", " onload=", " onclick="})
        EXPECT_THAT(html, Not(HasSubstr(loader)));
    // The only address is the name of the SVG namespace, which nobody fetches; once for each figure.
    const std::string_view address = "http://www.w3.org/2000/svg\"";
    size_t addresses = 0;
    for (size_t at = html.find("http"); at != std::string::npos; at = html.find("http", at + 1), ++addresses)
        EXPECT_EQ(html.substr(at, address.size()), address);
    EXPECT_EQ(addresses, 2u);
}

TEST(ReportHtml, NumericColumnsAreRightAligned) {
    const std::string html = reportHtml(example());
    EXPECT_THAT(html, HasSubstr("<th scope=\"col\" class=\"number\">RMS, %</th>"));
    EXPECT_THAT(html, HasSubstr("<td class=\"number\">-12.3 %</td><td class=\"number\">0.31</td>"));
    EXPECT_THAT(html, HasSubstr("<td class=\"number\">—</td>"));
    EXPECT_THAT(html, HasSubstr("<td>dipole</td>"));
}

TEST(ReportHtml, TextIsEscapedAndComplete) {
    const std::string html = reportHtml(example());
    for (const char* part : {"<h1>skin1 &lt;&amp; co&gt;</h1>", "The summary.", "<h2>Errors</h2>", "One &amp; two.",
                             "<caption>In numbers</caption>", "<dt>seed</dt><dd>1</dd>", "prefers-color-scheme: dark"})
        EXPECT_THAT(html, HasSubstr(part));
}

TEST(ReportHtml, FiguresShareNoIds) { EXPECT_THAT(reportHtml(example()), Not(HasSubstr(" id="))); }

TEST(ReportHtml, SameReportSameBytes) { EXPECT_EQ(reportHtml(example()), reportHtml(example())); }

}  // namespace
}  // namespace searchlight
