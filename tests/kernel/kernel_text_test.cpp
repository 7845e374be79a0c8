#include "kernel/kernel_text.h"

#include "base/error.h"
#include "base/files.h"
#include "illegal/messages.h"
#include "kernel/methods.h"
#include "kernel/profiles.h"

namespace searchlight {
namespace {

// The 25 and 17 taps of the first separable kernel as they are published with its demonstration [Jimenez2015].
std::string published() { return readFile(SEARCHLIGHT_SOURCE_DIR "/tests/data/kernels/skin_tables.hlsl"); }

TEST(KernelText, PublishedTablesAreWithoutFaultAndComeOutOfTheModel) {
    const std::vector<KernelTable> tables = parseKernelTables(published(), "skin_tables.hlsl");
    ASSERT_EQ(tables.size(), 2);
    for (const KernelTable& table : tables) {
        EXPECT_THAT(table.faults, testing::IsEmpty()) << table.line;
        const Taps ours = originalTaps(SkinModel(), static_cast<int>(table.term.offsets_mm.size()));
        for (std::size_t i = 0; i < table.term.weights.size(); ++i) {
            EXPECT_NEAR(table.term.offsets_mm[i], ours.terms[0].offsets_mm[i], 1e-5);
            // Six digits are printed, of single precision.
            for (int c = 0; c < Rgb::channels; ++c)
                EXPECT_NEAR(table.term.weights[i][c], ours.terms[0].weight(i)[c],
                            2e-5 * ours.terms[0].weight(i)[c] + 1e-9);
        }
    }
}

TEST(KernelText, SlipsOfDigitsAreFound) {
    const auto faultsWith = [](const std::string& right, const std::string& wrong) {
        std::string text = published();
        text.replace(text.find(right), right.size(), wrong);
        return parseKernelTables(text, "copy.hlsl")[0].faults;
    };
    EXPECT_THAT(faultsWith("0.0128496", "0.012849"), testing::Contains(testing::HasSubstr("other side")));
    EXPECT_THAT(faultsWith("0.0657244", "0.0675244"), testing::Contains(testing::HasSubstr("green adds up to")));
    EXPECT_THAT(faultsWith("float4(0.017924", "float4(-0.017924"), testing::Contains(testing::HasSubstr("negative")));
    EXPECT_THAT(faultsWith("-2.52083", "-2.25083"), testing::Contains(testing::HasSubstr("on the other side")));
}

TEST(KernelText, BothSidesWithTheSameSlipAreFoundWithinARightSum) {
    // Two weights exchanged on both sides: the sum stands, the shape does not.
    std::string text = published();
    for (std::size_t at = 0; (at = text.find("0.0410172", at)) != text.npos; ++at) text.replace(at, 9, "0.0263643");
    for (std::size_t at = 0; (at = text.find("0.0263642", at)) != text.npos; ++at) text.replace(at, 9, "0.0410172");
    const std::vector<KernelTable> tables = parseKernelTables(text, "copy.hlsl");
    EXPECT_THAT(tables[0].faults, testing::Contains(testing::HasSubstr("red per mm does not fall")));
}

TEST(KernelText, ExportsReadBackAsTheSameKernel) {
    const GroundTruth truth = burleyTruth();
    const CellKernel cells = cellKernel(truth, gridOf(truth));
    for (const MethodOptions& options : {MethodOptions{}, MethodOptions{.method = "svd", .rank = 3},
                                         MethodOptions{.method = "optimised", .rank = 2}}) {
        const Taps taps = makeKernel(truth, cells, options).taps;
        for (const TapsFormat& format : tapsFormats()) {
            const std::string text = format.write(taps, {.material = "a \"b\"", .truth = "c", .method = "d"});
            const std::vector<KernelTable> tables = parseKernelTables(text, "export");
            for (const KernelTable& table : tables) EXPECT_GE(table.line, 1) << format.name;
            const std::vector<Taps> read = kernelsOfTables(tables);
            ASSERT_EQ(read.size(), 1) << format.name;
            ASSERT_EQ(read[0].rank(), taps.rank()) << format.name;
            for (std::size_t t = 0; t < taps.rank(); ++t) {
                const TapTerm &a = read[0].terms[t], &b = taps.terms[t];
                EXPECT_EQ(a.angle_deg, b.angle_deg);
                ASSERT_EQ(a.weights.size(), b.weights.size());
                for (std::size_t i = 0; i < a.weights.size(); ++i) {
                    EXPECT_NEAR(a.offsets_mm[i], b.offsets_mm[i], 1e-7);
                    EXPECT_NEAR(a.scale.g, b.scale.g, 1e-7);
                    EXPECT_NEAR(a.weights[i].r, b.weight(i).r, 1e-8);
                }
            }
        }
    }
}

TEST(KernelText, FormsInCirculationAreTheSameKernel) {
    // Middle, then one side from the outermost tap inwards, as an engine ships it; bare numbers; nested lists.
    for (const char* text :
         {"const vec4 k[3] = vec4[](vec4(0.4, 0.4, 0.4, 0), vec4(0.1, 0.1, 0.1, 2), vec4(0.2, 0.2, "
          "0.2, 1));",
          "const vec2 k[3] = vec2[](vec2(0.4, 0.0), vec2(0.1, 2.0), vec2(0.2, 1.0));",
          "# weights and offset\n0.4 0.4 0.4 0\n0.2, 0.2, 0.2, 1\n0.1 0.1 0.1 2\n", "0.4 0\n0.2 1\n0.1 2",
          "kernel = [[0.4, 0.4, 0.4, 0], [0.2, 0.2, 0.2, 1], [0.1, 0.1, 0.1, 2]]",
          "0.1 0.1 0.1 -2\n0.2 0.2 0.2 -1\n0.4 0.4 0.4 0\n0.2 0.2 0.2 1\n0.1 0.1 0.1 2"}) {
        const std::vector<KernelTable> tables = parseKernelTables(text, "form");
        ASSERT_EQ(tables.size(), 1) << text;
        EXPECT_THAT(tables[0].faults, testing::IsEmpty()) << text;
        EXPECT_EQ(tables[0].term.offsets_mm, (std::vector<double>{-2, -1, 0, 1, 2})) << text;
        for (std::size_t i = 0; i < 5; ++i)
            EXPECT_EQ(tables[0].term.weights[i].g, (std::array{0.1, 0.2, 0.4, 0.2, 0.1}[i])) << text;
    }
}

TEST(KernelText, ALineBreakInANameStaysInTheComment) {
    const Taps taps = originalTaps(SkinModel(), 7);
    const std::string text = tapsFormats()[0].write(taps, {.material = "a\nfloat4 b;", .truth = "c", .method = "d"});
    EXPECT_THAT(text, testing::HasSubstr("kernel: a float4 b;\n"));
}

TEST(KernelText, EnginesGetTheWidthOfTheProfile) {
    const std::string unity = engineProfile("unity", burleyTruth(), {.material = "m", .truth = "t"}, 1.3);
    EXPECT_THAT(unity, testing::HasSubstr("Scattering Color = 1, 0.5, 0\n"));
    EXPECT_THAT(unity, testing::HasSubstr("Multiplier = 1 "));
    EXPECT_THAT(engineProfile("unreal", burleyTruth(), {}, 1.3), testing::HasSubstr("MeanFreePathDistance"));
    EXPECT_THROW(engineProfile("quake", burleyTruth(), {}, 1.3), Error);
}

TEST(KernelText, IllegalFilesAreRefusedWithAPlace) {
    expectMessages("kernels", [](std::string_view text, std::string_view path) { parseKernelTables(text, path); });
}

}  // namespace
}  // namespace searchlight
