#include <gmock/gmock.h>

#include "base/error.h"
#include "gl/context.h"
#include "job/json.h"
#include "job/render/kept_renderer.h"

namespace searchlight {
namespace {

// Takes the GPU away whenever the light is reported on, so many times.
struct Thief : Observer {
    Engine& engine;
    int times;

    Thief(Engine& engine_, int times_) : engine(engine_), times(times_) {}
    void progress(std::string_view task, std::uint64_t, std::uint64_t, std::string_view) override {
        if (task == "hierarchical" && times-- > 0) engine.context().abandon();
    }
};

Job smallPicture() {
    Job job;
    job.command = "render";
    job.scene.object = "sphere";
    job.scene.scale = 20;
    job.options = {{"backend", std::string("gl")}, {"size", std::string("24x16")}, {"points", std::string("1000")}};
    return job;
}

TEST(RenderOnGl, SaysWhatEachStageRanOn) {
    Engine engine;
    KeptRenderer kept;
    Observer observer;
    const Json json = Json::parse(renderPicture(smallPicture(), engine, kept, observer).json);
    EXPECT_EQ(json["backends"]["irradiance"], "gl");
    EXPECT_EQ(json["backends"]["visible"], "gl");
    EXPECT_EQ(json["backends"]["sum"], "gl");
    EXPECT_EQ(json["backends"]["points"], "cpu");
    EXPECT_GT(json["ms"]["irradiance"], 0);
}

TEST(RenderOnGl, AContextThatIsLostIsReplacedOnce) {
    Engine engine;
    KeptRenderer kept;
    Thief once(engine, 1), twice(engine, 2);
    EXPECT_FALSE(renderPicture(smallPicture(), engine, kept, once).json.empty());
    EXPECT_LT(once.times, 0);  // reported on after the theft, too
    kept.renderer.reset();
    EXPECT_THAT([&] { renderPicture(smallPicture(), engine, kept, twice); },
                testing::Throws<Error>(testing::Field(&Error::message, testing::HasSubstr("context was lost"))));
}

}  // namespace
}  // namespace searchlight
