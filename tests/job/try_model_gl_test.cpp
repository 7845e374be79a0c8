#include "job/live/try_model.h"

#include <gmock/gmock.h>

#include "gl/context.h"

namespace searchlight {
namespace {

using testing::HasSubstr;

std::string modelWith(const std::string& line) {
    return "analytic radial no_wi no_wo\n::begin shader\nvec3 Bssrdf(vec3 Xi, vec3 Wi, vec3 Xo, vec3 Wo) {\n" + line +
           "\n}\n::end shader\n";
}

TEST(TryModel, FindsWhatIsWrongAndWhere) {
    Engine engine;
    EXPECT_FALSE(tryModel(modelWith("return exp(-SigmaA * distance(Xi, Xo));"), "m.bssrdf", engine));
    const auto type = tryModel(modelWith("vec3 R = distance(Xi, Xo); return R;"), "m.bssrdf", engine);
    ASSERT_TRUE(type);
    EXPECT_EQ(type->line, 4);
    EXPECT_EQ(type->file, "m.bssrdf");
    const auto section = tryModel("analytic\n::begin shader\n", "m.bssrdf", engine);
    ASSERT_TRUE(section);
    const auto endless =
        tryModel(modelWith("float s = 1.0; while (s > 0.0) { s += 1.0; } return vec3(s);"), "m.bssrdf", engine);
    ASSERT_TRUE(endless);
    EXPECT_THAT(endless->message, HasSubstr("loop"));
    const auto infinite = tryModel(modelWith("return vec3(1.0) / (SigmaA - SigmaA);"), "m.bssrdf", engine);
    ASSERT_TRUE(infinite);
    EXPECT_THAT(infinite->message, HasSubstr("not finite"));
}

TEST(TryModel, ALostContextIsDroppedAndTheNextTryHasANewOne) {
    Engine engine;
    engine.context().abandon();
    const std::string good = modelWith("return exp(-SigmaA * distance(Xi, Xo));");
    const auto lost = tryModel(good, "m.bssrdf", engine);
    ASSERT_TRUE(lost);
    EXPECT_THAT(lost->message, HasSubstr("lost"));
    EXPECT_FALSE(engine.contextLost());
    EXPECT_FALSE(tryModel(good, "m.bssrdf", engine));
}

}  // namespace
}  // namespace searchlight
