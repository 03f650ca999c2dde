#include "muslin/simulation/fingerprint.hpp"

#include "muslin/core/hash.hpp"

namespace muslin {

std::uint64_t model_fingerprint(const Model& model) {
  std::uint64_t hash = hash_bytes(model.masses.data(), model.masses.size() * sizeof(double));
  hash = hash_bytes(model.rest_positions.data(), model.rest_positions.size() * sizeof(Vec3), hash);
  for (const Component& body : model.bodies) hash = body.shape_hash(hash);
  for (const Component& body : model.bodies) hash = body.material_hash(hash);
  return hash;
}

}  // namespace muslin
