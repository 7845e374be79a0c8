#include "base/param.h"

#include <limits>

#include "base/error.h"

namespace searchlight {
namespace {

Param make(ParamType type, double min = 0, double max = 0, std::string unit = "") {
    Param param;
    param.name = "p";
    param.type = type;
    param.min = min;
    param.max = max;
    param.unit = std::move(unit);
    param.choices = {"exact", "fit"};
    return param;
}

std::string messageOf(const Param& param, std::string_view text) {
    try {
        parseValue(param, text);
    } catch (const Error& error) {
        EXPECT_EQ(error.kind, ErrorKind::usage);
        return error.what();
    }
    return "no error";
}

TEST(Param, EveryTypeReadsItsText) {
    EXPECT_EQ(std::get<double>(parseValue(make(ParamType::number), "0.5")), 0.5);
    EXPECT_EQ(std::get<double>(parseValue(make(ParamType::integer), "1e6")), 1e6);
    EXPECT_EQ(std::get<bool>(parseValue(make(ParamType::toggle), "on")), true);
    EXPECT_EQ(std::get<bool>(parseValue(make(ParamType::toggle), "0")), false);
    EXPECT_EQ(std::get<Rgb>(parseValue(make(ParamType::color), "1,0.5,0.25")), (Rgb{1, 0.5, 0.25}));
    EXPECT_EQ(std::get<Rgb>(parseValue(make(ParamType::color), "2")), (Rgb{2, 2, 2}));
    EXPECT_EQ(std::get<std::string>(parseValue(make(ParamType::choice), "fit")), "fit");
    EXPECT_EQ(std::get<std::string>(parseValue(make(ParamType::path), "a b.exr")), "a b.exr");
    EXPECT_EQ(std::get<std::vector<double>>(parseValue(make(ParamType::numbers), "3, 1,2,4")),
              (std::vector<double>{3, 1, 2, 4}));
    EXPECT_EQ(std::get<std::vector<double>>(parseValue(make(ParamType::channels), "3")), std::vector<double>{3});
}

TEST(Param, TextOfAValueReadsBackAsTheSameValue) {
    const std::vector<std::pair<ParamType, ParamValue>> values{{ParamType::number, 1.0 / 3},
                                                               {ParamType::integer, 65536.0},
                                                               {ParamType::toggle, true},
                                                               {ParamType::color, Rgb{0.1, 1.0 / 3, 1e-9}},
                                                               {ParamType::choice, std::string("fit")},
                                                               {ParamType::numbers, std::vector<double>{1, 0.1, 1e30}}};
    for (const auto& [type, value] : values)
        EXPECT_EQ(parseValue(make(type), valueText(value)), value) << valueText(value);
}

TEST(Param, WhatIsNoValueIsAnsweredWithTheRange) {
    const Param number = make(ParamType::number, 0, 10, "mm");
    EXPECT_EQ(messageOf(number, "ten"), "'ten' is no value for p (expected a number from 0 to 10 mm)");
    EXPECT_EQ(messageOf(number, "10.5"), "'10.5' is no value for p (expected a number from 0 to 10 mm)");
    EXPECT_EQ(messageOf(number, "inf"), "'inf' is no value for p (expected a number from 0 to 10 mm)");
    EXPECT_EQ(messageOf(make(ParamType::integer, 1, 1e30), "2.5"),
              "'2.5' is no value for p (expected a whole number of at least 1)");
    EXPECT_EQ(messageOf(make(ParamType::toggle), "maybe"), "'maybe' is no value for p (expected true or false)");
    EXPECT_EQ(messageOf(make(ParamType::color, 0, 1), "1,2"),
              "'1,2' is no value for p (expected R,G,B or one number for all, each from 0 to 1)");
    EXPECT_EQ(messageOf(make(ParamType::channels, 0, 1e30, "1/mm"), "1,2,-3"),
              "'1,2,-3' is no value for p (expected one number or R,G,B, each of at least 0 1/mm)");
    EXPECT_EQ(messageOf(make(ParamType::numbers), "1,,2"),
              "'1,,2' is no value for p (expected numbers separated by commas)");
    EXPECT_EQ(messageOf(make(ParamType::choice), "fits"), "unknown choice for p 'fits' (valid: exact, fit)");
    EXPECT_EQ(messageOf(make(ParamType::path), ""), "'' is no value for p (expected a path)");
}

TEST(Param, ExclusiveBoundIsNotInTheRange) {
    Param param = make(ParamType::number, 0, 1);
    EXPECT_EQ(messageOf(param, "0"), "no error");
    param.exclusive = true;
    EXPECT_EQ(messageOf(param, "0"), "'0' is no value for p (expected a number above 0 and up to 1)");
}

TEST(Param, ValueOfTheWrongTypeIsRefused) {
    EXPECT_THROW(checkValue(make(ParamType::number), true), Error);
    EXPECT_THROW(checkValue(make(ParamType::toggle), 1.0), Error);
    EXPECT_THROW(checkValue(make(ParamType::color), std::vector<double>{1, 1, 1}), Error);
    EXPECT_THROW(checkValue(make(ParamType::numbers), std::vector<double>{}), Error);
    EXPECT_THROW(checkValue(make(ParamType::number), std::numeric_limits<double>::quiet_NaN()), Error);
}

TEST(Param, AbsentValueIsTheDefault) {
    Param param = make(ParamType::number);
    param.value = 3.0;
    EXPECT_EQ(std::get<double>(valueOf(param, {})), 3);
    EXPECT_EQ(std::get<double>(valueOf(param, {{"p", 4.0}})), 4);
}

TEST(Param, UnknownNameIsAnsweredWithTheValidOnes) {
    const std::vector<Param> params{make(ParamType::number)};
    EXPECT_EQ(&findParam(params, "p", "option"), &params[0]);
    try {
        findParam(params, "q", "option");
        FAIL() << "q was found";
    } catch (const Error& error) {
        EXPECT_STREQ(error.what(), "unknown option 'q' (valid: p)");
    }
}

}  // namespace
}  // namespace searchlight
