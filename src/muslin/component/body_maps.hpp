// Reads the maps by which numbers of a body vary: attributes and groups of its mesh, files of numbers, and
// images over its texture coordinates.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "muslin/component/component.hpp"
#include "muslin/component/mapped_number.hpp"
#include "muslin/schema/table.hpp"

namespace muslin {

/// Returns those of `variations` that are maps, over the vertices of the component's mesh. A name that ends
/// in `.csv` or `.npy` is a file of numbers beside the scene, in `.png` an image, of which a vertex has the
/// mean grey at its texture coordinates; another one is an attribute, or else a group, whose vertices have
/// weight 1 and others 0. `keys` declares the numbers. Errors: input and file, with the place in the scene:
/// an unknown name, a wrong count, texture coordinates that are missing or outside of the image, a value that
/// is not finite or beyond `lowest` and `highest`.
std::vector<MappedNumber> read_maps(const schema::Variations& variations, const schema::Table& keys,
                                    const SceneFiles& files, const Component& component);

/// Returns the maps over points: each has the weight of the nearest point of the mesh.
std::vector<MappedNumber> over_points(const std::vector<MappedNumber>& maps, const Mesh& mesh,
                                      const std::vector<Vec3>& points);

/// Returns the number of a key at selected points of the component, of which it is `otherwise` without a map.
/// `selected`: indices of points that `where` selects among. Errors: as read_maps.
std::vector<double> numbers_at(const schema::Variations& variations, const schema::Table& keys,
                               std::string_view key, const SceneFiles& files, const Component& component,
                               const std::vector<int>& selected, double otherwise);

/// Continues a hash with the numbers at every vertex of the maps that may not change when a run is resumed.
std::uint64_t maps_hash(const std::vector<MappedNumber>& maps, std::uint64_t seed);

}  // namespace muslin
