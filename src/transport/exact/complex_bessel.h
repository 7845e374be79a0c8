// Modified Bessel functions of the second kind for complex arguments.
#pragma once

#include <complex>

namespace searchlight {

struct BesselK {
    std::complex<double> K0, K1;
};

/// K0 and K1 for |arg z| <= pi/2, to 1e-13 relative; 0 where they underflow. [Abramowitz1964] 9.6.13, 9.6.24, 9.7.2.
BesselK besselK(std::complex<double> z);

}  // namespace searchlight
