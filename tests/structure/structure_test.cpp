// The rules of docs/architecture.md that a compiler does not enforce, checked on the sources themselves.
#include <algorithm>
#include <array>
#include <filesystem>
#include <functional>

#include "base/files.h"
#include "base/text.h"

namespace searchlight {
namespace {

namespace fs = std::filesystem;

struct Folder {
    std::string_view name;
    std::vector<std::string_view> may_include;  // besides itself
};

// Includes run one way: a folder sees what stands above it, and draw, which knows figures and nothing else, only base.
// The same order stands in the root CMakeLists.txt, where each folder is a target.
const std::vector<Folder>& folders() {
    static const std::vector<Folder> list{
        {"base", {}},
        {"language", {"base"}},
        {"gl", {"base"}},
        {"scene", {"base"}},
        {"io", {"base", "scene"}},
        {"geometry", {"base", "scene", "io"}},
        {"model", {"base", "language", "gl", "scene"}},
        {"light", {"base", "gl", "scene", "io", "geometry", "model"}},
        {"transport", {"base", "gl", "scene", "geometry", "model", "light"}},
        {"kernel", {"base", "scene", "model"}},
        {"render", {"base", "language", "gl", "scene", "io", "geometry", "model", "light", "transport", "kernel"}},
        {"plot", {"base", "scene", "model", "transport", "kernel"}},
        {"validate", {"base", "language", "gl", "scene", "model", "transport", "kernel", "plot"}},
        {"draw", {"base"}},
        {"job",
         {"base", "language", "gl", "scene", "io", "geometry", "model", "light", "transport", "kernel", "render",
          "plot", "validate", "draw"}},
    };
    return list;
}

struct Include {
    int line;
    std::string target;  ///< between the quotes or brackets
};

std::vector<Include> includesOf(std::string_view text) {
    std::vector<Include> includes;
    int number = 0;
    for (const std::string_view line : split(text, '\n')) {
        ++number;
        std::string_view rest = trim(line);
        if (!rest.starts_with('#')) continue;
        rest = trim(rest.substr(1));
        if (!rest.starts_with("include")) continue;
        rest = trim(rest.substr(std::string_view("include").size()));
        const std::size_t end = rest.find_first_of("\">", 1);
        if (rest.size() > 1 && end != std::string_view::npos)
            includes.push_back({number, std::string(rest.substr(1, end - 1))});
    }
    return includes;
}

// A complaint about an include in a file of src/`folder`; empty when it is fine.
std::string includeFault(std::string_view folder, std::string_view target) {
    const auto known = [](std::string_view name) { return std::ranges::find(folders(), name, &Folder::name); };
    const std::string_view from = target.substr(0, target.find('/'));
    if (from == target || known(from) == folders().end() || from == folder) return {};
    const auto here = known(folder);
    if (here == folders().end()) return "its folder has no row in the table of tests/structure";
    if (std::ranges::find(here->may_include, from) != here->may_include.end()) return {};
    return std::string(folder) + " must not include " + std::string(from);
}

// A library's header that has one home.
std::string homeFault(std::string_view path, std::string_view target) {
    const auto starts = [&](std::initializer_list<std::string_view> prefixes) {
        return std::ranges::any_of(prefixes, [&](std::string_view prefix) { return target.starts_with(prefix); });
    };
    const auto within = [&](std::initializer_list<std::string_view> homes) {
        return std::ranges::any_of(homes, [&](std::string_view home) { return path.starts_with(home); });
    };
    if (starts({"epoxy/", "EGL/", "GL/", "GLES", "KHR/"}) && !within({"src/gl/"})) return "only src/gl calls OpenGL";
    const bool qt = target.size() > 1 && target[0] == 'Q' && std::isupper(static_cast<unsigned char>(target[1]));
    if ((qt || starts({"Qt"})) && !within({"src/draw/", "apps/gui/", "tests/draw/", "tests/gui/"}))
        return "Qt belongs to src/draw and apps/gui";
    return {};
}

bool isSource(const fs::path& path) {
    static constexpr std::array<std::string_view, 6> endings{".h", ".cpp", ".glsl", ".bssrdf", ".cmake", ".py"};
    return std::ranges::find(endings, path.extension().string()) != endings.end();
}

const fs::path& root() {
    static const fs::path path = SEARCHLIGHT_SOURCE_DIR;
    return path;
}

// Calls visit(path below the root, text) for every source file.
void forEachSource(const std::function<void(const std::string&, const std::string&)>& visit) {
    int count = 0;
    for (const char* top : {"src", "apps", "tools", "tests", "bench", "models", "physics", "cmake"}) {
        if (!fs::exists(root() / top)) continue;
        for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root() / top)) {
            const std::string path = fs::relative(entry.path(), root()).generic_string();
            if (!entry.is_regular_file() || !isSource(entry.path()) || path.starts_with("tests/illegal/")) continue;
            visit(path, readFile(entry.path()));
            ++count;
        }
    }
    ASSERT_GT(count, 50) << "the sources were not found";
}

TEST(Structure, IncludesRunOneWay) {
    forEachSource([](const std::string& path, const std::string& text) {
        if (!path.starts_with("src/")) return;
        const std::string folder = path.substr(4, path.find('/', 4) - 4);
        for (const Include& include : includesOf(text)) {
            const std::string fault = includeFault(folder, include.target);
            EXPECT_TRUE(fault.empty()) << path << ":" << include.line << ": " << fault;
        }
    });
}

TEST(Structure, OpenGlAndQtStayInTheirFolders) {
    forEachSource([](const std::string& path, const std::string& text) {
        for (const Include& include : includesOf(text)) {
            const std::string fault = homeFault(path, include.target);
            EXPECT_TRUE(fault.empty()) << path << ":" << include.line << ": " << fault;
        }
    });
}

TEST(Structure, NoSourceFileIsOver600Lines) {
    forEachSource([](const std::string& path, const std::string& text) {
        EXPECT_LE(std::ranges::count(text, '\n'), 600) << path << " is worth a split";
    });
}

TEST(Structure, EveryHeaderIsIncludedOnce) {
    forEachSource([](const std::string& path, const std::string& text) {
        // Highway compiles an -inl.h once per instruction set; it has a guard of its own.
        if (!path.ends_with(".h") || path.ends_with("-inl.h")) return;
        EXPECT_TRUE(text.find("#pragma once\n") != std::string::npos) << path;
    });
}

// One folder of tests per folder of src, and none that tests nothing.
TEST(Structure, TestsMirrorTheSources) {
    for (const Folder& folder : folders()) {
        EXPECT_TRUE(fs::exists(root() / "src" / folder.name / "CMakeLists.txt")) << "src/" << folder.name;
        EXPECT_TRUE(fs::exists(root() / "tests" / folder.name / "CMakeLists.txt")) << "tests/" << folder.name;
    }
    const std::vector<std::string> others{"structure", "agreement", "golden", "illegal", "data",
                                          "fuzz",      "cli",       "gui",    "docs"};
    for (const fs::directory_entry& entry : fs::directory_iterator(root() / "tests")) {
        const std::string name = entry.path().filename().string();
        EXPECT_TRUE(!entry.is_directory() || std::ranges::find(others, name) != others.end() ||
                    fs::exists(root() / "src" / name))
            << "tests/" << name << " mirrors nothing";
    }
}

TEST(Structure, NoPathOrLinkLeadsOutOfTheSources) {
    forEachSource([](const std::string& path, const std::string& text) {
        for (const Include& include : includesOf(text))
            EXPECT_TRUE(include.target.find("..") == std::string::npos) << path << ":" << include.line;
    });
}

// The rules themselves: a rule that cannot fail checks nothing.
TEST(Structure, ForbiddenIncludesAreRecognised) {
    EXPECT_EQ(includeFault("base", "model/model.h"), "base must not include model");
    EXPECT_EQ(includeFault("draw", "scene/medium.h"), "draw must not include scene");
    EXPECT_EQ(includeFault("model", "transport/half_space/half_space.h"), "model must not include transport");
    EXPECT_EQ(includeFault("misc", "base/text.h"), "its folder has no row in the table of tests/structure");
    EXPECT_EQ(includeFault("job", "draw/draw.h"), "");
    EXPECT_EQ(includeFault("base", "fmt/format.h"), "");
    EXPECT_EQ(includeFault("base", "vector"), "");
    EXPECT_EQ(homeFault("src/model/evaluator.cpp", "epoxy/gl.h"), "only src/gl calls OpenGL");
    EXPECT_EQ(homeFault("src/gl/context.cpp", "epoxy/gl.h"), "");
    EXPECT_EQ(homeFault("src/plot/pencil.cpp", "QImage"), "Qt belongs to src/draw and apps/gui");
    EXPECT_EQ(homeFault("apps/gui/main.cpp", "QtWidgets/QApplication"), "");
    const std::vector<Include> found =
        includesOf("int a;\n #  include <QImage>\n// #include \"b.h\"\n#include \"c/d.h\"  // e\n");
    ASSERT_EQ(found.size(), 2u);
    EXPECT_EQ(found[0].target, "QImage");
    EXPECT_EQ(found[1].line, 4);
    EXPECT_EQ(found[1].target, "c/d.h");
}

}  // namespace
}  // namespace searchlight
