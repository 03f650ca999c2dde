// A flag of 3×2 voxels held at two corners, built by hand: for tests of runs that need no scene file.
#pragma once

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "support/lattice_box.hpp"

#include "muslin/component/lattice/lattice_body.hpp"
#include "muslin/energy/spring_damping.hpp"
#include "muslin/energy/spring_energy.hpp"
#include "muslin/lattice/embedding.hpp"
#include "muslin/potential/mass_damping.hpp"
#include "muslin/scene/model.hpp"

namespace muslin::test {

/// −f·x: a constant force on every vertex, or a field if that is what its role says.
class ConstantForce : public Potential {
 public:
  explicit ConstantForce(std::vector<Vec3> forces) : forces_(std::move(forces)) {}
  double value(ConstVectors x) const override {
    double sum = 0;
    for (std::size_t v = 0; v < x.size(); ++v) sum -= forces_[v].dot(x[v]);
    return sum;
  }
  void add_gradient(ConstVectors, Vectors g) const override {
    for (std::size_t v = 0; v < g.size(); ++v) g[v] -= forces_[v];
  }
  void add_hessian_product(ConstVectors, ConstVectors, Vectors) const override {}
  void add_diagonal_blocks(ConstVectors, std::span<Mat3>) const override {}
  void linearize(ConstVectors, HessianSink&, std::size_t) const override {}

 private:
  std::vector<Vec3> forces_;
};

/// Gives no finite energy beneath a height [m]: no step can pass it, however short.
class Wall : public ConstantForce {
 public:
  Wall(std::size_t count, double height)
      : ConstantForce(std::vector<Vec3>(count, Vec3::Zero())), height_(height) {}
  double value(ConstVectors x) const override {
    for (const Vec3& p : x)
      if (p.y() < height_) return std::nan("");
    return 0;
  }
  void add_gradient(ConstVectors x, Vectors g) const override {
    for (std::size_t v = 0; v < x.size(); ++v)
      if (x[v].y() < height_) g[v].setConstant(std::nan(""));
  }

 private:
  double height_;
};

/// A force between two times.
class TimedForce : public Load {
 public:
  TimedForce(std::vector<Vec3> forces, double from, double until)
      : forces_(std::move(forces)), from_(from), until_(until) {}
  std::unique_ptr<Potential> potential(const StepContext& step) const override {
    if (step.time_end <= from_ + 1e-9 || step.time_end > until_ + 1e-9) return nullptr;
    return std::make_unique<ConstantForce>(forces_);
  }

 private:
  std::vector<Vec3> forces_;
  double from_, until_;
};

struct SmallModelOptions {
  Integrator integrator = Integrator::implicit_euler;
  double tolerance = 1e-12;
  int steps_per_frame = 4;
  double frame_rate = 24;
  bool pinned = true;
  bool moving_pin = false;
  bool damped = true;
  double stiffness = 2000;  ///< edge modulus [N/m²]
  std::string body_name = "flag";
};

inline Model small_model(const SmallModelOptions& options = {}) {
  Model model;
  model.scene.title = "a small flag";
  model.scene.text = "title = \"a small flag\"\n";
  model.scene.resolved = R"({"title":"a small flag","body":[{"name":"flag","voxel_width":1.0}]})";
  model.scene.bodies.emplace_back().name = "flag";
  model.scene.time = {1, options.frame_rate, options.steps_per_frame};
  model.scene.solver.integrator = options.integrator;
  model.scene.solver.tolerance = options.tolerance;
  model.scene.solver.linear_tolerance = 1e-13;

  const auto built = std::make_shared<LatticeBody>();
  LatticeBody& body = *built;
  body.name = options.body_name;
  body.lattice = box_lattice({3, 2, 1});
  body.springs = build_springs(body.lattice, Bracing::kuhn);
  for (int c = 0; c < 8; ++c)
    body.mesh.positions.emplace_back(3.0 * (c & 1), 2.0 * (c >> 1 & 1), 1.0 * (c >> 2 & 1));
  const std::vector<std::vector<int>> faces = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                               {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  body.mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0.5, 0.25}};
  body.mesh.face_offsets = {0};
  for (const auto& face : faces) {
    body.mesh.face_vertices.insert(body.mesh.face_vertices.end(), face.begin(), face.end());
    body.mesh.face_offsets.push_back(static_cast<int>(body.mesh.face_vertices.size()));
    for (int corner = 0; corner < 4; ++corner) body.mesh.corner_uvs.push_back(corner);
  }
  body.mesh.corner_uvs[1] = 4;  // a seam: vertex 2 has another coordinate in face 0
  body.mesh.groups.push_back({"front", {1}, {4, 5, 6, 7}});
  body.skin = embed(body.lattice, body.mesh.positions);
  body.contour.mesh.positions = body.mesh.positions;
  body.contour.mesh.face_offsets = {0};
  for (const auto& face : faces) {
    for (int corner : {face[0], face[1], face[2], face[0], face[2], face[3]})
      body.contour.mesh.face_vertices.push_back(corner);
    body.contour.mesh.face_offsets.push_back(body.contour.mesh.face_offsets.back() + 3);
    body.contour.mesh.face_offsets.push_back(body.contour.mesh.face_offsets.back() + 3);
  }
  body.contour.embedding = body.skin;
  body.vertex_count = static_cast<int>(body.lattice.vertex_count());
  body.statistics = {body.vertex_count, 6, 36, {41, 23, 6}, 60, 1, 0};

  model.rest_positions = rest_positions(body.lattice);
  model.masses.assign(model.vertex_count(), 0.0);
  for (const auto& voxel : body.lattice.voxel_vertices)
    for (int v : voxel) model.masses[static_cast<std::size_t>(v)] += 10.0 / 8;

  const auto springs = std::make_shared<SpringEnergy>(body.springs, body.lattice.width,
                                                      std::array<double, 3>{options.stiffness, 100, 100});
  model.potentials.push_back({"flag springs", EnergyRole::elastic, springs});
  std::vector<Vec3> weights;
  for (double mass : model.masses) weights.push_back(mass * Vec3(0, -9.8, 0));
  model.potentials.push_back({"gravity", EnergyRole::potential, std::make_shared<ConstantForce>(weights)});
  if (options.damped) {
    model.loads.push_back(
        {"mass damping", EnergyRole::dissipation, std::make_shared<MassDamping>(0.3, model.masses)});
    model.loads.push_back(
        {"spring damping", EnergyRole::dissipation, std::make_shared<SpringDamping>(springs, 0.002)});
  }
  std::vector<Vec3> blow(model.vertex_count(), Vec3(0, 0, 3));
  model.loads.push_back({"blow", EnergyRole::work, std::make_shared<TimedForce>(blow, 0.1, 0.3)});
  std::vector<Vec3> lift(model.vertex_count(), Vec3(1, 2, 0));
  model.loads.push_back({"lift", EnergyRole::potential, std::make_shared<TimedForce>(lift, 0.2, 0.35)});
  if (options.pinned) {
    Pin pin;
    pin.name = "corners";
    for (int v = 0; v < body.vertex_count; ++v) {
      const Vec3i& at = body.lattice.vertices[static_cast<std::size_t>(v)];
      if (at.y() == 2 && (at.x() == 0 || at.x() == 3)) pin.vertices.push_back(v);
    }
    if (options.moving_pin) pin.motion.keys = {{0, Vec3::Zero()}, {0.25, Vec3(0.3, 0.4, 0.1)}};
    pin.until = 0.6;
    model.pins.push_back(pin);
  }
  Probe probe;
  probe.name = "tip";
  probe.point = embed(body.lattice, std::vector<Vec3>{Vec3(1.5, 0, 0.5)});
  model.probes.push_back(probe);
  model.bodies.push_back(built);
  return model;
}

}  // namespace muslin::test
