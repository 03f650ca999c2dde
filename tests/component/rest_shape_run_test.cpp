// rest_mesh with vertices of its own, and rest = "uv": a tube sewn of a flat sheet has no hoop strain, bends
// to its radius, and its forces keep momentum.
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>

#include "support/tube.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "muslin/component/shell/shell_body.hpp"
#include "muslin/core/error.hpp"
#include "muslin/simulation/simulation.hpp"

namespace muslin {
namespace {

using testing::HasSubstr;

constexpr double perimeter = 0.5, length = 0.06, rigidity = 1e-3;
constexpr int around = 24;

Scene scene(const std::string& keys, const Mesh& mesh) {
  Scene scene = parse_scene(
      "[time]\nframe_rate = 50\nduration = 1\n[solver]\neffort = \"exact\"\n"
      "[[body]]\nname = \"cloth\"\nmesh = \"tube.obj\"\nmodel = \"shell\"\n"
      "contact = false\ncompression = \"elastic\"\n" +
          keys +
          "\nmaterial = { areal_density = 0.1, membrane_warp = 100, bending_warp = 1e-3, poisson = 0, "
          "mass_damping = 20 }\n",
      "scene.toml");
  scene.meshes["tube.obj"] = std::make_shared<Mesh>(mesh);
  scene.meshes["pattern.obj"] = std::make_shared<Mesh>(test::sewn_tube(around, 3, perimeter, length).flat);
  return scene;
}

const std::string pattern = "warp = [1, 0, 0]\nrest_mesh = \"pattern.obj\"";

TEST(RestShapeRun, SewnTubeOfAFlatSheetHasOnlyTheEnergyOfItsCurvature) {
  const test::Tube tube = test::sewn_tube(around, 3, perimeter, length);
  const Model model = build_model(scene(pattern, tube.sewn));
  const double curvature = 2 * std::numbers::pi / perimeter;
  const double bent = 0.5 * rigidity * curvature * curvature * perimeter * length;
  ASSERT_EQ(model.potentials[0].name, "cloth: membrane");
  EXPECT_LT(model.potentials[0].potential->value(model.rest_positions), 1e-20);
  EXPECT_NEAR(model.potentials[1].potential->value(model.rest_positions), bent, 1e-6 * bent);
  EXPECT_NEAR(model.bodies[0].statistics.mass, 0.1 * perimeter * length, 1e-15);
}

TEST(RestShapeRun, FlattenedTubeBecomesRound) {
  test::Tube tube = test::sewn_tube(around, 3, perimeter, length);
  for (Vec3& x : tube.sewn.positions) x = Vec3(1.25 * x.x(), 0.7 * x.y(), x.z());
  Simulation simulation(std::make_shared<const Model>(build_model(scene(pattern, tube.sewn))));
  while (simulation.frame() < 50) simulation.advance();
  Vec3 center = Vec3::Zero();
  for (const Vec3& x : simulation.state().positions) center += x;
  center /= static_cast<double>(simulation.state().positions.size());
  for (const Vec3& x : simulation.state().positions)
    EXPECT_NEAR((x - center).head<2>().norm(), tube.radius, 1e-3 * tube.radius);
}

TEST(RestShapeRun, ForcesOfSeamsKeepMomentum) {
  // A gathered seam: the pattern is longer on one side.
  test::Tube tube = test::sewn_tube(around, 3, perimeter, length);
  Scene gathered = scene(pattern, tube.sewn);
  for (std::size_t v = 0; v < tube.flat.positions.size(); v += around + 1) tube.flat.positions[v].z() *= 1.3;
  gathered.meshes["pattern.obj"] = std::make_shared<Mesh>(tube.flat);
  const Model model = build_model(gathered);
  const std::vector<Vec3> x =
      test::sum(model.rest_positions, 1, test::random_vectors(model.vertex_count(), 0.004, 5));
  std::vector<Vec3> force(x.size(), Vec3::Zero());
  for (const auto& term : model.potentials) term.potential->add_gradient(x, force);
  Vec3 sum = Vec3::Zero(), moment = Vec3::Zero();
  double size = 0;
  for (std::size_t v = 0; v < x.size(); ++v) {
    sum += force[v];
    moment += x[v].cross(force[v]);
    size += force[v].norm();
  }
  ASSERT_GT(size, 1e-3);
  EXPECT_LT(sum.norm(), 1e-13 * size);
  EXPECT_LT(moment.norm(), 1e-13 * size);
}

TEST(RestShapeRun, TextureIsTheSamePattern) {
  test::Tube tube = test::sewn_tube(around, 3, perimeter, length);
  for (const Vec3& p : tube.flat.positions) tube.sewn.uvs.emplace_back(p.x(), p.z());
  tube.sewn.corner_uvs = tube.flat.face_vertices;
  const Model sewn = build_model(scene(pattern, tube.sewn));
  for (const char* keys : {"rest = \"uv\"", "rest = \"uv\"\nuv_scale = 1"}) {
    const Model textured = build_model(scene(keys, tube.sewn));
    EXPECT_LT(textured.potentials[0].potential->value(textured.rest_positions), 1e-20) << keys;
    EXPECT_NEAR(textured.potentials[1].potential->value(textured.rest_positions),
                sewn.potentials[1].potential->value(sewn.rest_positions), 1e-12)
        << keys;
    EXPECT_THAT(textured.warnings, testing::IsEmpty());
  }
  EXPECT_THAT(
      build_model(scene("rest = \"uv\"\nuv_scale = 0.01", tube.sewn)).warnings,
      testing::ElementsAre(HasSubstr("stress-free shape is 0.01 times as long as the mesh; correct or")));
}

TEST(RestShapeRun, IsDescribed) {
  test::Tube tube = test::sewn_tube(around, 3, perimeter, length);
  const Model model = build_model(scene(pattern, tube.sewn));
  EXPECT_THAT(model.bodies[0].description(),
              HasSubstr("rest        pattern.obj, 3 hinges on seams; stretched to 1 at the start"));
  const auto rest = nlohmann::json::parse(model.bodies[0].description_json())["rest"];
  EXPECT_EQ(rest["of"], "rest_mesh");
  EXPECT_EQ(rest["seam_hinges"], 3);
  EXPECT_NEAR(rest["start_stretch"].get<double>(), 1, 1e-12);
}

TEST(RestShapeRun, PolygonWithoutTextureIsAWarning) {
  Mesh mesh = test::flat_sheet(4, 3, 0.4, 0.3);
  test::add_flat_uvs(mesh);
  std::fill_n(mesh.corner_uvs.begin() + 8, 4, 3);
  EXPECT_THAT(build_model(scene("", mesh)).warnings,
              testing::ElementsAre(
                  "body cloth: 1 of 12 polygons have no place in the texture; their threads continue those "
                  "of their neighbours; unwrap them, or give `warp` a direction"));
  std::fill_n(mesh.corner_uvs.begin() + 12, 4, -1);
  EXPECT_THAT(build_model(scene("rest = \"uv\"", mesh)).warnings,
              testing::ElementsAre(
                  "body cloth: 2 of 12 polygons have no place in the texture; their stress-free shape is "
                  "that of the mesh, and their threads continue those of their neighbours; unwrap them"));
}

TEST(RestShapeRun, ContradictionsAreErrors) {
  const auto message = [](const std::string& keys) -> std::string {
    try {
      scene(keys, {});
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_THAT(message("uv_scale = 1"), HasSubstr("`uv_scale` has no effect without `rest = \"uv\"`"));
  EXPECT_THAT(message("rest = \"uv\"\nrest_mesh = \"pattern.obj\""), HasSubstr("given twice"));
}

}  // namespace
}  // namespace muslin
