// AttachmentForce is the force that an attachment exerts.
#pragma once

#include "muslin/core/vectors.hpp"

namespace muslin {

/// The force of the springs of an attachment on the points of the first body.
struct AttachmentForce {
  Vec3 sum = Vec3::Zero();  ///< of all joints [N]
  double mean = 0;          ///< magnitude of a joint that holds [N]
  double largest = 0;       ///< the largest magnitude of a joint [N]
  int holding = 0;          ///< joints that hold; 0 before the first step
};

}  // namespace muslin
