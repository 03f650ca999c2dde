#include "muslin/scene/build_collider.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "muslin/geometry/edge_length.hpp"
#include "muslin/geometry/shapes.hpp"
#include "muslin/io/mesh_file.hpp"
#include "muslin/io/point_sequence_file.hpp"
#include "muslin/scene/build_body.hpp"
#include "muslin/scene/placement.hpp"
#include "muslin/scene/solid.hpp"

namespace muslin {
namespace {

using Shape = ColliderSettings::Shape;

/// A plane is shown this many times as wide as the box of the other bodies.
constexpr double plane_reach = 2;
constexpr double smallest_volume = 1e-21;  // [m³]

/// Returns the placement of a box or mesh in the world.
Eigen::Affine3d placed(const ColliderSettings& c) {
  if (c.shape == Shape::mesh) return placement(c.translate, c.rotate, c.scale);
  Eigen::Affine3d turned = placement(c.center, c.rotate, Vec3::Ones());
  turned.translation() = c.center - turned.linear() * c.center;
  return turned;
}

Mesh plane_around(const ColliderSettings& c, const Box& around) {
  const Vec3 middle = around.isEmpty() ? c.center : around.center();
  const double size = around.isEmpty() ? 1 : std::max(around.diagonal().norm(), 1e-3);
  const Vec3 foot = middle - c.normal.dot(middle - c.center) * c.normal;
  return plane_mesh(foot, c.normal, plane_reach * size);
}

Mesh read_collider_mesh(const Scene& scene, const ColliderSettings& c, std::vector<std::string>& warnings) {
  const std::string file = resolve_path(scene, c.mesh).string();
  try {
    MeshFile read = scene_mesh(scene, c.mesh);
    if (!read.note.empty()) warnings.push_back(fmt::format("collider {}: {}", c.name, read.note));
    return std::move(read.mesh);
  } catch (const Error& error) {
    std::string where = file;
    if (error.place().line > 0) where += fmt::format(":{}", error.place().line);
    throw Error(error.kind(), c.mesh_place, where + ": " + error.problem(), error.remedy());
  }
}

Mesh mesh_of(const Scene& scene, const ColliderSettings& c, const Box& around,
             std::vector<std::string>& warnings) {
  switch (c.shape) {
    case Shape::plane:
      return plane_around(c, around);
    case Shape::sphere:
      return sphere_mesh(c.center, c.radius);
    case Shape::capsule:
      return capsule_mesh(c.points[0], c.points[1], c.radius);
    case Shape::box:
      return box_mesh(c.center, c.size);
    case Shape::mesh:
      return read_collider_mesh(scene, c, warnings);
  }
  return {};
}

void require_solid(const ColliderSettings& c, const MeshReport& report, const Mesh& mesh) {
  if (kind_of(mesh, report) == MeshKind::solid && report.flipped_edges == 0) return;
  throw Error(ErrorKind::input, c.mesh_place,
              fmt::format("collider {}: {} does not enclose a solid, so it has no mass", c.name, c.mesh),
              report.flipped_edges > 0 ? "let all its faces look outward"
                                       : "close its holes, or leave `density` out");
}

/// Returns the mass properties for density 1.
MassProperties mass_of(const ColliderSettings& c, const Body& body) {
  switch (c.shape) {
    case Shape::plane:
      break;
    case Shape::sphere:
      return sphere_mass(c.center, c.radius);
    case Shape::capsule:
      return capsule_mass(c.points[0], c.points[1], c.radius);
    case Shape::box: {
      MassProperties mass = box_mass(c.center, c.size);
      const Mat3 turn = placed(c).linear();
      mass.second_moment = turn * mass.second_moment * turn.transpose();
      return mass;
    }
    case Shape::mesh: {
      MassProperties mass = polyhedron_mass(body.mesh.positions, triangulate(body.mesh).triangles);
      if (mass.volume < 0) mass = {-mass.volume, mass.centre, -mass.second_moment};  // faces inward
      return mass;
    }
  }
  return {};
}

/// Builds the body of a mesh that follows a sequence, at time 0.
void follow_sequence(const Scene& scene, const ColliderSettings& c, BuiltCollider& built) {
  const std::string file = resolve_path(scene, c.sequence).string();
  Body& body = built.body;
  const auto fail = [&](ErrorKind kind, const std::string& problem, const std::string& remedy) {
    throw Error(kind, c.sequence_place, file + ": " + problem, remedy);
  };
  PointSequence sequence;
  try {
    sequence = read_point_sequence(file, c.frame_rate.value_or(scene.time.frame_rate));
  } catch (const Error& error) {
    fail(error.kind(), error.problem(), error.remedy());
  }
  if (sequence.points != body.mesh.vertex_count()) {
    fail(ErrorKind::input,
         fmt::format("it moves {} points, {} has {} vertices", sequence.points, c.mesh,
                     body.mesh.vertex_count()),
         "export the sequence from the same mesh");
  }
  if (c.start) {
    const double shift = *c.start - sequence.times.front();
    for (double& time : sequence.times) time += shift;
  }
  body.model = BodyModel::sequence;
  built.motion.sequence = std::make_shared<const PointSequence>(std::move(sequence));
  built.motion.placement = placed(c);
  built.motion.start.resize(body.mesh.vertex_count());
  built.motion.positions(0, built.motion.start);
  body.mesh.positions = built.motion.start;
}

/// Checks the coordinates, before and after the mesh was moved.
void require_usable(const Body& body, const ColliderSettings& settings) {
  try {
    muslin::require_usable(body.mesh, settings.mesh);
  } catch (const Error& error) {
    throw Error(error.kind(), settings.place, fmt::format("collider {}: {}", body.name, error.problem()),
                error.remedy());
  }
}

/// Returns a frame from the bounding box; any four points can carry a body without mass.
AffineFrame box_frame(const Box& bounds) {
  AffineFrame frame;
  frame.centre = bounds.center();
  frame.radii = Vec3::Constant(std::max(bounds.diagonal().norm() / 2, 1e-6));
  return frame;
}

}  // namespace

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

BuiltCollider build_collider(const Scene& scene, const ColliderSettings& settings, const Box& around,
                             std::vector<std::string>& warnings) {
  BuiltCollider built;
  Body& body = built.body;
  body.name = settings.name;
  body.model = BodyModel::rigid;
  body.prescribed = !settings.is_free();
  body.mesh = mesh_of(scene, settings, around, warnings);
  if (settings.shape == Shape::box || settings.shape == Shape::mesh) {
    const Eigen::Affine3d place = placed(settings);
    for (Vec3& x : body.mesh.positions) x = place * x;
  }
  require_usable(body, settings);
  body.report = inspect(body.mesh);
  body.sheet = !body.report.closed;
  if (settings.shape == Shape::mesh) {
    for (const std::string& warning : body.report.warnings)
      warnings.push_back(fmt::format("collider {}: {}", body.name, warning));
  }
  if (settings.is_free()) {
    if (settings.shape == Shape::mesh) require_solid(settings, body.report, body.mesh);
    const MassProperties mass = mass_of(settings, body);
    if (!(mass.volume > smallest_volume)) {
      throw Error(ErrorKind::input, settings.place,
                  fmt::format("collider {}: its volume of {:.3g} m³ is too small to have mass", body.name,
                              mass.volume),
                  "lengths are metres: set `scale`");
    }
    body.frame = equimomental_frame(mass);
    body.statistics.mass = *settings.density * mass.volume;
  } else if (!settings.sequence.empty()) {
    follow_sequence(scene, settings, built);
  } else {
    body.frame = box_frame(body.mesh.bounds());
    built.motion.motion = settings.motion;
    built.motion.motion.pivot =
        settings.pivot.value_or(settings.shape == Shape::plane ? settings.center : body.frame.centre);
    const Eigen::Isometry3d start = built.motion.motion.at(0);
    for (Vec3& x : body.mesh.positions) x = start * x;
    body.frame.centre = start * body.frame.centre;
    body.frame.axes = start.linear();
    const auto corners = body.frame.corners();
    built.motion.start.assign(corners.begin(), corners.end());
  }
  require_usable(body, settings);
  body.mean_edge = mean_edge(body.mesh.positions, triangulate(body.mesh).triangles);
  if (body.is_rigid()) {
    body.skin = embed(body.frame, body.mesh.positions);
    body.vertex_count = 4;
  } else {
    body.skin = identity_embedding(body.mesh.vertex_count());
    body.vertex_count = static_cast<int>(body.mesh.vertex_count());
  }
  body.statistics.vertices = body.vertex_count;
  body.statistics.triangles = static_cast<std::int64_t>(body.report.triangles);
  return built;
}

}  // namespace muslin
