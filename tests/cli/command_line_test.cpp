#include <nlohmann/json.hpp>

#include "base/csv.h"
#include "program.h"

namespace searchlight {
namespace {

using nlohmann::json;

TEST_F(Program, AnswersArgumentsThatMakeNoSenseWithOneMessage) {
    const std::filesystem::path table = std::filesystem::path(SEARCHLIGHT_SOURCE_DIR) / "tests/illegal/arguments.csv";
    const CsvTable expected = parseCsv(readFile(table), "arguments.csv");
    for (std::size_t i = 0; i < expected.rows.size(); ++i) {
        const std::string& arguments = expected.rows[i][0].text;
        const Output output = run(arguments);
        EXPECT_EQ(output.exit_code, expected.number(i, 1)) << arguments;
        EXPECT_EQ(output.err, "searchlight: " + expected.rows[i][2].text + "\n") << arguments;
        EXPECT_EQ(output.out, "") << arguments;
        EXPECT_EQ(fileCount(), 0u) << arguments;
    }
}

TEST_F(Program, RefusesAPictureFormatThatItCannotWrite) {
    const Output output = run("plot pencil --models dipole -o pencil.gif");
    EXPECT_EQ(output.exit_code, 2);
    // Builds with Qt go on with .png and .pdf.
    EXPECT_THAT(output.err,
                testing::StartsWith("searchlight: pencil.gif: a figure cannot be written as '.gif' (write .svg, .csv"));
    EXPECT_EQ(fileCount(), 0u);
}

TEST_F(Program, TakesAnObjectThatIsCalledAsACommandForAnObject) {
    const Output output = run("reference mesh sphere --walks 12345 --print-job");
    EXPECT_EQ(output.exit_code, 0) << output.err;
    const json job = json::parse(output.out);
    EXPECT_EQ(job.at("command"), "reference mesh");
    EXPECT_EQ(job.at("scene").at("object"), "sphere") << output.out;
    EXPECT_EQ(job.at("options").at("walks"), 12345) << output.out;
}

// Curves of several models are on one medium: whoever gives Rdr and ld may say which model turns them into one.
TEST_F(Program, RdrAndLdAreInvertedByTheModelThatIsNamed) {
    const std::string plot = "plot pencil --models dipole --Rdr 0.4 --ld 1 --print-job ";
    EXPECT_EQ(json::parse(run(plot).out).at("scene").at("model").at("id"), "dipole");
    const Output named = run(plot + "--inverted-by better_dipole:Moments=exact");
    EXPECT_EQ(named.exit_code, 0) << named.err;
    const json model = json::parse(named.out).at("scene").at("model");
    EXPECT_EQ(model.at("id"), "better_dipole");
    EXPECT_EQ(model.at("parameters").at("Moments"), "exact");
    EXPECT_EQ(run(plot + "--inverted-by no_such_model").exit_code, 2);
    const Output useless = run("plot pencil --material skin1 --inverted-by dipole");
    EXPECT_EQ(useless.exit_code, 2);
    EXPECT_THAT(useless.err, testing::HasSubstr("belongs to --Rdr and --ld"));
}

TEST_F(Program, HelpShowsEveryCommandsExampleAndSucceeds) {
    for (const char* command : {"models", "materials", "profile", "invert", "reference halfspace", "plot pencil",
                                "plot error", "plot albedo", "check", "report", "doctor", "run"}) {
        const Output output = run(std::string(command) + " --help");
        EXPECT_EQ(output.exit_code, 0) << command;
        EXPECT_THAT(output.out, testing::HasSubstr(std::string("Example:\n  searchlight ") + command)) << command;
        EXPECT_THAT(output.out, testing::HasSubstr(std::string("Usage: searchlight ") + command)) << command;
    }
    EXPECT_THAT(run("").out, testing::HasSubstr("plot"));
    EXPECT_THAT(run("--version").out, testing::StartsWith("searchlight "));
}

TEST_F(Program, ListsModelsAndMaterialsAsJson) {
    const json models = json::parse(run("models --json").out).at("models");
    const auto files = std::filesystem::directory_iterator(SEARCHLIGHT_SOURCE_DIR "/models");
    EXPECT_EQ(models.size(), static_cast<std::size_t>(std::distance(begin(files), end(files))));
    for (const json& model : models) {
        EXPECT_FALSE(model.at("id").get<std::string>().empty());
        EXPECT_FALSE(model.at("title").get<std::string>().empty());
        EXPECT_EQ(model.at("attributes").at(0), "analytic");
        EXPECT_TRUE(model.at("parameters").is_array());
    }
    const json materials = json::parse(run("materials --json").out).at("materials");
    EXPECT_GE(materials.size(), 12u + 35u + 4u);
}

TEST_F(Program, ProfileIsChannelMajorAndPerTransmittedFlux) {
    const json profile =
        json::parse(run("profile --model dipole --material skin1 --radii 0.05,0.1,0.3,1,3,10 --json").out);
    EXPECT_EQ(profile.at("format"), "searchlight-profile/1");
    EXPECT_EQ(profile.at("per"), "transmitted");
    EXPECT_EQ(profile.at("unit"), "1/mm^2");
    ASSERT_EQ(profile.at("Rd").size(), 3u);
    ASSERT_EQ(profile.at("Rd").at(0).size(), 6u);
    // An independent evaluation of the classical dipole with six digits printed: half a digit is 2e-7 relative.
    EXPECT_NEAR(profile.at("Rd").at(0).at(3).get<double>(), 2.201903e-02, 1e-5 * 2.2e-2);
    EXPECT_NEAR(profile.at("total").at(0).get<double>(), 0.435956, 1e-6);
}

TEST_F(Program, OneNumberPerCoefficientGivesOneChannel) {
    const json profile = json::parse(
        run("profile --model better_dipole --sigma-a 0.0041 --sigma-s 2.62 --g 0 --eta 1.5 --radii 1 --json").out);
    ASSERT_EQ(profile.at("Rd").size(), 1u);
    EXPECT_NEAR(profile.at("Rd").at(0).at(0).get<double>(), 4.141675e-02, 1e-5 * 4.1e-2);
}

TEST_F(Program, AChannelWithoutScatteringIsNull) {
    const json profile = json::parse(run("profile --model dipole --material coke --radii 1 --json").out);
    EXPECT_TRUE(profile.at("Rd").at(2).at(0).is_null());
    EXPECT_TRUE(profile.at("total").at(2).is_null());
    EXPECT_EQ(profile.at("material").at("not_applicable"), json({2}));
}

TEST_F(Program, ReferenceHasItsParts) {
    const json reference = json::parse(
        run("reference halfspace --sigma-a 1 --sigma-s 9 --g 0 --eta 1.5 --walks 1e5 --seed 1 --angle-deg 60 "
            "--edges 0,0.1,0.2,0.5,1,2,5,10 --json")
            .out);
    EXPECT_EQ(reference.at("format"), "searchlight-reference/1");
    EXPECT_EQ(reference.at("per"), "incident");
    EXPECT_EQ(reference.at("walks"), 100000);
    EXPECT_GT(reference.at("seconds").get<double>(), 0);
    EXPECT_GE(reference.at("threads").get<int>(), 1);
    EXPECT_EQ(reference.at("profile").at("edges_mm").size(), 8u);
    const double all = reference.at("diffuse").at("mean").at(0),
                 single = reference.at("single").at("diffuse").at("mean").at(0),
                 multiple = reference.at("multiple").at("diffuse").at("mean").at(0);
    EXPECT_NEAR(all, single + multiple, 1e-12);
    for (const json* order : {&reference, &reference.at("single"), &reference.at("multiple")}) {
        EXPECT_EQ(order->at("profile").at("Rd").at(0).size(), 7u);
        EXPECT_EQ(order->at("profile").at("stderr").at(0).size(), 7u);
    }
}

TEST_F(Program, ReferenceDoesNotDependOnThreads) {
    const std::string arguments =
        "reference halfspace --material marble --walks 2e5 --seed 5 --bins 20 --radii-max 10 --json";
    json one = json::parse(run(arguments + " --threads 1").out), two = json::parse(run(arguments + " --threads 2").out);
    for (const char* key : {"diffuse", "profile", "single", "multiple"}) EXPECT_EQ(one.at(key), two.at(key)) << key;
}

TEST_F(Program, AJobFileRepeatsItsCommandLine) {
    const std::string arguments = "reference halfspace --material skin1 --walks 1e4 --seed 3 --edges 0,1,2";
    writeFile(folder() / "job.json", run(arguments + " --print-job").out);
    json direct = json::parse(run(arguments + " --json").out), replayed = json::parse(run("run job.json --json").out);
    for (json* document : {&direct, &replayed}) document->erase("seconds");
    EXPECT_EQ(direct, replayed);
}

TEST_F(Program, PlotWritesWhatItIsAskedFor) {
    const Output output = run(
        "plot pencil --material skin1 --models dipole,better_dipole:Moments=exact --reference-walks 1e5 -o pencil.svg");
    EXPECT_EQ(output.exit_code, 0) << output.err;
    const std::string svg = readFile(folder() / "pencil.svg");
    EXPECT_THAT(svg, testing::HasSubstr("Classical dipole"));
    EXPECT_THAT(svg, testing::HasSubstr("Moments exact"));
    EXPECT_THAT(svg, testing::HasSubstr("Monte Carlo"));
    EXPECT_EQ(fileCount(), 1u);
}

TEST_F(Program, AMeasuredProfileIsTreatedLikeAModel) {
    ASSERT_EQ(run("profile --model dipole --material marble -o measured.csv").exit_code, 0);
    const json table = json::parse(run("profile --model ./measured.csv --material marble --radii 0.5,1,3 --json").out);
    const json model = json::parse(run("profile --model dipole --material marble --radii 0.5,1,3 --json").out);
    // The table was made to 1e-4.
    for (int c = 0; c < 3; ++c)
        for (int i = 0; i < 3; ++i)
            EXPECT_NEAR(table.at("Rd").at(c).at(i).get<double>() / model.at("Rd").at(c).at(i).get<double>(), 1, 1e-4);
}

TEST_F(Program, ReportIsSelfContained) {
    const Output output = run("report --material marble --walks 2e4 --albedo-walks 0 -o out/");
    EXPECT_EQ(output.exit_code, 0) << output.err;
    const std::string page = readFile(folder() / "out/index.html");
    EXPECT_THAT(page, testing::HasSubstr("<svg"));
    EXPECT_THAT(page, testing::Not(testing::HasSubstr("src=\"http")));
    EXPECT_THAT(page, testing::Not(testing::HasSubstr("<script")));
    EXPECT_THAT(readFile(folder() / "out/errors.csv"), testing::HasSubstr("better_dipole,R,"));
}

TEST_F(Program, AnInterruptedPlotExitsWith130AndLeavesNoFile) {
    // timeout sends what Ctrl+C sends.
    const Output output =
        run("plot pencil --models dipole --reference-walks 1e12 -o pencil.svg", "timeout --preserve-status -s INT 1");
    EXPECT_EQ(output.exit_code, 130);
    EXPECT_THAT(output.err, testing::HasSubstr("interrupted"));
    EXPECT_EQ(fileCount(), 0u);
}

}  // namespace
}  // namespace searchlight
