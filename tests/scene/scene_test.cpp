#include "scene/scene.h"

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/files.h"
#include "scene/json_text.h"

namespace searchlight {
namespace {

Scene parse(const std::string& body) {
    return parseScene("{\"format\": \"searchlight-scene/1\"" + (body.empty() ? "" : ", " + body) + "}", "scene.json");
}

// Every part in use, with numbers that have no short decimal form.
Scene richScene() {
    Scene scene;
    scene.object = "models/bunny \"70k\".ply";
    scene.scale = 1.0 / 3;
    scene.camera = {-12.5, 0.1 + 0.2, 3, 40, {0.1, -1e-17, 5e-324}};
    scene.material = {"", {0.1}, {1, 2, 1e29}, {0.9}, {}, {}, 1.0 / 0.7};
    scene.model = {
        "my.bssrdf",
        {{"fit", std::string("exact")}, {"Depth", 2.5}, {"Clamp", true}, {"w", std::vector<double>{1, 0, 0.1}}}};
    scene.lights = {DirectionalLight{{0, 1, 0}, {1, 0.5, 0.1}, 0.53, "glass.png"},
                    EnvironmentLight{"venice.hdr", {2, 2, 2}, 90, true, "angular"}, PointLight{{0, 2, 0}, {3, 2, 1}}};
    scene.ground = Ground{-0.25, {0.2, 0.3, 0.4}};
    scene.backdrop = Rgb{0.1, 0.1, 0.2};
    scene.coat = Coat{0.15, "clear.brdf", {{"gloss", 0.1}, {"tint", std::vector<double>{1, 0, 0.1}}}};
    return scene;
}

TEST(SceneFile, RoundTripIsExact) {
    for (const Scene& scene : {Scene{}, richScene()}) {
        const std::string text = sceneJson(scene);
        const Scene again = parseScene(text, "scene.json");
        EXPECT_EQ(sceneJson(again), text);
        EXPECT_EQ(again.scale, scene.scale);
        EXPECT_EQ(again.camera.target.z, scene.camera.target.z);
        EXPECT_EQ(again.material.sigma_s, scene.material.sigma_s);
        EXPECT_EQ(again.material.eta, scene.material.eta);
        EXPECT_EQ(again.model.parameters, scene.model.parameters);
        EXPECT_EQ(again.lights.size(), scene.lights.size());
        if (scene.coat) {
            EXPECT_EQ(again.coat->parameters, scene.coat->parameters);
        }
        EXPECT_EQ(again.backdrop, scene.backdrop);
    }
}

TEST(SceneFile, EmptySceneIsTheDefault) {
    EXPECT_EQ(sceneJson(parse("")), sceneJson(Scene{}));
    EXPECT_EQ(parse("").material.id, "skin1");
}

TEST(SceneFile, LightsReplaceTheDefaultLight) {
    EXPECT_EQ(parse("\"lights\": []").lights.size(), 0u);
    const Scene scene = parse("\"lights\": [{\"type\": \"point\", \"intensity\": 2}]");
    ASSERT_EQ(scene.lights.size(), 1u);
    EXPECT_EQ(std::get<PointLight>(scene.lights[0]).intensity, (Rgb{2, 2, 2}));
}

TEST(SceneFile, NullMeansThatAnOptionalPartIsAbsent) {
    EXPECT_FALSE(parse("\"ground\": null, \"coat\": null").ground.has_value());
    EXPECT_TRUE(parse("\"ground\": {}").ground.has_value());
}

TEST(SceneFile, MaterialHasThreeShapes) {
    EXPECT_EQ(parse("\"material\": \"marble\"").material.id, "marble");
    const SceneMaterial spelled = parse(R"("material": {"sigma_a": 0.1, "sigma_s": [1, 2, 3], "g": 0.5})").material;
    EXPECT_TRUE(spelled.id.empty());
    EXPECT_EQ(spelled.sigma_s, (std::vector<double>{1, 2, 3}));
    EXPECT_EQ(spelled.g, std::vector<double>{0.5});
    const SceneMaterial stretched = parse(R"("material": {"id": "marble", "scale": 2})").material;
    EXPECT_EQ(stretched.id, "marble");
    EXPECT_EQ(resolveMaterial(stretched).medium.sigma_s.r, resolveMaterial({.id = "marble"}).medium.sigma_s.r / 2);
    const SceneMaterial inverted = parse(R"("material": {"Rdr": 0.5, "ld": [3, 1, 0.5], "eta": 1.5})").material;
    EXPECT_TRUE(inverted.inverted());
    EXPECT_EQ(inverted.ld, (std::vector<double>{3, 1, 0.5}));
    EXPECT_EQ(inverted.eta, 1.5);
}

TEST(SceneFile, SpelledMaterialResolvesToItsNumbers) {
    const Material custom =
        resolveMaterial(parse(R"("material": {"sigma_a": 0.1, "sigma_s": 2, "eta": 1.5})").material);
    EXPECT_EQ(custom.id, "custom");
    EXPECT_EQ(custom.medium.channels, 1);
    EXPECT_EQ(custom.medium.sigma_s.g, 2);
    EXPECT_EQ(custom.medium.eta, 1.5);
    EXPECT_EQ(resolveMaterial(SceneMaterial{}).id, "skin1");
    SceneMaterial unknown;
    unknown.id = "skin7";
    EXPECT_THROW(resolveMaterial(unknown), Error);
}

TEST(SceneFile, SceneWithinAnotherDocumentIsReadWithPointersFromItsRoot) {
    const JsonText good(R"({"scene": {"material": "marble"}})", "job.json");
    EXPECT_EQ(readScene(good, "/scene").material.id, "marble");
    const JsonText bad("{\"scene\":\n  {\"scale\": -1}}", "job.json");
    try {
        readScene(bad, "/scene");
        FAIL() << "a negative scale was read";
    } catch (const Error& error) {
        EXPECT_EQ(
            std::string(error.what()),
            "job.json:2:13: /scene/scale: '-1' is no value for scale (expected a number from 1e-06 to 1000000 mm)");
    }
}

// Keys are stated once, as Params; the defaults that they state must be those that the structs have.
TEST(SceneFile, ParamDefaultsAreTheStructs) {
    const nlohmann::json written = nlohmann::json::parse(sceneJson(Scene{}));
    const auto section = [&](const std::string& name) {
        for (const SceneSection& candidate : sceneSections())
            if (candidate.name == name) return candidate;
        throw std::runtime_error("no section " + name);
    };
    for (const Param& param : section("camera").keys)
        if (const double* value = std::get_if<double>(&param.value)) {
            EXPECT_EQ(written["camera"][param.name], *value);
        }
    EXPECT_EQ(std::get<double>(section("scene").keys[1].value), written["scale"]);
}

std::string documented(const SceneSection& section) {
    std::string text =
        "## " + section.name + "\n\n" + section.doc + "\n\n| key | value | default | meaning |\n|---|---|---|---|\n";
    for (const Param& param : section.keys) {
        const std::string value = valueText(param.value);
        text += "| `" + param.name + "` | " + rangeText(param) + " | " + (value.empty() ? "" : "`" + value + "`") +
                " | " + param.doc + " |\n";
    }
    return text;
}

// The failure prints the section as it has to stand in the page.
TEST(SceneFile, EverySectionIsDocumentedWithRangesAndDefaults) {
    const std::string page = readFile(SEARCHLIGHT_SOURCE_DIR "/docs/scene.md");
    for (const SceneSection& section : sceneSections())
        EXPECT_TRUE(page.find(documented(section) + "\n") != std::string::npos) << "docs/scene.md lacks:\n"
                                                                                << documented(section);
}

TEST(SceneFile, ExampleOfTheDocumentationLoads) {
    const std::string doc = readFile(SEARCHLIGHT_SOURCE_DIR "/docs/scene.md");
    const std::size_t begin = doc.find("```json\n") + 8;
    const Scene scene = parseScene(doc.substr(begin, doc.find("```", begin) - begin), "docs/scene.md");
    EXPECT_EQ(scene.material.id, "marble");
    EXPECT_EQ(scene.lights.size(), 2u);
}

TEST(JsonText, KeysThatLookLikeIndicesKeepTheirPlaces) {
    const JsonText text("{\"1\": 1,\n \"x\": 2}", "a.json");
    EXPECT_EQ(std::string(text.errorAtKey("/1", "wrong").what()), "a.json:1:2: /1: wrong");
    EXPECT_EQ(std::string(text.error("/x", "wrong").what()), "a.json:2:7: /x: wrong");
}

TEST(JsonText, NestingBeyondAnyStackIsRefused) {
    const std::string deep(1'000'000, '[');
    EXPECT_THROW(JsonText(deep, "a.json"), Error);
    EXPECT_THROW(JsonText(deep + std::string(deep.size(), ']'), "a.json"), Error);
}

}  // namespace
}  // namespace searchlight
