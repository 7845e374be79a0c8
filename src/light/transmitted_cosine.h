// How much of the light from a direction crosses into the medium, per area of the surface.
#pragma once

#include <vector>

namespace searchlight {

/// T12(mu) mu at cosine mu of the angle of incidence, exact: the smooth surface of a medium of relative index eta. 0
/// for mu <= 0.
double transmittedCosine(double mu, double eta);

/// The same as a table, within 1e-5 for eta in [1/4, 4] (5e-5 where eta is nearer to 1 than 1e-3, and not 1).
class TransmittedCosine {
public:
    explicit TransmittedCosine(double eta);

    float operator()(float mu) const;

    double eta() const { return eta_; }

private:
    double eta_;
    bool thinner_;  ///< eta < 1: total reflection at grazing incidence
    double inverse_eta2_;
    std::vector<float> table_;  ///< by mu; where there is total reflection, by the cosine inside: smooth in both
};

}  // namespace searchlight
