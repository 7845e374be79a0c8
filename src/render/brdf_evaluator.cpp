#include "render/brdf_evaluator.h"

#include <algorithm>
#include <map>
#include <set>

#include "base/embedded.h"
#include "language/outline.h"
#include "language/tokens.h"

namespace searchlight {

namespace {

// Names that a model's program has at its top level and that a .brdf file knows nothing of.
std::set<std::string, std::less<>> reservedNames() {
    std::set<std::string, std::less<>> names{"PI", "SigmaA", "SigmaS", "G", "IOR", "Ni", "No", "Bssrdf"};
    for (const EmbeddedFile& file : embeddedFiles()) {
        if (!file.path.starts_with("physics/")) continue;
        const std::vector<Token> tokens = tokenize(file.text);
        const Outline found = outline(tokens);
        for (const Function& function : found.functions) names.emplace(function.name.text);
        for (const Global& global : found.globals)
            for (const Declarator& declarator : global.declarators) names.emplace(declarator.name.text);
    }
    return names;
}

// A name of the same length that nobody has, so that every column of the file stays what it is.
std::string freshName(std::string_view name, const std::set<std::string, std::less<>>& taken) {
    constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789";
    std::string fresh(name);
    for (std::size_t at = fresh.size(); at-- > 0;) {
        for (const char letter : letters) {
            fresh[at] = letter;
            const bool digit_first = fresh[0] >= '0' && fresh[0] <= '9';
            if (!digit_first && !taken.contains(fresh)) return fresh;
        }
    }
    return fresh;  // 62 names of the file differ in one letter each: the compiler will say which clash
}

// What the file declares at its top level and the program has already, under another name.
std::map<std::string, std::string, std::less<>> renamings(const BrdfFile& file, const std::vector<Token>& tokens) {
    std::set<std::string, std::less<>> taken = reservedNames();
    const std::set<std::string, std::less<>> reserved = taken;
    for (const Token& token : tokens) taken.emplace(token.text);
    for (const Param& param : file.parameters) taken.insert(param.name);
    std::map<std::string, std::string, std::less<>> renamed;
    const auto see = [&](std::string_view name) {
        if (!reserved.contains(name) || renamed.contains(name)) return;
        const std::string fresh = freshName(name, taken);
        taken.insert(fresh);
        renamed.emplace(name, fresh);
    };
    const Outline found = outline(tokens);
    for (const Function& function : found.functions) see(function.name.text);
    for (const Global& global : found.globals)
        for (const Declarator& declarator : global.declarators) see(declarator.name.text);
    for (const Param& param : file.parameters) see(param.name);
    return renamed;
}

// The file as a model: its five vectors travel as the first five of a query.
Model modelOf(const BrdfFile& file) {
    const std::vector<Token> tokens = tokenize(file.shader, file.shader_first_line);
    const auto renamed = renamings(file, tokens);
    Model model;
    model.id = file.path;
    model.file.path = file.path;
    model.file.normals = true;
    model.file.parameters = file.parameters;
    for (Param& param : model.file.parameters)
        if (const auto fresh = renamed.find(param.name); fresh != renamed.end()) param.name = fresh->second;
    std::string text = file.shader;
    for (const Token& token : tokens)
        if (const auto fresh = renamed.find(token.text); fresh != renamed.end())
            text.replace(token.offset, token.text.size(), fresh->second);
    model.file.shader.text =
        text + "\nvec3 Bssrdf(vec3 Xi, vec3 Wi, vec3 Xo, vec3 Wo) { return BRDF(Xi, Wi, Ni, Xo, Wo); }\n";
    model.file.shader.first_line = file.shader_first_line;
    return model;
}

}  // namespace

BrdfEvaluator::BrdfEvaluator(const BrdfFile& file, const ParamValues& parameters, gl::Context& context) {
    const std::vector<ParamValue> values = brdfValues(file, parameters);
    const Model model = modelOf(file);
    ParamValues renamed;
    for (std::size_t i = 0; i < values.size(); ++i) renamed[model.file.parameters[i].name] = values[i];
    evaluator_ = makeGlEvaluator(model, context);
    evaluator_->set(Medium(), renamed);
}

void BrdfEvaluator::evaluate(std::span<const BrdfQuery> queries, std::span<Rgb> values) {
    constexpr std::size_t piece = 16384;
    std::vector<Query> packed;
    for (std::size_t first = 0; first < queries.size(); first += piece) {
        const std::size_t count = std::min(piece, queries.size() - first);
        packed.clear();
        for (const BrdfQuery& q : queries.subspan(first, count))
            packed.push_back(
                {.xi = q.light, .wi = q.view, .ni = q.normal, .xo = q.tangent, .wo = q.bitangent, .no = {}});
        evaluator_->evaluate(packed, values.subspan(first, count));
    }
}

}  // namespace searchlight
