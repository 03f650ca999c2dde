// Reads the maps by which numbers of a body vary: attributes and groups of its mesh, and files of numbers.
#pragma once

#include <cstdint>
#include <vector>

#include "muslin/component/component.hpp"
#include "muslin/component/mapped_number.hpp"
#include "muslin/io/mesh_file.hpp"
#include "muslin/schema/table.hpp"

namespace muslin {

/// Returns those of `variations` that are maps, over the vertices of the component's mesh. A name that ends
/// in `.csv` or `.npy` is a file beside the scene, another one an attribute, or else a group, whose vertices
/// have weight 1 and others 0. `keys` declares the numbers. Errors: input and file, with the place in the
/// scene: an unknown name, a wrong count, a value that is not finite or beyond `lowest` and `highest`.
std::vector<MappedNumber> read_maps(const schema::Variations& variations, const schema::Table& keys,
                                    const std::vector<VertexAttribute>& attributes,
                                    const ComponentInputs& inputs, const Component& component);

/// Returns the maps over the vertices of a lattice: each has the weight of the nearest point of the mesh.
std::vector<MappedNumber> over_lattice(const std::vector<MappedNumber>& maps, const Mesh& mesh,
                                       const Lattice& lattice);

/// Continues a hash with the numbers at every vertex of the maps that may not change when a run is resumed.
std::uint64_t maps_hash(const std::vector<MappedNumber>& maps, std::uint64_t seed);

}  // namespace muslin
