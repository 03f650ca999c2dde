// Meshes that the tests of several folders use.
#pragma once

#include <array>
#include <cmath>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include "muslin/geometry/mesh.hpp"

namespace muslin::shapes {

inline Mesh from(std::vector<Vec3> positions, const std::vector<std::vector<int>>& faces) {
  Mesh mesh;
  mesh.positions = std::move(positions);
  for (const std::vector<int>& face : faces) mesh.add_face(face);
  return mesh;
}

/// Six outward quads.
inline Mesh box(const Vec3& low, const Vec3& high) {
  std::vector<Vec3> positions;
  for (int c = 0; c < 8; ++c)
    positions.emplace_back((c & 1) ? high.x() : low.x(), (c & 2) ? high.y() : low.y(),
                           (c & 4) ? high.z() : low.z());
  return from(std::move(positions),
              {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}});
}

/// A grid of nx × ny quads in the plane z = 0, normals along +z.
inline Mesh rectangle(double width, double height, int nx = 1, int ny = 1) {
  Mesh mesh;
  for (int j = 0; j <= ny; ++j)
    for (int i = 0; i <= nx; ++i) mesh.positions.emplace_back(width * i / nx, height * j / ny, 0);
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      const int v = j * (nx + 1) + i;
      mesh.add_face(std::array{v, v + 1, v + nx + 2, v + nx + 1});
    }
  return mesh;
}

/// An octahedron split `levels` times and pushed onto the sphere: 8·4^levels triangles, outward.
inline Mesh sphere(double radius, int levels, const Vec3& centre = Vec3::Zero()) {
  std::vector<Vec3> points{Vec3::UnitX(),  -Vec3::UnitX(), Vec3::UnitY(),
                           -Vec3::UnitY(), Vec3::UnitZ(),  -Vec3::UnitZ()};
  std::vector<std::array<int, 3>> faces{{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                                        {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
      const auto [entry, added] = middles.try_emplace(std::minmax(a, b), static_cast<int>(points.size()));
      if (added)
        points.push_back(
            (points[static_cast<std::size_t>(a)] + points[static_cast<std::size_t>(b)]).normalized());
      return entry->second;
    };
    std::vector<std::array<int, 3>> finer;
    for (const auto& [a, b, c] : faces) {
      const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    faces = std::move(finer);
  }
  Mesh mesh;
  for (const Vec3& p : points) mesh.positions.push_back(centre + radius * p);
  for (const auto& face : faces) mesh.add_face(face);
  return mesh;
}

/// Both meshes as one.
inline Mesh joined(Mesh first, const Mesh& second) {
  const int shift = static_cast<int>(first.positions.size());
  first.positions.insert(first.positions.end(), second.positions.begin(), second.positions.end());
  for (std::size_t f = 0; f < second.face_count(); ++f) {
    std::vector<int> face(second.face(f).begin(), second.face(f).end());
    for (int& v : face) v += shift;
    first.add_face(face);
  }
  return first;
}

/// Faces f with keep(f), turned round where turn(f).
template <class Keep, class Turn>
Mesh selected(const Mesh& mesh, const Keep& keep, const Turn& turn) {
  Mesh result;
  result.positions = mesh.positions;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    if (!keep(f)) continue;
    std::vector<int> face(mesh.face(f).begin(), mesh.face(f).end());
    if (turn(f)) face = std::vector<int>(face.rbegin(), face.rend());
    result.add_face(face);
  }
  return result;
}

/// `count` points evenly spread over a box grown by `share` of its size.
inline std::vector<Vec3> points_around(const Box& box, int count, double share, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-share, 1 + share);
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) {
    const double x = unit(random), y = unit(random), z = unit(random);
    points.push_back(box.min() + box.sizes().cwiseProduct(Vec3(x, y, z)));
  }
  return points;
}

/// Signed volume of a closed mesh.
inline double volume(const Mesh& mesh) {
  const Triangulation triangulation = triangulate(mesh);
  double sum = 0;
  for (const Vec3i& t : triangulation.triangles)
    sum += mesh.positions[static_cast<std::size_t>(t.x())].dot(
        mesh.positions[static_cast<std::size_t>(t.y())].cross(
            mesh.positions[static_cast<std::size_t>(t.z())]));
  return sum / 6;
}

}  // namespace muslin::shapes
