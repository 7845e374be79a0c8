#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "illegal/messages.h"
#include "transport/mcml/mcml_run.h"

namespace searchlight {
namespace {

McmlRun threeLayers() {
    McmlRun run;
    run.output = "three.mco";
    run.photons = 50'000;
    run.dz = 0.01, run.dr = 0.02;
    run.nz = 30, run.nr = 7, run.na = 4;
    run.layers = {{1.37, 1, 100, 0.9, 0.1}, {1.37, 1, 10, 0, 0.1}, {1.37, 2, 10, 0.7, 0.2}};
    return run;
}

McmlOutput walked(const McmlRun& run) {
    Observer observer;
    return mcmlOutput(run, walkSlab(slabProblem(run), slabOptions(run), observer));
}

std::string refusal(const std::function<void()>& read) {
    try {
        read();
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

TEST(Mci, IsReadWithCommentsBlankLinesAndCarriageReturns) {
    const std::vector<McmlRun> runs = parseMci(
        "# lengths in cm\r\n\r\n1.0\t# version\r\n2 # runs\r\n\r\none.mco A\r\n1e3\r\n20E-4 .5\r\n10 20 "
        "30\r\n1\r\n1.0\r\n"
        "#n mua mus g d\r\n1.4 10 2e2 0.7 1.0E+8\r\n1.33\r\n two.mco b\n5\n1 1\n1 1 1\n1\n1\n1.5 0 0 0 0.1#glass\n1",
        "x.mci");
    ASSERT_EQ(runs.size(), 2u);
    McmlRun one;
    one.output = "one.mco";
    one.photons = 1000;
    one.dz = 0.002, one.dr = 0.5;
    one.nz = 10, one.nr = 20, one.na = 30;
    one.n_below = 1.33;
    one.layers = {{1.4, 10, 200, 0.7, 1e8}};
    EXPECT_EQ(runs[0], one);
    EXPECT_EQ(runs[1].output, "two.mco");
    EXPECT_EQ(runs[1].format, 'B');
    EXPECT_EQ(runs[1].layers.at(0), (McmlLayer{1.5, 0, 0, 0, 0.1}));
}

TEST(Mci, TextIsReadBackUnchanged) {
    McmlRun other = threeLayers();
    other.output = "other.mco";
    other.format = 'B';
    other.dz = 1.0 / 3;
    other.n_below = 1.1;
    const std::vector<McmlRun> runs{threeLayers(), other};
    EXPECT_EQ(parseMci(mciText(runs), "x.mci"), runs);
}

// Two runs share the media; the second asks for its tallies over two lines.
TEST(Mci, VersionTwoIsReadAsTheSameRuns) {
    const std::vector<McmlRun> runs = parseMci(
        "# media\r\nmcmli2.0\nair 1.0 0 0 0\nwater 1.33 0 0 0\nskin 1.37 1 1e2 0.9 # dermis\nfat 1.4 2 10 -0.5\nend of "
        "media\none.mco A\nair\nskin 0.1\nfat 1E8\nwater\nend\npencil\n0\n0.01 0.02 0.1\n10 20 1 3\nRd_r A_z\n1E4 "
        "5:10\n1E-4\n1\ntwo.mco A\nwater\nfat 0.3\nair\nend\npencil\n0.0\n1 2 3\n1 2 3 4\nTD_RA \\\n a_rz\n77\n0\n5\n"
        "end of all\n",
        "x.mci");
    ASSERT_EQ(runs.size(), 2u);
    McmlRun one;
    one.output = "one.mco";
    one.photons = 10'000;
    one.dz = 0.01, one.dr = 0.02;
    one.nz = 10, one.nr = 20, one.na = 3;
    one.n_below = 1.33;
    one.layers = {{1.37, 1, 100, 0.9, 0.1}, {1.4, 2, 10, -0.5, 1e8}};
    EXPECT_EQ(runs[0], one);
    McmlRun two;
    two.output = "two.mco";
    two.photons = 77;
    two.dz = 1, two.dr = 2;
    two.nz = 1, two.nr = 2, two.na = 4;
    two.n_above = 1.33;
    two.layers = {{1.4, 2, 10, -0.5, 0.3}};
    EXPECT_EQ(runs[1], two);
}

// Its authors publish this with MCML 2.0: .237859 +- .000312, .641547 +- .000293 and .0962202 +- .000186 of 1e6
// photons, by a generator that is known to be biased by tenths of a percent, hence 0.005.
TEST(Mci, PublishedSampleOfVersionTwoComesOut) {
    const std::vector<McmlRun> runs = parseMci(
        "mcmli2.0\nair 1 0 0 0\none 1.37 1 100 0.9\ntwo 1.37 1 10 0\nthree 1.37 2 10 0.7\nend\ns.mco A\nair\none "
        "0.1\ntwo 0.1\nthree 0.2\nair\nend\npencil\n0\n0.01 0.01 0.1\n40 50 100 1\nA_rz\n2e5\n1e-4\n1\nend\n",
        "x.mci");
    const McmlOutput output = walked(runs.at(0));
    EXPECT_NEAR(output.specular, 0.0243729, 1e-6);
    EXPECT_NEAR(output.Rd, 0.237859, 0.005);
    EXPECT_NEAR(output.A, 0.641547, 0.005);
    EXPECT_NEAR(output.Tt, 0.0962202, 0.003);
}

TEST(Mci, IllegalFilesAreRefusedWithTheirPlace) {
    expectMessages("mci", [](auto text, auto path) { parseMci(text, path); });
}

TEST(Layers, IllegalFilesAreRefusedWithTheirPlace) {
    expectMessages("layers", [](auto text, auto path) { parseLayers(text, path); });
}

TEST(Layers, AreReadWithTheirDefaults) {
    const SlabProblem problem = parseLayers(
        R"({"format": "searchlight-layers/1", "n_below": 1.33, "layers": [
            {"n": 1.5, "sigma_a": 0, "sigma_s": 0, "thickness_mm": 1},
            {"n": 1.4, "sigma_a": 0.1, "sigma_s": 10, "g": -0.5, "thickness_mm": "infinite"}]})",
        "x.json");
    constexpr double infinity = std::numeric_limits<double>::infinity();
    EXPECT_EQ(problem, (SlabProblem{1, 1.33, {{1.5, 0, 0, 0, 1}, {1.4, 0.1, 10, -0.5, infinity}}, 0}));
}

TEST(Mcml, CentimetresBecomeMillimetresAndAnEndlessLayerAHalfSpace) {
    McmlRun run = threeLayers();
    run.layers.back().d = 1e8;
    const SlabProblem problem = slabProblem(run);
    EXPECT_EQ(problem.layers[0], (SlabLayer{.n = 1.37, .sigma_a = 0.1, .sigma_s = 10, .g = 0.9, .thickness_mm = 1}));
    EXPECT_TRUE(std::isinf(problem.layers[2].thickness_mm));
    const SlabOptions options = slabOptions(run);
    EXPECT_DOUBLE_EQ(options.edges_mm.at(7), 1.4);
    EXPECT_DOUBLE_EQ(options.depth_mm, 3);
}

// The file carries 5 digits.
TEST(Mco, IsReadBackToItsDigits) {
    const McmlOutput a = walked(threeLayers()), b = parseMco(mcoText(a), "x.mco");
    EXPECT_EQ(a.run, b.run);
    EXPECT_NEAR(a.Rd, b.Rd, 1e-6);
    for (const auto member :
         {&McmlOutput::A_l, &McmlOutput::A_z, &McmlOutput::Rd_r, &McmlOutput::Rd_a, &McmlOutput::Tt_r,
          &McmlOutput::Tt_a, &McmlOutput::A_rz, &McmlOutput::Rd_ra, &McmlOutput::Tt_ra}) {
        ASSERT_EQ((a.*member).size(), (b.*member).size());
        for (std::size_t i = 0; i < (a.*member).size(); ++i)
            EXPECT_NEAR((a.*member)[i], (b.*member)[i], 5.1e-5 * (a.*member)[i]);
    }
}

// The sums that MCML itself makes: cells times its measures are the totals, because the last cells take the rest.
TEST(Mco, CellsAddUpToTheTotals) {
    const McmlRun run = threeLayers();  // 1.4 mm wide and 3 of 4 mm deep: much lies beyond
    const McmlOutput out = walked(run);
    EXPECT_NEAR(out.specular + out.Rd + out.A + out.Tt, 1, 1e-12);
    EXPECT_NEAR(std::accumulate(out.A_l.begin(), out.A_l.end(), 0.0), out.A, 1e-12);
    const double da = 0.5 * std::numbers::pi / run.na;
    double Rd = 0, Tt = 0, Rd_a = 0, A_z = 0, A_rz = 0, Rd_ra = 0;
    const auto nr = static_cast<std::size_t>(run.nr), nz = static_cast<std::size_t>(run.nz),
               na = static_cast<std::size_t>(run.na);
    for (std::size_t i = 0; i < nr; ++i) {
        const double area = 2 * std::numbers::pi * (static_cast<double>(i) + 0.5) * run.dr * run.dr;
        Rd += out.Rd_r[i] * area;
        Tt += out.Tt_r[i] * area;
        for (std::size_t j = 0; j < nz; ++j) A_rz += out.A_rz[i * nz + j] * area * run.dz;
        for (std::size_t j = 0; j < na; ++j)
            Rd_ra += out.Rd_ra[i * na + j] * area * 2 * std::numbers::pi * std::sin(da / 2) *
                     std::sin((2 * static_cast<double>(j) + 1) * da);
    }
    for (std::size_t j = 0; j < na; ++j)
        Rd_a += out.Rd_a[j] * 2 * std::numbers::pi * std::sin((static_cast<double>(j) + 0.5) * da) * da;
    for (std::size_t j = 0; j < nz; ++j) A_z += out.A_z[j] * run.dz;
    EXPECT_NEAR(Rd, out.Rd, 1e-12);
    EXPECT_NEAR(Tt, out.Tt, 1e-12);
    EXPECT_NEAR(Rd_a, out.Rd, 1e-12);
    EXPECT_NEAR(Rd_ra, out.Rd, 1e-12);
    EXPECT_NEAR(A_z, out.A, 5 * out.A_error);  // counted at collisions
    EXPECT_NEAR(A_rz, A_z, 1e-12);
    EXPECT_GT(out.Rd_r.back(), out.Rd_r[nr - 2]);  // it holds what lies beyond
}

TEST(Mco, FaultsNameTheirLine) {
    const std::string good = mcoText(walked(threeLayers()));
    const auto with = [&](const std::string& from, const std::string& to) {
        std::string text = good;
        text.replace(text.find(from), from.size(), to);
        return refusal([&] { parseMco(text, "x.mco"); });
    };
    EXPECT_EQ(refusal([&] { parseMco(good, "x.mco"); }), "no error");
    EXPECT_EQ(with("A1", "A2"), "x.mco:1:1: unknown version 'A2' (A1 is read)");
    EXPECT_EQ(with("InParm", "Input"), "x.mco:5:1: 'Input' in place of the block InParm");
    EXPECT_EQ(with("\nA_z", "\nA_zz"), "x.mco:30:1: 'A_zz' in place of the block A_z");
    EXPECT_EQ(with("\nA_l", "\n0.5\nA_l"), "x.mco:25:1: '0.5' in place of the block A_l");
    std::string ones = "Tt_ra\n";
    for (int i = 0; i < 29; ++i) ones += "1 ";
    EXPECT_EQ(with("Tt_ra\n", ones + "\n"), "x.mco:148:57: '1' after the 28 values of Tt_ra");
    EXPECT_EQ(refusal([&] { parseMco(good + "\nend\n", "x.mco"); }), "x.mco:155:1: data after the block Tt_ra");
    EXPECT_EQ(refusal([&] { parseMco(good.substr(0, good.find("Tt_ra\n") + 6), "x.mco"); }),
              "x.mco:148:1: the file ends before the 28 values of Tt_ra");
}

// Glass as [Wang1995] has it: its reflections belong to the specular part.
TEST(Mcml, SpecularReflectanceIncludesTheGlassAbove) {
    McmlRun run = threeLayers();
    run.layers.insert(run.layers.begin(), {1.5, 0, 0, 0, 0.1});
    const double r1 = 0.04, r2 = std::pow((1.5 - 1.37) / (1.5 + 1.37), 2);
    EXPECT_NEAR(walked(run).specular, r1 + (1 - r1) * (1 - r1) * r2 / (1 - r1 * r2), 1e-15);
}

}  // namespace
}  // namespace searchlight
