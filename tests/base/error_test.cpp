#include "base/error.h"

namespace searchlight {
namespace {

TEST(Error, TextHasAsMuchOfThePlaceAsIsKnown) {
    EXPECT_STREQ(inputError("wrong").what(), "wrong");
    EXPECT_STREQ(inputError("wrong", "right").what(), "wrong (right)");
    EXPECT_STREQ(inputError("wrong").at("a.json").what(), "a.json: wrong");
    EXPECT_STREQ(inputError("wrong").at("a.json", 3).what(), "a.json:3: wrong");
    EXPECT_STREQ(inputError("wrong", "right").at("a.json", 3, 7).what(), "a.json:3:7: wrong (right)");
}

TEST(Error, PlaceThatIsKnownStays) {
    const Error inner = inputError("wrong").at("", 3, 7);
    EXPECT_STREQ(inner.what(), "3:7: wrong");
    EXPECT_STREQ(inner.at("a.json", 9, 9).what(), "a.json:3:7: wrong");
    EXPECT_STREQ(inner.at("a.json").at("b.json").what(), "a.json:3:7: wrong");
}

TEST(Error, KindDecidesWhoIsToBlame) {
    EXPECT_EQ(usageError("").kind, ErrorKind::usage);
    EXPECT_EQ(inputError("").kind, ErrorKind::input);
    EXPECT_EQ(deviceError("").kind, ErrorKind::device);
    EXPECT_EQ(interruptedError().kind, ErrorKind::interrupted);
    EXPECT_STREQ(interruptedError().what(), "interrupted");
}

TEST(Error, UnknownNameListsAFewNamesWholeAndTheNearestOfMany) {
    EXPECT_STREQ(unknownName(ErrorKind::usage, "model", "dipol", {"dipole", "gaussians"}).what(),
                 "unknown model 'dipol' (valid: dipole, gaussians)");
    std::vector<std::string> many;
    for (int i = 10; i < 23; ++i) many.push_back("skin" + std::to_string(i));
    EXPECT_STREQ(unknownName(ErrorKind::usage, "material", "skn15", many).what(),
                 "unknown material 'skn15' (did you mean: skin15, skin10, skin11)");
}

}  // namespace
}  // namespace searchlight
