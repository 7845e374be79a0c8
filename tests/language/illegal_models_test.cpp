#include <gtest/gtest.h>

#include <filesystem>
#include <map>

#include "base/error.h"
#include "base/files.h"
#include "language/initializer.h"

namespace searchlight {

namespace {

// What is wrong with each file of tests/illegal/models: the message, after the file's name.
const std::map<std::string, std::string> messages = {
    {"argument_name", "3:7: a parameter cannot be called 'Wo' (an argument of Bssrdf)"},
    {"attribute_twice", "1:23: attribute 'radial' is given twice"},
    {"backslash", "3:27: lines cannot be continued with a backslash"},
    {"bad_bool", "3:12: 'maybe' is no bool (expected 0, 1, false or true)"},
    {"bad_choice_name",
     "3:17: '6gaussians' cannot name a choice (letters, digits and _, separated by | without blanks)"},
    {"bad_name", "3:7: '2nd' cannot be a name (letters, digits and _, not starting with a digit)"},
    {"brace_never_closed", "3:49: '{' is never closed"},
    {"bssrdf_result", "3:7: Bssrdf has another signature (expected vec3 Bssrdf(vec3 Xi, vec3 Wi, vec3 Xo, vec3 Wo))"},
    {"bssrdf_signature",
     "3:6: Bssrdf has another signature (expected vec3 Bssrdf(vec3 Xi, vec3 Wi, vec3 Xo, vec3 Wo))"},
    {"builtin_name", "3:7: a parameter cannot be called 'exp' (a function of GLSL)"},
    {"choice_constant_taken", "4:6: 'Fit_skin' is already declared on line 3"},
    {"choice_twice", "3:24: choice 'skin' is named twice"},
    {"closes_nothing", "4:1: '}' closes nothing"},
    {"color_too_short", "3:15: the line ends early (expected color NAME RED GREEN BLUE)"},
    {"comment_continued", "3:8: a backslash continues the comment on the next line (end the comment differently)"},
    {"comment_never_ends", "3:1: this comment never ends (expected */)"},
    {"deep_nesting", "3:273: brackets are nested more than 256 deep"},
    {"default_outside", "3:16: the default 1.5 is outside 0 to 1"},
    {"double_underscore", "3:6: a parameter cannot be called 'a__b' (GLSL keeps names with two underscores)"},
    {"empty", "1:1: the file holds no model (expected a first line 'analytic ...')"},
    {"empty_range", "3:12: the range 2 to 1 is empty (expected MIN below MAX)"},
    {"empty_unit", "3:20: empty unit (leave [] out for a number without unit)"},
    {"end_without_begin", "2:1: ::end shader without a ::begin shader"},
    {"entry_point_name", "3:6: a parameter cannot be called 'init' (the name of an entry point)"},
    {"float_too_long", "3:20: unexpected '0.6' (expected float NAME MIN MAX DEFAULT)"},
    {"float_too_short", "3:15: the line ends early (expected float NAME MIN MAX DEFAULT)"},
    {"hash_in_line", "3:9: '#' inside a line (GLSL comments start with //)"},
    {"info_without_text", "3:3: 'title' without text"},
    {"init_with_arguments", "3:6: init has another signature (expected void init())"},
    {"keyword_name", "3:7: a parameter cannot be called 'discard' (a word of GLSL)"},
    {"malformed_number", "3:17: malformed number '1.5x'"},
    {"mismatched_end", "4:7: ::end shade ends section shader, which began on line 2 (expected ::end shader)"},
    {"nameless_section", "2:1: ::begin without the section's name"},
    {"negative_color", "3:14: the colour -0.5 is outside 0 to 1e30"},
    {"nested_begin",
     "4:1: ::begin shader inside section initializer, which began on line 2 (expected ::end initializer first)"},
    {"never_ends", "2:1: section shader never ends (expected ::end shader)"},
    {"no_analytic", "1:1: 'radial' found where 'analytic' was expected (the first line lists the model's attributes)"},
    {"no_bssrdf",
     "2:9: section shader has no function Bssrdf (expected vec3 Bssrdf(vec3 Xi, vec3 Wi, vec3 Xo, vec3 Wo))"},
    {"no_declaration", "3:1: 'return' found where a declaration was expected"},
    {"no_diffuse_reflectance",
     "2:9: section diffuseReflectance has no function DiffuseReflectance (expected vec3 DiffuseReflectance(vec3 "
     "AlphaPrime))"},
    {"no_exponent", "3:17: a number needs digits after its exponent"},
    {"no_init", "2:9: section initializer has no function init (expected void init())"},
    {"no_number", "3:14: 'one' is no finite number"},
    {"no_sections", "1:1: the model has no section shader (the file has no sections)"},
    {"no_semicolon", "4:1: 'vec3' found where ';' was expected"},
    {"no_shader", "6:1: the model has no section shader (sections found: Shader, info)"},
    {"no_utf8", "2:6: byte 0xe9 is no UTF-8 (save the file as UTF-8)"},
    {"not_ascii", "3:13: byte 0xce has no meaning in GLSL (outside comments GLSL is plain ASCII)"},
    {"not_finite", "3:14: 'inf' is no finite number"},
    {"nul_byte", "2:4: NUL byte (a model is a text file)"},
    {"only_comments", "1:1: the file holds no model (expected a first line 'analytic ...')"},
    {"other_format",
     "1:1: this is another tool's format, 'BSSRDF file format (version 0.2)' (a Searchlight model starts with a line "
     "'analytic ...')"},
    {"parameter_twice", "5:6: 'Size' is already declared on line 3"},
    {"preprocessor", "3:1: preprocessor line '#define N 3' (models are plain GLSL; comments start with //)"},
    {"reserved_prefix", "3:6: a parameter cannot be called 'sl_debug' (names that start with sl_ are taken)"},
    {"section_twice", "6:9: section shader is already on line 2"},
    {"single_choice", "3:12: a choice needs two names or more"},
    {"state_array_of_arrays", "3:11: arrays of arrays are not supported"},
    {"state_array_size",
     "4:7: the size of 'A' is no constant from 1 to 4096 (write a number, or const int globals with + - * /)"},
    {"state_block", "3:1: an initializer holds globals, structs and functions"},
    {"state_choice_name", "6:7: 'Fit_wax' is already a choice of Fit"},
    {"state_element_written",
     "8:31: Bssrdf writes 'Table' (globals of the initializer are the model's state: only init() may change them)"},
    {"state_incremented",
     "4:19: helper writes 'Count' (globals of the initializer are the model's state: only init() may change them)"},
    {"state_out_argument",
     "11:26: Bssrdf writes 'A' (globals of the initializer are the model's state: only init() may change them)"},
    {"state_parameter_name", "6:7: 'Clamp' is already a parameter of the model"},
    {"state_sampler",
     "3:1: a global of the initializer cannot have type 'sampler2D' (valid: float, int, uint, bool, their vectors, and "
     "matrices of float)"},
    {"state_twice", "4:6: 'A' is already declared on line 3"},
    {"state_uniform",
     "3:1: a global of the initializer cannot be 'uniform' (expected TYPE NAME; or const TYPE NAME = VALUE;)"},
    {"state_uniform_name", "3:7: a global cannot be called 'IOR' (given to every model)"},
    {"state_written_by_bssrdf",
     "9:3: Bssrdf writes 'A' (globals of the initializer are the model's state: only init() may change them)"},
    {"strange_character", "3:21: '@' has no meaning in GLSL"},
    {"text_after_unit", "3:25: text after the unit (a comment starts with #)"},
    {"text_outside",
     "2:1: 'vec3 Lu;' stands outside a section (expected ::begin NAME, or a comment that starts with #)"},
    {"uniform_name", "3:7: a parameter cannot be called 'SigmaA' (given to every model)"},
    {"unit_never_ends", "3:20: this unit never ends (expected ']')"},
    {"unknown_attribute",
     "1:10: unknown attribute 'radail' (valid: analytic, radial, no_wi, no_wo, normals, single_scattering, reciprocal, "
     "energy_violation, grosjean)"},
    {"unknown_default", "3:24: unknown choice 'wax' (valid: skin, marble)"},
    {"unknown_info", "3:1: unknown info 'author' (valid: title, citation, validity, note)"},
    {"unknown_marker", "2:1: '::start shader' found where ::begin or ::end was expected"},
    {"unknown_type", "3:1: unknown parameter type 'double' (valid: float, bool, color, choice)"},
    {"words_after_name", "2:16: unexpected 'now' after the section's name"},
    {"wrong_bracket", "3:16: ']' closes the '(' of line 3 (expected ')')"},
};

std::filesystem::path folder() { return std::filesystem::path(SEARCHLIGHT_SOURCE_DIR) / "tests/illegal/models"; }

std::string messageOf(std::string_view text, const std::string& path) {
    try {
        splitInitializer(parseBssrdf(text, path));
        return "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind, ErrorKind::input) << path;
        EXPECT_EQ(error.file, path);
        EXPECT_GT(error.line, 0) << path;
        EXPECT_GT(error.column, 0) << path;
        return error.what();
    }
}

}  // namespace

class IllegalModel : public testing::TestWithParam<std::pair<const std::string, std::string>> {};

TEST_P(IllegalModel, IsRefusedWithPlaceAndReason) {
    const std::string path = GetParam().first + ".bssrdf";
    EXPECT_EQ(messageOf(readFile(folder() / path), path), path + ":" + GetParam().second);
}

INSTANTIATE_TEST_SUITE_P(Files, IllegalModel, testing::ValuesIn(messages.begin(), messages.end()),
                         [](const auto& row) { return row.param.first; });

TEST(IllegalModels, EveryFileIsInTheTable) {
    std::size_t files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder())) {
        EXPECT_TRUE(messages.contains(entry.path().stem().string())) << entry.path();
        ++files;
    }
    EXPECT_EQ(files, messages.size());
}

TEST(IllegalModels, MoreThanAMebibyteIsRefusedBeforeItIsRead) {
    const std::string text = "analytic\n" + std::string(std::size_t{1} << 20, '#');
    EXPECT_THROW(parseBssrdf(text, "large.bssrdf"), Error);
    try {
        parseBssrdf(text, "large.bssrdf");
    } catch (const Error& error) {
        EXPECT_STREQ(error.what(), "large.bssrdf: the file has 1048585 bytes (a model has at most 1048576)");
    }
}

}  // namespace searchlight
