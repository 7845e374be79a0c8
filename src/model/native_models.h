// What the generated twin of a shipped model needs to become an Evaluator.
#pragma once

#include <algorithm>
#include <cassert>
#include <optional>
#include <span>
#include <string_view>
#include <type_traits>
#include <variant>

#include "base/error.h"
#include "base/parallel.h"
#include "language/glsl.h"
#include "model/evaluator.h"

namespace searchlight::native {

/// A row of the generated table.
struct NativeModel {
    std::string_view id;
    std::unique_ptr<Evaluator> (*make)(const Model& model, Precision precision);
};
std::span<const NativeModel> nativeModels();

/// Evaluates Twin<Real>, which language/portable.h made from the model's text.
template <template <class> class Twin, class Real>
class TwinEvaluator final : public Evaluator {
public:
    explicit TwinEvaluator(const Model& model) : path_(model.file.path), params_(model.file.parameters) {}

    void set(const Medium& medium, const ParamValues& parameters) override {
        Twin<Real>& twin = twin_.emplace();
        twin.SigmaA = vec(medium.sigma_a);
        twin.SigmaS = vec(medium.sigma_s);
        twin.G = vec(medium.g);
        twin.IOR = static_cast<Real>(medium.eta);
        twin.readParameters([&](std::string_view name, auto& member) {
            const Param& param = *std::ranges::find(params_, name, &Param::name);
            const ParamValue& value = valueOf(param, parameters);
            checkValue(param, value);
            read(param, value, member);
        });
        twin.init();
    }

    void evaluate(std::span<const Query> queries, std::span<Rgb> values) override {
        assert(queries.size() == values.size() && twin_);
        // Below this, waking threads takes longer than the work.
        constexpr std::size_t parallel_from = 16'384, chunk = 4'096;
        if (queries.size() <= parallel_from) return evaluateChunk(queries, values);
        parallelFor((queries.size() + chunk - 1) / chunk, 0, [&](std::size_t i) {
            const std::size_t first = i * chunk, count = std::min(chunk, queries.size() - first);
            evaluateChunk(queries.subspan(first, count), values.subspan(first, count));
        });
    }

    Rgb diffuseReflectance(Rgb alpha_prime) override {
        assert(twin_);
        if constexpr (Twin<Real>::has_diffuse_reflectance)
            return rgb(twin_->DiffuseReflectance(vec(alpha_prime)));
        else
            throw usageError("the model " + path_ + " has no DiffuseReflectance");
    }

    std::string backend() const override { return std::is_same_v<Real, double> ? "cpu double" : "cpu float"; }

private:
    using Vec3r = glsl::Vec<Real, 3>;

    static Vec3r vec(const Rgb& a) { return Vec3r(a.r, a.g, a.b); }
    static Vec3r vec(const Vec3& a) { return Vec3r(a.x, a.y, a.z); }
    static Rgb rgb(const Vec3r& a) { return {a[0], a[1], a[2]}; }

    static void read(const Param&, const ParamValue& value, Real& member) {
        member = static_cast<Real>(std::get<double>(value));
    }
    static void read(const Param&, const ParamValue& value, bool& member) { member = std::get<bool>(value); }
    static void read(const Param&, const ParamValue& value, Vec3r& member) { member = vec(std::get<Rgb>(value)); }
    static void read(const Param& param, const ParamValue& value, int& member) {
        const auto chosen = std::ranges::find(param.choices, std::get<std::string>(value));
        member = static_cast<int>(chosen - param.choices.begin());
    }

    void evaluateChunk(std::span<const Query> queries, std::span<Rgb> values) const {
        // A copy, because each query writes its normals into it.
        [[maybe_unused]] std::conditional_t<Twin<Real>::uses_normals, Twin<Real>, const Twin<Real>&> twin = *twin_;
        for (std::size_t i = 0; i < queries.size(); ++i) {
            const Query& query = queries[i];
            if constexpr (Twin<Real>::uses_normals) {
                twin.Ni = vec(query.ni);
                twin.No = vec(query.no);
            }
            values[i] = rgb(twin.Bssrdf(vec(query.xi), vec(query.wi), vec(query.xo), vec(query.wo)));
        }
    }

    std::string path_;
    std::vector<Param> params_;
    std::optional<Twin<Real>> twin_;
};

template <template <class> class Twin>
std::unique_ptr<Evaluator> makeTwinEvaluator(const Model& model, Precision precision) {
    if (precision == Precision::double_) return std::make_unique<TwinEvaluator<Twin, double>>(model);
    return std::make_unique<TwinEvaluator<Twin, float>>(model);
}

}  // namespace searchlight::native
