#include "muslin/simulation/fingerprint.hpp"

#include <array>
#include <cstring>

namespace muslin {

std::uint64_t hash_bytes(const void* data, std::size_t size, std::uint64_t seed) {
  // FNV-1a over words of eight bytes, with a final mix (Murmur3's) so that every input bit reaches every
  // output bit.
  std::uint64_t hash = 0xcbf29ce484222325ULL ^ seed;
  const auto* bytes = static_cast<const unsigned char*>(data);
  const auto stir = [&hash](std::uint64_t word) {
    hash = (hash ^ word) * 0x100000001b3ULL;
    hash ^= hash >> 29;
  };
  std::size_t i = 0;
  for (; i + 8 <= size; i += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes + i, 8);
    stir(word);
  }
  std::uint64_t tail = size;
  for (; i < size; ++i) tail = (tail << 8) | bytes[i];
  stir(tail);
  hash = (hash ^ (hash >> 33)) * 0xff51afd7ed558ccdULL;
  hash = (hash ^ (hash >> 33)) * 0xc4ceb9fe1a85ec53ULL;
  return hash ^ (hash >> 33);
}

std::uint64_t model_fingerprint(const Model& model) {
  std::uint64_t hash = hash_bytes(model.masses.data(), model.masses.size() * sizeof(double));
  hash = hash_bytes(model.rest_positions.data(), model.rest_positions.size() * sizeof(Vec3), hash);
  for (const Body& body : model.bodies) {
    hash = hash_bytes(body.name.data(), body.name.size(), hash);
    const std::array<std::int64_t, 3> shape = {body.first_vertex, body.vertex_count, body.springs.count};
    hash = hash_bytes(shape.data(), sizeof shape, hash);
    if (!body.is_shell()) continue;
    hash = hash_bytes(body.shell.triangles.data(), body.shell.triangles.size() * sizeof(Vec3i), hash);
    hash = hash_bytes(body.shell.inverses.data(), body.shell.inverses.size() * sizeof(Mat2), hash);
    hash = hash_bytes(body.shell.hinges.data(), body.shell.hinges.size() * sizeof(Hinge), hash);
  }
  for (const BodySettings& body : model.scene.bodies) {
    const Material& m = body.material;
    const std::array<double, 8> numbers = {m.density,
                                           m.edge_modulus,
                                           m.face_diagonal_modulus,
                                           m.body_diagonal_modulus,
                                           m.volume_modulus,
                                           m.mass_damping,
                                           m.stiffness_damping,
                                           static_cast<double>(body.boundary_springs)};
    hash = hash_bytes(numbers.data(), sizeof numbers, hash);
    if (m.young_modulus > 0) {
      const std::array<double, 2> solid = {m.young_modulus, m.poisson};
      hash = hash_bytes(solid.data(), sizeof solid, hash);
    }
    if (body.model == BodyModel::shell) hash = hash_bytes(&*m.shell, sizeof *m.shell, hash);
  }
  return hash;
}

}  // namespace muslin
