#include "muslin/component/collider/affine_collider.hpp"

#include <array>
#include <limits>

#include "muslin/schema/over_time.hpp"

namespace muslin {
namespace {

using Shape = ColliderSettings::Shape;

/// The longest step in single precision [s]; the stiffness is that of rigid/rigid_body.cpp.
constexpr double longest_rigid = 1.0 / 16;

}  // namespace

double AffineCollider::longest_step() const { return longest_rigid; }

AttachedPoint AffineCollider::attach(const Vec3& at) const { return {embed(frame, std::span(&at, 1)), ""}; }

std::optional<ContactPart> AffineCollider::contact_part() const {
  if (!settings.contact) return std::nullopt;
  ContactPart part;
  part.body.fixed = is_prescribed();
  part.body.self_contact = false;
  part.body.solid = true;
  part.body.friction = schema::over_time(settings.variations, "friction", settings.friction);
  part.body.layer = settings.layer;
  part.body.stiffness = std::numeric_limits<double>::infinity();
  if (!is_prescribed()) {
    part.body.mass = masses().front();
    part.edge = mean_edge;
    part.size = mesh.bounds().sizes().maxCoeff();
  }
  // The motion from the given shape to that at time 0.
  const Eigen::Isometry3d start = motion() ? motion()->motion.at(0) : Eigen::Isometry3d::Identity();
  const auto add_point = [&](const Vec3& at) {
    const std::array<double, 4> weights = frame.weights(at);
    std::array<SurfaceMap::Entry, 4> row;
    for (int i = 0; i < 4; ++i) row[static_cast<std::size_t>(i)] = {i, weights[static_cast<std::size_t>(i)]};
    return part.add_point(row, at);
  };
  switch (settings.shape) {
    case Shape::plane: {
      const Vec3 normal = start.linear() * settings.normal;
      ContactPlane plane = {add_point(frame.centre), normal};
      if (settings.motion.turns()) {
        // Within the corners that carry them.
        const double reach = frame.radii.x() / 2;
        const Vec3 u = normal.unitOrthogonal(), v = normal.cross(u);
        plane.span = {add_point(frame.centre + reach * u), add_point(frame.centre + reach * v)};
      }
      part.planes.push_back(plane);
      break;
    }
    case Shape::sphere:
      part.add_triangle(Vec3i::Constant(add_point(frame.centre)), -1);
      part.body.radius = settings.radius;
      part.body.frame = {0, 1, 2, 3};  // from which friction gets the rotation
      break;
    case Shape::capsule: {
      const int a = add_point(start * settings.points[0]), b = add_point(start * settings.points[1]);
      part.add_triangle({a, b, b}, -1);
      part.body.radius = settings.radius;
      part.body.frame = {0, 1, 2, 3};
      break;
    }
    case Shape::box:
    case Shape::mesh:
      part.add_mesh(mesh, triangulate(mesh), skin);
      break;
  }
  return part;
}

void AffineCollider::finish_affine() {
  skin = embed(frame, mesh.positions);
  vertex_count = 4;
  finish();
}

Embedding embed(const AffineFrame& frame, ConstVectors points) {
  Embedding embedding;
  for (const Vec3& point : points) {
    const std::array<double, 4> weights = frame.weights(point);
    embedding.vertices.push_back({0, 1, 2, 3, 0, 0, 0, 0});
    embedding.weights.push_back({weights[0], weights[1], weights[2], weights[3], 0, 0, 0, 0});
  }
  embedding.prepare_transpose(4);
  return embedding;
}

}  // namespace muslin
