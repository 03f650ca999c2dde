// Finds the points of a component selected by `where`.
#pragma once

#include <string>
#include <vector>

#include "muslin/component/component.hpp"

namespace muslin {

/// Returns the selectable points of the component (ascending; its vertices, or those of its mesh) that
/// satisfy every criterion. Box, sphere, plane and line are tested with a tolerance of 1e-6 voxel widths or
/// mean edges. `nearest` takes the vertices nearest to each point among those that satisfy the other
/// criteria. `what` names the owner in messages. Errors: input, if no vertex is left (the message names the
/// nearest one) or if the group does not exist.
std::vector<int> select_vertices(const Component& body, const Selection& where, const std::string& what);

}  // namespace muslin
