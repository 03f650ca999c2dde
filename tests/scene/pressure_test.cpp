// `[[pressure]]`: what is read, refused and built, and a sphere that grows as Laplace and Hooke say.
#include "muslin/scene/pressure.hpp"

#include <cmath>
#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "muslin/core/error.hpp"
#include "muslin/geometry/shapes.hpp"
#include "muslin/scene/model.hpp"
#include "muslin/simulation/simulation.hpp"

namespace muslin {
namespace {

using testing::HasSubstr;

constexpr double radius = 0.1, stiffness = 1000;

/// A scene of one shell: a ball, or a square.
Scene read(const std::string& pressure, const std::string& mesh = "ball") {
  Scene scene =
      parse_scene("[time]\nduration = 2\n[[body]]\nname = 'shell'\nmodel = 'shell'\nmesh = '" + mesh +
                      "'\ncompression = 'elastic'\nwarp = [1, 0.3, 0.2]\nmaterial = { areal_density = 0.2, "
                      "membrane_warp = 1000, "
                      "bending_warp = 1e-7, "
                      "poisson = 0.25, mass_damping = 20 }\n" +
                      pressure,
                  "scene.toml");
  Mesh ball = sphere_mesh(Vec3::Zero(), radius), square;
  square.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  square.add_face(std::array{0, 1, 2, 3});
  scene.meshes["ball"] = std::make_shared<const Mesh>(ball);
  scene.meshes["square"] = std::make_shared<const Mesh>(square);
  return scene;
}

std::string message(const std::string& pressure, const std::string& mesh = "ball") {
  try {
    build_model(read(pressure, mesh));
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    return error.what();
  }
  return "no error";
}

const PotentialTerm* term(const Model& model, const std::string& name) {
  for (const PotentialTerm& t : model.potentials)
    if (t.name == name) return &t;
  return nullptr;
}

double mean_radius(const Simulation& simulation) {
  double sum = 0;
  for (const Vec3& x : simulation.state().positions) sum += x.norm();
  return sum / static_cast<double>(simulation.state().positions.size());
}

TEST(PressureScene, SphereGrowsByLaplaceAndHooke) {
  // Tension p r/2 over stiffness: the radius grows by the share p r (1 − ν)/(2 K).
  const double p = 200, expected = p * radius * 0.75 / (2 * stiffness);
  Simulation simulation(std::make_shared<const Model>(
      build_model(read("[[pressure]]\npressure = 200\n[solver]\neffort = 'exact'\n"))));
  for (int frame = 0; frame < 48; ++frame) simulation.advance();
  const double growth = mean_radius(simulation) / radius - 1;
  EXPECT_NEAR(growth / expected, 1, 0.03);  // strains of 0.75 %, 642 vertices
}

TEST(PressureScene, GasFollowsBoyle) {
  const Model model = build_model(read("[[pressure]]\nname = 'air'\npressure = 1000\ngas = true\n"));
  const PotentialTerm* air = term(model, "air");
  ASSERT_NE(air, nullptr);
  EXPECT_EQ(air->role, EnergyRole::potential);
  // Grown evenly by s: x·∂W = −3 p V with p = (p_a + p_0)/s³ − p_a.
  const auto pressure = [&](double s) {
    std::vector<Vec3> x = model.rest_positions, g(x.size(), Vec3::Zero());
    for (Vec3& v : x) v *= s;
    air->potential->add_gradient(x, g);
    double work = 0, volume = 0;
    for (std::size_t v = 0; v < x.size(); ++v) work += x[v].dot(g[v]);
    for (const Vec3i& t : triangulate(model.bodies[0].mesh).triangles)
      volume += x[static_cast<std::size_t>(t[0])].dot(
                    x[static_cast<std::size_t>(t[1])].cross(x[static_cast<std::size_t>(t[2])])) /
                6;
    return -work / (3 * volume);
  };
  EXPECT_NEAR(pressure(1), 1000, 1e-6);
  EXPECT_NEAR(pressure(1.1), 102325 / std::pow(1.1, 3) - 101325, 1e-6);
  EXPECT_NEAR(pressure(0.9), 102325 / std::pow(0.9, 3) - 101325, 1e-6);
}

TEST(PressureScene, KeyframesDoWorkAndEnergyBalances) {
  const auto model = std::make_shared<const Model>(build_model(
      read("[[pressure]]\npressure = { keyframes = [{ time = 0, value = 0 }, { time = 0.5, value = 300 }] }\n"
           "until = 1\n[solver]\neffort = 'exact'\n")));
  EXPECT_EQ(model->loads.back().name, "pressure0");
  EXPECT_EQ(model->loads.back().role, EnergyRole::work);
  Simulation simulation(model);
  const double before = simulation.diagnostics().balance();
  double largest = 0;
  for (int frame = 0; frame < 40; ++frame) {
    simulation.advance();
    largest = std::max(largest, simulation.diagnostics().elastic);
  }
  EXPECT_NEAR(simulation.diagnostics().balance(), before, 1e-2 * largest);
  EXPECT_GT(largest, 0);
  EXPECT_NEAR(mean_radius(simulation), radius, 1e-3 * radius);  // the pressure is gone
}

TEST(PressureScene, ResolvedSceneHasItsDefaults) {
  const auto json = nlohmann::json::parse(read("[[pressure]]\npressure = 5\n").resolved)["pressure"][0];
  EXPECT_EQ(json["name"], "pressure0");
  EXPECT_EQ(json["body"], "shell");
  EXPECT_EQ(json["pressure"], 5);
  EXPECT_EQ(json["gas"], false);
  EXPECT_EQ(json["atmosphere"], 101325);
}

TEST(PressureScene, RefusesImpossiblePressures) {
  EXPECT_THAT(message("[[pressure]]\n"), HasSubstr("pressure"));
  EXPECT_THAT(message("[[pressure]]\npressure = 'much'\n"), HasSubstr("pressure"));
  EXPECT_THAT(message("[[pressure]]\npressure = 1e12\n"), HasSubstr("pressure"));
  EXPECT_THAT(message("[[pressure]]\npressure = { keyframes = [] }\n"), HasSubstr("keyframe"));
  EXPECT_THAT(message("[[pressure]]\npressure = { keyframes = [{ time = 0, value = 1e12 }] }\n"),
              HasSubstr("1000000000000"));
  EXPECT_THAT(message("[[pressure]]\npresure = 1\npressure = 2\n"), HasSubstr("pressure"));
  EXPECT_THAT(message("[[pressure]]\npressure = 1\nbody = 'shel'\n"), HasSubstr("shell"));
  EXPECT_THAT(message("[[pressure]]\npressure = 1\natmosphere = 5\n"), HasSubstr("gas"));
  EXPECT_THAT(message("[[pressure]]\npressure = -2e5\ngas = true\n"), HasSubstr("negative amount"));
  EXPECT_THAT(message("[[pressure]]\npressure = 1\nfrom = 2\nuntil = 1\n"), HasSubstr("until"));
  EXPECT_THAT(message("[[pressure]]\npressure = 1\ngas = true\n", "square"), HasSubstr("no volume"));
}

TEST(PressureScene, WarnsOfClosedHoles) {
  const Model model = build_model(read("[[pressure]]\npressure = 1\n", "square"));
  EXPECT_THAT(model.warnings, testing::Contains(HasSubstr("flat lids close a hole")));
}

}  // namespace
}  // namespace muslin
