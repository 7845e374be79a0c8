// What a layer scatters once and twice and sends out straight, at one transverse rate.
#pragma once

#include <complex>

#include "transport/exact/ordinate_rays.h"

namespace searchlight {

/// Flux that leaves above and below, per unit flux that entered the stack.
struct StackFlux {
    std::complex<double> R, T;

    StackFlux& operator+=(const StackFlux& other) {
        R += other.R;
        T += other.T;
        return *this;
    }
    StackFlux& operator-=(const StackFlux& other) {
        R -= other.R;
        T -= other.T;
        return *this;
    }
};

/// Of the beam in this layer, scattered once and not reflected after that; as these directions have it.
StackFlux firstOrder(const OrdinateStack::Layer& layer, const LayerRays& rays, const OrdinateScattering& scattering);

/// Scattered twice in this layer and not reflected, but between the two by an interface of the layer. scattering: null:
/// the layer's phase function itself.
StackFlux secondOrder(const OrdinateStack::Layer& layer, const LayerRays& rays, const OrdinateScattering* scattering);

}  // namespace searchlight
