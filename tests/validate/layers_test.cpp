// Slabs and layers against Monte Carlo: how far diffusion theory is off, as docs/errata.md says.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "model/plane.h"
#include "transport/slab/slab.h"

namespace searchlight {
namespace {

double total(std::string_view id, const Medium& medium, const ParamValues& parameters) {
    const Model model = loadModel(id);
    const std::unique_ptr<Evaluator> evaluator = makeNativeEvaluator(model);
    evaluator->set(medium, parameters);
    return pencilBeam(medium.eta, 0).transmittance * totalRd(*evaluator, model, medium).r;
}

Medium grey(double sigma_a, double sigma_s, double eta) {
    return {{sigma_a, sigma_a, sigma_a}, {sigma_s, sigma_s, sigma_s}, {0, 0, 0}, eta, 1};
}

TEST(Multipole, Probe) {
    Observer observer;
    SlabOptions options;
    options.walks = 200000;
    for (const double eta : {1.0, 1.4})
        for (const double albedo : {0.9, 0.99, 1.0})
            for (const double d : {0.5, 1.0, 2.0, 5.0, 20.0}) {
                const SlabResult mc = walkSlab({1, 1, {{eta, 1 - albedo, albedo, 0, d}}}, options, observer);
                fmt::print("n {} a {} d {}: MC R {:.4f} T {:.4f} |", eta, albedo, d, mc.R.mean, mc.T.mean);
                for (const char* dipole : {"classical", "better"})
                    for (const char* source : {"published", "first_collision"}) {
                        ParamValues p = {{"Thickness", ParamValue(d)}, {"Dipole", ParamValue(dipole)}, {"Source", ParamValue(source)}};
                        const Medium m = grey(1 - albedo, albedo, eta);
                        p.insert_or_assign("Side", ParamValue("reflectance"));
                        const double R = total("multipole", m, p);
                        p.insert_or_assign("Side", ParamValue("transmittance"));
                        fmt::print(" {:.4f} {:.4f} |", R, total("multipole", m, p));
                    }
                fmt::print("\n");
            }
    // skin-like: epidermis on dermis
    for (const auto& [name, a1, s1, d1, a2, s2] : std::vector<std::tuple<std::string, double, double, double, double, double>>{
             {"skin red", 0.15, 3.0, 0.1, 0.03, 1.5}, {"skin green", 0.35, 4.0, 0.1, 0.2, 2.2}, {"skin blue", 0.7, 5.0, 0.1, 0.6, 3.0},{"paint", 0.02, 10.0, 0.3, 1.0, 2.0}, {"thick", 0.1, 2.0, 1.5, 0.02, 1.0}}) {
        const SlabResult mc = walkSlab({1, 1, {{1.4, a1, s1, 0, d1}, {1.4, a2, s2, 0, 20}}}, options, observer);
        fmt::print("{}: MC {:.4f} +- {:.4f} single {:.4f}|", name, mc.R.mean, mc.R.standard_error, mc.R_single.mean);
        for (const char* coupling : {"kubelka_munk", "diffusion"})
            for (const char* boundary : {"partial_current", "extrapolated"})
                for (const char* source : {"first_collision", "published"})
                    fmt::print(" {:.4f}", total("two_layers", grey(a2, s2, 1.4),
                                                {{"TopSigmaA", ParamValue(Rgb{a1, a1, a1})}, {"TopSigmaSp", ParamValue(Rgb{s1, s1, s1})}, {"TopThickness", ParamValue(d1)},
                                                 {"Coupling", ParamValue(coupling)}, {"Boundary", ParamValue(boundary)}, {"Source", ParamValue(source)}}));
        fmt::print("\n");
    }
}

}  // namespace
}  // namespace searchlight
