// A sheet that is cut in two between frames goes on as two: nothing jumps, momentum and energy are accounted
// for, and each half moves as a sheet that was in two from the start.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "muslin/component/shell/shell_body_settings.hpp"
#include "muslin/core/error.hpp"
#include "muslin/core/parallel.hpp"
#include "muslin/scene/model.hpp"
#include "muslin/simulation/energy_account.hpp"
#include "muslin/simulation/simulation.hpp"

namespace muslin {
namespace {

using testing::HasSubstr;

constexpr int cells = 12;  // along each side
constexpr double side = 0.6;

int vertex(int i, int j) { return j * (cells + 1) + i; }

/// A square in the x, y plane.
Mesh square() {
  Mesh mesh;
  for (int j = 0; j <= cells; ++j)
    for (int i = 0; i <= cells; ++i) mesh.positions.emplace_back(side * i / cells, side * j / cells, 0);
  for (int j = 0; j < cells; ++j)
    for (int i = 0; i < cells; ++i)
      mesh.add_face(std::array{vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
  return mesh;
}

std::vector<std::array<int, 2>> row(int j) {
  std::vector<std::array<int, 2>> edges;
  for (int i = 0; i < cells; ++i) edges.push_back({vertex(i, j), vertex(i + 1, j)});
  return edges;
}

ShellMaterial fabric() {
  ShellMaterial m;
  m.areal_density = 0.2;
  m.membrane_warp = m.membrane_weft = 500;
  m.membrane_shear = 200;
  m.poisson = 0.25;
  m.bending_warp = m.bending_weft = m.bending_bias = 1e-4;
  return m;
}

/// The square hangs by its upper edge and sways, as it starts with a velocity out of its plane.
Scene hanging(Mesh mesh, bool contact = false) {
  Scene scene;
  scene.time.duration = 2;
  scene.time.frame_rate = 60;
  scene.solver.effort = Effort::exact;
  scene.contact.given = contact;
  scene.meshes["square"] = std::make_shared<const Mesh>(std::move(mesh));
  BodySettings body;
  body.name = "cloth";
  body.mesh = "square";
  body.model = "shell";
  body.material.shell = fabric();
  body.own.as<ShellBodySettings>().warp = Vec3::UnitX();
  body.velocity = Vec3(0, 0, 0.3);
  scene.bodies.push_back(body);
  PinSettings pin;
  pin.name = "rail";
  pin.body = "cloth";
  pin.where.box = Selection::BoxShape{Vec3(-1, side - 1e-3, -1), Vec3(1, side + 1e-3, 1)};
  scene.pins.push_back(pin);
  ForceSettings gravity;
  gravity.name = "gravity";
  gravity.value = {{{0, Vec3(0, -9.81, 0)}}};
  scene.forces.push_back(gravity);
  return scene;
}

Simulation started(const Scene& scene) {
  return Simulation(std::make_shared<const Model>(build_model(scene)));
}

Vec3 momentum(const Simulation& simulation) {
  return total_momentum(simulation.model().masses, simulation.state().velocities);
}

/// Centre of mass of vertices that `chosen` accepts by their origin.
template <class Chosen>
Vec3 centre(const Simulation& simulation, const Chosen& chosen) {
  Vec3 sum = Vec3::Zero();
  double mass = 0;
  for (std::size_t v = 0; v < simulation.model().vertex_count(); ++v) {
    if (!chosen(simulation.model().rest_positions[v], v)) continue;
    sum += simulation.model().masses[v] * simulation.state().positions[v];
    mass += simulation.model().masses[v];
  }
  return sum / mass;
}

TEST(CutRun, LowerHalfFallsFreelyAndUpperHalfHangs) {
  constexpr int line = 8;
  Simulation simulation = started(hanging(square()));
  for (int frame = 0; frame < 20; ++frame) simulation.advance();
  const State before = simulation.state();
  const Diagnostics energy = simulation.diagnostics();
  const Vec3 momentum_before = momentum(simulation);
  double mass = 0;
  for (const double m : simulation.model().masses) mass += m;
  const std::size_t count = simulation.model().vertex_count();

  simulation.cut("cloth", row(line));

  // Nothing moves by the cut.
  ASSERT_EQ(simulation.model().vertex_count(), count + cells + 1);
  for (std::size_t v = 0; v < count; ++v) {
    EXPECT_EQ(simulation.state().positions[v], before.positions[v]);
    EXPECT_EQ(simulation.state().velocities[v], before.velocities[v]);
  }
  for (int i = 0; i <= cells; ++i)
    EXPECT_EQ(simulation.state().positions[count + static_cast<std::size_t>(i)],
              before.positions[static_cast<std::size_t>(vertex(i, line))]);
  EXPECT_LT((momentum(simulation) - momentum_before).norm(), 1e-14 * momentum_before.norm());
  double mass_after = 0;
  for (const double m : simulation.model().masses) mass_after += m;
  EXPECT_NEAR(mass_after, mass, 1e-14 * mass);
  // The hinges of the cut are gone, and their energy is accounted for.
  EXPECT_LT(simulation.diagnostics().elastic, energy.elastic);
  EXPECT_NEAR(simulation.diagnostics().balance(), energy.balance(), 1e-12 * std::abs(energy.balance()));

  // The lowest faces keep their vertices, so that the copies belong to the upper half.
  const auto below = [&](const Vec3& rest, std::size_t v) {
    return v < count && rest.y() < side * (line + 0.5) / cells;
  };
  const auto above = [&](const Vec3& rest, std::size_t v) { return !below(rest, v); };
  Vec3 velocity = Vec3::Zero();
  double half = 0;
  for (std::size_t v = 0; v < count; ++v) {
    if (!below(simulation.model().rest_positions[v], v)) continue;
    velocity += simulation.model().masses[v] * simulation.state().velocities[v];
    half += simulation.model().masses[v];
  }
  velocity /= half;
  constexpr int frames = 20;
  for (int frame = 0; frame < frames; ++frame) simulation.advance();
  Vec3 velocity_then = Vec3::Zero();
  for (std::size_t v = 0; v < count; ++v)
    if (below(simulation.model().rest_positions[v], v))
      velocity_then += simulation.model().masses[v] / half * simulation.state().velocities[v];
  EXPECT_LT((velocity_then - velocity + 9.81 * frames / 60.0 * Vec3::UnitY()).norm(), 1e-6);
  EXPECT_LT(centre(simulation, below).y(), -0.1);
  EXPECT_GT(centre(simulation, above).y(), 0.5 * side);
  EXPECT_NEAR(simulation.diagnostics().balance(), energy.balance(), 1e-3 * simulation.diagnostics().kinetic);
}

TEST(CutRun, CutAtTheStartGivesTheBitsOfACutMesh) {
  Simulation cut_here = started(hanging(square()));
  cut_here.cut("cloth", row(8));
  Simulation was_cut = started(hanging(cut(square(), row(8)).mesh));
  for (int frame = 0; frame < 5; ++frame) {
    cut_here.advance();
    was_cut.advance();
  }
  EXPECT_EQ(cut_here.state().positions, was_cut.state().positions);
  EXPECT_EQ(cut_here.state().velocities, was_cut.state().velocities);
}

TEST(CutRun, SecondCutAndCheckpointContinue) {
  Simulation simulation = started(hanging(square()));
  for (int frame = 0; frame < 3; ++frame) simulation.advance();
  simulation.cut("cloth", row(8));
  for (int frame = 0; frame < 2; ++frame) simulation.advance();
  simulation.cut("cloth", row(4));
  EXPECT_EQ(simulation.model().body("cloth").mesh.version, 2);
  EXPECT_EQ(simulation.model().vertex_count(), static_cast<std::size_t>((cells + 3) * (cells + 1)));
  const std::vector<std::uint8_t> bytes = simulation.checkpoint();
  Simulation again(std::make_shared<const Model>(simulation.model()));
  again.restore(bytes);
  simulation.advance();
  again.advance();
  EXPECT_EQ(again.state().positions, simulation.state().positions);
}

TEST(CutRun, HalvesSeparateAfterTheCutWithContact) {
  Simulation simulation = started(hanging(square(), true));
  for (int frame = 0; frame < 10; ++frame) simulation.advance();
  const Diagnostics before = simulation.diagnostics();
  simulation.cut("cloth", row(8));
  EXPECT_NEAR(simulation.diagnostics().balance(), before.balance(), 1e-9 * std::abs(before.balance()));
  EXPECT_GT(simulation.tangled(), 0u);
  Simulation without = started(hanging(square()));
  for (int frame = 0; frame < 10; ++frame) without.advance();
  without.cut("cloth", row(8));
  for (int frame = 0; frame < 15; ++frame) {
    simulation.advance();
    without.advance();
  }
  EXPECT_EQ(simulation.tangled(), 0u);
  // Contact gives the halves no push.
  double largest = 0;
  for (std::size_t v = 0; v < simulation.model().vertex_count(); ++v)
    largest = std::max(largest, (simulation.state().positions[v] - without.state().positions[v]).norm());
  EXPECT_LT(largest, 2e-3);
  EXPECT_EQ(simulation.diagnostics().crossings, 0);
}

TEST(CutRun, BodiesThatShareAMeshAreCutSeparately) {
  Scene two = hanging(square());
  two.bodies.push_back(two.bodies[0]);
  two.bodies[1].name = "lining";
  two.bodies[1].translate = Vec3(0, 0, 0.1);
  Simulation simulation = started(two);
  simulation.cut("cloth", row(8));
  simulation.cut("lining", row(4));
  const Model& model = simulation.model();
  const Mesh &cloth = model.body("cloth").mesh, &lining = model.body("lining").mesh;
  EXPECT_EQ(cloth.vertex_count(), static_cast<std::size_t>((cells + 2) * (cells + 1)));
  EXPECT_EQ(lining.vertex_count(), cloth.vertex_count());
  // The copies come last: those of the cloth are where row 8 is, those of the lining where row 4 is.
  EXPECT_DOUBLE_EQ(cloth.positions.back().y(), side * 8 / cells);
  EXPECT_DOUBLE_EQ(lining.positions.back().y(), side * 4 / cells);
  simulation.advance();
}

TEST(CutRun, RefusesInvalidCuts) {
  Simulation simulation = started(hanging(square()));
  const auto complaint = [&](const std::string& body, std::vector<std::array<int, 2>> edges) -> std::string {
    try {
      simulation.cut(body, edges);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::usage);
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(complaint("clot", row(8)), HasSubstr("cloth"));
  EXPECT_THAT(complaint("cloth", {{0, 5}}), HasSubstr("vertices 0 and 5 share no edge"));
  const State before = simulation.state();
  EXPECT_THROW(simulation.change_model(nullptr, {}), Error);
  const std::vector<int> origins(simulation.model().vertex_count(), 100000);
  EXPECT_THROW(simulation.change_model(std::make_shared<const Model>(simulation.model()), origins), Error);
  EXPECT_EQ(simulation.state().positions, before.positions);
}

}  // namespace
}  // namespace muslin
