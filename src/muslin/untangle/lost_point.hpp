// LostPoint is a point of a surface that is on the wrong side of another one, or of itself.
#pragma once

#include "muslin/core/vectors.hpp"

namespace muslin {

struct LostPoint {
  int point = 0;
  int piece = 0;                    ///< on whose wrong side it is
  int triangle = 0;                 ///< of that piece: where the point has to pass
  Vec3 barycentric = Vec3::Zero();  ///< weights of its corners
  Vec3 out = Vec3::Zero();          ///< the direction in which the point has to pass, of length 1
  double depth = 0;                 ///< how far it is behind that place, along `out` [m]
};

}  // namespace muslin
