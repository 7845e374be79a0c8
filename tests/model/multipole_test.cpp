// The multipole against sums of its sources, closed forms of the total, and the dipoles that it becomes.
#include "model/physics.h"
#include "models.h"

namespace searchlight {
namespace {

using Real = long double;

struct Slab {
    double thickness_mm = 1;
    std::string side = "reflectance", dipole = "classical", source = "published", moments = "exact";

    ParamValues parameters() const {
        return {{"Thickness", ParamValue(thickness_mm)},
                {"Side", ParamValue(side)},
                {"Dipole", ParamValue(dipole)},
                {"Source", ParamValue(source)},
                {"Moments", ParamValue(moments)}};
    }
};

LoadedModel multipole(const Medium& medium, const Slab& slab) { return load("multipole", medium, slab.parameters()); }

// [DonnerJensen2005] Eqs. 8 to 11, with exact moments.
struct Sources {
    Real d, strength, D, s, depth, zb, C_phi = 0, C_E = 1;

    Sources(const Medium& medium, const Slab& slab) : d(slab.thickness_mm) {
        const Real sigma_a = medium.sigma_a.r, sigma_tp = medium.sigmaTp().r, alpha_prime = medium.alphaPrime().r;
        const Real C_1 = Physics<double>::fresnelMoment(1, medium.eta);
        const Real C_2 = Physics<double>::fresnelMoment(2, medium.eta);
        const bool better = slab.dipole == "better";
        const Real A = better ? (1 + 3 * C_2) / (1 - 2 * C_1) : (1 + 2 * C_1) / (1 - 2 * C_1);
        if (better) {
            C_phi = (1 - 2 * C_1) / 4;
            C_E = (1 - 3 * C_2) / 2;
        }
        D = (better ? 2 - alpha_prime : 1) / (3 * sigma_tp);
        s = std::sqrt(sigma_a / D);
        strength = better ? alpha_prime * alpha_prime : alpha_prime;
        depth = std::min(1 / sigma_tp, d / 2);
        zb = 2 * A * D;
        if (slab.source == "first_collision") {
            const Real tau = sigma_tp * d, chance = -std::expm1(-tau);
            depth = (1 - tau * std::exp(-tau) / chance) / sigma_tp;
            strength *= chance;
        }
    }

    Real flux(Real z, Real r) const {
        const Real R = std::hypot(z, r);
        return z * (1 + s * R) * std::exp(-s * R) / (R * R * R);
    }
    Real fluence(Real z, Real r) const {
        const Real R = std::hypot(z, r);
        return std::exp(-s * R) / R;
    }

    // The sources nearest the plane where light leaves: their sum is short of a multiple of 1 / (periods + 1/2)^2.
    Real sum(Real r, bool through, int periods) const {
        Real total = 0;
        const auto add = [&](int i) {
            const Real zr = 2 * i * (d + 2 * zb) + depth, zv = zr - 2 * (depth + zb);
            const Real to_source = through ? d - zr : zr, to_image = through ? d - zv : zv;
            total += C_E * (flux(to_source, r) - flux(to_image, r)) +
                     C_phi / D * (fluence(to_source, r) - fluence(to_image, r));
        };
        for (int i = periods; i > 0; --i) {
            add(-i);
            add(through ? i + 1 : i);
        }
        add(0);
        if (through) add(1);
        return strength / (4 * std::numbers::pi_v<Real>)*total;
    }
    Real Rd(Real r, bool through) const {
        constexpr int n = 500;
        const Real one = std::pow(n + (through ? 1 : 0.5L), 2), two = std::pow(2 * n + (through ? 1 : 0.5L), 2);
        return (two * sum(r, through, 2 * n) - one * sum(r, through, n)) / (two - one);
    }

    // The total from the equation in depth alone.
    Real total(bool through) const {
        const Real L = d + 2 * zb, source = depth + zb, from_far = through ? source : L - source;
        if (s == 0) return strength * from_far / L * (C_E + C_phi * zb / D);
        const Real fluence_of = std::sinh(s * zb) / (D * s), flux_of = std::cosh(s * zb);
        return strength * std::sinh(s * from_far) / std::sinh(s * L) * (C_E * flux_of + C_phi * fluence_of);
    }
};

std::vector<Slab> slabs(double thickness_mm) {
    std::vector<Slab> all;
    for (const char* side : {"reflectance", "transmittance"})
        for (const char* dipole : {"classical", "better"})
            for (const char* source : {"published", "first_collision"})
                all.push_back({thickness_mm, side, dipole, source, "exact"});
    return all;
}

std::string slabText(const Slab& slab) {
    return slab.side + ' ' + slab.dipole + ' ' + slab.source + ' ' + std::to_string(slab.thickness_mm) + " mm";
}

// Two thicknesses away the sources cancel to 1e-3, in long double here; the model's own error is 1e-10.
TEST(Multipole, IsTheSumOfItsSources) {
    for (const double thickness : {0.3, 2.0, 60.0})
        for (const Medium& medium : {ofAlbedo(0.9, 1.3), ofAlbedo(0.999, 1.5), ofAlbedo(1, 1)})
            for (const Slab& slab : slabs(thickness)) {
                const LoadedModel loaded = multipole(medium, slab);
                const Sources sources(medium, slab);
                const double L = static_cast<double>(sources.d + 2 * sources.zb);
                for (const double r : {0.0, 0.03, 0.2, 0.5, 0.69, 0.71, 1.0, 2.0}) {
                    const auto expected = static_cast<double>(sources.Rd(r * L, slab.side == "transmittance"));
                    EXPECT_NEAR(loaded.Rd(r * L), expected, 1e-9 * std::abs(expected))
                        << slabText(slab) << ", alpha' " << medium.alphaPrime().r << ", r / L " << r;
                }
            }
}

TEST(Multipole, HasTheTotalOfTheEquationInDepth) {
    for (const double thickness : {0.05, 0.5, 2.0, 20.0, 200.0})
        for (const Medium& medium : {ofAlbedo(0.5, 1.3), ofAlbedo(0.9, 1), ofAlbedo(0.999, 1.5), ofAlbedo(1, 1.3)})
            for (const Slab& slab : slabs(thickness)) {
                const double total = multipole(medium, slab).total();
                const auto expected = static_cast<double>(Sources(medium, slab).total(slab.side == "transmittance"));
                EXPECT_NEAR(total, expected, 1e-9) << slabText(slab) << ", alpha' " << medium.alphaPrime().r;
            }
}

TEST(Multipole, BecomesTheDipolesWhenThick) {
    for (const Medium& medium : {ofAlbedo(0.3, 1.3), ofAlbedo(0.9, 1.5), ofAlbedo(0.999, 1)})
        for (const char* moments : {"published", "exact"})
            for (const char* source : {"published", "first_collision"}) {
                const LoadedModel classical = load("dipole", medium, {{"Fresnel", ParamValue(moments)}});
                const LoadedModel better = load("better_dipole", medium, {{"Moments", ParamValue(moments)}});
                const LoadedModel as_classical = multipole(medium, {1000, "reflectance", "classical", source, moments});
                const LoadedModel as_better = multipole(medium, {1000, "reflectance", "better", source, moments});
                for (const double r : {0.0, 0.01, 0.3, 3.0, 30.0}) {
                    EXPECT_NEAR(as_classical.Rd(r) / classical.Rd(r), 1, 1e-10);
                    EXPECT_NEAR(as_better.Rd(r) / better.Rd(r), 1, 1e-10);
                }
            }
}

// With the moments of one Fresnel term, fluence and flux at both surfaces add up to what the source emits.
TEST(Multipole, KeepsEnergy) {
    for (const double thickness : {0.01, 0.3, 2.0, 50.0})
        for (const double eta : {1.0, 1.5})
            for (const double albedo : {0.5, 0.99, 1.0})
                for (const char* dipole : {"classical", "better"})
                    for (const char* moments : {"published", "exact"}) {
                        const Medium medium = ofAlbedo(albedo, eta);
                        const double R =
                            multipole(medium, {thickness, "reflectance", dipole, "published", moments}).total();
                        const double T =
                            multipole(medium, {thickness, "transmittance", dipole, "published", moments}).total();
                        EXPECT_GT(std::min(R, T), 0);
                        EXPECT_LE(R + T, 1 + 1e-9) << dipole << ", alpha' " << albedo;
                        if (albedo == 1) {
                            EXPECT_NEAR(R + T, 1, 1e-9) << dipole << ", eta " << eta;
                        }
                    }
}

TEST(FirstCollisionDepth, IsExactOnBothSidesOfItsSeam) {
    for (const double tau : {1e-6, 0.01, 0.3, 0.499999, 0.500001, 2.0, 40.0}) {
        const Real exact = 1 - tau / std::expm1(static_cast<Real>(tau));
        EXPECT_NEAR(Physics<double>::firstCollisionDepth(tau), static_cast<double>(exact), 4e-15 * tau + 1e-18);
    }
}

TEST(BesselK0, IsThatOfTheStandardLibrary) {
    for (const double x : {2.0, 2.5, 4.0, 10.0, 50.0, 300.0}) {
        const double expected = std::cyl_bessel_k(0.0, x);
        EXPECT_NEAR(Physics<double>::besselK0(x), expected, 2e-12 * expected) << x;
    }
}

}  // namespace
}  // namespace searchlight
