#include "transport/walk/walk_gl.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <numbers>

#include "base/embedded.h"
#include "base/error.h"
#include "exact.h"
#include "gl/context.h"
#include "gl/program.h"
#include "transport/mesh/reference_body.h"
#include "transport/slab/slab.h"

namespace searchlight {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

class WalkGlTest : public testing::Test {
protected:
    gl::Context context;
    Observer observer;

    HalfSpaceResult walkHalf(const HalfSpaceProblem& problem, double walks, std::uint64_t seed,
                             std::vector<double> edges = {0, 1}, int grid = 0) {
        HalfSpaceOptions options;
        options.walks = static_cast<std::uint64_t>(walks);
        options.seed = seed;
        options.edges_mm = std::move(edges);
        options.grid = grid;
        options.grid_extent_mm = 2;
        options.gl = &context;
        return walkHalfSpace(problem, options, observer);
    }

    SlabResult walkLayers(const SlabProblem& problem, double walks, std::uint64_t seed, bool on_gl) {
        SlabOptions options;
        options.walks = static_cast<std::uint64_t>(walks);
        options.seed = seed;
        options.edges_mm = {0, 0.1, 0.3, 1, 3};
        options.angles = 6;
        options.depths = 8;
        options.depth_mm = 4;
        options.gl = on_gl ? &context : nullptr;
        return walkSlab(problem, options, observer);
    }
};

// Known answers of the Random123 library of [Salmon2011] (kat_vectors, philox4x32 with 10 rounds).
TEST_F(WalkGlTest, PhiloxGivesTheKnownAnswers) {
    gl::Source source;
    source.add("#version 450 core", "test");
    const std::string_view file = "src/transport/walk/philox.glsl";
    source.add(embeddedText(file).value(), file);
    source.add(
        "layout(local_size_x = 1) in;\n"
        "layout(std430, binding = 0) buffer Words { uvec4 words[]; };\n"
        "void main() {\n"
        "    uint i = gl_GlobalInvocationID.x;\n"
        "    words[6u + i] = philox(words[2u * i], words[2u * i + 1u].xy);\n"
        "}\n",
        "test");
    gl::Program program(context, source);
    // Counter and key in turn, then room for what comes out.
    const std::array<std::uint32_t, 24> given{
        0,           0,           0,           0,           0,           0,           0, 0,   // none
        0xFFFFFFFFu, 0xFFFFFFFFu, 0xFFFFFFFFu, 0xFFFFFFFFu, 0xFFFFFFFFu, 0xFFFFFFFFu, 0, 0,   // all
        0x243F6A88u, 0x85A308D3u, 0x13198A2Eu, 0x03707344u, 0xA4093822u, 0x299F31D0u, 0, 0};  // digits of pi
    gl::Buffer words(context, 36 * sizeof(std::uint32_t));
    words.upload(std::span<const std::uint32_t>(given));
    program.dispatch({3}, {{0, words}});
    std::array<std::uint32_t, 12> found{};
    words.download(std::span<std::uint32_t>(found), sizeof(given));
    EXPECT_THAT(found,
                testing::ElementsAre(0x6627E8D5u, 0xE169C58Du, 0xBC57AC4Cu, 0x9B00DBD8u, 0x408F276Du, 0x41C83B0Eu,
                                     0xA20BC7C6u, 0x6D5451FDu, 0xD16CFE09u, 0x94FDCCEBu, 0x5001E420u, 0x24126EA1u));
}

// As half_space_exact_test.cpp does for the CPU, which says what these see; fewer walks, as this is a software driver.
TEST_F(WalkGlTest, HalfSpaceTotalsAgreeWithAddingDoubling) {
    Judge judge;
    std::uint64_t seed = 1;
    const CsvTable exact = table("halfspace_refractive_isotropic.csv");
    for (std::size_t row = 0; row < exact.rows.size(); row += 9) {
        const double n = exact.number(row, column(exact, "n")), albedo = exact.number(row, column(exact, "albedo"));
        judge.compare(fmt::format("n {}, albedo {}", n, albedo), walkHalf(ofAlbedo(albedo, n), 3e4, seed++).all.total,
                      exact.number(row, column(exact, "R_diffuse")));
    }
    judge.expectAgreement();
}

// Power: 1e6 walks see 0.5 % of a bin.
TEST_F(WalkGlTest, AnnuliAgreeWithTheExactSearchlight) {
    const CsvTable exact = table("searchlight_isotropic_matched.csv");
    Judge judge;
    for (const double albedo : {0.5, 0.9}) {
        std::vector<double> edges = {0}, encircled = {0};
        for (std::size_t row = 0; row < exact.rows.size(); ++row)
            if (exact.number(row, column(exact, "albedo")) == albedo) {
                edges.push_back(exact.number(row, column(exact, "r")));
                encircled.push_back(exact.number(row, column(exact, "F_encircled")));
            }
        const HalfSpaceResult result = walkHalf(ofAlbedo(albedo), 1e6, 11, edges);
        for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
            const double area = std::numbers::pi * (edges[i + 1] * edges[i + 1] - edges[i] * edges[i]);
            const double flux = encircled[i + 1] - encircled[i];
            judge.compare(fmt::format("albedo {}, from {}", albedo, edges[i]),
                          {result.all.Rd[i], result.all.standard_error[i], result.walks}, flux / area, flux * 1e6);
        }
    }
    judge.expectAgreement();
}

// Forward scattering, refraction, oblique incidence and wide beams, against the CPU's walk: annuli and moments.
TEST_F(WalkGlTest, HalfSpaceAgreesWithTheCpu) {
    const std::vector<double> edges = {0, 0.05, 0.2, 0.5, 1, 2, 5};
    Judge judge;
    std::uint64_t seed = 100;
    for (const HalfSpaceProblem& problem :
         {HalfSpaceProblem{.sigma_a = 0.1, .sigma_s = 5, .g = 0.8, .eta = 1.3, .angle_deg = 50},
          HalfSpaceProblem{.sigma_a = 0.3, .sigma_s = 2, .g = -0.4, .eta = 0.8, .angle_deg = 30},
          HalfSpaceProblem{.sigma_a = 0.1, .sigma_s = 1, .eta = 1.5, .angle_deg = 60, .beam = {BeamShape::gaussian, 1}},
          HalfSpaceProblem{.sigma_a = 0.1, .sigma_s = 1, .g = 0.99, .eta = 1.4, .beam = {BeamShape::flat, 0.7}}}) {
        const HalfSpaceResult a = walkHalf(problem, 4e5, seed++, edges), b = walk(problem, 2e6, seed++, edges);
        const auto compare = [&](const std::string& what, Estimate mine, Estimate other) {
            judge.compare(fmt::format("g {}, {}", problem.g, what),
                          {mine.mean, std::hypot(mine.standard_error, other.standard_error), 0}, other.mean);
        };
        compare("total", a.all.total, b.all.total);
        compare("single", a.single.total, b.single.total);
        compare("mean x", a.all.mean_x_mm, b.all.mean_x_mm);
        compare("mean r2", a.all.mean_r2_mm2, b.all.mean_r2_mm2);
        for (std::size_t i = 0; i + 1 < edges.size(); ++i)
            compare(fmt::format("from {}", edges[i]), {a.all.Rd[i], a.all.standard_error[i], 0},
                    {b.all.Rd[i], b.all.standard_error[i], 0});
    }
    judge.expectAgreement();
}

// Walks of 1e5 collisions and the roulette of those that are longer: without absorption everything leaves. Sees 2 %.
TEST_F(WalkGlTest, WithoutAbsorptionEverythingLeaves) {
    Judge judge;
    judge.compare("matched", walkHalf(ofAlbedo(1), 4000, 5).all.total, 1);
    judge.expectAgreement();
}

// Every kind of interface: glass above and below, a gap between, an index that falls and one that rises; and a layer
// without end.
TEST_F(WalkGlTest, LayersAgreeWithTheCpu) {
    const std::vector<SlabLayer> glass{
        {1.5, 0, 0, 0, 1}, {1.4, 0.05, 4, 0.8, 0.7}, {1, 0, 0, 0, 0.2}, {1.3, 0.3, 2, 0, 1}, {1.5, 0, 0, 0, 0.5}};
    Judge judge;
    std::uint64_t seed = 1;
    for (const SlabProblem& problem : {SlabProblem{1, 1.33, glass}, SlabProblem{1, 1.33, glass, 60},
                                       SlabProblem{1, 1, {{1.5, 0.1, 2, 0, infinity}}}}) {
        const SlabResult a = walkLayers(problem, 2e5, seed++, true), b = walkLayers(problem, 1e6, seed++, false);
        EXPECT_EQ(a.specular, b.specular);
        const auto compare = [&](const std::string& what, const Estimate& mine, const Estimate& other,
                                 double events = 1e9) {
            if (other.mean == 0) return;
            judge.compare(what, {mine.mean, std::hypot(mine.standard_error, other.standard_error), 0}, other.mean,
                          events);
        };
        compare("R", a.R, b.R);
        compare("R single", a.R_single, b.R_single);
        compare("R unscattered", a.R_unscattered, b.R_unscattered);
        compare("T", a.T, b.T);
        compare("T unscattered", a.T_unscattered, b.T_unscattered);
        compare("A", a.A, b.A);
        for (std::size_t i = 0; i < problem.layers.size(); ++i) compare("A of a layer", a.A_layer[i], b.A_layer[i]);
        const auto compareSeries = [&](const char* what, const SlabSeries& mine, const SlabSeries& other) {
            for (std::size_t i = 0; i < mine.mean.size(); ++i)
                if (!std::isnan(other.mean[i]))
                    compare(fmt::format("{} {}", what, i), {mine.mean[i], mine.standard_error[i], 0},
                            {other.mean[i], other.standard_error[i], 0},
                            std::pow(mine.mean[i] / mine.standard_error[i], 2));
        };
        compareSeries("R(r)", a.R_r, b.R_r);
        compareSeries("T(r)", a.T_r, b.T_r);
        compareSeries("R(alpha)", a.R_a, b.R_a);
        compareSeries("T(alpha)", a.T_a, b.T_a);
        compareSeries("A(z)", a.A_z, b.A_z);
        compareSeries("fluence(z)", a.fluence_z, b.fluence_z);
    }
    judge.expectAgreement();
}

// A ball in equilibrium (mesh_reference_test.cpp says why): collisions and the exitance of every cell are known.
TEST_F(WalkGlTest, ABallIsInEquilibriumInUniformLight) {
    constexpr double pi = std::numbers::pi, walks = 4e4;
    const Ball ball(1.5, 1);
    Judge judge;
    std::uint64_t seed = 1;
    for (const double eta : {1.0, 1.4})
        for (const double g : {0.0, 0.8}) {
            const Medium medium{.sigma_s = {2, 2, 2}, .g = {g, g, g}, .eta = eta};
            const BodyResult result =
                walkBody(ball, medium, 0, UniformLight{},
                         {.walks = static_cast<std::uint64_t>(walks), .seed = seed++, .gl = &context}, observer);
            double t = 0;  // 1 - 2 int F(mu, 1/eta) mu dmu, midpoint rule
            for (int i = 0; i < 4000; ++i) {
                const double mu = (i + 0.5) / 4000, inside = std::sqrt(1 - (1 - mu * mu) / (eta * eta));
                const double s = (mu - eta * inside) / (mu + eta * inside),
                             p = (eta * mu - inside) / (eta * mu + inside);
                t += (1 - 0.5 * (s * s + p * p)) * 2 * mu / 4000;
            }
            const std::string what = fmt::format("eta {}, g {}", eta, g);
            judge.compare(what, result.collisions_per_entry, 2 * eta * eta * 4 * ball.volume() / (ball.area() * t));
            EXPECT_EQ(result.left.mean, result.entered.mean) << what << ": all that entered leaves";
            for (std::size_t cell = 0; cell < result.exitance.size(); ++cell)
                judge.compare(fmt::format("{}, cell {}", what, cell),
                              {result.exitance[cell], result.standard_error[cell], result.candidates}, pi * t,
                              walks / static_cast<double>(ball.cellCount()));
        }
    judge.expectAgreement();
}

TEST_F(WalkGlTest, AnAbsorbingBallAgreesWithTheCpu) {
    const Ball ball(1.2, 1);
    const Medium medium{.sigma_a = {0.2, 0.2, 0.2}, .sigma_s = {3, 3, 3}, .g = {0.5, 0.5, 0.5}, .eta = 1.3};
    const PencilLight beam{{0, 1.2, 0}, {0, 1, 0}, {std::sin(1.0), std::cos(1.0), 0}};
    const BodyResult a = walkBody(ball, medium, 0, beam, {.walks = 200'000, .gl = &context}, observer);
    const BodyResult b = walkBody(ball, medium, 0, beam, {.walks = 1'000'000, .seed = 2}, observer);
    Judge judge;
    const auto compare = [&](const std::string& what, const Estimate& mine, const Estimate& other,
                             double events = 1e9) {
        judge.compare(what, {mine.mean, std::hypot(mine.standard_error, other.standard_error), 0}, other.mean, events);
    };
    compare("reflectance", a.reflectance, b.reflectance);
    compare("absorbed", a.absorbed, b.absorbed);
    compare("collisions", a.collisions_per_entry, b.collisions_per_entry);
    for (int axis = 0; axis < 3; ++axis) compare("mean exit", a.mean_exit[axis], b.mean_exit[axis]);
    for (std::size_t cell = 0; cell < a.exitance.size(); ++cell)
        compare(fmt::format("cell {}", cell), {a.exitance[cell], a.standard_error[cell], 0},
                {b.exitance[cell], b.standard_error[cell], 0}, std::pow(b.exitance[cell] / b.standard_error[cell], 2));
    judge.expectAgreement();
}

// Chunks of many sizes, among them the last; ends of a dispatch fall anywhere.
TEST_F(WalkGlTest, TheSameWalksGiveTheSameNumbers) {
    const HalfSpaceProblem problem{.sigma_a = 0.02, .sigma_s = 1, .g = 0.3, .eta = 1.4};
    for (const double walks : {1.0, 63.0, 1000.0, 65'537.0, 200'001.0}) {
        const HalfSpaceResult a = walkHalf(problem, walks, 7, {0, 1, 2}, 8),
                              b = walkHalf(problem, walks, 7, {0, 1, 2}, 8);
        EXPECT_EQ(a.walks, static_cast<std::uint64_t>(walks));
        EXPECT_EQ(a.collisions, b.collisions);
        EXPECT_EQ(a.all.Rd, b.all.Rd);
        EXPECT_EQ(a.all.grid, b.all.grid);
        EXPECT_EQ(a.all.standard_error, b.all.standard_error);
    }
}

TEST_F(WalkGlTest, AJobThatStoppedGoesOnAsIfItHadNot) {
    const HalfSpaceProblem problem{.sigma_a = 0.02, .sigma_s = 1, .eta = 1.4};
    HalfSpaceOptions options;
    options.walks = 100'000;
    options.edges_mm = {0, 1, 2};
    options.gl = &context;
    const HalfSpaceResult whole = walkHalfSpace(problem, options, observer);

    struct Impatient : Observer {
        mutable int asked = 0;
        bool cancelled() const override { return ++asked > 20; }
    } impatient;
    WalkState state;
    options.control.state = &state;
    EXPECT_TRUE(walkHalfSpace(problem, options, impatient).interrupted);
    EXPECT_GT(state.chunks, 0u);
    const HalfSpaceResult rest = walkHalfSpace(problem, options, observer);
    EXPECT_EQ(rest.walks, whole.walks);
    EXPECT_EQ(rest.all.Rd, whole.all.Rd);
    EXPECT_EQ(rest.all.standard_error, whole.all.standard_error);
}

TEST_F(WalkGlTest, RefusesTabulatedPhaseFunctions) {
    SlabProblem problem{1, 1, {{1.3, 0.1, 1, 0, 1}}};
    problem.layers[0].phase = PhaseFunction{{0, 90, 180}, {1, 0.5, 1}};
    try {
        walkLayers(problem, 1e3, 1, true);
        FAIL();
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("OpenGL does not walk tabulated phase functions"));
    }
}

}  // namespace
}  // namespace searchlight
