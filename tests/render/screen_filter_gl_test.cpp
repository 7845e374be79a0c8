#include "render/screen/screen_filter_gl.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "gl/context.h"
#include "screen_plane.h"

namespace searchlight {
namespace {

using test::gaussianTaps;
using test::ScreenPlane;

TEST(ScreenFilterGl, AgreesWithTheLanesOfTheCpu) {
    gl::Context context;
    ScreenFilterGl device(context);
    Taps taps = gaussianTaps(0.6, 0.1, 17);
    taps.terms.push_back(gaussianTaps(1.5, 0, 17, 30).terms[0]);
    taps.terms[1].scale = {0.2, -0.1, 0.3};
    for (const auto& [tilt, about] : {std::pair{0.0, 0.0}, {50.0, 37.0}}) {
        const ScreenPlane plane(60, tilt, about, 120);
        const std::vector<Rgbf> light =
            plane.light([](double s, double t) { return std::sin(3 * s) * t > 0 ? 1 : 0.1; });
        std::vector<float> strength;
        for (std::size_t i = 0; i < light.size(); ++i) strength.push_back(0.25f * static_cast<float>(i % 5));
        device.setSamples(plane.samples);
        for (const FilterAxes axes : {FilterAxes::surface, FilterAxes::screen, FilterAxes::turned})
            for (const FilterTrust trust : {FilterTrust::all, FilterTrust::depth, FilterTrust::distance}) {
                const ScreenFilterOptions options{.axes = axes, .trust = trust, .fallback = 0.7, .strength = strength};
                const auto expected = filterScreen(plane.samples, light, taps, options);
                const auto found = device.filter(light, taps, options);
                for (std::size_t i = 0; i < found.size(); ++i) {
                    // A place is known to 1e-5 of a pixel (single precision at 120 pixels), and light steps by 0.9 from
                    // one to the next; 34 taps of that add up in each pass.
                    ASSERT_NEAR(found[i].r, expected[i].r, 5e-5) << i << " tilt " << tilt;
                    ASSERT_NEAR(found[i].g, expected[i].g, 5e-5) << i << " tilt " << tilt;
                    ASSERT_NEAR(found[i].b, expected[i].b, 1e-4) << i << " tilt " << tilt;
                }
            }
    }
}

TEST(ScreenFilterGl, StopsWhenItIsCancelled) {
    struct Stop : Observer {
        bool cancelled() const override { return true; }
    } stop;
    gl::Context context;
    ScreenFilterGl device(context);
    const ScreenPlane plane(60, 0, 0, 40);
    device.setSamples(plane.samples);
    const std::vector<Rgbf> light(plane.samples.count);
    EXPECT_THROW(device.filter(light, gaussianTaps(1), {.observer = &stop}), Error);
}

}  // namespace
}  // namespace searchlight
