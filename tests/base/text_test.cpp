#include "base/text.h"

#include <cmath>
#include <limits>

namespace searchlight {
namespace {

using testing::ElementsAre;

TEST(Text, SplitKeepsEmptyParts) {
    EXPECT_THAT(split("a,,b,", ','), ElementsAre("a", "", "b", ""));
    EXPECT_THAT(split("", ','), ElementsAre(""));
    EXPECT_EQ(join({"a", "", "b"}, ", "), "a, , b");
    EXPECT_EQ(join({}, ", "), "");
}

TEST(Text, TrimTakesBlanksFromBothEnds) {
    EXPECT_EQ(trim(" \t a b\r\n"), "a b");
    EXPECT_EQ(trim(" \n"), "");
}

TEST(Text, NumberTakesTheWholeText) {
    EXPECT_EQ(parseNumber("1e6"), 1e6);
    EXPECT_EQ(parseNumber(" -.5 "), -0.5);
    EXPECT_EQ(parseNumber("+2"), 2);
    for (const char* bad : {"", " ", "1x", "1,5", "0x10", "--1", "inf", "nan", "1e999", "1 2"})
        EXPECT_EQ(parseNumber(bad), std::nullopt) << bad;
}

TEST(Text, NumberTextReadsBackAsTheSameDouble) {
    for (const double value : {0.1, 1.0 / 3, 1e-300, 5e-324, 123456789.123456789, -0.0, 1.7976931348623157e308}) {
        EXPECT_EQ(parseNumber(numberText(value)), value) << numberText(value);
    }
    EXPECT_EQ(numberText(0.1), "0.1");
    EXPECT_EQ(numberText(3), "3");
}

TEST(Text, PrettyNumberRoundsToDigits) {
    EXPECT_EQ(prettyNumber(0.123456), "0.1235");
    EXPECT_EQ(prettyNumber(2.0 / 3, 2), "0.67");
    EXPECT_EQ(prettyNumber(0.00012346), "0.0001235");
}

TEST(Text, LowerSnakeHasNoBlanksAtTheEnds) {
    EXPECT_EQ(lowerSnake("White Grapefruit Juice"), "white_grapefruit_juice");
    EXPECT_EQ(lowerSnake(" Head & Shoulders! "), "head_shoulders");
    EXPECT_EQ(lowerSnake("&"), "");
}

TEST(Text, NearestNameIsTheOneWithTheFewestEdits) {
    const std::vector<std::string> names{"marble", "skin1", "skin2", "potato"};
    EXPECT_THAT(nearestNames("marbel", names, 1), ElementsAre("marble"));
    EXPECT_THAT(nearestNames("SKIN2", names, 2), ElementsAre("skin2", "skin1"));
    EXPECT_THAT(nearestNames("kin", names, 2), ElementsAre("skin1", "skin2"));
    EXPECT_EQ(nearestNames("x", names, 9).size(), names.size());
}

}  // namespace
}  // namespace searchlight
