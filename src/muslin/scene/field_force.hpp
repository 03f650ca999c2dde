// Fields as kinds of [[force]]: vectors over space and time that move the air or accelerate bodies, and drag.
// docs/theory/fields.md.
#pragma once

#include <string>
#include <vector>

#include "muslin/force/field.hpp"
#include "muslin/scene/force_kind.hpp"

namespace muslin {

const std::vector<ForceKind>& field_kinds();

/// Returns the fields that add to the air of this wind, one of scene.forces, on the body. Errors: input, if
/// it is not clear to which wind a field adds.
std::vector<Field> fields_in_air(const Scene& scene, const ForceSettings& wind, const std::string& body);

}  // namespace muslin
