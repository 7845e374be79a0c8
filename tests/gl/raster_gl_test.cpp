#include <gtest/gtest.h>

#include <array>

#include "base/error.h"
#include "gl/program.h"
#include "gl/raster_program.h"

namespace searchlight::gl {
namespace {

using testing::HasSubstr;

constexpr std::string_view prelude = "#version 450 core\n";

Source sourceOf(std::string_view text, std::string_view file) {
    Source source;
    source.add(prelude, "prelude");
    source.add(text, file);
    return source;
}

// Triangles from a buffer: x, y, depth a vertex.
constexpr std::string_view pull =
    "layout(std430, binding = 0) readonly buffer V { float v[]; };\n"
    "flat out int triangle;\n"
    "void main() { int i = 3 * gl_VertexID; triangle = gl_VertexID / 3;\n"
    "gl_Position = vec4(v[i], v[i + 1], v[i + 2], 1.0); }\n";
constexpr std::string_view number =
    "flat in int triangle;\n"
    "layout(location = 0) out vec4 color;\nlayout(location = 1) out uint id;\n"
    "void main() { color = vec4(0.25, 0, 0, 1); id = uint(triangle) + 1u; }\n";

// One triangle that covers clip space up to x + y = 0, at a depth.
std::vector<float> corner(float depth) { return {-1, -1, depth, 1, -1, depth, -1, 1, depth}; }

struct Target {
    Texture color, id, depth;
    Framebuffer framebuffer;

    explicit Target(Context& context, int side = 4)
        : color(context, {.format = Format::rgba32f, .width = side, .height = side}),
          id(context, {.format = Format::r32ui, .width = side, .height = side}),
          depth(context, {.format = Format::depth32f, .width = side, .height = side}),
          framebuffer(context, {&color, &id}, &depth) {
        framebuffer.clear();
    }

    std::array<unsigned, 16> ids() const {
        std::array<unsigned, 16> ids;
        id.download<unsigned>(ids);
        return ids;
    }
};

void draw(Context& context, const Target& target, const std::vector<float>& vertices, DrawOptions options = {}) {
    RasterProgram program(context, sourceOf(pull, "v.glsl"), sourceOf(number, "f.glsl"));
    Buffer buffer(context, vertices.size() * sizeof(float));
    buffer.upload<float>(vertices);
    options.triangles = static_cast<unsigned>(vertices.size() / 9);
    program.draw(target.framebuffer, options, {{0, buffer}});
}

TEST(RasterProgram, FillsWhatATriangleCoversFromTheTopRow) {
    Context context;
    const Target target(context);
    draw(context, target, corner(0.5f));
    // Pixel centres with x + y below 0; y = -1 is row 0. Those on the line belong to one side by the fill rule.
    const auto ids = target.ids();
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x)
            if (x + y != 3) {
                EXPECT_EQ(ids[4 * y + x], x + y < 3 ? 1u : 0u) << x << ", " << y;
            }
    std::array<float, 16> depth;
    target.depth.download<float>(depth);
    EXPECT_EQ(depth.front(), 0.5f);
    EXPECT_EQ(depth.back(), 1.0f);
}

TEST(RasterProgram, NearerTriangleWinsInAnyOrder) {
    Context context;
    for (const bool near_first : {false, true}) {
        const Target target(context);
        std::vector<float> vertices = corner(near_first ? 0.25f : 0.75f);
        const std::vector<float> second = corner(near_first ? 0.75f : 0.25f);
        vertices.insert(vertices.end(), second.begin(), second.end());
        draw(context, target, vertices);
        EXPECT_EQ(target.ids()[0], near_first ? 1u : 2u);
    }
}

TEST(RasterProgram, BothSidesAreDrawn) {
    Context context;
    const Target target(context);
    std::vector<float> vertices = corner(0.5f);
    for (int i = 0; i < 3; ++i) std::swap(vertices[i], vertices[3 + i]);
    draw(context, target, vertices);
    EXPECT_EQ(target.ids()[0], 1u);
}

TEST(RasterProgram, AddsUpOverlappingTriangles) {
    Context context;
    const Texture sum(context, {.width = 4, .height = 4});
    Framebuffer framebuffer(context, {&sum}, nullptr);
    framebuffer.clear();
    RasterProgram program(context, sourceOf(pull, "v.glsl"),
                          sourceOf("out vec4 color;\nvoid main() { color = vec4(0.25, 0, 0, 1); }\n", "f.glsl"));
    std::vector<float> vertices = corner(0.25f);
    vertices.insert(vertices.end(), vertices.begin(), vertices.begin() + 9);
    Buffer buffer(context, vertices.size() * sizeof(float));
    buffer.upload<float>(vertices);
    program.draw(framebuffer, {.triangles = 2, .depth_test = false, .add = true}, {{0, buffer}});
    std::array<float, 64> texels;
    sum.download<float>(texels);
    EXPECT_EQ(texels[0], 0.5f);
}

TEST(RasterProgram, DepthTextureComparesInAShader) {
    Context context;
    const Texture depth(context,
                        {.format = Format::depth32f, .width = 4, .height = 4, .linear = true, .compare = true});
    Framebuffer framebuffer(context, {}, &depth);
    framebuffer.clear();
    RasterProgram program(context, sourceOf(pull, "v.glsl"), sourceOf("void main() {}\n", "f.glsl"));
    Buffer buffer(context, 36);
    buffer.upload<float>(corner(0.5f));
    program.draw(framebuffer, {.triangles = 1}, {{0, buffer}});
    Program compare(context, sourceOf("layout(local_size_x = 1) in;\n"
                                      "layout(std430, binding = 0) buffer X { float x[]; };\n"
                                      "layout(binding = 2) uniform sampler2DShadow S;\n"
                                      "void main() { x[0] = textureLod(S, vec3(0.2, 0.2, 0.4), 0.0);\n"
                                      "x[1] = textureLod(S, vec3(0.2, 0.2, 0.6), 0.0);\n"
                                      "x[2] = textureLod(S, vec3(0.8, 0.8, 0.6), 0.0); }\n",
                                      "c.glsl"));
    compare.dispatch(1, {{0, buffer}}, {{2, depth}});
    std::array<float, 3> lit;
    buffer.download<float>(lit);
    EXPECT_THAT(lit, testing::ElementsAre(1, 0, 1));
}

TEST(RasterProgram, DrawsIntoOneFaceOfACube) {
    Context context;
    const Texture cube(context, {.format = Format::r32ui, .width = 2, .height = 2, .cube = true});
    RasterProgram program(context, sourceOf(pull, "v.glsl"),
                          sourceOf("out uint id;\nvoid main() { id = 7u; }\n", "f.glsl"));
    Buffer buffer(context, 36);
    buffer.upload<float>(corner(0.5f));
    Framebuffer face(context, {&cube}, nullptr, 4);
    face.clear();
    program.draw(face, {.triangles = 1, .depth_test = false}, {{0, buffer}});
    std::array<unsigned, 24> texels;
    cube.download<unsigned>(texels);
    for (int i = 0; i < 6; ++i) EXPECT_EQ(texels[4 * i], i == 4 ? 7u : 0u) << "face " << i;
}

TEST(RasterProgram, CompileErrorNamesTheStagesFileAndLine) {
    Context context;
    try {
        const RasterProgram program(context, sourceOf(pull, "v.glsl"),
                                    sourceOf("out vec4 color;\nvoid main() { color = nothing; }\n", "f.glsl"));
        FAIL() << "an undeclared name compiled";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind, ErrorKind::input);
        EXPECT_EQ(error.file, "f.glsl");
        EXPECT_EQ(error.line, 2);
        EXPECT_THAT(error.message, HasSubstr("nothing"));
    }
    EXPECT_NO_THROW(context.checkpoint());
}

TEST(Framebuffer, WhatCannotBeDrawnToIsADeviceError) {
    Context context;
    const Texture color(context, {});
    try {
        // A colour where the depth belongs.
        const Framebuffer framebuffer(context, {}, &color);
        FAIL() << "a colour texture was taken for a depth";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind, ErrorKind::device);
    }
}

}  // namespace
}  // namespace searchlight::gl
