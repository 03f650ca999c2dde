// Models of cloth, balls and floors in contact, built by hand: for tests and benchmarks that need no scene
// file.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "support/cloth_grid.hpp"
#include "support/simple_potentials.hpp"

#include "muslin/component/shell/shell_body.hpp"
#include "muslin/contact/contact_model.hpp"
#include "muslin/energy/membrane_energy.hpp"
#include "muslin/energy/shell_bending.hpp"
#include "muslin/potential/restricted.hpp"
#include "muslin/scene/model.hpp"

namespace muslin::test {

struct ClothMaterial {
  double membrane = 1000;      ///< Young's modulus × thickness [N/m]
  double bending = 1e-5;       ///< [N·m]
  double areal_density = 0.2;  ///< [kg/m²]
  double poisson = 0.3;
};

/// Adds bodies one after the other; `finish` makes the model.
class ContactScene {
 public:
  Model model;
  std::vector<ContactBody> bodies;
  std::vector<ContactPlane> planes;
  double distance = 2e-3, friction = 0.3;

  explicit ContactScene(int steps_per_frame = 4, double frame_rate = 60) {
    model.scene.title = "contact";
    model.scene.resolved = "{}";
    model.scene.time = {10, frame_rate, steps_per_frame};
    model.scene.solver.tolerance = 1e-4;
    model.scene.solver.linear_tolerance = 1e-10;
  }

  /// Cloth where `grid` says, its rest shape flat as ClothGrid makes it. Returns its first vertex.
  int add_cloth(const ClothGrid& grid, const ClothMaterial& m = {}, ContactBody contact = {}) {
    const double spacing = (grid.rest[1] - grid.rest[0]).norm();
    const auto built = std::make_shared<ShellBody>();
    ShellBody& body = *built;
    body.settings.material.shell = ShellMaterial{};
    body.name = "cloth " + std::to_string(model.bodies.size());
    body.mesh.positions = grid.positions;
    body.mesh.face_offsets = {0};
    for (const Vec3i& t : grid.triangles) {
      for (const int v : t) body.mesh.face_vertices.push_back(v);
      body.mesh.face_offsets.push_back(static_cast<int>(body.mesh.face_vertices.size()));
    }
    body.shell = build_shell(body.mesh, grid.rest, {Vec3(1, 0, 0)});
    body.first_vertex = static_cast<int>(model.vertex_count());
    body.vertex_count = static_cast<int>(grid.positions.size());
    const auto pattern = block_pattern(body.shell);
    const double shear = m.membrane / (2 * (1 + m.poisson));
    add(body, std::make_shared<MembraneEnergy>(
                  body.shell, MembraneModuli{m.membrane, m.membrane, shear, m.poisson}, pattern));
    add(body,
        std::make_shared<ShellBending>(body.shell, BendingModuli{m.bending, m.bending, m.bending}, pattern));
    const auto first_point = static_cast<int>(bodies_of_points_.size());
    for (std::size_t v = 0; v < grid.positions.size(); ++v) {
      add_vertex(grid.positions[v], m.areal_density * body.shell.vertex_areas[v]);
      add_point({{body.first_vertex + static_cast<int>(v), 1}});
    }
    for (const Vec3i& t : grid.triangles) triangles_.push_back(t.array() + first_point);
    distance = std::min(distance, 0.2 * spacing);
    bodies.push_back(contact);
    model.scene.bodies.emplace_back().name = body.name;
    model.bodies.push_back(built);
    return body.first_vertex;
  }

  /// A ball that does not turn, held or moved by a pin of its own; returns its vertex.
  int add_ball(const Vec3& centre, double radius, Motion motion = {}) {
    const int v = add_held_vertex(centre, std::move(motion));
    triangles_.push_back(Vec3i::Constant(add_point({{v, 1}})));
    bodies.push_back({radius, false, true, INFINITY});
    return v;
  }

  /// A ball carried by four vertices, its equimomental tetrahedron if it has a mass; with none it is held, or
  /// moved by a pin of its own. Returns the first vertex.
  int add_turning_ball(const Vec3& centre, double radius, double mass, Motion motion = {}) {
    const int first = static_cast<int>(model.vertex_count());
    std::vector<SurfaceMap::Entry> entries;
    std::vector<int> all;
    for (const Vec3& corner : {Vec3(1, 1, 1), Vec3(1, -1, -1), Vec3(-1, 1, -1), Vec3(-1, -1, 1)}) {
      entries.push_back({first + static_cast<int>(entries.size()), 0.25});
      all.push_back(entries.back().vertex);
      // Points of a quarter of the mass at √(3/5) of the radius have the moments of a solid ball.
      add_vertex(centre + radius * std::sqrt(0.6 / 3) * corner, mass > 0 ? mass / 4 : 1);
      prescribed_.back() = mass > 0 ? 0 : 1;
    }
    triangles_.push_back(Vec3i::Constant(add_point(std::move(entries))));
    ContactBody body = {radius, false, mass <= 0, mass > 0 ? 1e5 : INFINITY};
    for (std::size_t k = 0; k < 4; ++k) body.frame[k] = all[k];
    bodies.push_back(body);
    if (mass <= 0) hold(all, std::move(motion));
    return first;
  }

  /// A half-space; returns its vertex.
  int add_plane(const Vec3& point, const Vec3& normal, Motion motion = {}) {
    const int v = add_held_vertex(point, std::move(motion));
    planes.push_back({add_point({{v, 1}}), normal.normalized()});
    bodies.push_back({0, false, true, INFINITY});
    return v;
  }

  void hold(std::vector<int> vertices, Motion motion = {}) {
    Pin pin;
    pin.name = "pin " + std::to_string(model.pins.size());
    pin.vertices = std::move(vertices);
    pin.motion = std::move(motion);
    model.pins.push_back(pin);
  }

  std::shared_ptr<const Model> finish(const Vec3& gravity = Vec3(0, -9.81, 0)) {
    auto weights = std::make_shared<UniformGravity>(model.masses, gravity);
    model.potentials.push_back({"gravity", EnergyRole::potential, weights});
    auto contact = std::make_shared<ContactModel>();
    contact->surface = std::make_shared<ContactSurface>(triangles_, bodies_of_points_, bodies, planes);
    std::vector<int> offsets = {0};
    std::vector<SurfaceMap::Entry> entries;
    bool identity = rows_.size() == model.vertex_count();
    for (const auto& row : rows_) {
      identity = identity && row.size() == 1 && row[0].vertex == static_cast<int>(entries.size());
      entries.insert(entries.end(), row.begin(), row.end());
      offsets.push_back(static_cast<int>(entries.size()));
    }
    contact->map = std::make_shared<SurfaceMap>(
        identity ? SurfaceMap::identity(model.vertex_count())
                 : SurfaceMap(model.vertex_count(), std::move(offsets), std::move(entries)));
    contact->rest.resize(rows_.size());
    contact->map->apply(model.rest_positions, contact->rest);
    contact->distance = distance;
    contact->friction = friction;
    contact->limits.gap_floor = 0.005 * distance;
    contact->limits.prescribed = prescribed_;
    model.contact = contact;
    return std::make_shared<const Model>(model);
  }

 private:
  void add(const Component& body, std::shared_ptr<const Potential> potential) {
    const std::string name = body.name + ": " + std::to_string(model.potentials.size());
    model.potentials.push_back({name, EnergyRole::elastic,
                                std::make_shared<RestrictedPotential>(
                                    std::move(potential), static_cast<std::size_t>(body.first_vertex),
                                    static_cast<std::size_t>(body.vertex_count))});
  }
  void add_vertex(const Vec3& x, double mass) {
    model.rest_positions.push_back(x);
    model.masses.push_back(mass);
    prescribed_.push_back(0);
  }
  /// Number of the next body.
  int add_point(std::vector<SurfaceMap::Entry> row) {
    bodies_of_points_.push_back(static_cast<int>(bodies.size()));
    rows_.push_back(std::move(row));
    return static_cast<int>(rows_.size()) - 1;
  }
  int add_held_vertex(const Vec3& x, Motion motion) {
    const int v = static_cast<int>(model.vertex_count());
    add_vertex(x, 1);
    prescribed_.back() = 1;
    hold({v}, std::move(motion));
    return v;
  }

  std::vector<Vec3i> triangles_;
  std::vector<int> bodies_of_points_;
  std::vector<std::vector<SurfaceMap::Entry>> rows_;
  std::vector<std::uint8_t> prescribed_;
};

}  // namespace muslin::test
