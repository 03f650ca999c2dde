#include "muslin/field/signed_distance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "muslin/core/error.hpp"
#include "muslin/geometry/closest_point.hpp"
#include "muslin/geometry/orientation.hpp"
#include "muslin/geometry/winding_number.hpp"

namespace muslin {

struct SignedDistance::Impl {
  Impl(ConstVectors positions, OrientedTriangles oriented)
      : closest(positions, oriented.triangles),
        winding(positions, oriented.triangles),
        watertight(oriented.watertight) {}

  ClosestPointQuery closest;
  WindingNumber winding;
  bool watertight;
  Box bounds;
};

SignedDistance::SignedDistance(const Mesh& mesh) {
  const Triangulation triangulation = triangulate(mesh);
  impl_ = std::make_unique<Impl>(mesh.positions, orient(mesh.positions, triangulation.triangles));
  for (const Vec3i& triangle : triangulation.triangles)
    for (int k = 0; k < 3; ++k) impl_->bounds.extend(mesh.positions[static_cast<std::size_t>(triangle[k])]);
  if (triangulation.triangles.empty())
    throw Error(ErrorKind::input, "the distance to a mesh without faces is undefined", "give it faces");
}

SignedDistance::~SignedDistance() = default;
SignedDistance::SignedDistance(SignedDistance&&) noexcept = default;
SignedDistance& SignedDistance::operator=(SignedDistance&&) noexcept = default;

double SignedDistance::distance(const Vec3& point) const { return impl_->closest(point).distance; }

bool SignedDistance::inside(const Vec3& point) const { return impl_->winding(point) > 0.5; }

double SignedDistance::operator()(const Vec3& point) const {
  const double magnitude = distance(point);
  return magnitude > 0 && inside(point) ? -magnitude : magnitude;
}

const Box& SignedDistance::bounds() const { return impl_->bounds; }

bool SignedDistance::watertight() const { return impl_->watertight; }

SurfacePoint SignedDistance::nearest(const Vec3& point, double max_distance, int hint) const {
  const ClosestPoint closest = impl_->closest(point, max_distance, hint);
  return {closest.distance, closest.triangle};
}

}  // namespace muslin
