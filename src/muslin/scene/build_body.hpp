// Builds a body from its settings: mesh, solid, lattice, springs, surfaces; shell.
#pragma once

#include <string>
#include <vector>

#include "muslin/core/progress.hpp"
#include "muslin/scene/model.hpp"

namespace muslin {

/// Builds all of Body except its vertex range in the model and its statistics of mass and time. Appends to
/// `warnings`. Errors: input and file, with the place in the scene and the mesh file.
Body build_body(const Scene& scene, const BodySettings& settings, std::vector<std::string>& warnings,
                const Progress& progress);

/// Returns the embedding whose points are the vertices: J = 1. Prepared for the transpose.
Embedding identity_embedding(std::size_t count);

/// Returns the share by which each voxel counts: its fill, or 1 with Mass::cells.
std::vector<double> voxel_shares(const Body& body, const BodySettings& settings);

/// Returns #V of the body [kg]: each voxel gives an eighth of density·share·width³ to each of its corners;
/// each triangle of a shell a third of areal density·area.
std::vector<double> vertex_masses(const Body& body, const BodySettings& settings);

/// Returns #springs factors of the spring constants; empty if all are 1.
std::vector<float> spring_weights(const Body& body, const BodySettings& settings);

}  // namespace muslin
