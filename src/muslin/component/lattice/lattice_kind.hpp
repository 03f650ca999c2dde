// The lattice as a kind of [[body]]: its keys, and the words of the scene file for them.
#pragma once

#include <string>
#include <vector>

#include "muslin/component/body_kind.hpp"

namespace muslin {

extern const BodyKind lattice_kind;

const std::vector<std::string>& voxel_rule_names();  ///< in the order of VoxelRule
const std::vector<std::string>& bracing_names();     ///< in the order of Bracing

}  // namespace muslin
