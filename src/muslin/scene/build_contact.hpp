// Builds Model::contact, the data of contact.
#pragma once

#include "muslin/scene/model.hpp"

namespace muslin {

/// A collider whose middle moves faster than this relative to the middle of every body passes through what is
/// in its way: it would tear what it pushes [m/s]. One metre in a frame at 25 frames per second.
constexpr double jump_speed = 25;

/// Contact is on in scenes with a collider, with [contact], or with more than one component; components
/// without a contact_part are left out. model.contact is null if none of the others can touch.
///
/// Surfaces are those of the components (component/contact_part.hpp), as maps of the vertices. The header of
/// each kind states its surface, thickness and stiffness; contact with a collider has the stiffness of the
/// other body.
///
/// The default of d̂ is that of each body: 1/500 of its longest side, but at most a fifth of the mean edge of
/// its surface (ContactSurface::range says which holds for a pair).
///
/// Needs all components. Adds to model.warnings, for example if bodies start so close that contact pushes
/// them apart. Errors: input, if the integrator is explicit.
void build_contact(Model& model);

}  // namespace muslin
