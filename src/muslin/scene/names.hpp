// Lists the words of the scene file for each enumeration, in the enumeration's order.
#pragma once

#include <string>
#include <vector>

namespace muslin {

const std::vector<std::string>& integrator_names();       ///< Integrator
const std::vector<std::string>& effort_names();           ///< Effort
const std::vector<std::string>& body_model_names();       ///< BodyModel
const std::vector<std::string>& collider_shape_names();   ///< ColliderSettings::Shape
const std::vector<std::string>& voxel_rule_names();       ///< VoxelRule
const std::vector<std::string>& bracing_names();          ///< Bracing
const std::vector<std::string>& mass_names();             ///< BodySettings::Mass
const std::vector<std::string>& boundary_spring_names();  ///< BodySettings::BoundarySprings
const std::vector<std::string>& force_type_names();       ///< ForceSettings::Type
/// Returns the name of the key that holds the value of each ForceSettings::Type: acceleration, force,
/// velocity.
const std::vector<std::string>& force_value_names();

template <class Enumeration>
const std::string& name_of(const std::vector<std::string>& names, Enumeration value) {
  return names[static_cast<std::size_t>(value)];
}

}  // namespace muslin
