// A model that somebody wrote a minute ago: the way through OpenGL.
#include <nlohmann/json.hpp>

#include "program.h"

namespace searchlight {
namespace {

constexpr const char* falloff = R"(analytic radial no_wi no_wo
::begin parameters
float Width 0.1 10 1
::end parameters
::begin shader
vec3 Bssrdf(vec3 Xi, vec3 Wi, vec3 Xo, vec3 Wo) {
    return vec3(exp(-distance(Xi, Xo) / Width) / (2.0 * PI * Width * Width));
}
::end shader
)";

TEST_F(Program, EvaluatesAModelFileOnOpenGl) {
    writeFile(folder() / "falloff.bssrdf", falloff);
    const Output output = run("profile --model falloff.bssrdf --set Width=2 --radii 0,2 --json");
    ASSERT_EQ(output.exit_code, 0) << output.err;
    const nlohmann::json profile = nlohmann::json::parse(output.out);
    EXPECT_THAT(profile.at("backend").get<std::string>(), testing::HasSubstr("gl"));
    const double peak = 1 / (8 * 3.14159265358979);
    EXPECT_NEAR(profile.at("Rd").at(0).at(1).get<double>() / (peak * std::exp(-1.0)), 1, 1e-5);  // float on GL
    EXPECT_NEAR(profile.at("total").at(0).get<double>(), 1, 1e-5);
}

TEST_F(Program, NamesFileLineAndColumnOfAMistake) {
    std::string broken = falloff;
    broken.replace(broken.find("Width * Width"), 13, "Width * Wdith");
    writeFile(folder() / "falloff.bssrdf", broken);
    const Output output = run("profile --model falloff.bssrdf --radii 1");
    EXPECT_EQ(output.exit_code, 3);
    EXPECT_THAT(output.err, testing::HasSubstr("falloff.bssrdf:7:"));
    EXPECT_THAT(output.err, testing::HasSubstr("Wdith"));
}

// Saves a mistake while the program watches, sees it reported, and mends it; waits for files, not for times.
TEST_F(Program, WatchesAModelFileThroughAMistake) {
    writeFile(folder() / "falloff.bssrdf", falloff);
    writeFile(folder() / "watch.sh", R"(
        until_true() { for i in $(seq 200); do if eval "$1"; then return 0; fi; sleep 0.05; done; echo "never: $1"; }
        "$1" plot pencil --models falloff.bssrdf --watch -o a.svg 2>err >/dev/null &
        until_true 'grep -q watching err'
        cp falloff.bssrdf good
        sed -i 's/Width \* Width/Width * Wdith/' falloff.bssrdf
        until_true 'grep -q falloff.bssrdf:7: err'
        rm a.svg
        cp good falloff.bssrdf
        until_true 'test -f a.svg'
        kill -INT $!
        wait $!
        echo "exit $?"
    )");
    const std::string command = "cd '" + folder().string() + "' && bash watch.sh '" SEARCHLIGHT_PROGRAM "' >out 2>&1";
    ASSERT_EQ(std::system(command.c_str()), 0);
    // A shell starts background work with Ctrl+C ignored; the program's own handler is what answers here.
    EXPECT_EQ(readFile(folder() / "out"), "exit 0\n");
}

}  // namespace
}  // namespace searchlight
