// `[[pressure]]`: what is read, refused and built, and a sphere that grows as Laplace and Hooke say.
#include "muslin/scene/pressure.hpp"

#include <array>
#include <cmath>
#include <fstream>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "cache/scratch.hpp"
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
  MeshGroup upper{"upper", {}, {}}, all{"all", {}, {}};
  for (int v = 0; v < static_cast<int>(ball.vertex_count()); ++v) {
    if (ball.positions[static_cast<std::size_t>(v)].y() > 0) upper.vertices.push_back(v);
    all.vertices.push_back(v);
  }
  ball.groups = {upper, all};
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

/// x of all vertices after a tenth of a second.
std::vector<Vec3> pushed(const std::string& pressure) {
  Simulation simulation(std::make_shared<const Model>(build_model(read(pressure))));
  for (int frame = 0; frame < 3; ++frame) simulation.advance();
  const ConstVectors x = simulation.state().positions;
  return {x.begin(), x.end()};
}

TEST(PressureScene, MapOfOneValueEqualsTheNumberBitForBit) {
  const std::string pressure = "[[pressure]]\npressure = 200\n";
  const std::vector<Vec3> plain = pushed(pressure);
  EXPECT_EQ(pushed(pressure + "weight = { map = 'upper', from = 1, to = 1 }"), plain);
  EXPECT_EQ(pushed("[[pressure]]\npressure = 400\nweight = { map = 'upper', from = 0.5, to = 0.5 }"), plain);
  EXPECT_EQ(pushed("[[pressure]]\npressure = -400\nweight = -0.5"), plain);
  EXPECT_NE(pushed(pressure + "weight = { map = 'upper', from = 0, to = 1 }"), plain);
}

TEST(PressureScene, MapPushesWithTheIntegralOfPressureAndItsWorkIsInTheAccount) {
  const auto model = std::make_shared<const Model>(
      build_model(read("[[pressure]]\npressure = 10\nweight = { map = 'upper', from = 0, to = 1 }\n[solver]\n"
                       "effort = 'exact'\n")));
  // ∫ p n dA at the start: linear on triangles, each has the mean of its corners.
  const Mesh& ball = model->bodies[0].mesh;
  Vec3 force = Vec3::Zero();
  for (const Vec3i& t : triangulate(ball).triangles) {
    const auto at = [&](int c) { return ball.positions[static_cast<std::size_t>(t[c])]; };
    int upper = 0;
    for (int c = 0; c < 3; ++c) upper += at(c).y() > 0 ? 1 : 0;
    force += 10.0 * upper / 3 * 0.5 * (at(1) - at(0)).cross(at(2) - at(0));
  }
  EXPECT_GT(force.y(), 0.9 * 10 * std::numbers::pi * radius * radius) << "the pressure on half a ball";
  std::vector<Vec3> gradient(model->vertex_count(), Vec3::Zero());
  term(*model, "pressure0")->potential->add_gradient(model->rest_positions, gradient);
  StepContext step;
  step.positions = model->rest_positions;
  step.velocities = model->rest_positions;
  step.anchor = model->rest_positions;
  step.time_end = 0.1;
  ASSERT_EQ(model->loads.back().name, "pressure0 by map");
  EXPECT_EQ(model->loads.back().role, EnergyRole::work);
  model->loads.back().load->potential(step)->add_gradient(model->rest_positions, gradient);
  Vec3 acting = Vec3::Zero();
  for (const Vec3& g : gradient) acting -= g;
  EXPECT_LT((acting - force).norm(), 1e-12 * force.norm());

  Simulation simulation(model);
  const double before = simulation.diagnostics().balance();
  for (int frame = 0; frame < 8; ++frame) simulation.advance();
  const Diagnostics after = simulation.diagnostics();
  EXPECT_GT(after.work, 0.01 * after.kinetic);
  EXPECT_NEAR(after.balance(), before, 1e-2 * after.work);
}

TEST(PressureScene, MapsAreListedAndRefusedByName) {
  const Model model =
      build_model(read("[[pressure]]\nname = 'air'\npressure = 5\nweight = { map = 'upper', from = 0, to = 1 "
                       "}\n"));
  ASSERT_EQ(model.bodies[0].maps.size(), 1U);
  EXPECT_EQ(model.bodies[0].maps.front().variation.key, "air.weight");
  EXPECT_EQ(model.bodies[0].material_hash(0), build_model(read("")).bodies[0].material_hash(0))
      << "it may change on a resume";
  const std::string pressure = "[[pressure]]\npressure = 5\nweight = ";
  EXPECT_THAT(message(pressure + "{ map = 'uper', from = 0, to = 1 }"),
              AllOf(HasSubstr("scene.toml:12:10:"), HasSubstr("did you mean `upper`?")));
  const test::Scratch scratch;
  const std::string file = (scratch.path() / "short.csv").string();
  std::ofstream(file) << "1\n0\n";
  EXPECT_THAT(
      message(pressure + "{ map = '" + file + "', from = 0, to = 1 }"),
      HasSubstr("short.csv` of `weight` has 2 numbers, but the mesh of body `shell` has 642 vertices"));
  std::ofstream(file) << "1\nnan\n";
  EXPECT_THAT(message(pressure + "{ map = '" + file + "', from = 0, to = 1 }"),
              HasSubstr("line 2: a number 'nan' is not a finite number"));
  EXPECT_THAT(message(pressure + "{ map = 'upper', from = 0, to = 2 }"), HasSubstr("`weight` is 2"));
  EXPECT_THAT(message(pressure + "{ map = 'upper', from = 0, to = nan }"), HasSubstr("to"));
  EXPECT_THAT(message(pressure + "0.5\ngas = true"), HasSubstr("a gas has one pressure everywhere"));
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
