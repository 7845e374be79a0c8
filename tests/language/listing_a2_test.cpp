// The listing of the thesis, as printed, through the parser and as a native twin.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "base/files.h"
#include "language/initializer.h"
#include "native/listing_a2.h"

namespace searchlight {

namespace {

BssrdfFile listing() {
    const std::string path = SEARCHLIGHT_SOURCE_DIR "/tests/language/data/listing_a2.bssrdf";
    return parseBssrdf(readFile(path), path);
}

native::listing_a2<double> twin(double sigma_a, double sigma_s, double g, double eta) {
    native::listing_a2<double> model;
    using vec3 = glsl::Vec<double, 3>;
    model.SigmaA = vec3(sigma_a);
    model.SigmaS = vec3(sigma_s);
    model.G = vec3(g);
    model.IOR = eta;
    model.Multiplier = 1;
    model.init();
    return model;
}

double rd(const native::listing_a2<double>& model, double r) {
    using vec3 = glsl::Vec<double, 3>;
    return model.Bssrdf(vec3(), vec3(0, 0, 1), vec3(r, 0, 0), vec3(0, 0, 1))[0];
}

}  // namespace

TEST(ListingA2, LoadsAsPrinted) {
    const BssrdfFile file = listing();
    EXPECT_TRUE(file.radial && file.no_wi && file.no_wo);
    EXPECT_EQ(file.attributes, (std::vector<std::string>{"analytic", "radial", "no_wi", "no_wo"}));
    EXPECT_EQ(file.title, "listing_a2");
    ASSERT_EQ(file.parameters.size(), 1u);
    EXPECT_EQ(file.parameters[0].name, "Multiplier");
    EXPECT_EQ(file.parameters[0].max, 10);
    EXPECT_EQ(std::get<double>(file.parameters[0].value), 1);
    EXPECT_TRUE(file.initializer.present() && file.diffuse_reflectance.present() && file.shader.present());
}

TEST(ListingA2, HasFourStateGlobals) {
    const Initializer initializer = splitInitializer(listing());
    std::vector<std::string> declarations;
    for (const StateVariable& variable : initializer.state) declarations.push_back(variable.type + " " + variable.name);
    EXPECT_EQ(declarations, (std::vector<std::string>{"vec3 Lu", "vec3 AlphaPrime", "vec3 SigmaTr", "float A"}));
}

TEST(ListingA2, IsTheClassicalDipole) {
    // [Jensen2001] Eq. 4, marble's green channel with g = 0.9.
    const double sigma_a = 0.0041, sigma_s = 26.2, g = 0.9, eta = 1.5;
    const double sigma_sp = sigma_s * (1 - g), sigma_tp = sigma_sp + sigma_a;
    const double f = -1.44 / (eta * eta) + 0.71 / eta + 0.668 + 0.0636 * eta, a = (1 + f) / (1 - f);
    const double d = 1 / (3 * sigma_tp), sigma_tr = std::sqrt(sigma_a / d), zr = 1 / sigma_tp, zv = zr + 4 * a * d;
    const native::listing_a2<double> model = twin(sigma_a, sigma_s, g, eta);
    for (const double r : {1e-3, 0.1, 1.0, 10.0, 50.0}) {
        double sum = 0;
        for (const double z : {zr, zv}) {
            const double distance = std::hypot(r, z);
            sum += z * (1 + sigma_tr * distance) * std::exp(-sigma_tr * distance) / std::pow(distance, 3);
        }
        const double expected = sigma_sp / sigma_tp / (4 * std::numbers::pi) * sum;
        EXPECT_NEAR(rd(model, r) / expected, 1, 1e-14) << r;  // rounding
    }
}

TEST(ListingA2, TotalReflectanceMatchesItsDiffuseReflectance) {
    // Integral of 2 pi r R_d over r by the midpoint rule in t = ln r: both ends vanish, so that it converges
    // exponentially; 4000 points leave rounding.
    for (const double sigma_a : {0.01, 0.3, 2.0}) {
        const native::listing_a2<double> model = twin(sigma_a, 2, 0, 1.3);
        const double low = std::log(1e-8), high = std::log(2e3);
        const int steps = 4000;
        double total = 0;
        for (int i = 0; i < steps; ++i) {
            const double r = std::exp(low + (high - low) * (i + 0.5) / steps);
            total += 2 * std::numbers::pi * r * r * rd(model, r) * (high - low) / steps;
        }
        const double albedo = 2 / (2 + sigma_a);
        const double expected = model.DiffuseReflectance(glsl::Vec<double, 3>(albedo))[0];
        EXPECT_NEAR(total / expected, 1, 1e-9) << sigma_a;
    }
}

}  // namespace searchlight
