// gust_noise computes turbulence: a smooth random velocity field carried along by the mean wind.
#pragma once

#include <cstdint>

#include "muslin/core/vectors.hpp"

namespace muslin {

/// Returns value noise with C² interpolation in space and time: eddies of size 1 and ½. Each component has
/// mean 0 and root mean square 1; the seed decides the field. It uses only integer hashing and polynomials
/// and gives the same bits on every machine. The field is not divergence free.
///
/// `place` is in eddy sizes and `time` in eddy turnover times. Sources: K. Perlin, Improving Noise, SIGGRAPH
/// 2002 (the interpolant); G. I. Taylor, The Spectrum of Turbulence, 1938 (frozen eddies carried by the mean
/// flow).
Vec3 gust_noise(const Vec3& place, double time, std::uint64_t seed);

}  // namespace muslin
