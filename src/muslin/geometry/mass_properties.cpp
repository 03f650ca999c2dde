#include "muslin/geometry/mass_properties.hpp"

#include <cmath>
#include <numbers>

namespace muslin {

MassProperties sphere_mass(const Vec3& centre, double radius) {
  const double volume = 4.0 / 3 * std::numbers::pi * std::pow(radius, 3);
  return {volume, centre, volume * radius * radius / 5 * Mat3::Identity()};
}

MassProperties capsule_mass(const Vec3& a, const Vec3& b, double radius) {
  const double length = (b - a).norm(), r2 = radius * radius;
  const Vec3 axis = (b - a) / length;
  const double cylinder = std::numbers::pi * r2 * length, ball = 4.0 / 3 * std::numbers::pi * r2 * radius;
  // Across: a disc has r²/4 per axis, a ball r²/5. Along: the half balls have r²/5 about the middle of their
  // flat side, which is length/2 from the centre, their own centre of mass 3r/8 farther.
  const double across = cylinder * r2 / 4 + ball * r2 / 5;
  const double along =
      cylinder * length * length / 12 + ball * (r2 / 5 + length * length / 4 + 3 * radius * length / 8);
  const Mat3 axial = axis * axis.transpose();
  return {cylinder + ball, (a + b) / 2, across * (Mat3::Identity() - axial) + along * axial};
}

MassProperties box_mass(const Vec3& centre, const Vec3& size) {
  const double volume = size.prod();
  return {volume, centre, Mat3((volume / 12 * size.cwiseProduct(size)).asDiagonal())};
}

MassProperties polyhedron_mass(ConstVectors positions, std::span<const Vec3i> triangles) {
  if (triangles.empty()) return {};
  // Signed tetrahedra between the triangles and a point near them, so that little cancels. Over one with
  // corners 0, a, b, c: ∫ x = V (a + b + c)/4, ∫ x xᵀ = V/20 (Σ p pᵀ + s sᵀ), s = a + b + c.
  Vec3 origin = Vec3::Zero();
  for (const Vec3i& t : triangles)
    for (int i = 0; i < 3; ++i) origin += positions[static_cast<std::size_t>(t[i])];
  origin /= 3 * static_cast<double>(triangles.size());
  double volume = 0;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();
  for (const Vec3i& t : triangles) {
    const Vec3 a = positions[static_cast<std::size_t>(t[0])] - origin,
               b = positions[static_cast<std::size_t>(t[1])] - origin,
               c = positions[static_cast<std::size_t>(t[2])] - origin;
    const double v = a.dot(b.cross(c)) / 6;
    const Vec3 s = a + b + c;
    volume += v;
    first += v / 4 * s;
    second += v / 20 * (a * a.transpose() + b * b.transpose() + c * c.transpose() + s * s.transpose());
  }
  const Vec3 offset = first / volume;
  return {volume, origin + offset, second - volume * offset * offset.transpose()};
}

}  // namespace muslin
