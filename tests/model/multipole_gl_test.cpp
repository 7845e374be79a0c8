// The multipole on GL for slabs thin and thick; the default thickness is compared with all other models.
#include "gl_test_model.h"
#include "models.h"

namespace searchlight {
namespace {

// Transmittance is the difference of sources that are the closer to each other the thicker the slab: 2e-5 where it is a
// hundred mean free paths thick.
TEST(Multipole, OnGlIsWithin2em5ForAnyThickness) {
    const Model model = loadModel("multipole");
    gl::Context context;
    const auto on_gl = makeGlEvaluator(model, context);
    const auto native = makeNativeEvaluator(model, Precision::double_);
    for (const double thickness : {0.0625, 0.5, 2.0, 20.0, 100.0})
        for (const char* side : {"reflectance", "transmittance"})
            for (const char* dipole : {"classical", "better"})
                for (const char* source : {"published", "first_collision"})
                    for (const double sigma_a : {0.0, 0.0625, 0.5}) {
                        const Medium medium = grey(sigma_a, 1, 0, 1.5);
                        const ParamValues parameters = {{"Thickness", ParamValue(thickness)},
                                                        {"Side", ParamValue(side)},
                                                        {"Dipole", ParamValue(dipole)},
                                                        {"Source", ParamValue(source)}};
                        on_gl->set(medium, parameters);
                        native->set(medium, parameters);
                        for (const double r : {0.0, 0.125, 1.0, 4.0, 16.0, 32.0}) {
                            const Query query = queryAt(r);
                            Rgb value, expected;
                            on_gl->evaluate({&query, 1}, {&value, 1});
                            native->evaluate({&query, 1}, {&expected, 1});
                            if (expected.r < 1e-30) continue;  // float ends there
                            EXPECT_NEAR(value.r / expected.r, 1, 2e-5)
                                << thickness << " mm, " << side << ' ' << dipole << ' ' << source << ", sigma_a "
                                << sigma_a << ", r " << r;
                        }
                    }
}

}  // namespace
}  // namespace searchlight
