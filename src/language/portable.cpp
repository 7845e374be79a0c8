#include "language/portable.h"

#include <fmt/format.h>

#include <algorithm>
#include <list>
#include <set>

#include "language/cpp_writer.h"
#include "language/glsl_names.h"
#include "language/initializer.h"

namespace searchlight {

namespace {

using Names = std::set<std::string, std::less<>>;

/// A GLSL text with its tokens and outline.
struct Source {
    std::string path;
    std::vector<Token> tokens;
    Outline found;

    Source(std::string path_, std::string_view text, int first_line)
        : path(std::move(path_)), tokens(tokenize(text, first_line)), found(outline(tokens)) {}
};

// Functions of GLSL other than constructors are not constexpr in C++.
bool callsFunction(const Global& global, const Names& functions) {
    for (const Declarator& declarator : global.declarators)
        for (const Token& token : declarator.value)
            if (functions.contains(token.text)) return true;
    return false;
}

Names builtins() { return {portableBuiltins().begin(), portableBuiltins().end()}; }

void noteFunctions(const Outline& found, Names& functions) {
    for (const Function& function : found.functions) functions.insert(std::string(function.name.text));
}

std::string aliases(const Names& used, std::string_view base) {
    std::string text = fmt::format("    using Base = {}<Real>;\n", base);
    for (const char* type : {"vec2", "vec3", "vec4", "bvec2", "bvec3", "bvec4", "mat3"})
        if (used.contains(type)) text += fmt::format("    using {} = typename Base::{};\n", type, type);
    return text;
}

std::string usings(const Names& used, const Names& inherited) {
    std::string text;
    for (const std::string& name : used)
        if (inherited.contains(name)) text += fmt::format("    using Base::{};\n", cppName(name));
    return text;
}

class ModelTranslator {
public:
    ModelTranslator(const BssrdfFile& file, const PortableLibrary& library, std::string_view name)
        : file_(file), library_(library), name_(name) {
        inherited_ = builtins();
        inherited_.insert(library.functions.begin(), library.functions.end());
        functions_ = inherited_;
        inherited_.insert(library.constants.begin(), library.constants.end());
        inherited_.insert("PI");
    }

    std::string run() {
        splitInitializer(file_);  // State is sound, and only init() writes it
        for (const BssrdfSection* section : {&file_.initializer, &file_.diffuse_reflectance, &file_.shader}) {
            if (!section->present()) continue;
            sources_.emplace_back(file_.path, section->text, section->first_line);
            noteFunctions(sources_.back().found, functions_);
        }
        CppWriter writer(functions_);
        members(writer);
        for (const Source& source : sources_) {
            writer.enterFile(source.path);
            write(writer, source);
        }
        if (!file_.initializer.present()) writer.line("void init() {}");
        Names used = writer.used();
        used.insert("vec3");
        // What the model declares itself hides what it would inherit.
        return fmt::format("template <class Real>\nstruct {} : {}<Real> {{\n{}{}\n{}}};\n", name_, library_.name,
                           aliases(used, library_.name), usings(used, inherited_), writer.text());
    }

private:
    void members(CppWriter& writer) const {
        writer.line(fmt::format("static constexpr bool uses_normals = {};", file_.normals));
        writer.line(
            fmt::format("static constexpr bool has_diffuse_reflectance = {};", file_.diffuse_reflectance.present()));
        writer.line("vec3 SigmaA, SigmaS, G;");
        writer.line("Real IOR{};");
        if (file_.normals) writer.line("vec3 Ni, No;");
        std::string reads;
        for (const Param& param : file_.parameters) {
            const std::string name = cppName(param.name);
            const char* type = param.type == ParamType::toggle   ? "bool"
                               : param.type == ParamType::color  ? "vec3"
                               : param.type == ParamType::choice ? "int"
                                                                 : "Real";
            writer.line(fmt::format("{} {}{{}};", type, name));
            for (std::size_t i = 0; i < param.choices.size(); ++i)
                writer.line(fmt::format("static constexpr int {}_{} = {};", param.name, param.choices[i], i));
            reads += fmt::format(" read(\"{}\", {});", param.name, name);
        }
        writer.line("template <class Read>");
        writer.line(fmt::format("void readParameters([[maybe_unused]] Read&& read) {{{} }}", reads));
    }

    void write(CppWriter& writer, const Source& source) const {
        const bool initializer = file_.initializer.present() && &source == &sources_.front();
        std::vector<Declarator> first;  // State with an initial value
        for (const OutlineItem& item : source.found.items) {
            if (item.kind == OutlineItem::Kind::other)
                throw notPortable(item.tokens.front(), fmt::format("'{}'", item.tokens.front().text));
            if (item.kind == OutlineItem::Kind::function) {
                const Function& function = source.found.functions[item.index];
                if (function.body.empty()) continue;  // members need no prototypes
                const bool init = initializer && function.name.text == "init" && function.parameters.empty();
                writer.function(function, "", init ? "" : " const", init ? std::span(first) : std::span<Declarator>());
                continue;
            }
            const Global& global = source.found.globals[item.index];
            if (global.isConst()) {
                writer.constants(global, !callsFunction(global, functions_));
                continue;
            }
            if (!initializer)
                throw notPortable(
                    global.declarators.front().name,
                    fmt::format("global '{}' outside section initializer", global.declarators.front().name.text));
            for (const Declarator& declarator : global.declarators) {
                writer.stateMember(global, declarator);
                if (!declarator.value.empty()) first.push_back(declarator);
            }
        }
    }

    const BssrdfFile& file_;
    const PortableLibrary& library_;
    std::string_view name_;
    Names functions_, inherited_;
    std::list<Source> sources_;
};

}  // namespace

PortableLibrary translateLibrary(std::span<const GlslSource> texts, std::string_view name) {
    PortableLibrary library;
    library.name = name;
    Names functions = builtins(), constants;
    std::list<Source> sources;
    for (const GlslSource& text : texts) {
        try {
            sources.emplace_back(text.path, text.text, 1);
        } catch (const Error& error) {
            throw error.at(text.path);
        }
        noteFunctions(sources.back().found, functions);
    }
    CppWriter writer(functions);
    for (const Source& source : sources) {
        writer.enterFile(source.path);
        try {
            for (const OutlineItem& item : source.found.items) {
                if (item.kind == OutlineItem::Kind::other)
                    throw notPortable(item.tokens.front(), fmt::format("'{}'", item.tokens.front().text));
                if (item.kind == OutlineItem::Kind::function) {
                    const Function& function = source.found.functions[item.index];
                    if (!function.body.empty()) writer.function(function, "static ", "");
                    library.functions.emplace_back(function.name.text);
                    continue;
                }
                const Global& global = source.found.globals[item.index];
                if (!global.isConst() || callsFunction(global, functions))
                    throw notPortable(global.declarators.front().name,
                                      "a global of physics/ that is no constant expression");
                writer.constants(global, true);
                for (const Declarator& declarator : global.declarators) constants.emplace(declarator.name.text);
            }
        } catch (const Error& error) {
            throw error.at(source.path);
        }
    }
    std::ranges::sort(library.functions);
    const auto surplus = std::ranges::unique(library.functions);
    library.functions.erase(surplus.begin(), surplus.end());
    library.constants.assign(constants.begin(), constants.end());
    Names inherited = builtins();
    inherited.insert("PI");
    library.cpp = fmt::format("template <class Real>\nstruct {} : glsl::Glsl<Real> {{\n{}{}\n{}}};\n", name,
                              aliases(writer.used(), "glsl::Glsl"), usings(writer.used(), inherited), writer.text());
    return library;
}

std::string translateModel(const BssrdfFile& file, const PortableLibrary& library, std::string_view name) {
    try {
        return ModelTranslator(file, library, name).run();
    } catch (const Error& error) {
        throw error.at(file.path);
    }
}

std::optional<Error> portabilityError(const BssrdfFile& file, const PortableLibrary& library) {
    try {
        translateModel(file, library, "Model");
        return std::nullopt;
    } catch (const Error& error) {
        return error;
    }
}

}  // namespace searchlight
