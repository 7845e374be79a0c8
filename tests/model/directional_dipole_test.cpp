// The directional dipole and its variants against finite differences of point sources, for any geometry.
#include <random>

#include "model/physics.h"
#include "models.h"

namespace searchlight {
namespace {

using Real = long double;

// Central difference of order 6. With the step 1e-3 of the distance its error is below 1e-17, rounding below 1e-15.
template <class F>
Real slope(const F& f, Real step) {
    return (45 * (f(step) - f(-step)) - 9 * (f(2 * step) - f(-2 * step)) + f(3 * step) - f(-3 * step)) / (60 * step);
}

struct Point {
    Real x, y, z;
    explicit Point(Vec3 v) : x(v.x), y(v.y), z(v.z) {}
    Point(Real x_, Real y_, Real z_) : x(x_), y(y_), z(z_) {}
};
Point operator+(Point a, Point b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Point operator*(Real s, Point a) { return {s * a.x, s * a.y, s * a.z}; }
Real dot(Point a, Point b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Real norm(Point a) { return std::sqrt(dot(a, a)); }

struct Parts {
    double source, image;
};

struct Ray {
    Real D, s, C_phi, C_E;

    // Fluence of a point source at the origin; correction is what [Frisvad2014] Eq. 24 adds to the squared distance.
    Real point(Point x, Real correction) const {
        const Real d = std::sqrt(dot(x, x) + correction);
        return std::exp(-s * d) / (4 * std::numbers::pi_v<Real> * D * d);
    }
    // A ray source is a point source pushed forward by 3 D, to first order: Eq. 9.
    Real fluence(Point x, Point w, Real correction, Real step) const {
        return point(x, correction) - 3 * D * slope([&](Real t) { return point(x + t * w, correction); }, step);
    }
    // Eq. 18
    Real exitance(Point x, Point w, Point no, Real correction) const {
        const Real step = 1e-3L * std::sqrt(dot(x, x) + correction);
        const auto along = [&](Real t) { return fluence(x + t * no, w, correction, step); };
        return C_phi * along(0) - C_E * D * slope(along, step);
    }
};

struct Settings {
    std::string plane = "modified", extrapolation = "published";

    ParamValues parameters() const {
        return {{"Plane", ParamValue(plane)},
                {"Extrapolation", ParamValue(extrapolation)},
                {"Moments", ParamValue("exact")},
                {"ClampNegative", ParamValue(false)}};
    }
};

// Snell's law by angles.
Point refracted(Point wi, Point n, double eta) {
    const Real cosine = dot(wi, n);
    const Point along = wi + -cosine * n;
    const Real sine = norm(along);
    const Real sine_inside = sine / eta;
    return (sine == 0 ? 0 : -sine_inside / sine) * along + -std::sqrt(1 - sine_inside * sine_inside) * n;
}

Parts expected(const Query& q, const Medium& medium, const Settings& settings) {
    const Real sigma_tp = medium.sigmaTp().r, alpha_prime = medium.alphaPrime().r, sigma_t = medium.sigmaT().r;
    const Real C_1 = Physics<double>::fresnelMoment(1, medium.eta), C_2 = Physics<double>::fresnelMoment(2, medium.eta);
    Ray ray{};
    ray.D = 1 / (3 * sigma_tp);
    ray.s = std::sqrt(3 * static_cast<Real>(medium.sigma_a.r) * sigma_tp);
    ray.C_phi = (1 - 2 * C_1) / 4;
    ray.C_E = (1 - 3 * C_2) / 2;
    const Real A = (1 - ray.C_E) / (2 * ray.C_phi);  // Eq. 22
    const Real d_e =
        settings.extrapolation == "report" ? 2.121L * ray.D / alpha_prime : 2.131L * ray.D / std::sqrt(alpha_prime);

    const Point x = Point(q.xo) + -1 * Point(q.xi), ni(q.ni), w = refracted(Point(q.wi), ni, medium.eta);
    const Real r = norm(x);
    // Eq. 23: ni without its part along x.
    const Point across = ni + -dot(ni, x) / (r * r) * x;
    const Point n = settings.plane == "tangent" ? ni : 1 / norm(across) * across;
    const Point no = settings.plane == "planar" ? n : Point(q.no);

    const Real mu = -dot(no, w), theta = std::acos(dot(x, w) / r);
    const Real cos_beta = -std::sin(theta) * r / std::sqrt(r * r + d_e * d_e);
    const Real correction =
        mu > 0 ? ray.D * mu * (ray.D * mu - 2 * d_e * cos_beta) : 1 / std::pow(3 * sigma_t, Real(2));
    const Point from_image = x + -2 * A * d_e * n;
    return {static_cast<double>(ray.exitance(x, w, no, correction)),
            static_cast<double>(ray.exitance(from_image, w + -2 * dot(w, n) * n, no, 0))};
}

class Geometries {
public:
    Vec3 direction() {
        const double z = std::uniform_real_distribution(-1.0, 1.0)(random_), phi = turn_(random_);
        const double flat = std::sqrt(1 - z * z);
        return {flat * std::cos(phi), flat * std::sin(phi), z};
    }
    Vec3 above(Vec3 n) {
        const Vec3 w = direction();
        return dot(w, n) < 0 ? -1 * w : w;
    }
    // Any two points and normals; the second surface may face anywhere.
    Query next() {
        const double r = std::exp(std::uniform_real_distribution(std::log(0.05), std::log(8.0))(random_));
        const Vec3 ni = direction(), no = direction(), xi = direction();
        return {xi, above(ni), ni, xi + r * direction(), above(no), no};
    }

private:
    std::mt19937 random_{1};
    std::uniform_real_distribution<double> turn_{0, 2 * pi};
};

const std::vector<Medium>& media() {
    static const std::vector<Medium> found = {ofAlbedo(0.95, 1), ofAlbedo(0.9, 1.3, 0.8), ofAlbedo(0.6, 1.5),
                                              ofAlbedo(0.999, 1.4), ofAlbedo(1, 1.3)};
    return found;
}

double valueOf(const LoadedModel& loaded, const Query& query) {
    Rgb value;
    loaded.evaluator->evaluate({&query, 1}, {&value, 1});
    return value.r;
}

// 1e-9 of the parts: the model in double, whose terms are up to a hundred times their sum.
TEST(DirectionalDipole, IsWhatFiniteDifferencesOfPointSourcesGive) {
    for (const char* plane : {"modified", "tangent", "planar"})
        for (const char* extrapolation : {"published", "report"})
            for (const Medium& medium : media()) {
                const Settings settings{plane, extrapolation};
                const LoadedModel loaded = load("directional_dipole", medium, settings.parameters());
                Geometries geometries;
                for (int i = 0; i < 100; ++i) {
                    const Query query = geometries.next();
                    const auto [source, image] = expected(query, medium, settings);
                    EXPECT_NEAR(valueOf(loaded, query), source - image, 1e-9 * (std::abs(source) + std::abs(image)))
                        << plane << ' ' << extrapolation << " alpha' " << medium.alphaPrime().r << ", geometry " << i;
                }
            }
}

TEST(DirectionalDipole, VariantsOfThePlaneAgreeOnAPlane) {
    for (const double angle_deg : {0.0, 45.0, 80.0}) {
        const std::vector<Vec3> points = {{0.3, 0.1, 0}, {-2, 0.7, 0}, {0, 5, 0}};
        const Medium medium = ofAlbedo(0.9, 1.3);
        const auto at = [&](const std::string& plane) {
            const LoadedModel loaded = load("directional_dipole", medium, {{"Plane", ParamValue(plane)}});
            return planeRd(*loaded.evaluator, loaded.model, medium, angle_deg, points);
        };
        const std::vector<Rgb> modified = at("modified"), tangent = at("tangent"), planar = at("planar");
        for (std::size_t i = 0; i < points.size(); ++i) {
            EXPECT_NEAR(tangent[i].r, modified[i].r, 1e-13 * modified[i].r);
            EXPECT_NEAR(planar[i].r, modified[i].r, 1e-13 * modified[i].r);
        }
    }
}

TEST(ReciprocalDirectionalDipole, IsTheMeanOfThereAndBack) {
    for (const char* plane : {"modified", "tangent", "planar"}) {
        const Medium medium = ofAlbedo(0.9, 1.3, 0.8);
        const ParamValues settings = {{"Plane", ParamValue(plane)}};
        const LoadedModel mean = load("directional_dipole_reciprocal", medium, settings);
        const LoadedModel one_way = load("directional_dipole", medium, settings);
        Geometries geometries;
        for (int i = 0; i < 100; ++i) {
            const Query there = geometries.next(), back{there.xo, there.wo, there.no, there.xi, there.wi, there.ni};
            EXPECT_EQ(valueOf(mean, there), 0.5 * (valueOf(one_way, there) + valueOf(one_way, back)));
            EXPECT_EQ(valueOf(mean, there), valueOf(mean, back));
        }
    }
}

// Only where a grazing ray enters at xo itself does the model diverge, and there it is cut off.
TEST(DirectionalDipole, IsFiniteInItsLimits) {
    const Vec3 up{0, 0, 1}, grazing{1, 0, 0}, almost{std::sqrt(1 - 1e-16), 0, 1e-8};
    for (const char* id : {"directional_dipole", "directional_dipole_reciprocal"})
        for (const char* plane : {"modified", "tangent", "planar"})
            for (const double eta : {0.5, 1.0, 1.5})
                for (const double albedo : {0.01, 0.9, 1.0}) {
                    const Medium medium = ofAlbedo(albedo, eta, 0.9);
                    const LoadedModel loaded =
                        load(id, medium, {{"Plane", ParamValue(plane)}, {"ClampNegative", ParamValue(false)}});
                    const double h =
                        2 *
                        Physics<double>::reflectionParameter(Physics<double>::fresnelMomentPublished(1, eta),
                                                             Physics<double>::fresnelMomentPublished(2, eta)) *
                        2.131 / 3 / std::sqrt(albedo);
                    for (const Vec3& wi : {up, grazing, almost})
                        for (const Vec3& xo :
                             {Vec3{}, Vec3{1e-9, 0, 0}, Vec3{1, 1, 0}, Vec3{0, 0, -3}, Vec3{0, 0, h}, Vec3{300, 0, 0}})
                            for (const Vec3& no : {up, -1 * up, grazing})
                                EXPECT_TRUE(std::isfinite(valueOf(loaded, {{}, wi, up, xo, no, no})))
                                    << id << ' ' << plane << ", eta " << eta << ", albedo " << albedo << ", xo " << xo.x
                                    << ' ' << xo.z << ", wi.z " << wi.z;
                }
}

}  // namespace
}  // namespace searchlight
