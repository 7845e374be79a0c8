#include <fmt/format.h>

#include <cassert>

#include "base/error.h"
#include "model/evaluator.h"

namespace searchlight {

namespace {

/// A table knows nothing of the medium: set() changes nothing.
class MeasuredEvaluator final : public Evaluator {
public:
    explicit MeasuredEvaluator(const Model& model) : profile_(model.profile), title_(model.file.title) {}

    void set(const Medium&, const ParamValues& parameters) override {
        if (!parameters.empty())
            throw usageError(fmt::format("unknown parameter '{}'", parameters.begin()->first),
                             "a measured profile has no parameters");
    }

    void evaluate(std::span<const Query> queries, std::span<Rgb> values) override {
        assert(queries.size() == values.size());
        for (std::size_t i = 0; i < queries.size(); ++i) values[i] = profile_(length(queries[i].xo - queries[i].xi));
    }

    Rgb diffuseReflectance(Rgb) override {
        throw usageError(fmt::format("'{}' is measured: it has no DiffuseReflectance", title_));
    }

    std::string backend() const override { return "table"; }

private:
    Profile profile_;
    std::string title_;
};

}  // namespace

std::unique_ptr<Evaluator> makeMeasuredEvaluator(const Model& model) {
    assert(model.measured);
    return std::make_unique<MeasuredEvaluator>(model);
}

}  // namespace searchlight
