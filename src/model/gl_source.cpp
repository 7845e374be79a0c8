#include "model/gl_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <span>

#include "base/embedded.h"
#include "base/error.h"
#include "language/initializer.h"
#include "language/outline.h"

namespace searchlight {

namespace {

using Names = std::set<std::string_view>;

// What errors in our own parts of the program are said to be in.
constexpr std::string_view generated = "searchlight";

bool isLoop(const Token& token) { return token.text == "for" || token.text == "while"; }

// A section's text, cut into tokens that know their file.
struct Text {
    std::string_view file;
    std::vector<Token> all;

    std::span<const Token> tokens() const { return std::span(all).first(all.size() - 1); }  // without the end

    Text(std::string_view file_, std::string_view text, int first_line) : file(file_) {
        try {
            all = tokenize(text, first_line);
        } catch (const Error& error) {
            throw error.at(file);
        }
    }
};

// Puts loop conditions under the budget: "(cond) && sl_loop(line)". Line 0 stands for "of physics/", whose loops count,
// too; that they are then not unrolled saves a third of llvmpipe's compile time.
class LoopGuard {
public:
    LoopGuard(gl::Source& source, std::string_view file, std::span<const Token> tokens, bool physics)
        : source_(source), file_(file), tokens_(tokens), physics_(physics) {}

    void write() {
        for (std::size_t i = 0; i < tokens_.size(); ++i) {
            if (tokens_[i].kind == TokenKind::identifier && tokens_[i].text.starts_with("sl_"))
                throw inputError(fmt::format("the name '{}'", tokens_[i].text), "names that start with sl_ are taken")
                    .at(file_, tokens_[i].line, tokens_[i].column);
            put(tokens_[i]);
            if (isLoop(tokens_[i]) && i + 1 < tokens_.size() && tokens_[i + 1].text == "(") findCondition(i);
            for (const Insertion& insertion : insertions_)
                if (insertion.after == i) insert(insertion.text, tokens_[i]);
            std::erase_if(insertions_, [&](const Insertion& insertion) { return insertion.after == i; });
        }
    }

private:
    struct Insertion {
        std::size_t after;  // this token
        std::string text;
    };

    void put(const Token& token) { source_.addToken(token.text, file_, token.line, token.column); }
    void insert(std::string_view text, const Token& at) { source_.addToken(text, file_, at.line, at.column); }

    // The condition is all between the brackets of while, and between the semicolons of for.
    void findCondition(std::size_t keyword) {
        const std::size_t close = closingBracket(tokens_, keyword + 1);
        std::size_t before = keyword + 1, end = close;
        if (tokens_[keyword].text == "for") {
            before = nextSemicolon(before + 1, close);
            end = nextSemicolon(before + 1, close);
        }
        if (end >= tokens_.size()) return;  // the compiler will say it
        const std::string call = fmt::format("sl_loop({})", physics_ ? 0 : tokens_[keyword].line);
        if (end == before + 1) {
            insertions_.push_back({before, call});
            return;
        }
        // "bool more = cond" is a condition, too.
        const bool declares = end > before + 3 && tokens_[before + 1].text == "bool" && tokens_[before + 3].text == "=";
        insertions_.push_back({declares ? before + 3 : before, "("});
        insertions_.push_back({end - 1, ") && " + call});
    }

    std::size_t nextSemicolon(std::size_t from, std::size_t close) const {
        for (std::size_t i = from; i < close; ++i) {
            if (tokens_[i].text == "(") i = closingBracket(tokens_, i);
            if (tokens_[i].text == ";") return i;
        }
        return tokens_.size();
    }

    gl::Source& source_;
    std::string_view file_;
    std::span<const Token> tokens_;
    bool physics_;
    std::vector<Insertion> insertions_;
};

// The functions and constants of physics/, of which a program gets what it names.
class Physics {
public:
    Physics() {
        for (const EmbeddedFile& file : embeddedFiles())
            if (file.path.starts_with("physics/")) texts_.emplace_back(file.path, file.text, 1);
        for (const Text& text : texts_) {
            const Outline found = outline(text.all);
            for (const OutlineItem& item : found.items) addItem(text.file, found, item);
        }
    }

    // Writes what `names` need. Prototypes come first, so that the order of the files does not matter.
    void write(gl::Source& source, Names names) const {
        std::vector<bool> used(items_.size(), false);
        for (bool grew = true; grew;) {
            grew = false;
            for (std::size_t i = 0; i < items_.size(); ++i) {
                if (used[i] || !std::ranges::any_of(items_[i].defines, [&](auto n) { return names.contains(n); }))
                    continue;
                used[i] = grew = true;
                for (const Token& token : items_[i].tokens) names.insert(token.text);
            }
        }
        for (const bool bodies : {false, true}) {
            for (std::size_t i = 0; i < items_.size(); ++i) {
                const Item& item = items_[i];
                const bool is_function = item.head > 0;
                if (!used[i] || (bodies && !is_function)) continue;
                put(source, item, bodies || !is_function ? item.tokens : item.tokens.first(item.head));
                if (is_function && !bodies) source.add(";", item.file);
            }
        }
    }

private:
    struct Item {
        std::string_view file;
        std::vector<std::string_view> defines;
        std::span<const Token> tokens;
        std::size_t head = 0;  // tokens before a function's body
    };

    void addItem(std::string_view file, const Outline& found, const OutlineItem& item) {
        Item& added = items_.emplace_back(Item{file, {}, item.tokens, 0});
        if (item.kind == OutlineItem::Kind::function) {
            const Function& function = found.functions[item.index];
            added.defines = {function.name.text};
            added.head = item.tokens.size() - function.body.size();
        } else if (item.kind == OutlineItem::Kind::global) {
            for (const Declarator& declarator : found.globals[item.index].declarators)
                added.defines.push_back(declarator.name.text);
        } else {
            added.defines = {item.tokens[1].text};  // struct NAME
        }
    }

    static void put(gl::Source& source, const Item& item, std::span<const Token> tokens) {
        LoopGuard(source, item.file, tokens, true).write();
    }

    std::vector<Text> texts_;
    std::vector<Item> items_;
};

constexpr std::string_view medium = R"(
const float PI = 3.14159265358979324;
uniform vec3 SigmaA, SigmaS, G;
uniform float IOR;
)";

constexpr std::string_view values_block = R"(
layout(std430, binding = 2) coherent volatile buffer sl_Values {
    int sl_failed;
    float sl_values[];
};
)";

// Counts an iteration; false when the budget is spent. Now and then it looks whether another invocation has failed, so
// that the whole dispatch ends soon. sl_line is the model's loop that runs, sl_long one that ran while iterations
// mounted.
constexpr std::string_view loop_budget = R"(
int sl_iterations = 0;
int sl_line = 0;
int sl_long = 0;
bool sl_loop(int line) {
    if (line != 0) sl_line = line;
    if ((sl_iterations & 1023) == 0) {
        sl_long = sl_line;
        if (sl_failed != 0) sl_iterations = sl_budget;
    }
    if (sl_iterations < sl_budget) {
        ++sl_iterations;
        return true;
    }
    atomicCompSwap(sl_failed, 0, sl_line + 1);
    return false;
}
)";

// A driver that has run out of iterations ends this loop, too, after its first one.
constexpr std::string_view driver_cut = R"(
uniform int sl_two;
void sl_findCut() {
    int passes = 0;
    for (int i = 0; i < sl_two; ++i) ++passes;
    if (passes < sl_two) atomicMax(sl_failed, sl_long + 1);
}
)";

constexpr std::string_view no_driver_cut = "void sl_findCut() {}\n";

constexpr std::string_view evaluate_main = R"(
layout(std430, binding = 1) readonly buffer sl_Queries { float sl_queries[]; };
uniform int sl_count;
vec3 sl_vector(int at) { return vec3(sl_queries[at], sl_queries[at + 1], sl_queries[at + 2]); }
void main() {
    int query = int(gl_GlobalInvocationID.x);
    if (query >= sl_count) return;
    int at = 18 * query;
    SL_NORMALS
    vec3 value = Bssrdf(sl_vector(at), sl_vector(at + 3), sl_vector(at + 9), sl_vector(at + 12));
    sl_values[3 * query] = value.x;
    sl_values[3 * query + 1] = value.y;
    sl_values[3 * query + 2] = value.z;
    sl_findCut();
}
)";

constexpr std::string_view diffuse_main = R"(
layout(local_size_x = 1) in;
uniform vec3 sl_alpha_prime;
void main() {
    vec3 value = DiffuseReflectance(sl_alpha_prime);
    sl_values[0] = value.x;
    sl_values[1] = value.y;
    sl_values[2] = value.z;
    sl_findCut();
}
)";

void addParameters(gl::Source& source, const std::vector<Param>& parameters) {
    for (const Param& param : parameters) {
        const std::string_view type = param.type == ParamType::toggle   ? "bool"
                                      : param.type == ParamType::color  ? "vec3"
                                      : param.type == ParamType::choice ? "int"
                                                                        : "float";
        source.add(fmt::format("uniform {} {};", type, param.name), generated);
        for (std::size_t i = 0; i < param.choices.size(); ++i)
            source.add(fmt::format("const int {}_{} = {};", param.name, param.choices[i], i), generated);
    }
}

void addState(gl::Source& source, const Initializer& initializer, std::string_view file, bool writable) {
    if (initializer.state.empty()) return;
    source.add(fmt::format("layout(std430, binding = 0) {} buffer sl_State {{", writable ? "" : "readonly"), generated);
    for (const StateVariable& variable : initializer.state) {
        const std::string size = variable.array_size > 0 ? fmt::format("[{}]", variable.array_size) : "";
        source.addToken(fmt::format("{} {}{};", variable.type, variable.name, size), file, variable.line,
                        variable.column);
    }
    source.add("};", generated);
}

void addInitMain(gl::Source& source, const Initializer& initializer, std::string_view file) {
    source.add("layout(local_size_x = 1) in;\nvoid main() {", generated);
    for (const StateVariable& variable : initializer.state) {
        if (variable.initial_value.empty()) continue;
        source.addToken(variable.name + " =", file, variable.line, variable.column);
        const Text value(file, variable.initial_value, variable.line);
        for (const Token& token : value.tokens()) source.addToken(token.text, file, variable.line, variable.column);
        source.addToken(";", file, variable.line, variable.column);
    }
    source.add("init();\nsl_findCut();\n}", generated);
}

// The model's own text for a stage, in the order in which it is compiled.
std::vector<Text> modelTexts(const BssrdfFile& file, const Initializer& initializer, GlStage stage) {
    std::vector<Text> texts;
    const auto add = [&](const std::string& text, int first_line) {
        if (first_line > 0) texts.emplace_back(file.path, text, first_line);
    };
    add(initializer.functions_text, initializer.first_line);
    if (stage == GlStage::init) {
        add(initializer.init_text, initializer.first_line);
        return texts;
    }
    add(file.diffuse_reflectance.text, file.diffuse_reflectance.first_line);
    add(file.shader.text, file.shader.first_line);
    return texts;
}

}  // namespace

gl::Source modelShader(const BssrdfFile& file, GlStage stage, const LoopBudget& budget) {
    const Initializer initializer = splitInitializer(file);
    const std::vector<Text> texts = modelTexts(file, initializer, stage);
    Names names;
    for (const Text& text : texts)
        for (const Token& token : text.tokens()) names.insert(token.text);

    gl::Source source;
    source.add("#version 450 core", generated);
    source.add(medium, generated);
    addParameters(source, file.parameters);
    if (file.normals) source.add("vec3 Ni, No;", generated);
    source.add(values_block, generated);
    source.add(fmt::format("const int sl_budget = {};", budget.iterations), generated);
    source.add(loop_budget, generated);
    source.add(budget.driver_cuts ? driver_cut : no_driver_cut, generated);
    Physics().write(source, names);
    addState(source, initializer, file.path, stage == GlStage::init);
    for (const Text& text : texts) LoopGuard(source, text.file, text.tokens(), false).write();
    if (stage == GlStage::init) {
        addInitMain(source, initializer, file.path);
    } else if (stage == GlStage::diffuse_reflectance) {
        source.add(diffuse_main, generated);
    } else if (stage == GlStage::evaluate) {
        if (file.normals)
            source.add("#define SL_NORMALS Ni = sl_vector(at + 6); No = sl_vector(at + 15);", generated);
        else
            source.add("#define SL_NORMALS", generated);
        source.add(fmt::format("layout(local_size_x = {}) in;", gl_group_size), generated);
        source.add(evaluate_main, generated);
    }
    return source;
}

}  // namespace searchlight
