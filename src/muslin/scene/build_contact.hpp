// Builds Model::contact, the contact of a scene.
#pragma once

#include "muslin/scene/model.hpp"

namespace muslin {

/// Contact is on in scenes with a collider, with [contact], or of more than one component; components without
/// a contact_part are left out. Null if none of the others can touch.
///
/// Surfaces are those of the components (component/contact_part.hpp), as maps of the vertices. Which surface
/// a kind has, its thickness and its stiffness are told by the header of the kind; colliders take the
/// stiffness of the other.
///
/// d̂, unless given: 1/500 of the longest side of the largest body, but no more than a fifth of the mean edge
/// of any body's surface.
///
/// Needs all components; adds to model.warnings, also if bodies start so close that contact pushes them
/// apart. Errors: input, if the integrator is explicit.
void build_contact(Model& model);

}  // namespace muslin
