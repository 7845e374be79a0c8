#include "job/render/render_material.h"

#include <gmock/gmock.h>

#include "base/error.h"
#include "job/command.h"

namespace searchlight {
namespace {

TEST(RenderMaterial, IsWhatEveryCommandMakesOfTheScene) {
    Engine engine;
    Scene scene;
    scene.material.id = "marble";
    scene.material.scale = 2;
    scene.model = {.id = "better_dipole", .parameters = {{"Moments", std::string("exact")}}};
    Subject subject;
    const RenderMaterial material = materialSource(engine, "cpu", &subject)(scene);
    EXPECT_EQ(material.model.id, "better_dipole");
    EXPECT_EQ(material.medium.sigma_s, (0.5 * Rgb{2.19, 2.62, 3.00}));  // [Jensen2001], lengths doubled
    EXPECT_EQ(subject.id, "marble");
    EXPECT_EQ(material.evaluator->backend(), "cpu double");

    scene.model.parameters = {{"Moments", std::string("exakt")}};
    EXPECT_THROW(materialSource(engine, "cpu")(scene), Error);
}

TEST(RenderMaterial, IsInvertedByItsOwnModel) {
    Engine engine;
    Scene scene;
    scene.material = {.id = "", .Rdr = {0.6, 0.4, 0.2}, .ld = {2, 1, 0.5}};
    const RenderMaterial material = materialSource(engine, "cpu")(scene);
    const Rgb Rd = material.evaluator->diffuseReflectance(material.medium.alphaPrime());
    EXPECT_NEAR(Rd.r, 0.6, 1e-6);
    EXPECT_NEAR(Rd.g, 0.4, 1e-6);
    EXPECT_NEAR(Rd.b, 0.2, 1e-6);
}

TEST(RenderMaterial, ATableWithoutAUnitIsRenderedAndSaysSo) {
    Engine engine;
    Scene scene;
    scene.material.id = "mustard";
    Subject subject;
    materialSource(engine, "cpu", &subject)(scene);
    EXPECT_THAT(subject.notes, testing::Contains(testing::HasSubstr("does not state its unit")));
}

TEST(Job, ThatRendersKeepsAllOfItsScene) {
    Job job;
    job.command = "render";
    job.scene.object = "statue";
    job.scene.lights = {PointLight{}, EnvironmentLight{.path = "a.hdr", .occlusion = true}};
    job.scene.ground.emplace();
    job.options["technique"] = std::string("brute_force");
    const Job read = parseJob(jobJson(job), "job.json");
    EXPECT_EQ(sceneJson(read.scene), sceneJson(job.scene));
    EXPECT_EQ(read.options, job.options);
}

}  // namespace
}  // namespace searchlight
