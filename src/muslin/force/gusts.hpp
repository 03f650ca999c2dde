// gust_noise computes turbulence: a smooth random velocity field carried along by the mean wind.
#pragma once

#include <cstdint>

#include "muslin/core/vectors.hpp"

namespace muslin {

/// Eddies of size `length` and half of it: value noise with C² interpolation in space and time. Each
/// component has mean 0 and root mean square 1; the seed decides the field. Only integer hashing and
/// polynomials: same bits everywhere. Not divergence free.
///
/// Argument: place and time in eddy sizes and eddy turnover times. Source: K. Perlin, Improving Noise,
/// SIGGRAPH 2002 (the interpolant); G. I. Taylor, The Spectrum of Turbulence, 1938 (frozen eddies carried by
/// the mean flow).
Vec3 gust_noise(const Vec3& place, double time, std::uint64_t seed);

}  // namespace muslin
