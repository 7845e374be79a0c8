// What every check works with: media, queries, and the comparison of what came back. Internal to this folder.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "validate/check.h"

namespace searchlight {

/// What a check found: a CheckResult without its name.
struct Finding {
    CheckResult::Outcome outcome;
    std::string detail;
};
Finding passed(std::string detail);
Finding failed(std::string detail);
Finding reported(std::string detail);
Finding skipped(std::string detail);

/// Media of reduced extinction 1/mm, so that a mm is a mean free path: every pair of three refractive indices and two
/// g, with reduced albedos from 0.1 to 0.999 over the channels.
const std::vector<Medium>& checkMedia();

/// Reduced extinction 1/mm, with a reduced albedo per channel.
Medium mediumOf(const Rgb& alpha_prime, double g, double eta);

/// "alpha' 0.9, IOR 1.3, g 0.8"
std::string mediumText(const Medium& medium, int channel);

/// Queries at `radii` distances, `directions` of each; query i belongs to distance i / directions.
struct Probe {
    std::vector<double> radii_mm;
    int directions = 1;
    std::vector<Query> queries;

    double radius(std::size_t query) const { return radii_mm[query / static_cast<std::size_t>(directions)]; }
};

/// What the points of a low-discrepancy sequence are turned into, per query.
struct ProbeOptions {
    int radii = 40;  ///< from 1e-3 to 30 mm, logarithmic
    int directions = 8;
    double least_cosine = 0.02;  ///< of wi and wo to the normal
    bool tilted_exit = false;    ///< exit points above and below the plane, with normals of their own
};

/// Pencil beams on the plane z = 0: entry at the origin, exit around it, directions over the hemisphere.
Probe makeProbe(const ProbeOptions& options = {});

/// Point `index` of the Halton sequence in [0, 1)^9.
std::array<double, 9> haltonPoint(unsigned index);

/// A direction over the hemisphere about +z, by u and v in [0, 1).
Vec3 hemisphereDirection(double u, double v, double least_cosine = ProbeOptions().least_cosine);

/// The largest difference of two runs of one probe, relative to the largest value at that distance.
struct Difference {
    double relative = 0;
    std::string where;  ///< of the largest

    void see(const Difference& other) {
        if (other.relative > relative) *this = other;
    }
};

/// What the checks share about the model under test.
class CheckBench {
public:
    CheckBench(const Model& model, const ParamValues& parameters, const EvaluatorFactory& factory, Observer& observer);

    const Model& model() const { return model_; }
    const BssrdfFile& file() const { return model_.file; }
    const ParamValues& parameters() const { return parameters_; }

    /// In double for a shipped or a measured model, else on GL.
    Evaluator& evaluator() { return native_ ? *native_ : *gl_; }
    bool isNative() const { return native_ != nullptr; }
    Evaluator* gl() { return gl_.get(); }               ///< nullptr: not on this machine, or a measured model
    const std::string& noGl() const { return no_gl_; }  ///< why

    /// The model's values for the medium; throws interruptedError() when cancelled.
    std::vector<Rgb> values(const Medium& medium, const Probe& probe) { return values(medium, probe, parameters_); }
    std::vector<Rgb> values(const Medium& medium, const Probe& probe, const ParamValues& parameters);
    void pollCancelled() const;

    /// Difference of two results for `probe`. Values below 1e-30 of either are not compared: float ends there.
    static Difference difference(const Medium& medium, const Probe& probe, const std::vector<Rgb>& a,
                                 const std::vector<Rgb>& b);

    /// How far equal quantities may differ by rounding after exponentials of up to 50 and some cancellation: 1e-9 in
    /// double, 1e-4 in float.
    double rounding() const { return native_ ? 1e-9 : 1e-4; }

    /// False when it returns the same for every medium: a fit or a measurement.
    bool readsMedium();

private:
    const Model& model_;
    const ParamValues& parameters_;
    Observer& observer_;
    std::unique_ptr<Evaluator> native_, gl_;
    std::string no_gl_;
};

// What checks measure, over the media given.

/// The integral of R_d over the plane.
struct Total {
    Rgb value;
    double accuracy;  ///< relative
};
Total totalOf(CheckBench& bench, const Medium& medium, double angle_deg);

/// Angles of incidence at which a total is looked at: one for a model that does not read the direction.
std::vector<double> energyAngles(const CheckBench& bench);

struct LeastValue {
    double value = 0;  ///< 1/mm^2
    /// Of r^2 R_d, which is what a logarithmic step of the radius gives, in its largest value; below 0 if negative.
    double share = 0;
    std::string where;
};
LeastValue leastValue(CheckBench& bench, std::span<const Medium> media);

/// R_d(s r) s^2 in the medium s times thinner against R_d(r). `scales`: how many s kept parameters that are lengths in
/// their ranges; with 0 nothing was compared.
Difference scalingDifference(CheckBench& bench, std::span<const Medium> media, int& scales);

/// With both ends exchanged.
Difference reciprocalDifference(CheckBench& bench, std::span<const Medium> media);

// The checks, grouped by file. check_values:
Finding checkFinite(CheckBench& bench);
Finding checkNonNegative(CheckBench& bench);
Finding checkParameterEnds(CheckBench& bench);
// check_integrals:
Finding checkEnergy(CheckBench& bench);
Finding checkClosedForm(CheckBench& bench);
// check_claims:
Finding checkScaling(CheckBench& bench);
Finding checkRadial(CheckBench& bench);
Finding checkNoWi(CheckBench& bench);
Finding checkNoWo(CheckBench& bench);
Finding checkReciprocal(CheckBench& bench);
// check_text:
Finding checkFormat(CheckBench& bench);
Finding checkCompiles(CheckBench& bench);
Finding checkPortable(CheckBench& bench);
Finding checkBackendsAgree(CheckBench& bench);

}  // namespace searchlight
