// From `where` to the vertices of a body.
#pragma once

#include <string>
#include <vector>

#include "muslin/scene/model.hpp"

namespace muslin {

/// The vertices of the body (indices local to it, ascending; of a rigid body those of its mesh) that satisfy
/// every criterion. Box, sphere, plane and line are tested with a tolerance of 1e-6 voxel widths or mean
/// edges. `nearest` takes the vertices nearest to each point among those that satisfy the other criteria.
/// `what` names the owner in messages. Errors: input, if no vertex is left, saying what lies nearest; or if
/// the group does not exist.
std::vector<int> select_vertices(const Body& body, const Selection& where, const std::string& what);

}  // namespace muslin
