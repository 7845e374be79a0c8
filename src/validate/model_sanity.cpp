#include "validate/model_sanity.h"

#include "base/error.h"
#include "validate/check_bench.h"

namespace searchlight {

namespace {

const std::vector<Medium>& sanityMedia() {
    static const std::vector<Medium> media = [] {
        const std::vector<double>& a = sanityAlbedos();
        std::vector<Medium> list;
        for (const double eta : {0.77, 1.0, 1.3, 1.5})
            for (const double g : {0.0, 0.5, 0.9})
                for (std::size_t i = 0; i < a.size(); i += Rgb::channels)
                    list.push_back(mediumOf({a[i], a[i + 1], a[i + 2]}, g, eta));
        return list;
    }();
    return media;
}

}  // namespace

const std::vector<double>& sanityAlbedos() {
    // All but the first: those of the exact half-spaces in tests/data/half_space_refractive.csv.
    static const std::vector<double> albedos{.02, .1, .3, .5, .7, .9, .95, .98, .99, .995, .999, .9999};
    return albedos;
}

ModelSanity modelSanity(const Model& model, const ParamValues& parameters, const EvaluatorFactory& factory,
                        Observer& observer) {
    const bool native = model.shipped || model.measured;
    const EvaluatorFactory one = [&](const Model& which, std::string_view backend) {
        if (native && backend == "gl") throw deviceError("native code is enough");
        return factory(which, backend);
    };
    CheckBench bench(model, parameters, one, observer);
    ModelSanity sanity;
    for (const Medium& medium : sanityMedia())
        for (const double angle_deg : energyAngles(bench)) {
            const auto [sum, accuracy] = totalOf(bench, medium, angle_deg);
            for (int c = 0; c < Rgb::channels; ++c) {
                const SanityTotal total{medium.eta, medium.g[c], medium.alphaPrime()[c], angle_deg, sum[c]};
                if (angle_deg == 0) sanity.totals.push_back(total);
                if (total.total > 1 + accuracy) sanity.above.push_back(total);
                if (total.total > sanity.most.total) sanity.most = total;
            }
        }
    const LeastValue least = leastValue(bench, sanityMedia());
    sanity.least_share = least.share;
    sanity.least_where = least.where;
    const Difference reciprocal = reciprocalDifference(bench, sanityMedia());
    sanity.reciprocal = reciprocal.relative;
    sanity.reciprocal_where = reciprocal.where;
    if (model.measured || !bench.readsMedium()) return sanity;
    int scales = 0;
    const Difference scaling = scalingDifference(bench, sanityMedia(), scales);
    sanity.scales = scales > 0;
    sanity.scaling = scaling.relative;
    sanity.scaling_where = scaling.where;
    return sanity;
}

}  // namespace searchlight
