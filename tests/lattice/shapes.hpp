// Closed meshes for the tests of the lattice and the contour.
#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "muslin/geometry/mesh.hpp"

namespace muslin::shapes {

inline void add_box(Mesh& mesh, const Vec3& low, const Vec3& high) {
  const int first = static_cast<int>(mesh.vertex_count());
  for (int c = 0; c < 8; ++c) {
    mesh.positions.push_back(
        {c & 1 ? high.x() : low.x(), c & 2 ? high.y() : low.y(), c & 4 ? high.z() : low.z()});
  }
  const std::array<std::array<int, 4>, 6> faces = {
      {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
  for (std::array<int, 4> face : faces) {
    for (int& v : face) v += first;
    mesh.add_face(face);
  }
}

inline Mesh box(const Vec3& low, const Vec3& high) {
  Mesh mesh;
  add_box(mesh, low, high);
  return mesh;
}

/// A polyhedron with 2·rings·rings faces whose vertices lie on r(direction)·direction.
template <class Radius>
Mesh star(int rings, const Radius& radius) {
  Mesh mesh;
  const int around = 2 * rings;
  const auto add = [&](double theta, double phi) {
    const Vec3 d(std::sin(theta) * std::cos(phi), std::cos(theta), -std::sin(theta) * std::sin(phi));
    mesh.positions.push_back(radius(d) * d);
  };
  add(0, 0);
  for (int r = 1; r < rings; ++r)
    for (int a = 0; a < around; ++a) add(std::numbers::pi * r / rings, 2 * std::numbers::pi * a / around);
  add(std::numbers::pi, 0);
  const int last = static_cast<int>(mesh.vertex_count()) - 1;
  const auto at = [&](int r, int a) { return 1 + (r - 1) * around + a % around; };
  for (int a = 0; a < around; ++a) {
    mesh.add_face(std::array{0, at(1, a), at(1, a + 1)});
    for (int r = 1; r + 1 < rings; ++r) {
      mesh.add_face(std::array{at(r, a), at(r + 1, a), at(r + 1, a + 1)});
      mesh.add_face(std::array{at(r, a), at(r + 1, a + 1), at(r, a + 1)});
    }
    mesh.add_face(std::array{last, at(rings - 1, a + 1), at(rings - 1, a)});
  }
  return mesh;
}

inline Mesh sphere(int rings, double radius = 1) {
  return star(rings, [&](const Vec3&) { return radius; });
}

inline double volume(const Mesh& mesh) {
  double sum = 0;
  for (const Vec3i& t : triangulate(mesh).triangles)
    sum += mesh.positions[t[0]].dot(mesh.positions[t[1]].cross(mesh.positions[t[2]])) / 6;
  return sum;
}

inline Mesh moved(Mesh mesh, const Mat3& rotation, const Vec3& translation) {
  for (Vec3& p : mesh.positions) p = rotation * p + translation;
  return mesh;
}

inline Mat3 some_rotation() {
  return (Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()) * Eigen::AngleAxisd(0.4, Vec3::UnitZ()))
      .toRotationMatrix();
}

/// A prism over a counterclockwise outline in the plane z = 0, from z = −thickness/2 to thickness/2.
inline Mesh prism(const std::vector<Vec2>& outline, double thickness) {
  Mesh mesh;
  const int n = static_cast<int>(outline.size());
  for (double z : {-0.5 * thickness, 0.5 * thickness})
    for (const Vec2& p : outline) mesh.positions.push_back({p.x(), p.y(), z});
  std::vector<int> top, bottom;
  for (int v = 0; v < n; ++v) {
    top.push_back(n + v);
    bottom.push_back(n - 1 - v);
    mesh.add_face(std::array{v, (v + 1) % n, n + (v + 1) % n, n + v});
  }
  mesh.add_face(top);
  mesh.add_face(bottom);
  return mesh;
}

}  // namespace muslin::shapes
