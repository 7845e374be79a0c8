#include <algorithm>
#include <cassert>
#include <vector>

#include "base/error.h"
#include "base/text.h"
#include "model/evaluator.h"
#include "model/sum_model.h"

namespace searchlight {

namespace {

class SumEvaluator final : public Evaluator {
public:
    SumEvaluator(const Model& model, const PartEvaluator& make) : model_(model) {
        for (const Model& part : model_.parts) parts_.push_back(make(part));
    }

    void set(const Medium& medium, const ParamValues& parameters) override {
        for (std::size_t i = 0; i < parts_.size(); ++i)
            parts_[i]->set(medium, partParameters(model_, model_.parts[i], parameters));
    }

    void evaluate(std::span<const Query> queries, std::span<Rgb> values) override {
        assert(queries.size() == values.size());
        parts_.front()->evaluate(queries, values);
        added_.resize(values.size());
        for (std::size_t i = 1; i < parts_.size(); ++i) {
            parts_[i]->evaluate(queries, added_);
            for (std::size_t k = 0; k < values.size(); ++k) values[k] = values[k] + added_[k];
        }
    }

    Rgb diffuseReflectance(Rgb alpha_prime) override {
        Rgb sum;
        for (const auto& part : parts_) sum = sum + part->diffuseReflectance(alpha_prime);
        return sum;
    }

    std::string backend() const override {
        std::vector<std::string> names;
        for (const auto& part : parts_)
            if (std::ranges::find(names, part->backend()) == names.end()) names.push_back(part->backend());
        return join(names, " + ");
    }

private:
    Model model_;
    std::vector<std::unique_ptr<Evaluator>> parts_;
    std::vector<Rgb> added_;
};

}  // namespace

std::unique_ptr<Evaluator> makeSumEvaluator(const Model& model, const PartEvaluator& make) {
    assert(model.parts.size() > 1);
    return std::make_unique<SumEvaluator>(model, make);
}

}  // namespace searchlight
