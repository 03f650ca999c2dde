// Builds Model::contact, the contact of a scene.
#pragma once

#include "muslin/scene/model.hpp"

namespace muslin {

/// Contact is on in scenes with a collider, with [contact], or of more than one body; bodies and colliders
/// with `contact = false` are left out. Null if none of the others can touch.
///
/// Surfaces, as maps of the vertices: a shell is its triangles, thickened by half its thickness; a lattice is
/// its mesh, thickened as well if that is a sheet; a sphere a point, a capsule a segment, both thickened by
/// their radius; a plane a half-space; a box or mesh its triangles.
///
/// d̂, unless given: 1/500 of the longest side of the largest body, but no more than a fifth of the mean edge
/// of any body's surface. Thickness of a shell, unless given: 0.5 mm, but no more than a tenth of its mean
/// edge.
///
/// Stiffness of a contact: of a shell 0.15 × its mean membrane modulus [N/m]; of a lattice 0.15 × Young's
/// modulus along its voxels × voxel width (or thickness, of a thinner sheet whose voxels count by their
/// share); of a rigid body mass/step², which limits its penetration to its free fall in one step; colliders
/// take that of the other.
///
/// Needs all bodies; adds to model.warnings, also if bodies start so close that contact pushes them apart.
/// Errors: input, if the integrator is explicit.
void build_contact(Model& model);

}  // namespace muslin
