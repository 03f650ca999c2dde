// SpringLaw is a linear spring between two points, and DashpotLaw a dashpot along it. Their measure is the
// vector z from one end to the other. The force is a multiple f of z; the product is the change of the force
// when z changes by d.
#pragma once

#include <cmath>

#include "muslin/core/vector_code.hpp"
#include "muslin/energy/law.hpp"

namespace muslin {

/// W = ½ k (|z| − r)². A spring no longer than `least` has no direction: it exerts no force, and k I is its
/// Hessian.
struct SpringLaw {
  struct Force {
    double f, w;
  };
  struct Product {
    double z, d;  // z z + d d
  };

  MUSLIN_INLINE static double energy(double k, double rest, double zx, double zy, double zz) {
    const double stretch = std::sqrt(zx * zx + zy * zy + zz * zz) - rest;
    const double pull = k * stretch;
    return 0.5 * pull * stretch;
  }
  MUSLIN_INLINE static Force force(double k, double rest, double least, double zx, double zy, double zz) {
    const double length = std::sqrt(zx * zx + zy * zy + zz * zz);
    const double stretch = length - rest;
    const double pull = k * stretch;
    const double f = pull / length;
    return {length > least ? f : 0.0, 0.5 * pull * stretch};
  }
  MUSLIN_INLINE static Product product(double k, double rest, double least, double zx, double zy, double zz,
                                       double dx, double dy, double dz) {
    const double square = zx * zx + zy * zy + zz * zz;
    const double length = std::sqrt(square);
    const double along = zx * dx + zy * dy + zz * dz;
    const double ratio = rest / length;
    const double turn = k * ratio * along / square;
    return {length > least ? turn : 0.0, length > least ? k * (1 - ratio) : k};
  }
};

/// W = ½ k (n·d)², n = z/|z|.
struct DashpotLaw {
  MUSLIN_INLINE static SpringLaw::Force force(double k, double least_square, double zx, double zy, double zz,
                                              double dx, double dy, double dz) {
    const double square = zx * zx + zy * zy + zz * zz;
    const double along = zx * dx + zy * dy + zz * dz;
    // Divisions are unconditional, or the loop would not vectorise.
    const double directed = square > least_square ? 1.0 : 0.0;
    const double f = directed * k * along / (square + (1.0 - directed));
    return {f, 0.5 * f * along};
  }
};

}  // namespace muslin
