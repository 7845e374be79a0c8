#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <optional>
#include <vector>

#include "base/error.h"
#include "gl/buffer.h"
#include "gl/context.h"
#include "gl/program.h"
#include "model/evaluator.h"
#include "model/gl_program.h"
#include "model/gl_source.h"

namespace searchlight {

namespace {

// 16k queries a dispatch: about 1 ms of llvmpipe for the shipped models, so that no dispatch blocks for long.
constexpr std::size_t slice = 16384;

constexpr std::size_t floats_per_query = 18;

float* put(float* target, const Vec3& vector) {
    *target++ = static_cast<float>(vector.x);
    *target++ = static_cast<float>(vector.y);
    *target++ = static_cast<float>(vector.z);
    return target;
}

class GlEvaluator final : public Evaluator {
public:
    GlEvaluator(const Model& model, gl::Context& context)
        : file_(model.file), context_(context), budget_(loopBudget(context.info())) {
        // State first: an error in the initializer is then reported once, and as the first.
        if (file_.initializer.present()) init_.emplace(context, modelShader(file_, GlStage::init, budget_));
        evaluate_.emplace(context, modelShader(file_, GlStage::evaluate, budget_));
        if (init_) state_.reserve(init_->blockSize("sl_State"));
    }

    void set(const Medium& medium, const ParamValues& parameters) override {
        medium_ = medium;
        parameters_ = parameters;
        setUniforms(*evaluate_);
        if (diffuse_) setUniforms(*diffuse_);
        if (!init_) return;
        setUniforms(*init_);
        run(*init_, 1, 0);
    }

    void evaluate(std::span<const Query> queries, std::span<Rgb> values) override {
        assert(queries.size() == values.size());
        for (std::size_t first = 0; first < queries.size(); first += slice) {
            const std::size_t count = std::min(slice, queries.size() - first);
            evaluateSlice(queries.subspan(first, count), values.subspan(first, count));
        }
    }

    Rgb diffuseReflectance(Rgb alpha_prime) override {
        if (!file_.diffuse_reflectance.present())
            throw usageError(fmt::format("the model {} has no DiffuseReflectance", file_.path));
        if (!diffuse_) {
            diffuse_.emplace(context_, modelShader(file_, GlStage::diffuse_reflectance, budget_));
            setUniforms(*diffuse_);
        }
        diffuse_->set("sl_alpha_prime", alpha_prime);
        return valueAt(run(*diffuse_, 1, 1), 0);
    }

    std::string backend() const override { return "gl " + context_.info().renderer; }

private:
    // In the buffer: whether a loop failed, then three floats a query.
    static Rgb valueAt(std::span<const float> values, std::size_t i) {
        return {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
    }

    void setUniforms(gl::Program& program) const { setModelUniforms(program, file_, medium_, parameters_); }

    void evaluateSlice(std::span<const Query> queries, std::span<Rgb> values) {
        upload_.resize(queries.size() * floats_per_query);
        float* target = upload_.data();
        for (const Query& query : queries)
            for (const Vec3* vector : {&query.xi, &query.wi, &query.ni, &query.xo, &query.wo, &query.no})
                target = put(target, *vector);
        queries_.reserve(upload_.size() * sizeof(float));
        queries_.upload<float>(upload_);
        evaluate_->set("sl_count", static_cast<int>(queries.size()));
        const std::size_t groups = (queries.size() + gl_group_size - 1) / gl_group_size;
        const std::span<const float> results = run(*evaluate_, static_cast<unsigned>(groups), queries.size());
        for (std::size_t i = 0; i < values.size(); ++i) values[i] = valueAt(results, i);
    }

    // Runs a program and returns what it wrote for `count` queries. Throws the Error of a loop without end.
    std::span<const float> run(gl::Program& program, unsigned groups, std::size_t count) {
        download_.resize(1 + 3 * std::max<std::size_t>(count, 1));
        values_.reserve(download_.size() * sizeof(float));
        program.dispatch(groups,
                         {{GlBinding::state, state_}, {GlBinding::queries, queries_}, {GlBinding::values, values_}});
        values_.download<float>(download_);
        const int failed = std::bit_cast<int>(download_[0]);
        if (failed != 0) {
            constexpr int good = 0;
            values_.upload(std::span(&good, 1));
            throw loopError(file_, budget_, failed);
        }
        return std::span<const float>(download_).subspan(1);
    }

    BssrdfFile file_;
    gl::Context& context_;
    LoopBudget budget_;
    std::optional<gl::Program> init_, evaluate_, diffuse_;
    gl::Buffer state_{context_, 4}, queries_{context_, 4}, values_{context_, 4};
    Medium medium_;
    ParamValues parameters_;
    std::vector<float> upload_, download_;
};

}  // namespace

std::unique_ptr<Evaluator> makeGlEvaluator(const Model& model, gl::Context& context) {
    if (!model.parts.empty())
        return makeSumEvaluator(model, [&](const Model& part) {
            return part.measured ? makeMeasuredEvaluator(part) : makeGlEvaluator(part, context);
        });
    return std::make_unique<GlEvaluator>(model, context);
}

}  // namespace searchlight
