#include "muslin/geometry/shapes.hpp"

#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

namespace muslin {
namespace {

/// The icosahedron's corners are the cyclic permutations of (0, ±1, ±φ).
std::vector<Vec3> icosahedron_corners() {
  const double phi = std::numbers::phi;
  return {{-1, phi, 0},  {1, phi, 0},  {-1, -phi, 0}, {1, -phi, 0}, {0, -1, phi},  {0, 1, phi},
          {0, -1, -phi}, {0, 1, -phi}, {phi, 0, -1},  {phi, 0, 1},  {-phi, 0, -1}, {-phi, 0, 1}};
}

constexpr std::array<std::array<int, 3>, 20> icosahedron_faces = {
    {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
     {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
     {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};

constexpr int sphere_subdivisions = 3;
constexpr int capsule_sides = 32, capsule_rings = 8;  // rings of each half sphere

}  // namespace

Mesh sphere_mesh(const Vec3& centre, double radius) {
  std::vector<Vec3> points = icosahedron_corners();
  std::vector<std::array<int, 3>> faces(icosahedron_faces.begin(), icosahedron_faces.end());
  for (int level = 0; level < sphere_subdivisions; ++level) {
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
      const auto [at, is_new] = middles.try_emplace(std::minmax(a, b), static_cast<int>(points.size()));
      if (is_new)
        points.push_back((points[static_cast<std::size_t>(a)].normalized() +
                          points[static_cast<std::size_t>(b)].normalized()) /
                         2);
      return at->second;
    };
    std::vector<std::array<int, 3>> finer;
    for (const auto& [a, b, c] : faces) {
      const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    faces = std::move(finer);
  }
  Mesh mesh;
  for (const Vec3& p : points) mesh.positions.push_back(centre + radius * p.normalized());
  for (const auto& face : faces) mesh.add_face(face);
  return mesh;
}

Mesh capsule_mesh(const Vec3& a, const Vec3& b, double radius) {
  const Vec3 axis = (b - a).normalized(), u = axis.unitOrthogonal(), v = axis.cross(u);
  Mesh mesh;
  // Rings from the end at a to that at b; the two poles come last.
  const auto add_ring = [&](const Vec3& end, double latitude) {
    for (int s = 0; s < capsule_sides; ++s) {
      const double angle = 2 * std::numbers::pi * s / capsule_sides;
      mesh.positions.push_back(end +
                               radius * (std::sin(latitude) * axis +
                                         std::cos(latitude) * (std::cos(angle) * u + std::sin(angle) * v)));
    }
  };
  const auto latitude = [](int ring) { return std::numbers::pi / 2 * ring / capsule_rings; };
  for (int ring = 1 - capsule_rings; ring <= 0; ++ring) add_ring(a, latitude(ring));
  for (int ring = 0; ring < capsule_rings; ++ring) add_ring(b, latitude(ring));
  const int rings = 2 * capsule_rings, pole_a = rings * capsule_sides, pole_b = pole_a + 1;
  mesh.positions.push_back(a - radius * axis);
  mesh.positions.push_back(b + radius * axis);
  for (int s = 0; s < capsule_sides; ++s) {
    const int next = (s + 1) % capsule_sides;
    mesh.add_face(std::array{pole_a, next, s});
    for (int ring = 0; ring + 1 < rings; ++ring) {
      const int below = ring * capsule_sides, above = below + capsule_sides;
      mesh.add_face(std::array{below + s, below + next, above + next, above + s});
    }
    const int last = (rings - 1) * capsule_sides;
    mesh.add_face(std::array{last + s, last + next, pole_b});
  }
  return mesh;
}

Mesh box_mesh(const Vec3& centre, const Vec3& size) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.positions.push_back(centre + Vec3(size.x() * ((i & 1) - 0.5), size.y() * ((i >> 1 & 1) - 0.5),
                                           size.z() * ((i >> 2 & 1) - 0.5)));
  for (const std::array<int, 4>& face :
       {std::array{0, 4, 6, 2}, std::array{1, 3, 7, 5}, std::array{0, 1, 5, 4}, std::array{2, 6, 7, 3},
        std::array{0, 2, 3, 1}, std::array{4, 5, 7, 6}})
    mesh.add_face(face);
  return mesh;
}

Mesh plane_mesh(const Vec3& centre, const Vec3& normal, double side) {
  // The axis farthest from the normal, made orthogonal to it; a coordinate axis if the normal is one.
  int axis;
  normal.cwiseAbs().minCoeff(&axis);
  const Vec3 n = normal.normalized();
  const Vec3 u = (Vec3::Unit(axis) - n[axis] * n).normalized() * (side / 2), v = n.cross(u);
  Mesh mesh;
  mesh.positions = {centre - u - v, centre + u - v, centre + u + v, centre - u + v};
  mesh.add_face(std::array{0, 1, 2, 3});
  return mesh;
}

}  // namespace muslin
