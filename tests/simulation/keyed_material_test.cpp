// Numbers of a material that change over time: the energy account says what a change puts in, motion has the
// stiffness of its time, and constant keyframes, resumed runs and any thread count give the same bits.
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>

#include "support/sheet.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "muslin/core/error.hpp"
#include "muslin/core/parallel.hpp"
#include "muslin/geometry/shapes.hpp"
#include "muslin/simulation/simulation.hpp"

namespace muslin {
namespace {

using std::numbers::pi;

std::shared_ptr<const Model> model(const std::string& text, const Mesh& mesh) {
  Scene scene = parse_scene(text, "scene.toml");
  scene.meshes["mesh"] = std::make_shared<const Mesh>(mesh);
  return std::make_shared<const Model>(build_model(scene));
}

/// A triangle of base 1 m, which is held, and height 1 m along warp. Its tip at height 1 + d stores
/// ½ A K (d + d²/2)², A = ½ m², and has the mass ρ A/3.
std::shared_ptr<const Model> triangle(const std::string& warp, const std::string& rest = "",
                                      const std::string& solver = "integrator = 'bdf2'") {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0.5, 0}, {0, 1, 0}};
  mesh.add_face(std::array{0, 1, 2});
  return model(
      "[time]\nframe_rate = 8\nsteps_per_frame = 400\n[solver]\neffort = 'exact'\ntolerance = 1e-6\n" +
          solver +
          "\n[[body]]\nname = 'cloth'\nmesh = 'mesh'\nmodel = 'shell'\nwarp = [1, 0, 0]\ncontact = "
          "false\ncompression = 'elastic'\nvelocity = [0.01, 0, 0]\nmaterial = { areal_density = 0.3, "
          "membrane_weft = 20, membrane_shear = 10, poisson = 0, bending_warp = 0, membrane_warp = " +
          warp +
          " }\n[[pin]]\nname = 'base'\nwhere = { plane = { point = [0, 0, 0], normal = [1, 0, 0], "
          "distance = 0.01 } }\n" +
          rest,
      mesh);
}

double stored(double stiffness, double d) { return 0.25 * stiffness * std::pow(d + d * d / 2, 2); }

std::string keys(double first, double last, const std::string& way, double begin = 1, double end = 2) {
  return "{ keyframes = [{ time = " + std::to_string(begin) + ", value = " + std::to_string(first) +
         ", interpolation = '" + way + "' }, { time = " + std::to_string(end) +
         ", value = " + std::to_string(last) + " }] }";
}

void run_to(Simulation& simulation, int frame) {
  while (simulation.frame() < frame) simulation.advance();
}

TEST(KeyedMaterial, StiffeningAtAFixedStretchPutsInHalfTheChangeTimesTheSquare) {
  const std::string pull =
      "[[pin]]\nname = 'tip'\nwhere = { nearest = [1, 0.5, 0] }\nkeyframes = [{ time = 0 }, { time = 1, "
      "translate = [0.1, 0, 0] }]\n";
  for (const char* way : {"linear", "step", "smooth"}) {
    Simulation simulation(triangle(keys(10, 30, way), pull));
    run_to(simulation, 8);
    const Diagnostics before = simulation.diagnostics();
    EXPECT_EQ(before.material_work, 0) << way;
    EXPECT_NEAR(before.elastic, stored(10, 0.1), 1e-12) << way;
    run_to(simulation, 12);
    const double half = std::string(way) == "step" ? 10 : 20;
    EXPECT_NEAR(simulation.diagnostics().elastic, stored(half, 0.1), 1e-12) << way;
    run_to(simulation, 17);
    const Diagnostics& after = simulation.diagnostics();
    const double put_in = stored(30, 0.1) - stored(10, 0.1);
    EXPECT_NEAR(after.material_work / put_in, 1, 1e-12) << way;
    EXPECT_NEAR((after.elastic - before.elastic) / put_in, 1, 1e-12) << way;
    EXPECT_NEAR(after.work - before.work, put_in, 1e-12) << way << ": pins that rest do no work";
  }
}

TEST(KeyedMaterial, TheAccountBeginsWithTheNumbersOfTheStart) {
  const std::string pull = "[[pin]]\nname = 'tip'\nwhere = { nearest = [1, 0.5, 0] }\n";
  Simulation simulation(triangle(keys(10, 30, "linear", 0, 1), pull));
  auto stretched = simulation.state().positions;
  stretched[1].x() = 1.1;
  simulation.set_positions(stretched);
  EXPECT_NEAR(simulation.diagnostics().elastic, stored(10, 0.1), 1e-15);
  run_to(simulation, 8);
  EXPECT_NEAR(simulation.diagnostics().material_work, stored(30, 0.1) - stored(10, 0.1), 1e-14);
}

TEST(KeyedMaterial, TipSwingsWithTheStiffnessOfItsTime) {
  // ω² = A K/(ρ A/3) = 10 K: one swing per second, and two from 1 s on.
  const double slow = std::pow(2 * pi, 2) / 10, speed = 0.01;
  Simulation simulation(triangle(keys(slow, 4 * slow, "step", 0, 1)));
  const auto tip = [&] { return simulation.state().positions[1].x() - 1; };
  run_to(simulation, 2);
  EXPECT_NEAR(tip(), speed / (2 * pi), 2e-3 * speed / (2 * pi));
  run_to(simulation, 8);
  EXPECT_NEAR(tip(), 0, 5e-3 * speed / (2 * pi));
  run_to(simulation, 9);
  EXPECT_NEAR(tip(), speed / (4 * pi), 5e-3 * speed / (4 * pi)) << "a quarter of the fast swing";
  run_to(simulation, 11);
  EXPECT_NEAR(tip(), -speed / (4 * pi), 5e-3 * speed / (4 * pi));
}

/// A strip of 6 by 2 squares that hangs from its held end.
std::shared_ptr<const Model> strip(const std::string& numbers, const std::string& integrator,
                                   const std::string& steps = "200") {
  return model("[time]\nframe_rate = 24\nsteps_per_frame = " + steps +
                   "\n[solver]\neffort = 'exact'\nintegrator = '" + integrator +
                   "'\n[[body]]\nname = 'cloth'\nmesh = 'mesh'\nmodel = 'shell'\nwarp = [1, 0, 0]\ncontact = "
                   "false\nmaterial = { areal_density = 0.2, " +
                   numbers +
                   " }\n[[pin]]\nname = 'base'\nwhere = { plane = { point = [0, 0, 0], normal = [1, 0, 0], "
                   "distance = 0.01 } }\n[[force]]\ntype = 'gravity'\n",
               test::flat_sheet(6, 2, 0.6, 0.2));
}
const std::string changing =
    "membrane_warp = { keyframes = [{ time = 0, value = 40 }, { time = 0.3, value = 90, interpolation = "
    "'smooth' }, { time = 0.5, value = 50 }] }, bending_warp = { keyframes = [{ time = 0.1, value = 1e-4 }, "
    "{ "
    "time = 0.4, value = 1e-3 }] }, stiffness_damping = { keyframes = [{ time = 0.2, value = 0 }, { time = "
    "0.3, value = 1e-3, interpolation = 'step' }, { time = 0.4, value = 0 }] }, mass_damping = 1";

class KeyedBalance : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Integrators, KeyedBalance,
                         testing::Values("implicit_euler", "bdf2", "linearly_implicit_euler",
                                         "symplectic_euler"),
                         [](const auto& info) { return info.param; });

TEST_P(KeyedBalance, ClosesWhileEveryNumberChanges) {
  Simulation simulation(strip(changing, GetParam()));
  const double balance = simulation.diagnostics().balance();
  while (simulation.frame() < 14) {
    simulation.advance();
    const Diagnostics& row = simulation.diagnostics();
    EXPECT_NEAR(row.balance() - row.unbalanced, balance, 1e-13);
    EXPECT_LT(std::abs(row.unbalanced), 1e-4);
  }
  EXPECT_GT(std::abs(simulation.diagnostics().material_work), 1e-6);
}

/// A bar of 4 by 2 by 2 voxels that hangs from its held end.
std::shared_ptr<const Model> bar(const std::string& numbers, const std::string& integrator,
                                 const std::string& steps = "40") {
  return model(
      "[time]\nframe_rate = 24\nsteps_per_frame = " + steps + "\n[solver]\nintegrator = '" + integrator +
          "'\n[[body]]\nname = 'bar'\nmesh = 'mesh'\nvoxel_width = 0.1\ncontact = false\nmaterial = { "
          "density = 500, " +
          numbers +
          " }\n[[pin]]\nname = 'base'\nwhere = { plane = { point = [0, 0, 0], normal = [1, 0, 0], "
          "distance = 0.01 } }\n[[force]]\ntype = 'gravity'\n",
      box_mesh(Vec3(0.2, 0.1, 0.1), Vec3(0.4, 0.2, 0.2)));
}
const std::string softening =
    "edge_modulus = { keyframes = [{ time = 0.05, value = 6e4 }, { time = 0.3, value = 2e4 }] }, "
    "face_diagonal_modulus = 2e4, volume_modulus = { keyframes = [{ time = 0.1, value = 0, interpolation = "
    "'smooth' }, { time = 0.4, value = 1e4 }] }, stiffness_damping = { keyframes = [{ time = 0, value = 0 }, "
    "{ "
    "time = 0.3, value = 1e-3 }] }";

TEST_P(KeyedBalance, ClosesWhileALatticeSoftens) {
  Simulation simulation(bar(softening, GetParam()));
  const double balance = simulation.diagnostics().balance();
  while (simulation.frame() < 8) {
    simulation.advance();
    const Diagnostics& row = simulation.diagnostics();
    EXPECT_NEAR(row.balance() - row.unbalanced, balance, 1e-11);
  }
  EXPECT_LT(simulation.diagnostics().material_work, -1e-4) << "a softer bar gives energy back";
}

TEST(KeyedMaterial, ResumedLatticesHaveTheSameBits) {
  const auto changed = bar(softening, "bdf2", "'auto'");
  Simulation whole(changed), resumed(changed);
  run_to(whole, 3);
  resumed.restore(whole.checkpoint());
  run_to(whole, 7);
  set_thread_count(1);
  while (resumed.frame() < 7) {
    resumed.forget_scratch();
    resumed.advance();
  }
  set_thread_count(0);
  EXPECT_EQ(whole.checkpoint(), resumed.checkpoint());
}

TEST(KeyedMaterial, KeyframesOfOneValueAreTheNumberBitForBit) {
  const auto state = [](const std::string& warp) {
    Simulation simulation(strip("membrane_warp = " + warp + ", bending_warp = 1e-4", "bdf2", "'auto'"));
    run_to(simulation, 6);
    return simulation.checkpoint();
  };
  EXPECT_EQ(state("40"), state("{ keyframes = [{ time = 0, value = 40 }, { time = 0.1, value = 40 }] }"));
}

TEST(KeyedMaterial, ResumedRunsAndAnyThreadCountHaveTheSameBits) {
  const auto changed = strip(changing, "bdf2", "'auto'");
  set_thread_count(1);
  Simulation whole(changed);
  run_to(whole, 5);
  Simulation resumed(changed);
  resumed.restore(whole.checkpoint());
  run_to(whole, 11);
  set_thread_count(2);
  while (resumed.frame() < 11) {
    resumed.forget_scratch();
    resumed.advance();
  }
  set_thread_count(0);
  EXPECT_EQ(whole.checkpoint(), resumed.checkpoint());
}

TEST(KeyedMaterial, AResumeSaysWhatAChangeOfStiffnessPutIn) {
  const std::string pull = "[[pin]]\nname = 'tip'\nwhere = { nearest = [1, 0.5, 0] }\n";
  Simulation soft(triangle("10", pull));
  auto stretched = soft.state().positions;
  stretched[1].x() = 1.1;
  soft.set_positions(stretched);
  run_to(soft, 1);
  for (const std::string& stiffness : {std::string("30"), keys(30, 40, "linear", 10, 20)}) {
    Simulation stiff(triangle(stiffness, pull));
    stiff.restore(soft.checkpoint());
    run_to(stiff, 2);
    const Diagnostics& row = stiff.diagnostics();
    EXPECT_NEAR(row.material_work, stored(30, 0.1) - stored(10, 0.1), 1e-14) << stiffness;
    EXPECT_NEAR(row.balance(), soft.diagnostics().balance(), 1e-14) << stiffness;
  }
}

TEST(KeyedMaterial, BadKeyframesAreErrorsWithPlaceAndRemedy) {
  const auto message = [](const std::string& numbers) {
    try {
      strip(numbers, "bdf2");
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input);
      return std::string(error.what());
    }
    return std::string("no error");
  };
  const std::string bent = ", bending_warp = 1e-4";
  const auto warp = [&](const std::string& keyframes) {
    return message("membrane_warp = { keyframes = " + keyframes + " }" + bent);
  };
  using testing::HasSubstr;
  EXPECT_THAT(warp("[{ time = 1, value = 1 }, { time = 1, value = 2 }]"),
              HasSubstr("the keyframe at 1 s does not come after that at 1 s"));
  EXPECT_THAT(warp("[{ time = nan, value = 1 }]"), HasSubstr("`time`"));
  EXPECT_THAT(warp("[{ time = 1, value = -2 }]"), HasSubstr("is -2 at 1 s; give a number from 0 to"));
  EXPECT_THAT(warp("[{ time = 1, value = 2, interpolation = 'cubic' }]"), HasSubstr("`linear`"));
  EXPECT_THAT(warp("[]"), HasSubstr("`keyframes` is empty"));
  EXPECT_THAT(message("membrane_warp = 1, bending_weft = 1e-4, bending_bias = 1.1e-4, bending_warp = { "
                      "keyframes = [{ time = 0, value = 1e-4 }, { time = 1, value = 1e-2 }] }"),
              HasSubstr("would twist by itself"));
}

}  // namespace
}  // namespace muslin
