// Laws that the shipped models keep.
#include "models.h"

namespace searchlight {
namespace {

const std::vector<Medium>& media() {
    static const std::vector<Medium> found = {grey(0.0041, 2.62, 0, 1.5), grey(0.032, 0.74, 0, 1.3),
                                              grey(0.5, 0.5, 0, 1.33),    grey(0.01, 20, 0.9, 1.4),
                                              grey(0.1, 1, 0, 1),         grey(0.1, 1, 0, 0.75)};
    return found;
}

ParamValues choose(const std::string& name, const std::string& value) { return {{name, ParamValue(value)}}; }

std::vector<std::pair<std::string, ParamValues>> variants() {
    return {{"dipole", choose("Fresnel", "published")},
            {"dipole", choose("Fresnel", "exact")},
            {"better_dipole", choose("Moments", "published")},
            {"better_dipole", choose("Moments", "exact")},
            {"normalized_diffusion", choose("Parameterization", "searchlight")},
            {"normalized_diffusion", choose("Parameterization", "diffuse")},
            {"normalized_diffusion", choose("Parameterization", "diffuse_mean_free_path")},
            {"directional_dipole", choose("Moments", "published")},
            {"directional_dipole", choose("Moments", "exact")},
            {"directional_dipole_reciprocal", choose("Moments", "exact")},
            {"multipole", choose("Side", "reflectance")},
            {"multipole", choose("Dipole", "better")},
            {"quantized_diffusion", choose("Moments", "published")},
            {"quantized_diffusion", choose("Moments", "exact")},
            {"photon_beam_diffusion", choose("Moments", "published")},
            {"photon_beam_diffusion", choose("Moments", "exact")},
            {"photon_beam_diffusion_normal", {{"NearField", ParamValue(false)}}}};
}

TEST(ShippedModels, AreAllThere) {
    std::vector<std::string> ids;
    for (const Model& model : shippedModels()) {
        ids.push_back(model.id);
        EXPECT_TRUE(hasNativeEvaluator(model)) << model.id;
        EXPECT_FALSE(model.file.title.empty() || model.file.citation.empty() || model.file.validity.empty());
    }
    EXPECT_THAT(ids, testing::UnorderedElementsAre(
                         "better_dipole", "dipole", "directional_dipole", "directional_dipole_reciprocal", "gaussians",
                         "multipole", "normalized_diffusion", "photon_beam_diffusion", "photon_beam_diffusion_normal",
                         "quantized_diffusion", "single", "single_jensen", "two_layers"));
}

// The trapezoidal sum is good to 1e-11 where the integrand is analytic.
TEST(ShippedModels, PlaneIntegralIsTheClosedForm) {
    for (const auto& [id, parameters] : variants())
        for (const Medium& medium : media()) {
            const LoadedModel loaded = load(id, medium, parameters);
            if (!loaded.model.file.diffuse_reflectance.present()) continue;
            const double expected = loaded.closedForm();
            EXPECT_NEAR(loaded.total(), expected, 1e-9 * expected) << id << " eta " << medium.eta;
        }
}

// R(lambda r; sigma / lambda) = R(r; sigma) / lambda^2. Rounding is amplified by the exponent, at most 20 here.
TEST(ShippedModels, ScaleWithTheMedium) {
    const double lambda = 3.7;
    for (const auto& [id, parameters] : variants())
        for (const Medium& medium : media()) {
            if (id == "multipole") continue;  // its thickness is a length, too; `check` scales both
            Medium scaled = medium;
            scaled.sigma_a = 1 / lambda * medium.sigma_a;
            scaled.sigma_s = 1 / lambda * medium.sigma_s;
            const LoadedModel small = load(id, medium, parameters), large = load(id, scaled, parameters);
            for (const double r : {0.01, 0.1, 1.0, 10.0}) {
                const double mfp = r / medium.sigmaTp().r, expected = small.Rd(mfp) / (lambda * lambda);
                EXPECT_NEAR(large.Rd(lambda * mfp), expected, 1e-13 * expected) << id;
            }
        }
}

TEST(ShippedModels, DependOnReducedScatteringAlone) {
    // The directional dipole reads sigma_t itself, but only where it is lit from behind.
    for (const auto& [id, parameters] : variants()) {
        const LoadedModel isotropic = load(id, ofAlbedo(0.9, 1.3), parameters);
        const LoadedModel forward = load(id, ofAlbedo(0.9, 1.3, 0.8), parameters);
        for (const double r : {0.1, 1.0, 10.0}) EXPECT_NEAR(forward.Rd(r) / isotropic.Rd(r), 1, 1e-13) << id;
    }
}

TEST(ShippedModels, ArePositiveAndFiniteForIndicesThatTheFitsCover) {
    for (const auto& [id, parameters] : variants())
        for (const double eta : {0.4, 0.6, 0.9999, 1.0, 1.0001, 1.2, 1.7, 2.5})
            for (const double albedo : {0.05, 0.5, 0.999}) {
                const LoadedModel loaded = load(id, ofAlbedo(albedo, eta), parameters);
                for (const double r : {1e-3, 0.1, 1.0, 30.0}) {
                    EXPECT_GE(loaded.Rd(r), 0) << id << " eta " << eta;
                    EXPECT_TRUE(std::isfinite(loaded.Rd(r))) << id << " eta " << eta;
                }
            }
}

TEST(ShippedModels, WithoutAbsorptionAllLightReturnsFromADipole) {
    // Published moments do not conserve energy in the better dipole; exact ones do not either: A is from diffusion
    // theory alone. At matched indices C_phi 4 A + 2 C_E = 1 + 1.
    for (const char* id : {"dipole", "better_dipole"}) {
        const LoadedModel loaded = load(id, ofAlbedo(1, 1));
        EXPECT_NEAR(loaded.closedForm(), 1, 1e-14) << id;
    }
    EXPECT_NEAR(load("dipole", ofAlbedo(1, 1.5)).closedForm(), 1, 1e-14);
}

TEST(ShippedModels, ReturnNothingFromAChannelThatOnlyAbsorbs) {
    Medium medium = ofAlbedo(0.9, 1.3);
    medium.sigma_s.g = 0;
    for (const char* id : {"dipole", "better_dipole", "normalized_diffusion", "quantized_diffusion",
                           "photon_beam_diffusion", "photon_beam_diffusion_normal"}) {
        const LoadedModel loaded = load(id, medium);
        const std::vector<double> radii = {0.1, 1, 10};
        for (const Rgb& value : radialRd(*loaded.evaluator, loaded.model, medium, 0, radii)) {
            EXPECT_EQ(value.g, 0) << id;
            EXPECT_GT(value.r, 0) << id;
        }
    }
}

TEST(Gaussians, IntegrateToTheSumOfTheirWeights) {
    for (const auto& [fit, total] : std::vector<std::pair<std::string, double>>{
             {"skin6", 1}, {"skin4", 1}, {"marble4", 1}, {"marble_green", 0.75}}) {
        const LoadedModel loaded = load("gaussians", ofAlbedo(0.9, 1), choose("Fit", fit));
        const Rgb sum = totalRd(*loaded.evaluator, loaded.model, loaded.medium);
        // The published weights have 12 digits.
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c], total, 1e-10) << fit;
    }
}

TEST(Gaussians, DoNotReadTheMedium) {
    EXPECT_EQ(load("gaussians", ofAlbedo(0.9, 1)).Rd(0.7), load("gaussians", ofAlbedo(0.2, 1.5)).Rd(0.7));
}

TEST(NormalizedDiffusion, EncirclesWhatItsClosedFormSays) {
    const Medium medium = grey(0.032, 0.74, 0, 1.3);
    const LoadedModel loaded = load("normalized_diffusion", medium, choose("Parameterization", "searchlight"));
    const double A = loaded.closedForm();
    // d of Eq. 5, mean free path 1 / sigma_t'.
    const double d = 1 / (0.772 * (1.85 - A + 7 * std::pow(std::abs(A - 0.8), 3)));
    for (const double r : {0.01, 0.3, 1.0, 5.0}) {
        const double edges[] = {0, r};
        const double mean = annulusMeans(*loaded.evaluator, loaded.model, medium, 0, edges)[0].r;
        const double encircled = A * (1 - 0.25 * std::exp(-r / d) - 0.75 * std::exp(-r / (3 * d)));
        EXPECT_NEAR(mean * pi * r * r, encircled, 1e-12);
    }
}

TEST(NormalizedDiffusion, DivergesAsOneOverR) {
    const LoadedModel loaded = load("normalized_diffusion", ofAlbedo(0.9, 1.3));
    EXPECT_NEAR(1e-6 * loaded.Rd(1e-6) / (1e-9 * loaded.Rd(1e-9)), 1, 1e-5);
}

// R_d at the points, beam at the angle.
std::vector<Rgb> at(const LoadedModel& loaded, double angle_deg, const std::vector<Vec3>& points) {
    return planeRd(*loaded.evaluator, loaded.model, loaded.medium, angle_deg, points);
}

TEST(DirectionalDipole, IsMirroredInThePlaneOfIncidence) {
    const LoadedModel loaded = load("directional_dipole", ofAlbedo(0.95, 1.3));
    for (const double x : {-2.0, 0.1, 1.5}) {
        const std::vector<Rgb> both = at(loaded, 50, {{x, 0.8, 0}, {x, -0.8, 0}});
        EXPECT_EQ(both[0].r, both[1].r);
    }
}

TEST(DirectionalDipole, IsRoundUnderANormalBeam) {
    const LoadedModel loaded = load("directional_dipole", ofAlbedo(0.95, 1.3));
    const std::vector<Rgb> values = at(loaded, 0, {{1.3, 0, 0}, {0, 1.3, 0}, {0.78, -1.04, 0}});
    EXPECT_NEAR(values[1].r / values[0].r, 1, 1e-14);
    EXPECT_NEAR(values[2].r / values[0].r, 1, 1e-14);
}

TEST(DirectionalDipole, LeansTowardsTheRefractedBeam) {
    const LoadedModel loaded = load("directional_dipole", ofAlbedo(0.95, 1));
    const std::vector<Rgb> values = at(loaded, 60, {{1, 0, 0}, {-1, 0, 0}});
    EXPECT_GT(values[0].r, 2 * values[1].r);
}

// Far from a normal beam, with s r >> 1, every distance is nearly r: e^{-s d} = e^{-s r} (1 - s (d^2 - r^2) / (2 r)).
// Eqs. 20 and 26 then give, by hand,
//   4 pi R_d r^2 e^{s r} = C_phi (s (d_v^2 - d_r^2) / (2 D) + 3 h s) + C_E s (6 D + h) + O(1/(s r)),  h = 2 A d_e.
TEST(DirectionalDipole, HasTheAsymptoteOfItsSources) {
    const double albedo = 0.9, D = 1.0 / 3, s = std::sqrt(3 * (1 - albedo)), d_e = 2.131 * D / std::sqrt(albedo);
    const double h = 2 * d_e, C_phi = 0.25, C_E = 0.5;
    const double difference = h * h - D * (D + 2 * d_e);  // cos(beta) = -1
    const double expected = C_phi * (s * difference / (2 * D) + 3 * h * s) + C_E * s * (6 * D + h);
    const LoadedModel loaded = load("directional_dipole", ofAlbedo(albedo, 1));
    const double r = 1200;
    EXPECT_NEAR(4 * pi * loaded.Rd(r) * r * r * std::exp(s * r) / expected, 1, 2 / (s * r));
}

// [Frisvad2014] Eqs. 20 to 26 as they are printed, index-matched. The model joins source and image so that they do not
// cancel; off the plane, with any normals, that must change nothing.
double asPrinted(const Query& q, double sigma_a, double sigma_s) {
    const double sigma_t = sigma_a + sigma_s, D = 1 / (3 * sigma_t), s = std::sqrt(sigma_a / D);
    const double d_e = 2.131 * D / std::sqrt(sigma_s / sigma_t), C_phi = 0.25, C_E = 0.5;
    const Vec3 w = -1 * q.wi, x = q.xo - q.xi, side = cross(q.ni, x);
    const Vec3 n = cross(1 / length(x) * x, 1 / length(side) * side);
    const double mu = -dot(q.no, w), r2 = dot(x, x);
    const double cos_beta = -std::sqrt((r2 - dot(x, w) * dot(x, w)) / (r2 + d_e * d_e));
    const double d_r = std::sqrt(r2 + (mu > 0 ? D * mu * (D * mu - 2 * d_e * cos_beta) : 1 / (9 * sigma_t * sigma_t)));
    const auto S = [&](Vec3 y, Vec3 v, double d) {
        const double one = 1 + s * d, yv = dot(y, v), yn = dot(y, q.no);
        return std::exp(-s * d) / (d * d * d) *
               (C_phi * (d * d / D + 3 * one * yv) -
                C_E * (3 * D * one * dot(v, q.no) - (one + 3 * D * (3 * one + s * d * s * d) / (d * d) * yv) * yn));
    };
    const Vec3 y = x - 2 * d_e * n;
    return (S(x, w, d_r) - S(y, w - 2 * dot(w, n) * n, length(y))) / (4 * pi);
}

TEST(DirectionalDipole, IsEquation26ForAnyNormals) {
    const LoadedModel loaded = load("directional_dipole", ofAlbedo(0.8, 1), {{"ClampNegative", ParamValue(false)}});
    const auto unit = [](double x, double y, double z) {
        const Vec3 v{x, y, z};
        return 1 / length(v) * v;
    };
    const Vec3 ni = unit(0.2, -0.1, 1);
    for (const Vec3 wi : {unit(0.1, 0.3, 1), unit(-0.9, 0.2, 0.5)})
        for (const Vec3 xo : {Vec3{0.7, 0.3, -0.4}, Vec3{-0.2, 1.5, 0.3}, Vec3{0.1, 0.1, -2}})
            for (const Vec3 no : {ni, unit(1, 0.4, 0.2), unit(0.1, -0.3, -1)}) {
                const Query query{{}, wi, ni, xo, no, no};
                Rgb value;
                loaded.evaluator->evaluate({&query, 1}, {&value, 1});
                const double expected = asPrinted(query, 0.2, 0.8);
                EXPECT_NEAR(value.r, expected, 1e-13 + 1e-12 * std::abs(expected));
            }
}

// Without the clamp the image may win: behind an oblique beam.
TEST(DirectionalDipole, ClampsWhatWouldBeNegative) {
    const Medium medium = ofAlbedo(0.99, 1);
    const std::vector<Vec3> behind = {{-0.6, 0, 0}};
    const double clamped = at(load("directional_dipole", medium), 80, behind)[0].r;
    const double free = at(load("directional_dipole", medium, {{"ClampNegative", ParamValue(false)}}), 80, behind)[0].r;
    EXPECT_LT(free, 0);
    EXPECT_EQ(clamped, 0);
}

// Both normals matter: a slab lit from behind sees neither the virtual source in the wrong place nor a singularity.
TEST(DirectionalDipole, IsFiniteStraightThroughASlab) {
    const LoadedModel loaded = load("directional_dipole", ofAlbedo(0.9, 1.3));
    const Query through{{0, 0, 0}, {0, 0, 1}, {0, 0, 1}, {0, 0, -2}, {0, 0, -1}, {0, 0, -1}};
    const Query beside{{0, 0, 0}, {0, 0, 1}, {0, 0, 1}, {1e-5, 0, -2}, {0, 0, -1}, {0, 0, -1}};
    const Query queries[] = {through, beside};
    Rgb values[2];
    loaded.evaluator->evaluate(queries, values);
    EXPECT_GT(values[0].r, 0);
    EXPECT_NEAR(values[0].r / values[1].r, 1, 1e-4);
}

// How far the exact moments move the profiles: docs/errata.md quotes these.
double largestMove(const std::string& id, const std::string& parameter, double eta) {
    double largest = 0;
    for (const double albedo : {0.5, 0.9, 0.99, 0.999}) {
        const LoadedModel published = load(id, ofAlbedo(albedo, eta), choose(parameter, "published"));
        const LoadedModel exact = load(id, ofAlbedo(albedo, eta), choose(parameter, "exact"));
        for (double r = 0.01; r < 30; r *= 1.3)
            largest = std::max(largest, std::abs(exact.Rd(r) / published.Rd(r) - 1));
    }
    return largest;
}

TEST(Errata, ExactMomentsMoveTheProfilesByWhatIsQuoted) {
    // Percent, as printed there: two digits.
    const auto percent = [](const std::string& id, const std::string& parameter, double eta) {
        return 100 * largestMove(id, parameter, eta);
    };
    EXPECT_NEAR(percent("dipole", "Fresnel", 1.1), 0.11, 0.005);
    EXPECT_NEAR(percent("dipole", "Fresnel", 1.3), 0.06, 0.005);
    EXPECT_NEAR(percent("dipole", "Fresnel", 1.5), 0.13, 0.005);
    EXPECT_NEAR(percent("better_dipole", "Moments", 1.1), 0.42, 0.005);
    EXPECT_NEAR(percent("better_dipole", "Moments", 1.3), 0.25, 0.005);
    EXPECT_NEAR(percent("better_dipole", "Moments", 1.5), 0.23, 0.005);
    EXPECT_NEAR(percent("directional_dipole", "Moments", 1.1), 0.47, 0.005);
    EXPECT_NEAR(percent("directional_dipole", "Moments", 1.3), 0.35, 0.005);
    EXPECT_NEAR(percent("directional_dipole", "Moments", 1.5), 0.31, 0.005);
}

}  // namespace
}  // namespace searchlight
