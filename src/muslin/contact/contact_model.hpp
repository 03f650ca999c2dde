// ContactModel holds the contact data that is constant during a run: surfaces, contact distance, friction.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "muslin/contact/contact_exemptions.hpp"
#include "muslin/contact/contact_surface.hpp"
#include "muslin/contact/step_limiter.hpp"
#include "muslin/contact/surface_map.hpp"
#include "muslin/core/keyed_number.hpp"
#include "muslin/core/vectors.hpp"

namespace muslin {

struct ContactModel {
  std::shared_ptr<const ContactSurface> surface;
  std::shared_ptr<const SurfaceMap> map;  ///< the surface's points from all vertices of the model
  std::vector<Vec3> rest;                 ///< #P by 3, points of the surface at rest [m]
  double distance = 2e-3;  ///< d̂ of bodies without their own, the gap below which contact acts [m]
  KeyedNumber friction = 0;               ///< default of Coulomb's μ
  StepLimits limits;                      ///< gap floor; prescribed vertices, rigid groups
  ContactExemptions exempt;
  // For messages; may be empty.
  std::vector<std::string> names;  ///< of the surface's bodies
  std::vector<int> faces;          ///< #T, of the user's mesh, from 0; −1 of balls and capsules

  /// True if two triangles of the surface must not cross under the rules in force.
  bool forbids_crossing(int first, int second, ContactRules::Set rules) const {
    const Vec3i &a = surface->triangles()[static_cast<std::size_t>(first)],
                &b = surface->triangles()[static_cast<std::size_t>(second)];
    return surface->may_touch(surface->body_of(a[0]), surface->body_of(b[0])) &&
           !exempt.has(a, first, b, second) && !surface->rules().parts({a.data(), 3}, {b.data(), 3}, rules);
  }
};

}  // namespace muslin
