// Flat sheets of squares for the tests of shells.
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "support/potential_battery.hpp"

#include "muslin/geometry/mesh.hpp"

namespace muslin::test {

/// nx by nz squares in the plane y = 0 from the origin to (x, 0, z); vertex (i, k) is i + k (nx + 1). With
/// `jitter`, inner vertices are moved by up to that share of a square.
inline Mesh flat_sheet(int nx, int nz, double x, double z, double jitter = 0) {
  Mesh mesh;
  const std::vector<Vec3> noise = random_vectors(static_cast<std::size_t>((nx + 1) * (nz + 1)), jitter, 77);
  for (int k = 0; k <= nz; ++k) {
    for (int i = 0; i <= nx; ++i) {
      Vec3 p(i * x / nx, 0, k * z / nz);
      if (i > 0 && i < nx && k > 0 && k < nz) {
        const Vec3& n = noise[mesh.positions.size()];
        p += Vec3(n.x() * x / nx, 0, n.z() * z / nz);
      }
      mesh.positions.push_back(p);
    }
  }
  for (int k = 0; k < nz; ++k) {
    for (int i = 0; i < nx; ++i) {
      const int v = i + k * (nx + 1);
      mesh.add_face(std::array{v, v + nx + 1, v + nx + 2, v + 1});
    }
  }
  return mesh;
}

/// Texture coordinates (x, z)·`turn` on every vertex.
inline void add_flat_uvs(Mesh& mesh, double angle = 0) {
  for (const Vec3& p : mesh.positions) {
    mesh.uvs.emplace_back(std::cos(angle) * p.x() + std::sin(angle) * p.z(),
                          -std::sin(angle) * p.x() + std::cos(angle) * p.z());
  }
  mesh.corner_uvs = mesh.face_vertices;
}

/// The sheet in the plane y = 0 rolled up along the direction (cos, 0, sin) of `angle` to curvature κ [1/m].
inline std::vector<Vec3> rolled(ConstVectors flat, double curvature, double angle = 0) {
  const Vec3 along(std::cos(angle), 0, std::sin(angle)), across(-std::sin(angle), 0, std::cos(angle));
  std::vector<Vec3> x;
  for (const Vec3& p : flat) {
    const double s = p.dot(along) * curvature;
    x.push_back(p.dot(across) * across +
                (std::sin(s) * along + (1 - std::cos(s)) * Vec3::UnitY()) / curvature);
  }
  return x;
}

}  // namespace muslin::test
