// The window under a user without a plan: no crash, no wait, nothing that undo does not take back.
#include <cstdio>

#include "random_user.h"
#include "window_fixture.h"

namespace searchlight::gui {
namespace {

class RandomUserTest : public WindowTest {};

TEST_F(RandomUserTest, FewActionsEndWell) {
    {
        MainWindow window(desk);
        window.resize(1100, 700);
        window.show();
        RandomUser user(window, desk, 20260101);
        for (int i = 0; i < 400; ++i) user.act();
        RecordProperty("longest_ms", std::to_string(user.longest_ms));
        RecordProperty("blocked", user.blocked);
        std::printf("events took more than 100 ms %d times, longest %.0f ms\n", user.blocked, user.longest_ms);
        const State& state = workspace.state();
        EXPECT_FALSE(state.models.empty());
        EXPECT_NO_THROW(parseWorkspace(workspaceJson(state), "after.json"));
    }
    // The window is gone while engines still work; they end, and nothing is delivered to what is no more.
    QTest::qWait(20);
}

}  // namespace
}  // namespace searchlight::gui
