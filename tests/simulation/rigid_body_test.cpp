// Rigid bodies against closed forms: falling, spinning, resting, sliding, held and let go.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include <gtest/gtest.h>
#include <unistd.h>

#include "muslin/contact/contact_model.hpp"
#include "muslin/simulation/simulation.hpp"

namespace muslin {
namespace {

std::shared_ptr<const Model> build(const std::string& text) {
  return std::make_shared<const Model>(build_model(parse_scene(text, "scene.toml")));
}

/// The colliders come after the bodies.
const Component& collider_of(const Simulation& simulation, std::size_t index) {
  return simulation.model().bodies[simulation.model().scene.bodies.size() + index];
}
ConstVectors body(const Simulation& simulation, std::size_t collider, const std::vector<Vec3>& all) {
  return simulation.model().of(collider_of(simulation, collider), all);
}
Vec3 mean(ConstVectors x) { return (x[0] + x[1] + x[2] + x[3]) / 4; }
Vec3 centre(const Simulation& simulation, std::size_t collider = 0) {
  return mean(body(simulation, collider, simulation.state().positions));
}
Vec3 velocity(const Simulation& simulation, std::size_t collider = 0) {
  return mean(body(simulation, collider, simulation.state().velocities));
}
/// Returns the largest deviation of the ball's drawn surface from a sphere, in radii.
double out_of_round(const Simulation& simulation, double radius) {
  const Component& ball = collider_of(simulation, 0);
  std::vector<Vec3> skin(ball.mesh.vertex_count());
  ball.skin.apply(body(simulation, 0, simulation.state().positions), skin);
  double worst = 0;
  for (const Vec3& x : skin) worst = std::max(worst, std::abs((x - centre(simulation)).norm() / radius - 1));
  return worst;
}

const std::string ball =
    "[[collider]]\nname = 'ball'\nshape = 'sphere'\ncenter = [0, 0.5, 0]\nradius = 0.1\ndensity = 500\n";
const std::string floor_below = "[[collider]]\nname = 'floor'\nshape = 'plane'\n";
const std::string gravity = "[[force]]\ntype = 'gravity'\nacceleration = [0, -10, 0]\n";

TEST(RigidBody, FallsAndSpinsCorrectly) {
  for (const char* effort : {"draft", "normal", "exact"}) {
    for (const char* integrator : {"implicit_euler", "bdf2"}) {
      SCOPED_TRACE(std::string(effort) + " " + integrator);
      Simulation simulation(build(ball + "angular_velocity = [0, 0, 1200]\n" + floor_below + gravity +
                                  "[time]\nsteps_per_frame = 10\n[solver]\nintegrator = '" + integrator +
                                  "'\neffort = '" + effort + "'\n"));
      for (int frame = 0; frame < 4; ++frame) simulation.advance();
      const double t = 4.0 / 24, dt = 1.0 / 240;
      const double drop = std::string(integrator) == "bdf2" ? 5 * t * t : 5 * t * (t + dt);  // Euler's sum
      EXPECT_NEAR(centre(simulation).y(), 0.5 - drop, 1e-3 * drop + 10 * dt * dt);
      EXPECT_NEAR(velocity(simulation).y(), -10 * t, 1e-3 * 10 * t);
      EXPECT_LT(out_of_round(simulation, 0.1), 1e-5);
      const ConstVectors x = body(simulation, 0, simulation.state().positions),
                         v = body(simulation, 0, simulation.state().velocities);
      Vec3 spin = Vec3::Zero();  // Σ r × v = 4 · ⅖ r² ω for four equal masses
      for (std::size_t i = 0; i < 4; ++i) spin += (x[i] - mean(x)).cross(v[i] - mean(v));
      const double omega = spin.z() / (4 * 0.4 * 0.01);
      EXPECT_NEAR(omega, 1200 * std::numbers::pi / 180, std::string(integrator) == "bdf2" ? 0.5 : 1e-3);
    }
  }
}

TEST(RigidBody, EnergyBalanceClosesWhileItSpinsAndFalls) {
  Simulation simulation(
      build(ball + "angular_velocity = [0, 300, 600]\n" + gravity + "[solver]\ntolerance = 1e-8\n"));
  const double before = simulation.diagnostics().balance();
  for (int frame = 0; frame < 6; ++frame) simulation.advance();
  EXPECT_NEAR(simulation.diagnostics().balance(), before, 1e-6 * simulation.diagnostics().kinetic);
  EXPECT_LT(std::abs(simulation.diagnostics().dissipated), 0.05 * simulation.diagnostics().kinetic);
}

TEST(RigidBody, RestsOnAPlaneAndStaysRound) {
  for (const char* effort : {"draft", "normal", "exact"}) {
    SCOPED_TRACE(effort);
    Simulation simulation(build(ball + floor_below + gravity + "[solver]\neffort = '" + effort + "'\n"));
    for (int frame = 0; frame < 36; ++frame) {
      simulation.advance();
      EXPECT_GT(centre(simulation).y(), 0.1);
      EXPECT_LT(out_of_round(simulation, 0.1), 1e-3);
    }
    const double distance = simulation.model().contact->distance;
    EXPECT_LT(centre(simulation).y(), 0.1 + distance);
    EXPECT_LT(velocity(simulation).norm(), 1e-3);
    EXPECT_LT(out_of_round(simulation, 0.1), 1e-4);
  }
}

/// Returns the distance that a box slides down a slope of 30° in half a second.
double slid(double friction) {
  const double tilt = std::numbers::pi / 6;
  const Vec3 normal(-std::sin(tilt), std::cos(tilt), 0), along(-std::cos(tilt), -std::sin(tilt), 0);
  const Vec3 start = 0.0505 * normal;
  const std::string box =
      "[[collider]]\nshape = 'box'\nsize = [0.2, 0.1, 0.2]\nrotate = [0, 0, 30]\ndensity = 500\ncenter = [" +
      std::to_string(start.x()) + ", " + std::to_string(start.y()) + ", 0]\n";
  const std::string slope = "[[collider]]\nshape = 'plane'\nnormal = [" + std::to_string(normal.x()) + ", " +
                            std::to_string(normal.y()) + ", 0]\n";
  Simulation simulation(build(box + slope + gravity + "[contact]\nfriction = " + std::to_string(friction) +
                              "\n[solver]\ntolerance = 1e-5\n"));
  const Vec3 before = centre(simulation);
  for (int frame = 0; frame < 12; ++frame) simulation.advance();
  return (centre(simulation) - before).dot(along);
}

TEST(RigidBody, ABoxOnASlopeSlidesOrHolds) {
  const double tilt = std::numbers::pi / 6;
  const auto expected = [&](double mu) { return 0.5 * 10 * (std::sin(tilt) - mu * std::cos(tilt)) * 0.25; };
  EXPECT_NEAR(slid(0), expected(0), 0.02 * expected(0));
  EXPECT_NEAR(slid(0.2), expected(0.2), 0.02 * expected(0));
  EXPECT_LT(std::abs(slid(0.7)), 1e-3);  // tan 30° is 0.577
}

TEST(RigidBody, IsHeldByAPinUntilReleased) {
  Simulation simulation(
      build(ball + gravity +
            "[[pin]]\nbody = 'ball'\nuntil = 0.25\nkeyframes = [{ time = 0 }, { time = 0.25, "
            "translate = [0.1, 0, 0] }]\n[[force]]\ntype = 'point'\nname = 'push'\nforce = "
            "[1, 0, 0]\nfrom = 0.25\n"));
  for (int frame = 0; frame < 5; ++frame) simulation.advance();
  EXPECT_NEAR(centre(simulation).y(), 0.5, 1e-12);
  EXPECT_NEAR(centre(simulation).x(), 5.0 / 24 / 0.25 * 0.1, 1e-12);
  for (int frame = 0; frame < 7; ++frame) simulation.advance();
  const double mass = collider_of(simulation, 0).statistics.mass, t = 0.25;
  EXPECT_NEAR(centre(simulation).y(), 0.5 - 5 * t * t, 0.02);
  EXPECT_NEAR(velocity(simulation).x(), 0.4 + t / mass, 0.01);
  EXPECT_LT(out_of_round(simulation, 0.1), 1e-5);
}

/// A box that rises into falling cloth far faster than contact reaches keeps to its keyframes and lifts it.
TEST(Collider, LiftsClothInItsPath) {
  const auto file =
      std::filesystem::temp_directory_path() / ("lifted_" + std::to_string(::getpid()) + ".obj");
  {
    std::ofstream out(file);
    constexpr int n = 12;
    for (int i = 0; i <= n; ++i)
      for (int j = 0; j <= n; ++j) out << "v " << 0.05 * (i - n / 2) << " 0 " << 0.05 * (j - n / 2) << "\n";
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const int v = i * (n + 1) + j + 1;
        out << "f " << v << " " << v + 1 << " " << v + n + 2 << " " << v + n + 1 << "\n";
      }
  }
  Simulation simulation(build("[time]\nsteps_per_frame = 8\n[[body]]\nname = 'cloth'\nmesh = '" +
                              file.string() + "'\nmodel = 'shell'\nmaterial = 'cotton'\n" + gravity +
                              "[[collider]]\nname = 'box'\nshape = 'box'\ncenter = [0, -0.3, 0]\n"
                              "size = [0.3, 0.2, 0.3]\nkeyframes = [{time = 0, translate = [0, 0, 0]}, "
                              "{time = 0.4, translate = [0, 0.4, 0]}]\n"));
  std::filesystem::remove(file);
  for (int frame = 0; frame < 11; ++frame) simulation.advance();
  EXPECT_NEAR(centre(simulation).y(), 0.1, 1e-9);
  const Component& cloth = simulation.model().bodies[0];
  const ConstVectors x = simulation.model().of(cloth, simulation.state().positions);
  EXPECT_GT(x[x.size() / 2].y(), 0.2);
  EXPECT_GT(simulation.diagnostics().min_distance, 0);
}

}  // namespace
}  // namespace muslin
