// From the settings of a body to its mesh and all that is built on it: solid, lattice, springs, surfaces;
// shell.
#pragma once

#include <string>
#include <vector>

#include "muslin/core/progress.hpp"
#include "muslin/scene/model.hpp"

namespace muslin {

/// Everything of Body but its place among the vertices of the model and its statistics of mass and time.
/// Appends to `warnings`. Errors: input and file, with the place in the scene and the mesh file.
Body build_body(const Scene& scene, const BodySettings& settings, std::vector<std::string>& warnings,
                const Progress& progress);

/// Points that are the vertices: J = 1. Prepared for the transpose.
Embedding identity_embedding(std::size_t count);

/// How full each voxel counts: its fill, or 1 if the body weighs by cells.
std::vector<double> voxel_shares(const Body& body, const BodySettings& settings);

/// #V of the body [kg]: each voxel gives an eighth of density·share·width³ to each of its corners; each
/// triangle of a shell a third of areal density·area.
std::vector<double> vertex_masses(const Body& body, const BodySettings& settings);

/// #springs: what each spring's constant is multiplied by; empty if that is 1 for all.
std::vector<float> spring_weights(const Body& body, const BodySettings& settings);

}  // namespace muslin
