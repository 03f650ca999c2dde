// Turbulence is a random field that is free of divergence and has Kolmogorov's spectrum.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "muslin/force/field.hpp"

namespace muslin {

/// A sum of plane waves a cos(k·x + φ − ω t) with a across k, so that each of them is free of divergence. The
/// energy per wave number is E(k) ∝ k^−5/3 between 2π/largest and 2π/smallest and zero outside, in bands of
/// equal ratio with six waves each. The waves of a band run along the axes of two random frames, so the mean
/// over all space of uᵢuⱼ is exactly δᵢⱼ: each component has the root mean square 1.
///
/// With a turnover time T, ω(k) = 2π/T (k/k₀)^⅔ with k₀ = 2π/largest; else the field is frozen. Sources: R.
/// H. Kraichnan, Diffusion by a random velocity field, 1970 (random waves); J. C. H. Fung et al., Kinematic
/// simulation of homogeneous turbulence, 1992 (bands, frequencies).
class Turbulence : public FieldPattern {
 public:
  struct Settings {
    double largest = 1;   ///< size of the largest eddies [m] > 0
    double smallest = 1;  ///< of the smallest ones [m], 0 < smallest ≤ largest
    double turnover = std::numeric_limits<double>::infinity();  ///< of the largest eddies [s] > 0
    std::uint64_t seed = 1;                                     ///< decides the waves
  };
  struct Wave {
    Vec3 number;     ///< k [1/m]
    Vec3 amplitude;  ///< a
    double frequency, phase;
  };

  explicit Turbulence(const Settings& settings);
  FieldSample at(const Vec3& place, double time) const override;
  const std::vector<Wave>& waves() const { return waves_; }

 private:
  std::vector<Wave> waves_;
};

}  // namespace muslin
