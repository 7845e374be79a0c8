// Figures of papers, made again: a paper is a file paper_x.cpp, or a few, and one line in papers.cpp.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/figure.h"
#include "base/observer.h"
#include "draw/contact_sheet.h"
#include "job/engine.h"
#include "job/json.h"

namespace searchlight {

/// What a paper says in words, and what is found here.
struct PaperStatement {
    std::string says;   ///< in our words
    std::string found;  ///< with numbers
    bool holds = false;
};

/// A figure, what had to be chosen for it, and what it shows.
struct PaperPlate {
    Figure figure;
    std::optional<ContactSheet> sheet;  ///< where the paper shows pictures: in place of the figure, or beside it
    std::string csv;                    ///< the sheet's numbers; empty: the figure's
    std::vector<std::string> choices;   ///< where the paper's text leaves a setting open
    std::vector<PaperStatement> statements;
    Json values = Json::object();  ///< the numbers behind the statements
    std::string table;             ///< of a table: ours beside theirs, as lines of text
};

/// What a figure is made with.
struct PaperRun {
    Engine& engine;
    Observer& observer;
    std::uint64_t walks = 1'000'000;  ///< of the reference, per curve or picture
    std::uint64_t seed = 1;
    int threads = 0;
    std::string backend = "auto";
    std::string object = "statue";  ///< where the paper shows a scan
    std::string environment;        ///< a picture of all directions, where the paper has one; empty: discs of light
    int size = 0;                   ///< side of each picture in pixels; 0: the figure's own
};

struct PaperFigure {
    std::string id;     ///< "4"
    std::string shows;  ///< one line
    PaperPlate (*make)(const PaperRun& run);
};

struct Paper {
    std::string id;  ///< "frisvad2014"
    std::string citation;
    std::vector<PaperFigure> figures;
    std::vector<PaperFigure> tables = {};
};

/// In the order of publication.
std::span<const Paper> papers();

/// The rows of papers(), each made in the paper's own file.
Paper mertens2003Paper();
Paper chang2007Paper();
Paper frisvad2014Paper();
Paper freude2014Paper();

}  // namespace searchlight
