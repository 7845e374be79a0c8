// data/vocabulary.bssrdf, translated at build time, against the same by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "native/vocabulary.h"

namespace searchlight {

namespace {

template <class Real>
class Vocabulary : public testing::Test {
protected:
    using Vec3 = glsl::Vec<Real, 3>;

    Vocabulary() {
        twin.SigmaA = Vec3(1, 2, 3);
        twin.SigmaS = Vec3(4);
        twin.G = Vec3(0.5);
        twin.IOR = Real(1.5);
        twin.Weight = 2;
        twin.Flip = true;
        twin.Tint = Vec3(1, 10, 100);
        twin.Mode = twin.Mode_middle;
        twin.init();
    }

    /// A few roundings of a sum of terms up to 100.
    static void expectNear(Real value, double expected) {
        EXPECT_NEAR(static_cast<double>(value), expected,
                    16 * static_cast<double>(std::numeric_limits<Real>::epsilon()) * std::max(1.0, std::abs(expected)));
    }
    template <int N>
    static void expectNear(const glsl::Vec<Real, N>& value, const std::vector<double>& expected) {
        ASSERT_EQ(static_cast<int>(expected.size()), N);
        for (int i = 0; i < N; ++i) expectNear(value[i], expected[static_cast<std::size_t>(i)]);
    }

    native::vocabulary<Real> twin;
};

using Reals = testing::Types<double, float>;
TYPED_TEST_SUITE(Vocabulary, Reals);

}  // namespace

TYPED_TEST(Vocabulary, LiteralsKeepTheirValue) {
    this->expectNear(this->twin.literals(), 1 + 0.5 + 10 + 0.25 + 1 + 2 + 16 + 8 + 7);
}

TYPED_TEST(Vocabulary, SwizzlesReadAnyComponents) {
    using vec4 = glsl::Vec<TypeParam, 4>;
    // v.wz v.zx + xxxx + (x y y w) of 1 2 3 4.
    this->expectNear(this->twin.swizzles(vec4(1, 2, 3, 4)), {4 + 1 + 1, 3 + 1 + 2, 3 + 1 + 2, 1 + 1 + 4});
}

TYPED_TEST(Vocabulary, SingleComponentsAreWritten) {
    using vec3 = glsl::Vec<TypeParam, 3>;
    this->expectNear(this->twin.componentWrites(vec3(7, 2, 5)), {1, 7, 6});
}

TYPED_TEST(Vocabulary, ConstructorsStringPartsTogether) {
    using vec2 = glsl::Vec<TypeParam, 2>;
    // (1 2 5) + (5 1 2) + (1 2 5) + 2 + (1 0 1), halved.
    this->expectNear(this->twin.constructors(vec2(1, 2), 5), {5, 3.5, 7.5});
}

TYPED_TEST(Vocabulary, OutAndInoutAreReferences) { this->expectNear(this->twin.references(TypeParam(2.25)), {2, 1.5}); }

TYPED_TEST(Vocabulary, ControlFlowIsKept) {
    this->expectNear(this->twin.control(10), 0 + 1 + 3 + 4 + 5 + 100);
    this->expectNear(this->twin.control(2), -(0 + 1 + 100));
}

TYPED_TEST(Vocabulary, ArraysAreValues) { this->expectNear(this->twin.arrays(1), 1 + 2 + 3 + 5 * 100 + 1 + 2); }

TYPED_TEST(Vocabulary, ParametersAndLocalsHideGlobals) { this->expectNear(this->twin.shadows(5), 15); }

TYPED_TEST(Vocabulary, WordsOfCppAreNames) { this->expectNear(this->twin.keywords(1, 2), 6); }

TYPED_TEST(Vocabulary, ScalarFunctionsAreThoseOfTheStandard) {
    const double x = 0.75;
    const double a = std::sqrt(x) + 1 / std::sqrt(x) + std::exp(x) + std::exp2(x) + std::log(x) + std::log2(x) +
                     std::pow(x, 3) + x - 1;
    const double b = std::sin(x) + std::cos(x) + std::tan(x) + std::asin(x) + std::acos(x) + std::atan(x) +
                     std::atan2(x, -2) + std::sinh(x) + std::cosh(x) + std::tanh(x);
    // floor 0, ceil 1, fract x, trunc(-x) 0, round 1, mod(-x, 2) = 2 - x, min x, max 2, clamp x, mixes, step 1.
    const double t = x / 2;
    const double c = 0 + 1 + x + 0 + 1 + (2 - x) + x + 2 + x + (0.75 * x + 1.25) + 5 + 1 + t * t * (3 - 2 * t) +
                     x * std::numbers::pi / 180 + x * 180 / std::numbers::pi + x + (3 - x) + 4 * x;
    this->expectNear(this->twin.scalarFunctions(TypeParam(x)), {a, b, c});
}

TYPED_TEST(Vocabulary, VectorFunctionsWorkByComponent) {
    using vec3 = glsl::Vec<TypeParam, 3>;
    const double u[3] = {0.25, 0.5, 0.75}, v[3] = {0.5, 0.25, 1};
    const auto length = [](const double* w) { return std::sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]); };
    const double lu = length(u), lv = length(v), uv = u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
    const double difference[3] = {u[0] - v[0], u[1] - v[1], u[2] - v[2]};
    const double cosine = uv / (lu * lv), k = 1 - 0.81 * (1 - cosine * cosine);
    std::vector<double> expected;
    for (int i = 0; i < 3; ++i) {
        const double p = u[i], q = v[i];
        double sum = std::sqrt(p) + std::exp(-q) + std::pow(p, q) + p + std::atan2(p, q) + q + std::fmod(q, p);
        sum += std::min(p, q) + std::min(p, 0.5) + std::max(p, q) + std::max(q, 0.5);
        sum += std::clamp(p, 0.1, 0.3) + std::clamp(p, 0.1, q);
        sum += (0.75 * p + 0.25 * q) + 0.5 * (p + q) + (p < 0.3 ? q : p);
        sum += (p < 0.3 ? 0 : 1) + (p < q ? 0 : 1) + p * p * (3 - 2 * p);
        const int j = (i + 1) % 3, l = (i + 2) % 3;
        sum += u[j] * v[l] - u[l] * v[j] + q / lv + (p - 2 * uv / lv * q / lv);
        sum += 0.9 * p / lu - (0.9 * cosine + std::sqrt(k)) * q / lv;
        expected.push_back(sum + lu + length(difference) * uv - 2 * q + 1 / q);
    }
    this->expectNear(this->twin.vectorFunctions(vec3(u[0], u[1], u[2]), vec3(v[0], v[1], v[2])), expected);
}

TYPED_TEST(Vocabulary, RelationsGiveBoolVectors) {
    using vec3 = glsl::Vec<TypeParam, 3>;
    EXPECT_EQ(this->twin.relations(vec3(1, 2, 3), vec3(2, 2, 3)), 1 + 2 + 4 + 8 + 16);
    EXPECT_EQ(this->twin.relations(vec3(3, 2, 3), vec3(2, 2, 3)), 2 + 4 + 8 + 16);
}

TYPED_TEST(Vocabulary, IntegersStayIntegers) {
    EXPECT_EQ(this->twin.integers(-3, 2), 300 - 30 + 2 - 1 + 8 + 3 - 1);
    EXPECT_EQ(this->twin.bits(0x0fu), 0x78u);
}

TYPED_TEST(Vocabulary, MatricesAreColumnMajor) {
    using vec3 = glsl::Vec<TypeParam, 3>;
    // Turn is a quarter turn about z: (x y z) -> (-y x z); from the left and transposed, (y -x z).
    // Turn Turn e_x = -e_x; Turn[1] Turn[0][1] = (-1 0 0).
    this->expectNear(this->twin.matrices(vec3(1, 2, 3)), {-2 + 2 + 2 - 1 - 1 + 1, 1 - 1 - 1 + 2, 3 + 3 + 3 + 3});
}

TYPED_TEST(Vocabulary, LibraryFunctionsAreInherited) {
    // Between the squares 0 1 4 9, and beyond by extrapolation: 1.5 -> 2.5, 2 -> 4, 2.5 -> 6.5.
    const double rest = 9 + std::sqrt(2) / 3;
    this->expectNear(this->twin.library(TypeParam(1.5)), {2.5 + 2 + rest, 4 + 3 + rest, 6.5 + 4 + 4 + rest});
}

TYPED_TEST(Vocabulary, StateAndNormalsReachTheModel) {
    using vec3 = glsl::Vec<TypeParam, 3>;
    auto& model = this->twin;
    EXPECT_TRUE(model.uses_normals);
    EXPECT_FALSE(model.has_diffuse_reflectance);
    model.Ni = vec3(1000, 0, 0);
    model.No = vec3(0, 1, 0);
    // Scaled Tint = (2 40 600), Table[5] = 2.5, Given = (7 9 9).
    this->expectNear(model.Bssrdf(vec3(), vec3(), vec3(), vec3()), {1009, 40 + 2.5 + 9, 609});
    model.Mode = model.Mode_high;
    model.init();
    this->expectNear(model.Bssrdf(vec3(), vec3(), vec3(), vec3()), {12, 12, 12});
    EXPECT_EQ(model.Calls, 4 + 7);  // init() starts from the initial values each time
}

TYPED_TEST(Vocabulary, ParametersAreReadByName) {
    std::vector<std::string> names;
    this->twin.readParameters([&](std::string_view name, auto&) { names.emplace_back(name); });
    EXPECT_EQ(names, (std::vector<std::string>{"Weight", "Flip", "Tint", "Mode"}));
}

}  // namespace searchlight
