// A report as data, and as one HTML file that needs nothing else: no network, no scripts.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "base/figure.h"
#include "draw/contact_sheet.h"

namespace searchlight {

struct ReportTable {
    std::string caption;
    std::vector<std::string> header;
    std::vector<std::vector<std::string>> rows;  ///< each as long as the header; numbers are right-aligned
};

struct ReportSection {
    std::string heading;
    std::vector<std::string> paragraphs;  ///< plain text; escaped
    std::vector<ReportTable> tables;
    std::vector<Figure> figures;       ///< drawn inline as SVG
    std::vector<ContactSheet> sheets;  ///< the same, each over the whole width
};

struct Report {
    std::string title;
    std::string summary;  ///< what a reader should take away
    std::vector<ReportSection> sections;
    std::vector<std::pair<std::string, std::string>> metadata;  ///< version, job, seed, backend
};

std::string reportHtml(const Report& report);

}  // namespace searchlight
