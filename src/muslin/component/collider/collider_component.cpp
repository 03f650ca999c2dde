#include "muslin/component/collider/collider_component.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "muslin/component/description.hpp"
#include "muslin/component/placement.hpp"
#include "muslin/core/counted.hpp"
#include "muslin/geometry/edge_length.hpp"
#include "muslin/geometry/shapes.hpp"
#include "muslin/io/mesh_file.hpp"

namespace muslin {
namespace {

using Shape = ColliderSettings::Shape;

/// A plane is shown this many times as wide as the box of the other bodies.
constexpr double plane_reach = 2;

Mesh plane_around(const ColliderSettings& c, const Box& around) {
  const Vec3 middle = around.isEmpty() ? c.center : around.center();
  const double size = around.isEmpty() ? 1 : std::max(around.diagonal().norm(), 1e-3);
  const Vec3 foot = middle - c.normal.dot(middle - c.center) * c.normal;
  return plane_mesh(foot, c.normal, plane_reach * size);
}

Mesh read_collider_mesh(const ColliderSettings& c, const ComponentInputs& inputs) {
  try {
    MeshFile read = inputs.files.mesh(c.mesh);
    if (!read.note.empty()) inputs.warnings.push_back(fmt::format("collider {}: {}", c.name, read.note));
    return std::move(read.mesh);
  } catch (const Error& error) {
    std::string where = inputs.files.resolve(c.mesh).string();
    if (error.place().line > 0) where += fmt::format(":{}", error.place().line);
    throw Error(error.kind(), c.mesh_place, where + ": " + error.problem(), error.remedy());
  }
}

Mesh mesh_of(const ColliderSettings& c, const ComponentInputs& inputs) {
  switch (c.shape) {
    case Shape::plane:
      return plane_around(c, inputs.around);
    case Shape::sphere:
      return sphere_mesh(c.center, c.radius);
    case Shape::capsule:
      return capsule_mesh(c.points[0], c.points[1], c.radius);
    case Shape::box:
      return box_mesh(c.center, c.size);
    case Shape::mesh:
      return read_collider_mesh(c, inputs);
  }
  return {};
}

/// Checks the coordinates, before and after the mesh was moved.
void require_usable(const Mesh& mesh, const ColliderSettings& settings) {
  try {
    muslin::require_usable(mesh, settings.mesh);
  } catch (const Error& error) {
    throw Error(error.kind(), settings.place, fmt::format("collider {}: {}", settings.name, error.problem()),
                error.remedy());
  }
}

}  // namespace

const char* name_of(ColliderSettings::Shape shape) {
  constexpr std::array names = {"plane", "sphere", "capsule", "box", "mesh"};
  return names[static_cast<std::size_t>(shape)];
}

Eigen::Affine3d placement_of(const ColliderSettings& c) {
  if (c.shape == Shape::mesh) return placement(c.translate, c.rotate, c.scale);
  Eigen::Affine3d turned = placement(c.center, c.rotate, Vec3::Ones());
  turned.translation() = c.center - turned.linear() * c.center;
  return turned;
}

MassProperties mass_properties(const ColliderSettings& c, const Mesh& mesh) {
  switch (c.shape) {
    case Shape::plane:
      break;
    case Shape::sphere:
      return sphere_mass(c.center, c.radius);
    case Shape::capsule:
      return capsule_mass(c.points[0], c.points[1], c.radius);
    case Shape::box: {
      MassProperties mass = box_mass(c.center, c.size);
      const Mat3 turn = placement_of(c).linear();
      mass.second_moment = turn * mass.second_moment * turn.transpose();
      return mass;
    }
    case Shape::mesh: {
      MassProperties mass = polyhedron_mass(mesh.positions, triangulate(mesh).triangles);
      if (mass.volume < 0) mass = {-mass.volume, mass.centre, -mass.second_moment};  // faces inward
      return mass;
    }
  }
  return {};
}

void ColliderComponent::begin(const ColliderSettings& the_settings, const ComponentInputs& inputs) {
  settings = the_settings;
  name = settings.name;
  mesh = mesh_of(settings, inputs);
  if (settings.shape == Shape::box || settings.shape == Shape::mesh) {
    const Eigen::Affine3d place = placement_of(settings);
    for (Vec3& x : mesh.positions) x = place * x;
  }
  require_usable(mesh, settings);
  report = inspect(mesh);
  sheet = !report.closed;
  if (settings.shape != Shape::mesh) return;
  for (const std::string& warning : report.warnings)
    inputs.warnings.push_back(fmt::format("collider {}: {}", name, warning));
}

void ColliderComponent::finish() {
  require_usable(mesh, settings);
  mean_edge = muslin::mean_edge(mesh.positions, triangulate(mesh).triangles);
  statistics.vertices = vertex_count;
  statistics.triangles = static_cast<std::int64_t>(report.triangles);
}

Appearance ColliderComponent::appearance() const {
  return {settings.colour, name_of(settings.shape), settings.shape == Shape::plane};
}

std::string ColliderComponent::description_json() const {
  nlohmann::ordered_json json = {
      {"name", name}, {"shape", name_of(settings.shape)}, {"movement", movement()}};
  if (!is_prescribed()) json["mass"] = statistics.mass;
  json["vertices"] = mesh.vertex_count();
  json["triangles"] = statistics.triangles;
  return to_line(json);
}

std::string ColliderComponent::description() const {
  const bool from_file = settings.shape == Shape::mesh;
  std::string text = fmt::format("collider {}: {}, {}", name,
                                 from_file ? settings.mesh.c_str() : name_of(settings.shape), movement());
  if (!is_prescribed()) text += fmt::format(" of {:.6g} kg", statistics.mass);
  if (from_file) text += ", " + counted(static_cast<std::size_t>(statistics.triangles), "triangle");
  return text + "\n";
}

}  // namespace muslin
