// Builds the rules of contact from [[contact.pair]] and from `ignore` of pins.
#pragma once

#include <span>
#include <string>

#include "muslin/contact/contact_rules.hpp"
#include "muslin/contact/surface_map.hpp"
#include "muslin/scene/model.hpp"

namespace muslin {

/// The points of a contact surface: `names` of its bodies, the body of each point, and their map.
struct ContactPoints {
  std::span<const std::string> names;
  std::span<const int> body_of_point;
  const SurfaceMap& map;
};

/// Returns a rule for each pair, then one for each pin and body that it ignores: points all of whose weight
/// is on vertices of the pin are free of the body while the pin holds. Adds to model.warnings. Errors: input,
/// for a group that does not exist, or for more than ContactRules::most rules.
ContactRules build_contact_rules(Model& model, const ContactPoints& points);

}  // namespace muslin
