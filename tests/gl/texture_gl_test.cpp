#include "gl/texture.h"

#include <gtest/gtest.h>

#include <array>
#include <numeric>

#include "base/error.h"
#include "gl/program.h"

namespace searchlight::gl {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

Source compute(std::string_view text) {
    Source source;
    source.add("#version 450 core\nlayout(local_size_x = 1) in;\nlayout(std430, binding = 0) buffer X { float x[]; };",
               "prelude");
    source.add(text, "user.glsl");
    return source;
}

template <std::size_t n>
std::array<float, n> run(Context& context, std::string_view text, TextureBinding texture, Groups groups = {}) {
    Program program(context, compute(text));
    const Buffer buffer(context, n * sizeof(float));
    program.dispatch(groups, {{0, buffer}}, {texture});
    std::array<float, n> values;
    buffer.download<float>(values);
    return values;
}

TEST(Texture, StartsAsZerosAndReturnsWhatWasUploaded) {
    Context context;
    Texture texture(context, {.format = Format::rgba32f, .width = 2, .height = 1});
    std::array<float, 8> texels;
    texels.fill(-1);
    texture.download<float>(texels);
    EXPECT_THAT(texels, testing::Each(0));
    const std::array<float, 8> sent{1, 2, 3, 4, 5, 6, 7, 8e30f};
    texture.upload<float>(sent);
    texture.download<float>(texels);
    EXPECT_EQ(texels, sent);
}

TEST(Texture, NearestAndLinearLookUps) {
    Context context;
    const std::array<float, 2> row{0, 1};
    const char* text =
        "layout(binding = 1) uniform sampler2D T;\n"
        "void main() { for (int i = 0; i < 3; ++i) x[i] = texture(T, vec2(0.25 + 0.25 * i, 0.5)).x; }";
    for (const bool linear : {false, true}) {
        Texture texture(context, {.format = Format::r32f, .width = 2, .height = 1, .linear = linear});
        texture.upload<float>(row);
        const auto values = run<3>(context, text, {1, texture});
        EXPECT_EQ(values[0], 0);
        EXPECT_EQ(values[2], 1);
        // Weights of a linear look-up are fixed point with 8 bits on many devices.
        if (linear) {
            EXPECT_NEAR(values[1], 0.5, 1.0 / 256);
        }
    }
}

TEST(Texture, RepeatsOrEndsAtItsEdge) {
    Context context;
    const std::array<float, 4> row{1, 2, 3, 4};
    const char* text =
        "layout(binding = 0) uniform sampler2D T;\nvoid main() { x[0] = texture(T, vec2(1.125, 0.5)).x; }";
    for (const bool repeat : {false, true}) {
        Texture texture(context, {.format = Format::r32f, .width = 4, .height = 1, .repeat = repeat});
        texture.upload<float>(row);
        EXPECT_EQ(run<1>(context, text, {0, texture})[0], repeat ? 1 : 4);
    }
}

TEST(Texture, SmallestMipLevelIsTheMean) {
    Context context;
    Texture texture(context, {.format = Format::r32f, .width = 8, .height = 8, .mipmaps = true, .linear = true});
    std::array<float, 64> texels;
    std::iota(texels.begin(), texels.end(), 0.0f);
    texture.upload<float>(texels);
    texture.update();
    const char* text =
        "layout(binding = 0) uniform sampler2D T;\nvoid main() { x[0] = textureLod(T, vec2(0.5), 3.0).x; }";
    EXPECT_NEAR(run<1>(context, text, {0, texture})[0], 31.5, 1e-5);
}

TEST(Texture, LayersOfAnArrayAndFacesOfACube) {
    Context context;
    Texture array(context, {.format = Format::r32f, .layers = 3});
    Texture cube(context, {.format = Format::r32f, .cube = true});
    for (int i = 0; i < 6; ++i) {
        const float value = static_cast<float>(10 + i);
        if (i < 3) array.upload(std::span(&value, 1), i);
        cube.upload(std::span(&value, 1), i);
    }
    EXPECT_THAT(run<3>(context,
                       "layout(binding = 0) uniform sampler2DArray T;\n"
                       "void main() { for (int i = 0; i < 3; ++i) x[i] = texture(T, vec3(0.5, 0.5, i)).x; }",
                       {0, array}),
                ElementsAre(10, 11, 12));
    EXPECT_THAT(run<3>(context,
                       "layout(binding = 0) uniform samplerCube T;\nvoid main() { x[0] = texture(T, vec3(1, 0, 0)).x;\n"
                       "x[1] = texture(T, vec3(0, -1, 0)).x; x[2] = texture(T, vec3(0, 0, -1)).x; }",
                       {0, cube}),
                ElementsAre(10, 13, 15));
}

TEST(Texture, BeyondTheDeviceIsADeviceError) {
    Context context;
    try {
        const Texture texture(context, {.width = 1 << 30, .height = 1});
        FAIL() << "a row of 2^30 texels was made";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind, ErrorKind::device);
        EXPECT_THAT(error.message, HasSubstr("too large"));
    }
}

TEST(BufferTexture, ReadsItsBuffer) {
    Context context;
    Buffer buffer(context, 32);
    const std::array<float, 8> sent{0, 1, 2, 3, 4, 5, 6, 7};
    buffer.upload<float>(sent);
    const BufferTexture vectors(context, buffer, Format::rgba32f);
    EXPECT_THAT(run<2>(context,
                       "layout(binding = 4) uniform samplerBuffer T;\n"
                       "void main() { x[0] = texelFetch(T, 1).x; x[1] = texelFetch(T, 1).w; }",
                       {4, vectors}),
                ElementsAre(4, 7));
    const BufferTexture integers(context, buffer, Format::r32ui);
    EXPECT_EQ(run<1>(context,
                     "layout(binding = 4) uniform usamplerBuffer T;\n"
                     "void main() { x[0] = uintBitsToFloat(texelFetch(T, 6).x); }",
                     {4, integers})[0],
              6);
}

TEST(Program, DispatchesInThreeDimensions) {
    Context context;
    Texture unused(context, {});
    const auto values =
        run<24>(context, "void main() { uvec3 i = gl_WorkGroupID; x[i.x + 2 * (i.y + 3 * i.z)] = 1.0 + i.z; }",
                {0, unused}, {2, 3, 4});
    for (int i = 0; i < 24; ++i) EXPECT_EQ(values[i], 1 + i / 6);
}

TEST(Context, ClockRunsForwards) {
    Context context;
    const double first = context.finish();
    EXPECT_GE(context.finish(), first);
}

}  // namespace
}  // namespace searchlight::gl
