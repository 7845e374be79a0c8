#include "model/gl_program.h"

#include <fmt/format.h>

#include <algorithm>

namespace searchlight {

namespace {

void setParameter(gl::Program& program, const Param& param, const ParamValue& value) {
    checkValue(param, value);
    const char* name = param.name.c_str();
    switch (param.type) {
        case ParamType::toggle: program.set(name, std::get<bool>(value) ? 1 : 0); break;
        case ParamType::color: program.set(name, std::get<Rgb>(value)); break;
        case ParamType::choice: {
            const auto chosen = std::ranges::find(param.choices, std::get<std::string>(value));
            program.set(name, static_cast<int>(chosen - param.choices.begin()));
            break;
        }
        default: program.set(name, static_cast<float>(std::get<double>(value)));
    }
}

}  // namespace

// llvmpipe ends all loops of an invocation after 65,535 iterations in sum (LP_MAX_TGSI_LOOP_ITERATIONS) and says
// nothing. An invocation there is a vector of queries: where they run different loops, the driver counts more than each
// of them.
LoopBudget loopBudget(const gl::ContextInfo& device) {
    const bool is_llvmpipe = device.renderer.find("llvmpipe") != std::string::npos;
    return is_llvmpipe ? LoopBudget{60'000, true} : LoopBudget{};
}

void setModelUniforms(gl::Program& program, const BssrdfFile& file, const Medium& medium,
                      const ParamValues& parameters) {
    program.set("SigmaA", medium.sigma_a);
    program.set("SigmaS", medium.sigma_s);
    program.set("G", medium.g);
    program.set("IOR", static_cast<float>(medium.eta));
    program.set("sl_two", 2);
    for (const Param& param : file.parameters) setParameter(program, param, valueOf(param, parameters));
}

Error loopError(const BssrdfFile& file, const LoopBudget& budget, int failed) {
    const int line = failed - 1;
    std::string iterations = fmt::format("{:.0e}", static_cast<double>(budget.iterations));
    iterations.erase(iterations.find("+0"), 2);  // 1e6
    const std::string hint = budget.driver_cuts ? "per evaluation; llvmpipe stops there, a GPU may run 1e6"
                                                : "per evaluation, all loops of the model together";
    if (line == 0) return inputError(fmt::format("the loops exceeded {} iterations", iterations), hint).at(file.path);
    return inputError(fmt::format("loop at line {} exceeded {} iterations", line, iterations), hint)
        .at(file.path, line);
}

}  // namespace searchlight
