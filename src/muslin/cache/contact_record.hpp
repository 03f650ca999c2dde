// ContactRecord is what run.json keeps of the contact of a run, so that its surfaces can be examined from the
// caches alone.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "muslin/contact/contact_model.hpp"
#include "muslin/core/vectors.hpp"

namespace muslin {

struct ContactRecord {
  struct Body {
    std::string name;
    std::size_t points = 0;    ///< of its surface: as many as its skin has, unless it is round or a plane
    double radius = 0;         ///< half the (greatest) thickness, or the radius of a ball or capsule [m]
    std::vector<double> radii;  ///< of its points [m]; empty: all have that radius
    bool self_contact = true;  ///< true if it touches itself
    bool fixed = false;        ///< a collider that forces do not move
    std::optional<double> range;  ///< its own d̂ [m]
    std::vector<Vec3> axis;    ///< centre of a ball, ends of a capsule's axis, at the start [m]; else empty
  };
  double distance = 0;       ///< the contact distance d̂ of bodies without their own [m]
  std::vector<Body> bodies;  ///< all that have a surface, in the order of the run's bodies
  ContactExemptions exempt;  ///< at joints; triangles and points are counted over all bodies
  std::vector<ContactRule> rules;  ///< without friction and stiffness; points are counted over all bodies
};

/// Returns the object `contact` of run.json.
nlohmann::ordered_json contact_record_json(const ContactModel& contact);

/// Reads it. Errors: input without a place, if it is damaged.
ContactRecord read_contact_record(const nlohmann::ordered_json& contact);

}  // namespace muslin
