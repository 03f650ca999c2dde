// All of contact that does not change during a run: what touches, how far apart it keeps, how it slides.
#pragma once

#include <memory>
#include <vector>

#include "muslin/contact/contact_surface.hpp"
#include "muslin/contact/step_limiter.hpp"
#include "muslin/contact/surface_map.hpp"
#include "muslin/core/vectors.hpp"

namespace muslin {

struct ContactModel {
  std::shared_ptr<const ContactSurface> surface;
  std::shared_ptr<const SurfaceMap> map;  ///< the surface's points from all vertices of the model
  std::vector<Vec3> rest;                 ///< #P by 3, points of the surface at rest [m]
  double distance = 2e-3;                 ///< d̂, the gap below which contact acts [m]
  double friction = 0;                    ///< Coulomb's μ
  StepLimits limits;                      ///< gap floor; which vertices are prescribed, which move as one
};

}  // namespace muslin
