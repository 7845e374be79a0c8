#include "job/paper/paper.h"

#include <gmock/gmock.h>

#include "job/command.h"

namespace searchlight {
namespace {

using testing::HasSubstr;

PaperPlate plate(std::string_view figure, std::uint64_t walks) {
    Engine engine;
    Observer observer;
    for (const Paper& paper : papers())
        for (const PaperFigure& entry : paper.figures)
            if (paper.id == "frisvad2014" && entry.id == figure)
                return entry.make({.engine = engine, .observer = observer, .walks = walks, .seed = 7});
    throw std::runtime_error("no such figure");
}

// Pictures of a sphere in place of the scan, small and noisy.
PaperPlate pictures(std::string_view figure, std::uint64_t walks) {
    Engine engine;
    Observer observer;
    for (const PaperFigure& entry : frisvad2014Paper().figures)
        if (entry.id == figure)
            return entry.make(
                {.engine = engine, .observer = observer, .walks = walks, .seed = 7, .object = "sphere", .size = 40});
    throw std::runtime_error("no such figure");
}

const PaperStatement& statement(const PaperPlate& plate, std::string_view part) {
    for (const PaperStatement& candidate : plate.statements)
        if (candidate.says.find(part) != std::string::npos) return candidate;
    throw std::runtime_error("no such statement");
}

TEST(Frisvad2014, DirectionalDipoleOverestimatesAtNormalIncidence) {
    const PaperPlate four = plate("4", 200'000);
    EXPECT_EQ(four.figure.panels.size(), 3u);
    EXPECT_TRUE(statement(four, "overestimation").holds) << statement(four, "overestimation").found;
    EXPECT_TRUE(statement(four, "very small").holds) << statement(four, "very small").found;
}

TEST(Frisvad2014, OnlyTheDirectionalDipoleShiftsWithTheAngle) {
    const PaperPlate five = plate("5", 400'000);
    EXPECT_TRUE(statement(five, "only the directional dipole").holds);
    // Contradicted: single scattering carries about half of the shift near the beam (docs/oblique.md).
    EXPECT_FALSE(statement(five, "minor directional").holds) << statement(five, "minor directional").found;
    const PaperPlate six = plate("6", 400'000);
    EXPECT_EQ(six.figure.panels.size(), 12u);
    for (const PaperStatement& said : six.statements) EXPECT_TRUE(said.holds) << said.says << said.found;
}

TEST(Frisvad2014, DipolesMissThePeakWithoutSingleScattering) {
    for (const PaperStatement& said : plate("12", 400'000).statements)
        EXPECT_TRUE(said.holds) << said.says << said.found;
}

TEST(Frisvad2014, NegativeValuesAppearAtGrazingIncidence) {
    const PaperPlate thirteen = plate("13", 20'000);
    for (const PaperStatement& said : thirteen.statements) EXPECT_TRUE(said.holds) << said.says << said.found;
    EXPECT_THAT(thirteen.figure.caption, HasSubstr("White outline"));
}

TEST(Frisvad2014, TheDirectionalDipoleIsCloserWhereLightScattersForward) {
    const PaperPlate one = pictures("1", 40'000);
    EXPECT_TRUE(one.statements.at(0).holds) << one.statements.at(0).found;
    ASSERT_TRUE(one.sheet.has_value());
    EXPECT_EQ(one.sheet->cells.size(), one.sheet->rows.size() * one.sheet->columns.size());
    EXPECT_THAT(one.csv, HasSubstr("white_grapefruit_juice,ours,own,"));
    const Json& numbers = one.values.at("white_grapefruit_juice");
    EXPECT_GT(numbers.at("reference").at("relative_noise"), 0.0);
    for (const char* label : {"dipole", "btpole", "qntzd"})
        EXPECT_GT(numbers.at(label).at("without_single_scattering").at("relative_rmse_without_noise"),
                  numbers.at(label).at("relative_rmse_without_noise"))
            << "light scattered once is missing";
}

TEST(Frisvad2014, ThePlaneInWhichTheSourceIsMirroredMattersInBackLitRegions) {
    const PaperPlate fourteen = pictures("14", 20'000);
    const PaperStatement& said = statement(fourteen, "overestimates them. Marble");
    EXPECT_TRUE(said.holds) << said.found;
    EXPECT_THAT(fourteen.csv, HasSubstr("marble,tangent,own,"));
}

TEST(Papers, SayWhatTheyAre) {
    for (const Paper& paper : papers()) {
        EXPECT_FALSE(paper.citation.empty());
        for (const PaperFigure& figure : paper.figures) {
            EXPECT_FALSE(figure.shows.empty());
            EXPECT_NE(figure.make, nullptr);
        }
    }
}

}  // namespace
}  // namespace searchlight
