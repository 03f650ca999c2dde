// Measured curves of a shell's material: reading, what takes the place of what, what is wrong, and that they
// reach the model and a run's comparison of models.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "support/sheet.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "muslin/component/shell/shell_body.hpp"
#include "muslin/io/mesh_file.hpp"
#include "muslin/material/measured_sheet.hpp"
#include "muslin/scene/describe.hpp"
#include "muslin/scene/model.hpp"

namespace muslin {
namespace {

using testing::HasSubstr;

class MeasuredCloth : public testing::Test {
 protected:
  static std::filesystem::path folder() {
    return std::filesystem::temp_directory_path() / ("muslin_measured_cloth_" + std::to_string(getpid()));
  }
  static void SetUpTestSuite() {
    std::filesystem::create_directories(folder());
    write_mesh(folder() / "sheet.obj", test::flat_sheet(4, 3, 0.8, 0.6));
  }
  static void TearDownTestSuite() { std::filesystem::remove_all(folder()); }

  static Scene scene(std::string material, const std::vector<std::string>& overrides = {}) {
    material.erase(material.find_last_not_of(", ") + 1);
    return parse_scene(
        "[[body]]\nname = 'cloth'\nmesh = 'sheet.obj'\nmodel = 'shell'\nwarp = [1, 0, 0]\n"
        "material = { " +
            material + " }\n",
        folder() / "scene.toml", overrides);
  }
  static ShellMaterial read(const std::string& material, const std::vector<std::string>& overrides = {}) {
    return *scene(material, overrides).bodies[0].material.shell;
  }
  static std::string message(const std::string& material) {
    try {
      scene(material);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input);
      return error.what();
    }
    return "no error";
  }
};

const std::string weight = "areal_density = 0.2, bending_warp = 1e-5, ";
const std::string warp = "warp_curve = [[0, 0], [0.05, 10], [0.1, 40]], ";

TEST_F(MeasuredCloth, CurvesStandInPlaceOfModuli) {
  const ShellMaterial m = read(weight + warp + "shear_curve = [[4, 2], [8, 5]]");
  EXPECT_EQ(*m.warp_curve, (MeasuredCurve{{0, 0}, {0.05, 10}, {0.1, 40}}));
  EXPECT_EQ(m.weft_curve, m.warp_curve);
  EXPECT_EQ(*m.shear_curve, (MeasuredCurve{{4, 2}, {8, 5}}));
  EXPECT_EQ(m.poisson, 0.25);
}

TEST_F(MeasuredCloth, OneThreadMayBeMeasuredAndTheOtherNot) {
  const ShellMaterial m = read(weight + warp + "membrane_weft = 300, poisson = 0.2");
  EXPECT_FALSE(m.weft_curve);
  EXPECT_EQ(m.membrane_weft, 300);
  // Shear as in an isotropic sheet of the stiffnesses at rest.
  EXPECT_NEAR(m.membrane_shear, std::sqrt(stress_of(m).warp.slope(0) * 300) / 2.4, 1e-9);
}

TEST_F(MeasuredCloth, ChangesABaseAndIsChangedByIt) {
  const ShellMaterial curved = read("base = 'cotton', " + warp);
  EXPECT_EQ(*curved.warp_curve, (MeasuredCurve{{0, 0}, {0.05, 10}, {0.1, 40}}));
  EXPECT_EQ(curved.weft_curve, find_material("cotton").shell->weft_curve);
  const ShellMaterial set = read(weight + warp, {"body.cloth.material.weft_curve=[[0.1, 70]]"});
  EXPECT_EQ(*set.weft_curve, (MeasuredCurve{{0.1, 70}}));

  std::ofstream(folder() / "knit.toml") << "[shell]\nareal_density = 0.2\nbending_warp = 1e-5\n"
                                           "warp_curve = [[0.1, 40]]\nweft_curve = [[0.1, 20]]\n";
  const ShellMaterial stiff = read("base = 'knit.toml', membrane_warp = 300");
  EXPECT_FALSE(stiff.warp_curve);
  EXPECT_EQ(stiff.membrane_warp, 300);
  EXPECT_TRUE(stiff.weft_curve);
}

TEST_F(MeasuredCloth, AWeftAloneLacksAWarp) {
  EXPECT_THAT(message(weight + "weft_curve = [[0.1, 20]]"), HasSubstr("[N/m], or `base` or `warp_curve`"));
}

TEST_F(MeasuredCloth, DerivesNumbersOfABaseAnew) {
  const ShellMaterial cotton = *find_material("cotton").shell;
  const ShellMaterial stiff = read("base = 'cotton', bending_warp = 1e-4, bending_weft = 1e-4");
  EXPECT_DOUBLE_EQ(stiff.bending_bias, 1e-4);
  EXPECT_EQ(stiff.membrane_shear, cotton.membrane_shear);    // that of cotton is measured
  EXPECT_EQ(stiff.bending_damping, cotton.bending_damping);  // not that of stretch
  EXPECT_EQ(read("base = 'cotton', bending_warp = 1e-4, bending_bias = 5e-5").bending_bias, 5e-5);
  EXPECT_EQ(read("base = 'cotton', poisson = 0.1").bending_bias, cotton.bending_bias);

  std::ofstream(folder() / "plain.toml")
      << "[shell]\nareal_density = 0.2\nmembrane_warp = 100\nbending_warp = 1e-5\nstiffness_damping = 1e-3\n";
  const ShellMaterial plain =
      read("base = 'plain.toml', membrane_warp = 400, membrane_weft = 400, stiffness_damping = 2e-3");
  EXPECT_DOUBLE_EQ(plain.membrane_shear, 400 / 2.5);
  EXPECT_EQ(plain.bending_damping, 2e-3);
}

TEST_F(MeasuredCloth, ResolvedSceneHasTheCurveAndReadsBackAlike) {
  const Model model = build_model(scene(weight + warp + "membrane_shear = 30"));
  const auto material = nlohmann::json::parse(model.scene.resolved)["body"][0]["material"];
  EXPECT_EQ(material["warp_curve"].dump(), "[[0.0,0.0],[0.05,10.0],[0.1,40.0]]");
  EXPECT_FALSE(material.contains("membrane_warp"));
  EXPECT_FALSE(material.contains("membrane_weft"));
  EXPECT_EQ(material["membrane_shear"], 30);
  EXPECT_THAT(describe_text(model), HasSubstr("curves      at most warp"));
}

TEST_F(MeasuredCloth, PullsInTheModelAndMayChangeOnResume) {
  const auto model = [](const std::string& material) { return build_model(scene(material)); };
  const Model first = model(weight + warp), other = model(weight + "warp_curve = [[0.05, 10], [0.1, 41]]");
  EXPECT_EQ(first.bodies[0].material_hash(0), other.bodies[0].material_hash(0));
  std::vector<Vec3> x = first.rest_positions;
  for (Vec3& p : x) p.x() *= 1.1;
  const double strain = 0.5 * (1.1 * 1.1 - 1);
  const StressCurve curve = stress_of(*first.scene.bodies[0].material.shell).warp;
  const double expected = curve.energy(strain) + 0.5 * curve.slope(0) * strain * strain * 0.0625 / 0.9375;
  EXPECT_NEAR(first.potentials[0].potential->value(x) / (0.48 * expected), 1, 1e-9);
}

TEST_F(MeasuredCloth, WrongCurvesAreErrorsWithARemedy) {
  EXPECT_THAT(message(weight + "shear_curve = [[4, 2]]"), HasSubstr("has no `membrane_warp`"));
  EXPECT_THAT(message(weight + warp + "membrane_warp = 3"),
              HasSubstr("`warp_curve` stands beside `membrane_warp`, in whose place it is"));
  EXPECT_THAT(message(weight + "warp_curve = []"), HasSubstr("has 0 points beside the origin; give 1 to 10"));
  EXPECT_THAT(message(weight + "warp_curve = [0.1, 20]"),
              HasSubstr("a point of `warp_curve` is no pair of numbers"));
  EXPECT_THAT(message(weight + "warp_curve = [[0.1, 20], [0.1, 30]]"),
              HasSubstr("`warp_curve` goes from [0.1, 20] to [0.1, 30]"));
  EXPECT_THAT(message(weight + "warp_curve = [[0.1, 20], [0.2, 19]]"),
              HasSubstr("let both numbers ascend: the first by"));
  EXPECT_THAT(message(weight + "warp_curve = [[5, 20], [50, 30]]"), HasSubstr("is 50; give a number"));
  EXPECT_THAT(message(weight + warp + "shear_curve = [[85, 2]]"), HasSubstr("is 85; give a number"));
  EXPECT_THAT(message(weight + "warp_curve = [[0.1, 20], [0.5, 21]]"),
              HasSubstr("from 20 to 21 N/m the force rises by a smaller share than the length of the strip"));
  EXPECT_THAT(message(weight + warp + "poisson = -0.1"),
              HasSubstr("curves with a Poisson ratio of -0.1 make an unstable sheet; give `poisson` from 0"));
  EXPECT_THAT(message(weight + "poisson = 0.4, warp_curve = [[0.05, 20], [0.2, 24], [0.3, 27]]"),
              HasSubstr("give `poisson` from 0 to 0."));
  EXPECT_THAT(message(weight + warp + "bending_weft_curve = [[5, 1e-150]]"),
              HasSubstr("`bending_weft_curve` goes from [0, 0] to [5, 1e-150]"));
}

TEST_F(MeasuredCloth, RemediesHoldWhenUsed) {
  const std::string curve = "warp_curve = [[0.0819, 7.5931], [0.1568, 8.4401]]";
  const std::string refusal = message(weight + curve + ", poisson = 0.487");
  const std::string words = "give `poisson` from 0 to ";
  ASSERT_THAT(refusal, HasSubstr(words));
  EXPECT_EQ(message(weight + curve + ", poisson = " + refusal.substr(refusal.find(words) + words.size())),
            "no error");
}

TEST_F(MeasuredCloth, CurveOfShearDoesNotLimitPoissonsRatio) {
  EXPECT_EQ(message(weight + "membrane_warp = 1000, poisson = -0.2, shear_curve = [[5, 2]]"), "no error");
}

TEST_F(MeasuredCloth, AProgramsCurvesAreCheckedLikewise) {
  Scene made = scene(weight + warp);
  made.bodies[0].material.shell->warp_curve = MeasuredCurve{{0.1, 5}, {0.05, 7}};
  EXPECT_THROW(build_model(made), Error);
}

}  // namespace
}  // namespace muslin
