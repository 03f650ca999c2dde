// From a scene to a model: counts, masses, stiffness, selections, loads, descriptions.
#include "muslin/scene/model.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "muslin/component/lattice/lattice_body.hpp"
#include "muslin/scene/describe.hpp"

namespace muslin {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// A folder with the meshes of these tests: the thesis's flag as a closed box and as a sheet of one polygon
/// (group "left" is a triangle at its left edge), and a thin box.
class ModelTest : public testing::Test {
 protected:
  static std::filesystem::path folder() {
    return std::filesystem::temp_directory_path() / ("muslin_model_test_" + std::to_string(getpid()));
  }
  static void SetUpTestSuite() {
    std::filesystem::create_directories(folder());
    write_box("box.obj", 1);
    write_box("thin.obj", 0.25);
    std::ofstream(folder() / "sheet.obj") << "v 0 0 0\nv 10 0 0\nv 10 6 0\nv 0 6 0\nf 1 2 3 4\n";
    std::ofstream(folder() / "groups.obj")
        << "v 0 0 0\nv 10 0 0\nv 10 6 0\nv 0 6 0\nv 1 0 0\nv 1 6 0\ng left\nf 1 5 6 4\ng right\nf 5 2 3 6\n";
    std::ofstream(folder() / "broken.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n";
  }
  static void TearDownTestSuite() { std::filesystem::remove_all(folder()); }

  static void write_box(const std::string& name, double depth) {
    std::ofstream out(folder() / name);
    for (int c = 0; c < 8; ++c) {
      out << "v " << (c & 1 ? 10 : 0) << " " << (c & 2 ? 6 : 0) << " " << (c & 4 ? depth : 0) << "\n";
    }
    out << "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
  }

  static Model build(const std::string& text) {
    return build_model(parse_scene(text, folder() / "scene.toml"));
  }
  static std::string body(const std::string& mesh, const std::string& more = "") {
    return "[[body]]\nname = 'flag'\nmesh = '" + mesh + "'\nvoxel_width = 1\nmaterial = 'thesis_flag'\n" +
           more;
  }
  static std::string message(const std::string& text, ErrorKind kind = ErrorKind::input) {
    try {
      build(text);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), kind);
      return error.what();
    }
    return "no error";
  }
};

TEST_F(ModelTest, TheFlagHasTheCountsOfTheThesis) {
  for (const std::string& text : {body("box.obj"), body("sheet.obj", "mass = 'cells'\nthickness = 1\n")}) {
    const Model model = build(text);
    const BodyStatistics& s = model.bodies[0].statistics;
    EXPECT_EQ(s.vertices, 154);
    EXPECT_EQ(s.voxels, 60);
    EXPECT_EQ(s.tetrahedra, 360);
    EXPECT_THAT(s.springs, ElementsAre(349, 256, 60));
    EXPECT_NEAR(s.mass, 600, 1e-9);
    EXPECT_NEAR(s.coverage, 1, 1e-12);
    EXPECT_THAT(model.warnings, testing::IsEmpty());
  }
  const Model full = build(body("box.obj", "bracing = 'full'\n"));
  EXPECT_THAT(full.bodies[0].statistics.springs, ElementsAre(349, 512, 240));
}

TEST_F(ModelTest, SolidMassFollowsTheFillAndCellMassDoesNot) {
  const Model solid = build(body("thin.obj"));
  EXPECT_NEAR(solid.bodies[0].statistics.mass, 10 * 10 * 6 * 0.25, 1e-6);
  const Model cells = build(body("thin.obj", "mass = 'cells'\n"));
  EXPECT_NEAR(cells.bodies[0].statistics.mass, 600, 1e-9);
  EXPECT_NEAR(cells.masses[0], 10.0 / 8, 1e-12);  // a corner belongs to one voxel
  // Stiffness goes with mass, so both sound alike.
  EXPECT_NEAR(solid.bodies[0].statistics.stable_step, cells.bodies[0].statistics.stable_step, 1e-6);
}

TEST_F(ModelTest, ASpringsConstantIsModulusTimesWidthTimesWeight) {
  // All edges along x stretched by 1 %: W = Σ ½ k (w/100)², with (7·2) rows of 10 edges of k = 20000·w.
  const auto energy = [](const Model& model) {
    std::vector<Vec3> x = model.rest_positions;
    for (Vec3& p : x) p.x() *= 1.01;
    double sum = 0;
    for (const PotentialTerm& term : model.potentials) sum += term.potential->value(x);
    return sum;
  };
  const std::string material = "[body.material]\ndensity = 10\nedge_modulus = 20000\n";
  const std::string flag = "[[body]]\nname = 'flag'\nmesh = 'box.obj'\nvoxel_width = 1\n";
  EXPECT_NEAR(energy(build(flag + material)), 140 * 0.5 * 20000 * 1e-4, 1e-6);
  // Shared: a voxel has four edges along x, each counts a quarter for it: 60 full edges.
  EXPECT_NEAR(energy(build(flag + "boundary_springs = 'shared'\n" + material)), 60 * 0.5 * 20000 * 1e-4,
              1e-6);
}

TEST_F(ModelTest, NoForcesAtRest) {
  const Model model = build(
      "[[body]]\nmesh = 'box.obj'\nvoxel_width = 1\n[body.material]\nbase = 'thesis_flag'\nvolume_modulus = "
      "10\n");
  std::vector<Vec3> force(model.vertex_count(), Vec3::Zero());
  for (const PotentialTerm& term : model.potentials)
    term.potential->add_gradient(model.rest_positions, force);
  EXPECT_EQ(model.potentials.size(), 2u);
  for (const Vec3& f : force) EXPECT_LT(f.norm(), 1e-9);
}

TEST_F(ModelTest, PlacementScalesRotatesAndTranslates) {
  const Model model = build(body("box.obj", "scale = 0.5\nrotate = [0, 0, 90]\ntranslate = [100, 0, 0]\n"));
  const Box bounds = model.bodies[0].mesh.bounds();
  EXPECT_EQ(bounds.min(), Vec3(97, 0, 0));
  EXPECT_EQ(bounds.max(), Vec3(100, 5, 0.5));
}

TEST_F(ModelTest, SelectionsChooseVertices) {
  const auto held = [](const std::string& where) {
    return build(body("box.obj", "[[pin]]\nwhere = { " + where + " }\n")).pins.front().vertices.size();
  };
  EXPECT_EQ(held("plane = { point = [0, 0, 0], normal = [1, 0, 0] }"), 14u);
  EXPECT_EQ(held("plane = { point = [0.5, 0, 0], normal = [2, 0, 0] }"), 28u);  // midway: both layers
  EXPECT_EQ(held("box = [[0, 0, 0], [1, 6, 0]]"), 14u);
  EXPECT_EQ(held("sphere = { center = [0, 0, 0], radius = 1 }"), 4u);
  EXPECT_EQ(held("line = { from = [0, 3, 0.5], to = [10, 3, 0.5] }"), 22u);  // both sides of the sheet
  EXPECT_EQ(held("line = { from = [0, 3, 0], to = [10, 3, 0], distance = 0.1 }"), 11u);
  EXPECT_EQ(held("nearest = [0.2, 5.9, 0.1]"), 1u);
  EXPECT_EQ(held("nearest = [[0, 6, 0.5], [10, 6, 0.5]]"), 4u);  // each has two as near
  EXPECT_EQ(held("plane = { point = [0, 0, 0], normal = [1, 0, 0] }, nearest = [10, 6, 0]"), 1u);
  EXPECT_EQ(held("plane = { point = [0, 0, 0], normal = [1, 0, 0] }, box = [[0, 6, 0], [10, 6, 1]]"), 2u);
}

TEST_F(ModelTest, AGroupIsHeldByTheVerticesThatCarryIt) {
  const Model model = build(body("groups.obj", "thickness = 1\n[[pin]]\nwhere = { group = 'left' }\n"));
  for (const int v : model.pins[0].vertices) {
    EXPECT_LE(model.rest_positions[static_cast<std::size_t>(v)].x(), 1 + 1e-9);
  }
  EXPECT_EQ(model.pins[0].vertices.size(), 28u);
  EXPECT_THAT(message(body("groups.obj", "thickness = 1\n[[pin]]\nwhere = { group = 'lefd' }\n")),
              HasSubstr("has no group `lefd`; did you mean `left`?"));
  EXPECT_THAT(message(body("box.obj", "[[pin]]\nwhere = { group = 'left' }\n")), HasSubstr("group"));
}

TEST_F(ModelTest, EmptySelectionNamesTheNearestVertex) {
  EXPECT_THAT(
      message(
          body("box.obj", "[[pin]]\nname = 'p'\nwhere = { sphere = { center = [12, 6, 1], radius = 1 } }\n")),
      HasSubstr("scene.toml:8:9: pin p: no vertex of body `flag` lies within `sphere`; the nearest is "
                "[10, 6, 1], 1 m outside"));
}

TEST_F(ModelTest, MeshErrorsNameTheSceneAndTheMesh) {
  EXPECT_THAT(message(body("missing.obj"), ErrorKind::file),
              testing::AllOf(HasSubstr("scene.toml:3:8: "), HasSubstr("missing.obj")));
  EXPECT_THAT(message(body("broken.obj")),
              testing::AllOf(HasSubstr("scene.toml:3:8: "), HasSubstr("broken.obj")));
}

TEST_F(ModelTest, ForcesActOnTheirBodies) {
  const std::string two = body("box.obj") +
                          "[[body]]\nname = 'other'\nmesh = 'box.obj'\nvoxel_width = 1\n"
                          "translate = [0, 0, 5]\nmaterial = 'thesis_flag'\n";
  const Model model = build(two +
                            "[[force]]\ntype = 'gravity'\n[[force]]\ntype = 'gravity'\nbody = 'other'\n"
                            "acceleration = [1, 0, 0]\n"
                            "[[force]]\ntype = 'point'\nbody = 'other'\nforce = [0, 7, 0]\n"
                            "where = { nearest = [0, 0, 5] }\n[[probe]]\nbody = 'other'\nat = [5, 3, 5.5]\n");
  ASSERT_EQ(model.bodies.size(), 2u);
  ASSERT_EQ(model.vertex_count(), 308u);
  StepContext step;
  step.time_end = step.dt = 0.01;
  step.anchor = model.rest_positions;
  const std::vector<Vec3> still(model.vertex_count(), Vec3::Zero());
  step.positions = model.rest_positions;
  step.velocities = still;
  std::vector<Vec3> sums;
  for (const LoadTerm& load : model.loads) {
    std::vector<Vec3> gradient(model.vertex_count(), Vec3::Zero());
    load.load->potential(step)->add_gradient(model.rest_positions, gradient);
    Vec3 sum = Vec3::Zero();
    for (const Vec3& g : gradient) sum -= g;
    sums.push_back(sum);
  }
  ASSERT_EQ(sums.size(), 3u);
  EXPECT_LT((sums[0] - Vec3(0, -9.8 * 1200, 0)).norm(), 1e-6);
  EXPECT_LT((sums[1] - Vec3(600, 0, 0)).norm(), 1e-6);
  EXPECT_LT((sums[2] - Vec3(0, 7, 0)).norm(), 1e-12);
  EXPECT_EQ(model.loads[0].role, EnergyRole::potential);
  // The probe stands where it was put, on the second body.
  EXPECT_EQ(model.probes[0].body, 1);
  Vec3 at;
  model.probes[0].point.apply(model.of(model.bodies[1], model.rest_positions), std::span(&at, 1));
  EXPECT_LT((at - Vec3(5, 3, 5.5)).norm(), 1e-12);
  // Each body's springs see their own vertices.
  std::vector<Vec3> moved = model.rest_positions;
  moved.back().x() += 0.1;
  EXPECT_EQ(model.potentials[0].potential->value(moved), 0);
  EXPECT_GT(model.potentials[1].potential->value(moved), 0);
}

TEST_F(ModelTest, TheStableStepBoundsTheFastestOscillation) {
  // ω² is the largest eigenvalue of M⁻¹K, by power iteration; symplectic Euler is stable below 2/ω.
  const Model model = build(body("box.obj"));
  std::vector<Vec3> p(model.vertex_count());
  for (std::size_t v = 0; v < p.size(); ++v)
    p[v] = Vec3(std::sin(3.0 * v), std::cos(5.0 * v), std::sin(7.0 * v));
  double squared = 0;
  for (int round = 0; round < 300; ++round) {
    std::vector<Vec3> y(p.size(), Vec3::Zero());
    model.potentials[0].potential->add_hessian_product(model.rest_positions, p, y);
    double norm = 0;
    for (std::size_t v = 0; v < p.size(); ++v) norm += (y[v] /= model.masses[v]).squaredNorm();
    squared = std::sqrt(norm);
    for (std::size_t v = 0; v < p.size(); ++v) p[v] = y[v] / squared;
  }
  const double exact = 2 / std::sqrt(squared);
  EXPECT_LE(model.bodies[0].statistics.stable_step, exact * (1 + 1e-6));
  EXPECT_GE(model.bodies[0].statistics.stable_step, exact / 1.6);
}

TEST_F(ModelTest, SymplecticEulerTakesAsManyStepsAsStabilityAllows) {
  const Model model = build(body("box.obj", "[solver]\nintegrator = 'symplectic_euler'\n"));
  ASSERT_TRUE(model.scene.time.steps_per_frame);
  const double longest = 0.9 * model.bodies[0].statistics.stable_step;
  EXPECT_LE(model.scene.time.step(), longest);
  const int fewer = *model.scene.time.steps_per_frame - 1;
  EXPECT_TRUE(fewer == 0 || 1 / (24.0 * fewer) > longest) << "no more steps than needed";
  EXPECT_FALSE(build(body("box.obj")).scene.time.steps_per_frame);
}

TEST_F(ModelTest, WarnsOfStepsThatAreTooLongForSymplecticEuler) {
  const Model model = build(body("box.obj", "[solver]\nintegrator = 'symplectic_euler'\n"));
  EXPECT_THAT(model.warnings, testing::IsEmpty());
  const Model coarse =
      build(body("box.obj", "[solver]\nintegrator = 'symplectic_euler'\n[time]\nsteps_per_frame = 1\n"));
  EXPECT_THAT(coarse.warnings, ElementsAre(HasSubstr("symplectic_euler is unstable")));
}

TEST_F(ModelTest, SheetWithoutThicknessIsOneVoxelThickWithAWarning) {
  const Model model = build(body("sheet.obj"));
  EXPECT_TRUE(model.bodies[0].sheet);
  EXPECT_EQ(as_lattice(model.bodies[0])->thickness, 1);
  EXPECT_THAT(model.warnings, ElementsAre(HasSubstr("set `thickness`")));
}

TEST_F(ModelTest, ThePivotOfAPinIsTheCentreOfItsVertices) {
  const Model model =
      build(body("box.obj", "[[pin]]\nwhere = { plane = { point = [0, 0, 0], normal = [1, 0, 0] } }\n"));
  EXPECT_LT((model.pins[0].motion.pivot - Vec3(0, 3, 0.5)).norm(), 1e-12);
}

TEST_F(ModelTest, IsDescribedAsJsonAndText) {
  const Model model = build(body("box.obj", "[[pin]]\nname = 'p'\nwhere = { nearest = [0, 0, 0] }\n"));
  const auto json = nlohmann::json::parse(describe_json(model));
  EXPECT_EQ(json["bodies"][0]["name"], "flag");
  EXPECT_EQ(json["bodies"][0]["vertices"], 154);
  EXPECT_EQ(json["bodies"][0]["voxels"], 60);
  EXPECT_EQ(json["bodies"][0]["tetrahedra"], 360);
  EXPECT_EQ(json["bodies"][0]["springs"]["edge"], 349);
  EXPECT_EQ(json["bodies"][0]["springs"]["face_diagonal"], 256);
  EXPECT_EQ(json["bodies"][0]["springs"]["body_diagonal"], 60);
  EXPECT_NEAR(json["bodies"][0]["mass"].get<double>(), 600, 1e-9);
  EXPECT_EQ(json["time"]["frames"], 48);
  EXPECT_EQ(json["time"]["steps_per_frame"], "auto");
  EXPECT_TRUE(json["time"]["steps"].is_null());
  EXPECT_EQ(json["pins"][0]["vertices"], 1);
  const std::string text = describe_text(model);
  EXPECT_THAT(text, HasSubstr("349 edge, 256 face diagonal, 60 body diagonal"));
  EXPECT_THAT(text, HasSubstr("pin p: 1 held vertex"));
  EXPECT_THAT(text, HasSubstr("2 s in 48 frames, steps as the motion needs them, of at most 0.04167 s, by "
                              "implicit_euler, effort normal, tolerance 0.2"));
  const Model fixed = build(body("box.obj", "[time]\nsteps_per_frame = 10\n"));
  EXPECT_EQ(nlohmann::json::parse(describe_json(fixed))["time"]["steps"], 480);
  EXPECT_THAT(describe_text(fixed), HasSubstr("2 s in 48 frames, 480 steps of 0.004167 s by implicit_euler"));
  EXPECT_THAT(describe_text(model.bodies[0].report, "box.obj"), HasSubstr("closed, volume 60 m³"));
  EXPECT_EQ(nlohmann::json::parse(describe_json(model.bodies[0].report, "box.obj"))["faces"], 6);
}

}  // namespace
}  // namespace muslin
