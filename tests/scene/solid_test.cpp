// `law = "neo_hookean"` of a lattice's material: what is read, refused, resolved and built.
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "muslin/core/error.hpp"
#include "muslin/scene/model.hpp"
#include "muslin/scene/validate.hpp"
#include "muslin/simulation/simulation.hpp"

namespace muslin {
namespace {

using testing::HasSubstr;

class SolidScene : public testing::Test {
 protected:
  static std::filesystem::path folder() {
    return std::filesystem::temp_directory_path() / ("muslin_solid_test_" + std::to_string(getpid()));
  }
  static void SetUpTestSuite() {
    std::filesystem::create_directories(folder());
    std::ofstream out(folder() / "box.obj");
    for (int c = 0; c < 8; ++c)
      out << "v " << (c & 1 ? 0.4 : 0) << " " << (c & 2 ? 0.2 : 0) << " " << (c & 4 ? 0.2 : 0) << "\n";
    out << "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
    std::ofstream(folder() / "foam.toml") << "name = 'foam'\n[lattice]\ndensity = 60\nlaw = "
                                             "'neo_hookean'\nyoungs_modulus = 4e4\npoisson = 0.1\n";
  }
  static void TearDownTestSuite() { std::filesystem::remove_all(folder()); }

  static std::string text(const std::string& material) {
    return "[[body]]\nname = 'block'\nmesh = 'box.obj'\nvoxel_width = 0.1\nmaterial = " + material + "\n";
  }
  static Scene read(const std::string& material) {
    return parse_scene(text(material), folder() / "scene.toml");
  }
  static Model build(const std::string& material) { return build_model(read(material)); }
  static std::vector<std::string> names(const Model& model) {
    std::vector<std::string> all;
    for (const PotentialTerm& term : model.potentials) all.push_back(term.name);
    return all;
  }
  static std::string message(const std::string& material) {
    try {
      build(material);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input);
      return error.what();
    }
    return "no error";
  }
};

TEST_F(SolidScene, ReplacesSprings) {
  EXPECT_THAT(names(build("{ density = 1000, law = 'neo_hookean', youngs_modulus = 1e5 }")),
              testing::ElementsAre("block: solid"));
  EXPECT_THAT(names(build("{ base = 'rubber', law = 'neo_hookean', youngs_modulus = 1e5 }")),
              testing::ElementsAre("block: solid"));
  EXPECT_THAT(names(build("{ density = 1000, youngs_modulus = 1e5 }")),
              testing::ElementsAre("block: springs"));
  EXPECT_THAT(names(build("{ base = 'rubber' }")), testing::Not(testing::Contains("block: solid")));
}

TEST_F(SolidScene, HasTheEnergyOfTheLaw) {
  // Stretched by 1 % along x with its sides held: ½ (λ + 2μ) ε², λ Lamé's.
  const Model model = build("{ density = 1000, law = 'neo_hookean', youngs_modulus = 1e5, poisson = 0.25 }");
  std::vector<Vec3> x = model.rest_positions;
  for (Vec3& p : x) p.x() *= 1 + 1e-4;
  const double volume = 0.4 * 0.2 * 0.2, modulus = 1e5 * 0.75 / (1.25 * 0.5);
  EXPECT_NEAR(model.potentials[0].potential->value(x) / (0.5 * modulus * 1e-8 * volume), 1, 1e-3);
}

TEST_F(SolidScene, IsNotWarnedOfMissingDiagonals) {
  EXPECT_THAT(read("{ density = 1000, law = 'neo_hookean', youngs_modulus = 1e5 }").warnings,
              testing::IsEmpty());
  EXPECT_THAT(read("{ density = 1000, edge_modulus = 1e5 }").warnings, testing::SizeIs(1));
}

TEST_F(SolidScene, MaterialFileHasTheKeysToo) {
  const Scene scene = read("'foam.toml'");
  EXPECT_EQ(scene.bodies[0].material.youngs_modulus, 4e4);
  EXPECT_EQ(scene.bodies[0].material.poisson, 0.1);
}

TEST_F(SolidScene, ResolvedSceneShowsTheKeysOfSolidsOnly) {
  const auto of = [](const std::string& material) {
    return nlohmann::json::parse(read(material).resolved)["body"][0]["material"];
  };
  const auto solid = of("{ density = 1000, law = 'neo_hookean', youngs_modulus = 1e5 }");
  EXPECT_EQ(solid["youngs_modulus"], 1e5);
  EXPECT_EQ(solid["poisson"], 0.3);
  EXPECT_EQ(solid["law"], "neo_hookean");
  EXPECT_FALSE(of("'rubber'").contains("youngs_modulus"));
  EXPECT_FALSE(of("'rubber'").contains("law"));
}

TEST_F(SolidScene, RefusesInvalidMaterials) {
  EXPECT_THAT(message("{ density = 1000, law = 'neo_hookean', youngs_modulus = -1 }"),
              HasSubstr("youngs_modulus"));
  EXPECT_THAT(message("{ density = 1000, law = 'neo_hookean', youngs_modulus = 1e5, poisson = 0.5 }"),
              HasSubstr("poisson"));
  EXPECT_THAT(message("{ density = 1000, edge_modulus = 1e5, poisson = 0.3 }"), HasSubstr("law"));
  EXPECT_THAT(message("{ density = 1000, youngs_modulus = 1e5, poisson = 0.3 }"), HasSubstr("law"));
  EXPECT_THAT(message("{ density = 1000, law = 'neo_hookean' }"), HasSubstr("youngs_modulus"));
  EXPECT_THAT(message("{ density = 1000, law = 'neo_hooke', youngs_modulus = 1e5 }"),
              HasSubstr("neo_hookean"));
  EXPECT_THAT(message("{ density = 1000, law = 'neo_hookean', youngs_modulus = 1e5, edge_modulus = 9 }"),
              HasSubstr("edge_modulus"));
  EXPECT_THAT(message("{ density = 1000, law = 'neo_hookean', youngs_modulus = 1e5, shear_modulus = 9 }"),
              HasSubstr("poisson"));
  EXPECT_THAT(message("{ density = 1000 }"), HasSubstr("edge_modulus"));
}

TEST_F(SolidScene, ValidateRefusesInvalidRatios) {
  Scene scene = read("{ density = 1000, law = 'neo_hookean', youngs_modulus = 1e5 }");
  scene.bodies[0].material.poisson = 0.5;
  EXPECT_THROW(validate(scene), Error);
}

TEST_F(SolidScene, StepsConvergeAloneAndWithAnotherBody) {
  const std::string more =
      "contact = false\n[[pin]]\nbody = 'block'\nwhere = { plane = { point = [0, 0, 0], normal = [1, 0, 0], "
      "distance = 0.01 "
      "} }\n"
      "[[force]]\ntype = 'gravity'\n";
  const std::string other =
      "[[body]]\nname = 'other'\nmesh = 'box.obj'\nvoxel_width = 0.1\ntranslate = [0, 1, 0]\ncontact = "
      "false\n"
      "material = { density = 1000, edge_modulus = 1e5, face_diagonal_modulus = 1e4 }\n";
  for (const std::string& scene :
       {text("{ density = 1000, law = 'neo_hookean', youngs_modulus = 1e5, poisson = 0.4, stiffness_damping "
             "= 0.01 }") +
            more,
        other + text("{ density = 1000, law = 'neo_hookean', youngs_modulus = 1e5 }") + more}) {
    Simulation simulation(
        std::make_shared<const Model>(build_model(parse_scene(scene, folder() / "scene.toml"))));
    for (int frame = 0; frame < 12; ++frame) {
      simulation.advance();
      const Diagnostics& row = simulation.diagnostics();
      EXPECT_EQ(row.converged_steps, row.steps);
      EXPECT_LE(row.newton_iterations, 4 * row.steps);
    }
  }
}

TEST_F(SolidScene, MirroredBlockReturnsToRest) {
  // Every element starts inverted; no step fails, and the block is at rest in the end.
  const auto model =
      std::make_shared<const Model>(build("{ density = 1000, law = 'neo_hookean', youngs_modulus = 1e5, "
                                          "poisson = 0.3, stiffness_damping = 0.02, mass_damping = 5 }"));
  Simulation simulation(model);
  std::vector<Vec3> x = model->rest_positions;
  for (Vec3& p : x) p.y() *= -0.5;
  simulation.set_positions(x);
  while (simulation.frame() < 48) simulation.advance();
  EXPECT_LT(simulation.diagnostics().elastic, 1e-6 * model->potentials[0].potential->value(x));
}

}  // namespace
}  // namespace muslin
