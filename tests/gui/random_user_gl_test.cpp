// The window under a user without a plan: no crash, no wait, nothing that undo does not take back.
#include "random_user.h"
#include "window_fixture.h"

namespace searchlight::gui {
namespace {

class RandomUserTest : public WindowTest {};

TEST_F(RandomUserTest, FewActionsEndWell) { survives(desk, 400); }

}  // namespace
}  // namespace searchlight::gui
