// Reads the mesh of a [[body]] and adds the place in the scene to errors and warnings.
#pragma once

#include <string>
#include <vector>

#include "muslin/component/body_settings.hpp"
#include "muslin/component/component.hpp"
#include "muslin/core/error.hpp"
#include "muslin/io/mesh_file.hpp"

namespace muslin {

/// Returns the error with a place in the scene; its place in `file` becomes part of the message.
Error placed_in(const Place& place, const std::string& file, const Error& error);

/// Calls build(). Errors get the place in the scene and the mesh file, except an interruption.
template <class Build>
auto at_place(const Place& place, const std::string& file, const Build& build) -> decltype(build()) {
  try {
    return build();
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::interrupted) throw;
    throw placed_in(place, file, error);
  }
}

/// Appends a sentence about a body to the warnings.
void warn_of_body(const ComponentInputs& inputs, const std::string& body, const std::string& sentence);

/// Cloth has no vertices without polygons, and edges of any number of polygons.
enum class MeshUse { solid, cloth };

/// Fills in name, mesh, source, attributes and report of a component, the mesh placed in the world and
/// welded. Errors: input and file, with the place in the scene and the mesh file.
void read_body_mesh(const BodySettings& settings, const ComponentInputs& inputs, MeshUse use,
                    Component& component);

/// Continues a hash with what a saved state must fit of a material, its density and law, and with a number of
/// the kind's own, or 0. Stiffness and damping may change on a resume.
std::uint64_t material_hash(const Material& material, double own, std::uint64_t seed);

}  // namespace muslin
