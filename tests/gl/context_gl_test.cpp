#include "gl/context.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <thread>

#include "base/error.h"
#include "gl/buffer.h"
#include "gl/program.h"

namespace searchlight::gl {
namespace {

using testing::HasSubstr;

Source sourceOf(std::string_view text) {
    Source source;
    source.add("#version 450 core\nlayout(local_size_x = 1) in;\n", "prelude");
    source.add(text, "user.glsl");
    return source;
}

// Doubles four integers in a buffer.
std::array<int, 4> doubled(Context& context) {
    Program program(context, sourceOf("layout(std430, binding = 3) buffer Data { int x[]; };\n"
                                      "void main() { x[gl_GlobalInvocationID.x] *= 2; }\n"));
    std::array<int, 4> values = {1, -2, 3, 40};
    Buffer buffer(context, sizeof values);
    buffer.upload<int>(values);
    program.dispatch(4, {{3, buffer}});
    buffer.download<int>(values);
    return values;
}

constexpr std::array<int, 4> expected = {2, -4, 6, 80};

TEST(Context, SaysWhatItRunsOn) {
    const Context context("surfaceless");
    EXPECT_EQ(context.info().platform, "surfaceless");
    EXPECT_FALSE(context.info().renderer.empty());
    EXPECT_THAT(context.info().glsl_version, testing::StartsWith("4."));
}

TEST(Context, ComputesOverABuffer) {
    Context context;
    EXPECT_EQ(doubled(context), expected);
}

TEST(Context, TwoContextsTakeTurnsOnOneThread) {
    Context first, second;
    Buffer in_first(first, 4), in_second(second, 4);
    const int one = 1, two = 2;
    in_first.upload(std::span(&one, 1));
    in_second.upload(std::span(&two, 1));
    int read = 0;
    in_first.download(std::span(&read, 1));
    EXPECT_EQ(read, 1);
    in_second.download(std::span(&read, 1));
    EXPECT_EQ(read, 2);
    EXPECT_EQ(doubled(first), expected);
    EXPECT_EQ(doubled(second), expected);
}

TEST(Context, IsMadeAndUsedOnAnotherThread) {
    std::array<int, 4> from_thread{};
    std::thread([&] {
        Context context;
        from_thread = doubled(context);
    }).join();
    EXPECT_EQ(from_thread, expected);
}

TEST(Context, MovesBetweenThreadsOnceReleased) {
    Context context;
    context.release();
    std::array<int, 4> from_thread{};
    std::thread([&] {
        from_thread = doubled(context);
        context.release();
    }).join();
    EXPECT_EQ(from_thread, expected);
    EXPECT_EQ(doubled(context), expected);
}

TEST(Context, HeldByAnotherThreadIsADeviceError) {
    Context context;
    std::thread([&] {
        try {
            context.makeCurrent();
            ADD_FAILURE() << "the context was current on two threads";
        } catch (const Error& error) {
            EXPECT_EQ(error.kind, ErrorKind::device);
            EXPECT_THAT(error.hint, HasSubstr("another thread"));
        }
    }).join();
}

TEST(Context, TwoContextsComputeAtTheSameTime) {
    std::array<std::array<int, 4>, 2> results{};
    std::thread other([&] {
        Context context;
        for (int i = 0; i < 20; ++i) results[0] = doubled(context);
    });
    Context context;
    for (int i = 0; i < 20; ++i) results[1] = doubled(context);
    other.join();
    EXPECT_EQ(results[0], expected);
    EXPECT_EQ(results[1], expected);
}

TEST(Context, HealthyContextIsNotLost) {
    Context context;
    EXPECT_FALSE(context.lost());
    EXPECT_NO_THROW(context.checkpoint());
}

TEST(Context, UnknownPlatformIsAnsweredWithThoseThatExist) {
    try {
        const Context context("99");
        FAIL() << "device 99 was found";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind, ErrorKind::device);
        EXPECT_EQ(error.message, "no OpenGL platform '99' on this machine");
        EXPECT_THAT(error.hint, HasSubstr("surfaceless"));
    }
}

TEST(Context, EnvironmentChoosesThePlatform) {
    setenv("SEARCHLIGHT_GL", "nonsense", 1);
    EXPECT_THROW(Context(), Error);
    setenv("SEARCHLIGHT_GL", "surfaceless", 1);
    EXPECT_EQ(Context().info().platform, "surfaceless");
    unsetenv("SEARCHLIGHT_GL");
}

// In a process of its own, which has not loaded EGL yet.
TEST(ContextDeathTest, MissingDriverIsADeviceErrorAndNoAbort) {
    testing::GTEST_FLAG(death_test_style) = "threadsafe";
    const auto tryWithoutDrivers = [] {
        setenv("__EGL_VENDOR_LIBRARY_DIRS", "/nonexistent", 1);
        try {
            const Context context;
        } catch (const Error& error) {
            std::_Exit(error.kind == ErrorKind::device && error.hint.find("apt install") == 0 ? 4 : 1);
        }
        std::_Exit(0);
    };
    EXPECT_EXIT(tryWithoutDrivers(), testing::ExitedWithCode(4), "");
}

TEST(Context, DriverErrorSurfacesAtTheNextCheckpoint) {
    Context context;
    Program program(context, sourceOf("layout(std430, binding = 0) buffer Data { int x[]; };\n"
                                      "void main() { x[0] = 1; }\n"));
    Buffer buffer(context, 4);
    try {
        program.dispatch(0xffffffffu, {{0, buffer}});  // more groups than any device takes
        FAIL() << "the driver's error was lost";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind, ErrorKind::device);
        EXPECT_THAT(error.message, HasSubstr("GL_INVALID_VALUE"));
    }
    EXPECT_NO_THROW(context.checkpoint());  // said once
}

TEST(Context, CompilerWarningIsNoError) {
    Context context;
    Program program(context, sourceOf("layout(std430, binding = 0) buffer Data { float x[]; };\n"
                                      "void main() { float never_set; x[0] = never_set; }\n"));
    EXPECT_NO_THROW(context.checkpoint());
}

TEST(Buffer, StartsAsZeros) {
    Context context;
    const Buffer buffer(context, 64);
    std::array<int, 16> values;
    values.fill(-1);
    buffer.download<int>(values);
    EXPECT_THAT(values, testing::Each(0));
}

TEST(Buffer, DownloadsAPart) {
    Context context;
    Buffer buffer(context, 16);
    buffer.upload<int>(std::array{1, 2, 3, 4});
    std::array<int, 2> part{};
    buffer.download<int>(part, 4);
    EXPECT_THAT(part, testing::ElementsAre(2, 3));
}

TEST(Buffer, BeyondTheDeviceIsADeviceError) {
    Context context;
    try {
        const Buffer buffer(context, std::size_t{1} << 50);
        FAIL() << "a petabyte was allocated";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind, ErrorKind::device);
        EXPECT_THAT(error.message, HasSubstr("too large"));
    }
}

TEST(Program, UniformsReachTheShader) {
    Context context;
    Program program(context, sourceOf("layout(std430, binding = 0) buffer Data { float x[]; };\n"
                                      "uniform int I; uniform bool B; uniform float F; uniform vec3 V;\n"
                                      "void main() { x[0] = float(I); x[1] = B ? 1.0 : 0.0; x[2] = F;\n"
                                      "x[3] = V.x; x[4] = V.y; x[5] = V.z; }\n"));
    program.set("I", -7);
    program.set("B", 1);
    program.set("F", 0.25f);
    program.set("V", Rgb{1, 2, 3});
    program.set("NoSuchUniform", 1);
    Buffer buffer(context, 24);
    program.dispatch(1, {{0, buffer}});
    std::array<float, 6> values;
    buffer.download<float>(values);
    EXPECT_THAT(values, testing::ElementsAre(-7, 1, 0.25, 1, 2, 3));
}

TEST(Program, BlockSizeFollowsStd430) {
    Context context;
    const Program program(context, sourceOf("layout(std430, binding = 0) buffer Data { float a; vec3 b; vec3 c[2]; };\n"
                                            "layout(std430, binding = 1) buffer Unused { int u; };\n"
                                            "void main() { c[1] = a * b; }\n"));
    EXPECT_EQ(program.blockSize("Data"), 64u);
    EXPECT_EQ(program.blockSize("Nothing"), 0u);
}

TEST(Program, CompileErrorNamesTheUsersFileLineAndColumn) {
    Context context;
    try {
        const Program program(context, sourceOf("// a comment\nvoid main() {\n    float y =   1.0;  y = foo;\n}\n"));
        FAIL() << "an undeclared name compiled";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind, ErrorKind::input);
        EXPECT_EQ(error.file, "user.glsl");
        EXPECT_EQ(error.line, 3);
        EXPECT_EQ(error.column, 27);
        EXPECT_EQ(error.message, "`foo' undeclared");
    }
    EXPECT_NO_THROW(context.checkpoint());
}

TEST(Program, RecursionIsRefused) {
    Context context;
    try {
        const Program program(context, sourceOf("layout(std430, binding = 0) buffer Data { int x[]; };\n"
                                                "int f(int n);\nint f(int n) { return n < 1 ? 0 : f(n - 1); }\n"
                                                "void main() { x[0] = f(x[1]); }\n"));
        FAIL() << "recursion linked";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind, ErrorKind::input);
        EXPECT_THAT(error.message, HasSubstr("recurs"));
    }
}

TEST(Probe, ReportsEveryPlatformAndOneThatWorks) {
    const std::vector<DeviceReport> reports = probe();
    ASSERT_FALSE(reports.empty());
    bool any = false;
    for (const DeviceReport& report : reports) {
        any |= report.works;
        EXPECT_EQ(report.works, report.problem.empty());
        EXPECT_EQ(report.works, !report.info.renderer.empty());
    }
    EXPECT_TRUE(any);
}

}  // namespace
}  // namespace searchlight::gl
