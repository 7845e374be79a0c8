// Two layers against one slab, against sums over spatial frequencies, and against the energy that enters.
#include <fmt/format.h>

#include "model/physics.h"
#include "models.h"

namespace searchlight {
namespace {

using Real = long double;
constexpr Real real_pi = std::numbers::pi_v<Real>;

struct Layers {
    double top_sigma_a = 0.2, top_sigma_sp = 1.5, top_mm = 0.7;
    std::string base = "half_space";
    double base_mm = 4;
    std::string side = "reflectance", coupling = "diffusion", boundary = "extrapolated", source = "published";

    ParamValues parameters() const {
        return {{"TopSigmaA", ParamValue(Rgb{top_sigma_a, top_sigma_a, top_sigma_a})},
                {"TopSigmaSp", ParamValue(Rgb{top_sigma_sp, top_sigma_sp, top_sigma_sp})},
                {"TopThickness", ParamValue(top_mm)},
                {"Base", ParamValue(base)},
                {"BaseThickness", ParamValue(base_mm)},
                {"Side", ParamValue(side)},
                {"Coupling", ParamValue(coupling)},
                {"Boundary", ParamValue(boundary)},
                {"Source", ParamValue(source)},
                {"Fresnel", ParamValue("exact")}};
    }
    std::string text() const {
        return fmt::format("top {} {} {} mm, {} {} mm, {}, {}, {}, {}", top_sigma_a, top_sigma_sp, top_mm, base,
                           base_mm, side, coupling, boundary, source);
    }
};

LoadedModel twoLayers(const Medium& base, const Layers& layers) {
    return load("two_layers", base, layers.parameters());
}

// The other road: in depth, fluence is a e^(qz) + b e^(-qz) on each side of each source, and the conditions at sources,
// interface and boundaries are a linear system; over the plane, an integral with a Bessel function.
class ByFrequencies {
public:
    ByFrequencies(const Medium& base, const Layers& layers)
        : layers_(layers),
          inner_(2 * Physics<double>::fresnelMoment(1, base.eta)),
          layer_{Layer(layers.top_sigma_a, layers.top_sigma_sp, layers.top_mm),
                 Layer(base.sigma_a.r, base.sigmaSp().r, layers.base_mm)} {
        half_space_ = layers.base == "half_space";
        for (int i = 0; i < 2; ++i) {
            Layer& layer = layer_[i];
            const bool endless = i == 1 && half_space_;
            const Real tau = layer.sigma_tp * layer.d, chance = endless ? 1 : -std::expm1(-tau);
            if (layers.source == "published") {
                layer.z = endless ? 1 / layer.sigma_tp : std::min(1 / layer.sigma_tp, layer.d / 2);
            } else {
                layer.z = (endless ? 1 : 1 - tau * std::exp(-tau) / chance) / layer.sigma_tp;
                layer.strength *= chance;
                layer.through = endless ? 0 : std::exp(-tau);
            }
        }
    }

    // (1 / 2 pi) times the integral of k J_0(k r), by panels shorter than all that happens. What goes
    // through unscattered is a point, and left out.
    Real Rd(Real r) const {
        const Real unscattered = straight();
        const Real end = 45 / shortest();
        const Real x[3] = {0, std::sqrt(0.6L), -std::sqrt(0.6L)}, weight[3] = {4 / 9.0L, 5 / 18.0L, 5 / 18.0L};
        Real sum = 0, panel = 0;
        for (Real from = 0; from < end; from += panel) {
            panel = std::min(real_pi / (12 * (r + 0.1L)), 0.03L + 0.05L * from);
            for (int j = 0; j < 3; ++j) {
                const Real k = from + (0.5L + 0.5L * x[j]) * panel;
                sum += panel * weight[j] * k * std::cyl_bessel_j(0.0L, k * r) * (transformed(k) - unscattered);
            }
        }
        return sum / (2 * real_pi);
    }
    // Light that is joined as Kubelka and Munk do may go straight through both layers.
    Real straight() const {
        const bool joined = layers_.coupling == "diffusion" || layers_.side == "reflectance";
        return joined ? 0 : layer_[0].through * layer_[1].through;
    }
    Real transformed(Real k) const { return layers_.coupling == "diffusion" ? joined(k) : kubelkaMunk(k); }

private:
    struct Layer {
        Real sigma_a, sigma_tp, d, D, strength, z = 0, through = 0;
        Layer(Real a, Real sp, Real thickness)
            : sigma_a(a), sigma_tp(a + sp), d(thickness), D(1 / (3 * sigma_tp)), strength(sp / sigma_tp) {}
        Real q(Real k) const { return std::sqrt(k * k + sigma_a / D); }
    };

    // The shortest way out, with what decays over it.
    Real shortest() const {
        return layers_.side == "transmittance" ? std::min(layer_[0].d - layer_[0].z, layer_[1].d - layer_[1].z)
                                               : layer_[0].z;
    }
    Real A() const { return (1 + inner_) / (1 - inner_); }

    // Flux out of both sides of a slab or half-space for a source at depth z: [top, bottom].
    struct Flux {
        Real top, bottom;
    };
    Flux slab(const Layer& layer, Real z, Real k, Real A_top, Real A_bottom, bool endless) const {
        const Real q = layer.q(k), D = layer.D, z_top = 2 * A_top * D, z_bottom = 2 * A_bottom * D;
        if (layers_.boundary == "extrapolated") {
            if (endless) return {std::exp(-q * z) * (1 + std::exp(-2 * q * z_top)) / 2, 0};
            const Real L = layer.d + z_top + z_bottom;
            return {std::cosh(q * z_top) * std::sinh(q * (L - z - z_top)) / std::sinh(q * L),
                    std::cosh(q * z_bottom) * std::sinh(q * (z + z_top)) / std::sinh(q * L)};
        }
        if (endless) return {std::exp(-q * z) / (1 + q * z_top), 0};
        const Real h = layer.d - z, S = std::sinh(q * layer.d), C = std::cosh(q * layer.d);
        const Real W = (q * z_top + q * z_bottom) * C + (1 + q * q * z_top * z_bottom) * S;
        return {(std::sinh(q * h) + q * z_bottom * std::cosh(q * h)) / W,
                (std::sinh(q * z) + q * z_top * std::cosh(q * z)) / W};
    }

    Real kubelkaMunk(Real k) const {
        const Layer &one = layer_[0], &two = layer_[1];
        const Flux above = slab(one, one.z, k, A(), 1, false), below = slab(one, one.d - one.z, k, A(), 1, false);
        const Flux base = slab(two, two.z, k, 1, A(), half_space_);
        const Real R1 = one.strength * above.top, T1 = one.strength * above.bottom + one.through;
        const Real R1_below = one.strength * below.bottom, T1_below = one.strength * below.top + one.through;
        const Real R2 = two.strength * base.top, T2 = two.strength * base.bottom + two.through;
        const Real loss = 1 - R1_below * R2;
        return layers_.side == "transmittance" ? T1 * T2 / loss : R1 + T1 * R2 * T1_below / loss;
    }

    // Fluence a_j e^(-q z) + b_j e^(q z) with z from the upper end of each of four pieces; Gauss elimination.
    Real joined(Real k) const {
        const Layer &one = layer_[0], &two = layer_[1];
        const Real height[4] = {one.z, one.d - one.z, two.z, two.d - two.z};
        const Layer* of[4] = {&one, &one, &two, &two};
        const Real in[3] = {one.strength, 0, one.through * two.strength};
        constexpr int n = 8;
        Real m[n][n + 1] = {};
        const auto q = [&](int j) { return of[j]->q(k); };
        // b belongs to e^(q (z - height)), so that nothing overflows.
        for (int j = 0; j < 3; ++j) {  // end of piece j, start of piece j + 1
            const Real down = std::exp(-q(j) * height[j]), up = std::exp(-q(j + 1) * height[j + 1]);
            Real* fluence = m[2 * j];
            fluence[2 * j] = down;
            fluence[2 * j + 1] = 1;
            fluence[2 * j + 2] = -1;
            fluence[2 * j + 3] = -up;
            Real* flux = m[2 * j + 1];  // D phi' below less D phi' above is -in
            flux[2 * j] = of[j]->D * q(j) * down;
            flux[2 * j + 1] = -of[j]->D * q(j);
            flux[2 * j + 2] = -of[j + 1]->D * q(j + 1);
            flux[2 * j + 3] = of[j + 1]->D * q(j + 1) * up;
            flux[n] = -in[j];
        }
        // Outer boundaries: phi at the end, phi' into the layer.
        const bool extrapolated = layers_.boundary == "extrapolated";
        const auto condition = [&](Real* row, int at, int away, Real decay, const Layer& layer, Real qj) {
            const Real zb = 2 * A() * layer.D;
            // e^(-q z) from the boundary has phi 1, phi' -q there.
            row[at] = extrapolated ? std::exp(qj * zb) : 1 + qj * zb;
            row[away] = decay * (extrapolated ? std::exp(-qj * zb) : 1 - qj * zb);
        };
        condition(m[6], 0, 1, std::exp(-q(0) * height[0]), one, q(0));
        if (half_space_)
            m[7][7] = 1;  // nothing grows
        else
            condition(m[7], 7, 6, std::exp(-q(3) * height[3]), two, q(3));
        for (int c = 0; c < n; ++c) {
            int pivot = c;
            for (int i = c; i < n; ++i)
                if (std::abs(m[i][c]) > std::abs(m[pivot][c])) pivot = i;
            std::swap(m[c], m[pivot]);
            for (int i = 0; i < n; ++i) {
                if (i == c) continue;
                const Real factor = m[i][c] / m[c][c];
                for (int j = c; j <= n; ++j) m[i][j] -= factor * m[c][j];
            }
        }
        const auto solution = [&](int i) { return m[i][n] / m[i][i]; };
        if (layers_.side == "transmittance") {
            const Real a = solution(6) * std::exp(-q(3) * height[3]), b = solution(7);
            return two.D * q(3) * (a - b);
        }
        const Real a = solution(0), b = solution(1) * std::exp(-q(0) * height[0]);
        return one.D * q(0) * (b - a);
    }

    Layers layers_;
    Real inner_;
    Layer layer_[2];
    bool half_space_ = true;
};

std::vector<Layers> combinations(const Layers& of) {
    std::vector<Layers> all;
    for (const char* coupling : {"diffusion", "kubelka_munk"})
        for (const char* boundary : {"extrapolated", "partial_current"})
            for (const char* source : {"published", "first_collision"})
                for (const auto& [base, side] : std::vector<std::pair<std::string, std::string>>{
                         {"half_space", "reflectance"}, {"slab", "reflectance"}, {"slab", "transmittance"}}) {
                    Layers layers = of;
                    layers.coupling = coupling;
                    layers.boundary = boundary;
                    layers.source = source;
                    layers.base = base;
                    layers.side = side;
                    all.push_back(layers);
                }
    return all;
}

// A top that absorbs more than the base, and one that absorbs less and is a light guide.
const std::vector<std::pair<Medium, Layers>>& cases() {
    static const std::vector<std::pair<Medium, Layers>> found = {
        {grey(0.05, 1, 0, 1.4), {.top_sigma_a = 0.2, .top_sigma_sp = 1.5, .top_mm = 0.7}},
        {grey(0.4, 5, 0.8, 1.3), {.top_sigma_a = 0.01, .top_sigma_sp = 2, .top_mm = 2, .base_mm = 3}}};
    return found;
}

// The trapezoidal rules of init() are good to 1e-8. Far away the sum over frequencies cancels: 1e-12 of its largest
// value.
TEST(TwoLayers, AreWhatASumOverFrequenciesGives) {
    for (const auto& [base, top] : cases())
        for (const Layers& layers : combinations(top)) {
            const LoadedModel loaded = twoLayers(base, layers);
            const ByFrequencies exact(base, layers);
            const auto largest = static_cast<double>(exact.Rd(0));
            for (const double r : {0.0, 0.3, 1.0, 4.0}) {
                const auto expected = static_cast<double>(exact.Rd(r));
                EXPECT_NEAR(loaded.Rd(r), expected, 5e-7 * std::abs(expected) + 1e-10 * std::abs(largest))
                    << layers.text() << ", r " << r;
            }
            // A mode decays over lengths that the sum over the logarithm of r does not see twice: 1e-8.
            const auto total = static_cast<double>(exact.transformed(1e-9L) - exact.straight());
            EXPECT_NEAR(loaded.total(), total, 1e-7 * total) << layers.text();
        }
}

// One slab of the summed thickness, by the multipole. 2e-8: the Gaussians.
TEST(TwoLayers, OfOneMaterialAreOneSlab) {
    const Medium medium = ofAlbedo(0.95, 1.4);
    for (const char* side : {"reflectance", "transmittance"}) {
        const Layers layers{
            .top_sigma_a = 0.05, .top_sigma_sp = 0.95, .top_mm = 2.5, .base = "slab", .base_mm = 4, .side = side};
        const LoadedModel two = twoLayers(medium, layers);
        const LoadedModel one =
            load("multipole", medium,
                 {{"Thickness", ParamValue(6.5)}, {"Side", ParamValue(side)}, {"Moments", ParamValue("exact")}});
        for (const double r : {0.0, 0.1, 1.0, 5.0, 20.0}) EXPECT_NEAR(two.Rd(r) / one.Rd(r), 1, 2e-8) << side << r;
        EXPECT_NEAR(two.total() / one.total(), 1, 2e-8);
    }
}

// Below the top layer lies the same medium, endless: the classical dipole.
TEST(TwoLayers, OfOneMaterialAreTheDipole) {
    for (const double albedo : {0.5, 0.95, 0.999}) {
        const Medium medium = ofAlbedo(albedo, 1.4);
        const LoadedModel two = twoLayers(medium, {.top_sigma_a = 1 - albedo, .top_sigma_sp = albedo, .top_mm = 2.5});
        const LoadedModel one = load("dipole", medium, {{"Fresnel", ParamValue("exact")}});
        for (const double r : {0.0, 0.1, 1.0, 5.0, 30.0}) EXPECT_NEAR(two.Rd(r) / one.Rd(r), 1, 2e-8) << r;
    }
}

// docs/errata.md quotes what joining layers as Kubelka and Munk do makes of the total of one material.
TEST(Errata, KubelkaMunkIsOffByWhatIsQuoted) {
    const auto percent = [](double top_mm, const char* source) {
        Layers layers{.top_sigma_a = 0.05, .top_sigma_sp = 0.95, .top_mm = top_mm, .source = source};
        const Medium medium = ofAlbedo(0.95, 1.4);
        const double exact = load("dipole", medium, {{"Fresnel", ParamValue("exact")}}).total();
        layers.coupling = "kubelka_munk";
        return 100 * (twoLayers(medium, layers).total() / exact - 1);
    };
    // Three digits, as printed there.
    EXPECT_NEAR(percent(0.25, "published"), 7.37, 0.005);
    EXPECT_NEAR(percent(1, "published"), 8.14, 0.005);
    EXPECT_NEAR(percent(2, "published"), -1.23, 0.005);
    EXPECT_NEAR(percent(8, "published"), -0.01, 0.005);
    EXPECT_NEAR(percent(0.25, "first_collision"), 28.54, 0.005);
    EXPECT_NEAR(percent(1, "first_collision"), 16.22, 0.005);
    EXPECT_NEAR(percent(2, "first_collision"), 7.62, 0.005);
    EXPECT_NEAR(percent(8, "first_collision"), 0.06, 0.005);
}

// What is not absorbed leaves, on one side or the other, but for what was never scattered.
TEST(TwoLayers, KeepEnergy) {
    for (const char* coupling : {"diffusion", "kubelka_munk"})
        for (const char* boundary : {"extrapolated", "partial_current"})
            for (const char* source : {"published", "first_collision"})
                for (const double top_sigma_a : {0.0, 0.3}) {
                    Layers layers{.top_sigma_a = top_sigma_a, .top_mm = 0.4, .base = "slab", .base_mm = 2};
                    layers.coupling = coupling;
                    layers.boundary = boundary;
                    layers.source = source;
                    const Medium base = grey(0, 2, 0, 1.4);
                    const double R = twoLayers(base, layers).total();
                    layers.side = "transmittance";
                    const double T = twoLayers(base, layers).total();
                    const double scattered =
                        layers.source == "published" ? 1 : 1 - std::exp(-(top_sigma_a + 1.5) * 0.4 - 4);
                    if (top_sigma_a == 0) {
                        EXPECT_NEAR(R + T, scattered, 1e-8) << layers.text();
                    } else {
                        EXPECT_LT(R + T, scattered) << layers.text();
                    }
                }
}

}  // namespace
}  // namespace searchlight
