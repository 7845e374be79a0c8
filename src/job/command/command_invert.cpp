// invert: from (Rdr, ld) to sigma_a and sigma_s'.
#include <fmt/format.h>

#include "base/error.h"
#include "base/text.h"
#include "job/command_table.h"
#include "job/json.h"
#include "job/shared_options.h"
#include "model/inversion.h"

namespace searchlight {

namespace {

Rgb spread(const std::vector<double>& list) {
    return list.size() == 1 ? Rgb{list[0], list[0], list[0]} : Rgb{list[0], list[1], list[2]};
}

JobResult runInvert(const Job& job, Engine& engine, Observer& observer) {
    const Options options(job);
    InversionTarget target;
    target.Rdr = spread(options.list("Rdr"));
    target.ld_mm = spread(options.list("ld"));
    target.eta = options.number("eta");
    target.g = options.number("g");
    target.channels = std::max(options.list("Rdr").size(), options.list("ld").size()) == 1 ? 1 : 3;

    Medium any;  // only eta and g matter before the coefficients are known
    any.sigma_s = any.sigma_a = {1, 1, 1};
    any.eta = target.eta;
    any.g = {target.g, target.g, target.g};
    LoadedModel loaded = engine.load(options.text("model"), options.names("set"), options.text("backend"), any);
    const Inversion inversion = invert(*loaded.evaluator, loaded.model, loaded.parameters, target);
    const Medium& medium = inversion.medium;

    const auto list = [&](const Rgb& value) {
        Json json = Json::array();
        for (int c = 0; c < target.channels; ++c) json.push_back(value[c]);
        return json;
    };
    Json document = documentJson("searchlight-inversion/1", job);
    document["model"] = loaded.model.id;
    document["sigma_a"] = list(medium.sigma_a);
    document["sigma_sp"] = list(medium.sigmaSp());
    document["sigma_s"] = list(medium.sigma_s);
    document["g"] = target.g;
    document["eta"] = target.eta;
    document["alpha_prime"] = list(inversion.alpha_prime);
    document["Rdr"] = list(inversion.achieved);
    document["reached"] = inversion.reached;
    document["mean_free_path"] = inversion.mean_free_path;
    document["through"] = inversion.from_profile ? "integral of the profile" : "DiffuseReflectance";
    document["unit"] = "1/mm";

    JobResult result;
    result.json = jsonText(document);
    result.text = fmt::format("{}: ld is 1/sigma_tr with the {} diffusion coefficient; Rdr through {}\n",
                              loaded.model.file.title, inversion.mean_free_path,
                              inversion.from_profile ? "the integral of the profile" : "DiffuseReflectance");
    result.text +=
        fmt::format("{:>3} {:>12} {:>14} {:>14} {:>12}\n", "", "alpha'", "sigma_a 1/mm", "sigma_s' 1/mm", "Rdr");
    for (int c = 0; c < target.channels; ++c) {
        result.text += fmt::format("{:>3} {:>12.6g} {:>14.6g} {:>14.6g} {:>12.6g}\n",
                                   target.channels == 1 ? "" : channelName(medium, c), inversion.alpha_prime[c],
                                   medium.sigma_a[c], medium.sigmaSp()[c], inversion.achieved[c]);
        if (!inversion.reached[static_cast<std::size_t>(c)])
            observer.log(LogLevel::warning,
                         fmt::format("Rdr {} cannot be reached by {} at eta {}: it goes from {:.4g} to {:.4g}; the "
                                     "nearest is given",
                                     target.Rdr[c], loaded.model.id, target.eta, inversion.reachable_min[c],
                                     inversion.reachable_max[c]));
    }
    return result;
}

}  // namespace

Command invertCommand() {
    return {
        .name = "invert",
        .summary = "Find sigma_a and sigma_s' from reflectance and mean free path",
        .example = "searchlight invert --model dipole --Rdr 0.44,0.22,0.13 --ld 3.673,1.367,0.683 --eta 1.3",
        .options = {option::model(),
                    option::set(),
                    {.name = "Rdr",
                     .type = ParamType::channels,
                     .min = 0,
                     .max = 1,
                     .doc = "total diffuse reflectance",
                     .required = true,
                     .exclusive = true},
                    {.name = "ld",
                     .type = ParamType::channels,
                     .unit = "mm",
                     .min = 0,
                     .max = option::unlimited,
                     .doc = "diffuse mean free path",
                     .required = true,
                     .exclusive = true},
                    {.name = "eta", .min = .25, .max = 4, .value = 1.3, .doc = "refractive index, inside over outside"},
                    {.name = "g", .min = -.99, .max = .99, .value = 0.0, .doc = "mean cosine, to unreduce sigma_s'"},
                    option::backend()},
        .run = runInvert};
}

}  // namespace searchlight
