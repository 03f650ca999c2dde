// Soft pins in runs: forces in closed form, arrival in time, hand-over, the energy account, resume and
// threads; the report of what pins hold; the first keyframe of any pin; errors.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "cache/scratch.hpp"
#include "support/sheet.hpp"
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "muslin/core/error.hpp"
#include "muslin/core/parallel.hpp"
#include "muslin/scene/model.hpp"
#include "muslin/simulation/simulation.hpp"

namespace muslin {
namespace {

using testing::HasSubstr;

constexpr double g = 9.8;  // of gravity [m/s²]

/// A sheet of 0.2 m by 0.1 m and 2 g in squares, `squares` along its width.
std::shared_ptr<const Model> sheet(const std::string& pins, const std::string& more = "", int squares = 2,
                                   const std::vector<std::string>& overrides = {}) {
  Scene scene = parse_scene(R"([time]
duration = 4
[solver]
effort = 'exact'
[[body]]
name = 'cloth'
mesh = 'sheet'
model = 'shell'
contact = false
compression = 'elastic'
material = { areal_density = 0.1, membrane_warp = 200, bending_warp = 1e-4, mass_damping = 8 }
[[force]]
type = 'gravity'
)" + pins + more,
                            "scene.toml", overrides);
  scene.meshes["sheet"] = std::make_shared<const Mesh>(test::flat_sheet(2 * squares, squares, 0.2, 0.1));
  return std::make_shared<const Model>(build_model(scene));
}
const std::string everywhere = "where = { box = [[-1, -1, -1], [1, 1, 1]] }\n";
const std::string row = "where = { plane = { point = [0, 0, 0], normal = [1, 0, 0] } }\n";
constexpr double mass = 0.1 * 0.2 * 0.1;

Simulation after(const std::shared_ptr<const Model>& model, int frames) {
  Simulation simulation(model);
  while (simulation.frame() < frames) simulation.advance();
  return simulation;
}

Vec3 centre(const Simulation& simulation) {
  Vec3 sum = Vec3::Zero();
  double total = 0;
  for (std::size_t v = 0; v < simulation.state().positions.size(); ++v) {
    sum += simulation.model().masses[v] * simulation.state().positions[v];
    total += simulation.model().masses[v];
  }
  return sum / total;
}

std::string message(const std::string& pins, const std::string& more = "") {
  try {
    sheet(pins, more);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    return error.what();
  }
  return "no error";
}

TEST(SoftPinRun, WeightsShareTheStiffness) {
  const std::string hand = "[[pin]]\nname = 'hand'\nstiffness = 2\ndamping = 0.1\n" + everywhere;
  const auto plain = sheet(hand), whole = sheet(hand + "weight = 1\n"), half = sheet(hand + "weight = 0.5\n");
  EXPECT_EQ(plain->pins[0].stiffness, whole->pins[0].stiffness);
  for (std::size_t k = 0; k < plain->pins[0].stiffness.size(); ++k) {
    EXPECT_EQ(half->pins[0].stiffness[k], 0.5 * plain->pins[0].stiffness[k]);
    EXPECT_EQ(half->pins[0].damping[k], 0.5 * plain->pins[0].damping[k]);
  }
  EXPECT_NEAR(centre(after(half, 90)).y(), -mass * g / 1, 1e-3 * mass * g);
}

TEST(SoftPinRun, WeightsVaryByAMap) {
  test::Scratch scratch;
  const auto pinned = [&](const std::string& body, const char* to) {
    Scene scene =
        parse_scene("[time]\nduration = 1\n[[body]]\nname = 'cloth'\nmesh = 'sheet'\ncontact = false\n" +
                        body + "[[pin]]\nstiffness = 2\n" + everywhere +
                        "weight = { map = 'ramp.csv', from = 0, to = " + to + " }\n",
                    scratch.path() / "scene.toml");
    auto mesh = std::make_shared<Mesh>(test::flat_sheet(4, 2, 0.2, 0.1));
    std::ofstream ramp(scratch.path() / "ramp.csv");
    for (const Vec3& p : mesh->positions) ramp << p.x() / 0.2 << '\n';
    ramp.close();
    scene.meshes["sheet"] = std::move(mesh);
    return build_model(scene);
  };
  const std::string shell =
      "model = 'shell'\nmaterial = { areal_density = 0.1, membrane_warp = 200, bending_warp = 1e-4 }\n";
  const Model cloth = pinned(shell, "1");
  const Pin& pin = cloth.pins[0];
  ASSERT_EQ(pin.vertices.size(), 12u) << "three vertices have no weight";
  for (std::size_t k = 0; k < pin.vertices.size(); ++k) {
    const auto v = static_cast<std::size_t>(pin.vertices[k]);
    EXPECT_NEAR(pin.stiffness[k] / pin.stiffness.back(),
                cloth.rest_positions[v].x() / 0.2 * cloth.masses[v] / cloth.masses.back(), 1e-12);
  }
  const Model block = pinned(
      "thickness = 0.05\nvoxel_width = 0.05\nmaterial = { density = 90, edge_modulus = 3000, "
      "face_diagonal_modulus = 700 }\n",
      "1");
  for (const int v : block.pins[0].vertices)
    EXPECT_GT(block.rest_positions[static_cast<std::size_t>(v)].x(), 0.01);
  EXPECT_THROW(pinned(shell, "0"), Error);
}

TEST(SoftPinRun, KeyframesOfOneWeightEqualItBitForBit) {
  const std::string hand = "[[pin]]\nname = 'hand'\nstiffness = 2\ndamping = 0.1\n" + everywhere;
  const Simulation number = after(sheet(hand + "weight = 0.3\n"), 8),
                   keyed =
                       after(sheet(hand + "weight = { keyframes = [{ time = 0, value = 0.3 }, { time = 0.1, "
                                          "value = 0.3 }] }\n"),
                             8);
  EXPECT_EQ(number.state().positions, keyed.state().positions);
}

// A weight that falls from 1 to ½ doubles the way by which the pin gives.
TEST(SoftPinRun, WeightsVaryInTime) {
  const std::string hand = "[[pin]]\nname = 'hand'\nstiffness = 2\ndamping = 0.05\n" + everywhere;
  const auto model =
      sheet(hand +
            "weight = { keyframes = [{ time = 1.9, value = 1, interpolation = 'smooth' }, { time "
            "= 2.1, value = 0.5 }] }\n");
  Simulation simulation = after(model, 45);
  EXPECT_NEAR(centre(simulation).y(), -mass * g / 2, 1e-3 * mass * g / 2);
  const double start = simulation.diagnostics().balance() - simulation.diagnostics().unbalanced;
  while (simulation.frame() < 96) simulation.advance();
  EXPECT_NEAR(centre(simulation).y(), -mass * g, 1e-3 * mass * g);
  EXPECT_NEAR(simulation.pin_force("hand").sum.y(), mass * g, 1e-3 * mass * g);
  EXPECT_NEAR(simulation.diagnostics().balance() - simulation.diagnostics().unbalanced, start, 1e-10);
}

// One pin lets go while another takes over.
TEST(SoftPinRun, WeightsHandOver) {
  const auto hand = [](const char* name, int first, int last) {
    return fmt::format(
        "[[pin]]\nname = '{}'\nstiffness = 2\nweight = {{ keyframes = [{{ time = 1, value = {} }}, {{ time = "
        "2, "
        "value = {} }}] }}\n{}",
        name, first, last, everywhere);
  };
  Simulation simulation = after(sheet(hand("a", 1, 0) + hand("b", 0, 1)), 48);
  EXPECT_EQ(simulation.pin_force("a").sum.norm(), 0);
  while (simulation.frame() < 90) simulation.advance();
  EXPECT_NEAR(simulation.pin_force("b").sum.y(), mass * g, 1e-3 * mass * g);
}

TEST(SoftPinRun, SpringOfStiffnessKGivesWayByTheWeightOverKAtAnyResolution) {
  for (const int squares : {2, 5}) {
    const auto model = sheet("[[pin]]\nname = 'hand'\nstiffness = 2\n" + everywhere, "", squares);
    const Simulation simulation = after(model, 90);
    EXPECT_NEAR(centre(simulation).y(), -mass * g / 2, 1e-3 * mass * g / 2);
    EXPECT_NEAR(simulation.pin_force("hand").sum.y(), mass * g, 1e-3 * mass * g);
    EXPECT_LT(std::abs(simulation.pin_force("hand").sum.x()), 1e-6);
  }
}

// With dashpots that resist motion relative to the target, a jump by a overshoots by a/e².
TEST(SoftPinRun, PinWithATimeArrivesInThatTime) {
  const std::string move =
      "keyframes = [{ time = 0 }, { time = 0.001, translate = [0.1, 0, 0] }]\ntime = 1\n";
  const auto model = sheet("[[pin]]\n" + everywhere + move, "", 2, {"body.cloth.material.mass_damping=0"});
  Simulation simulation(model);
  double farthest = 0;
  while (simulation.frame() < 24) {
    simulation.advance();
    farthest = std::max(farthest, centre(simulation).x() - 0.1);
  }
  EXPECT_LT(farthest, 0.1 * (1 + std::exp(-2)));
  EXPECT_NEAR(centre(simulation).x(), 0.2, 0.002);
}

TEST(SoftPinRun, BothKindsReportTheWeightTheyHold) {
  const Simulation hard = after(sheet("[[pin]]\nname = 'rail'\n" + row), 90);
  EXPECT_NEAR(hard.pin_force("rail").sum.y(), mass * g, 2e-3 * mass * g);
  EXPECT_GE(hard.pin_force("rail").largest, hard.pin_force("rail").mean);
  EXPECT_GE(hard.pin_force("rail").most, hard.pin_force("rail").sum.norm());
  const Simulation soft = after(sheet("[[pin]]\nname = 'rail'\nstiffness = 50\n" + row), 90);
  EXPECT_NEAR(soft.pin_force("rail").sum.y(), mass * g, 2e-3 * mass * g);
  EXPECT_THROW(hard.pin_force("rial"), Error);
}

TEST(SoftPinRun, ForceIsZeroAfterTheRelease) {
  const Simulation simulation = after(sheet("[[pin]]\nname = 'rail'\nuntil = 1\n" + row), 30);
  EXPECT_EQ(simulation.pin_force("rail").sum.norm(), 0);
  EXPECT_GT(simulation.pin_force("rail").most, 0);
}

TEST(SoftPinRun, PinsHandOverWithoutAJump) {
  const std::string first = "[[pin]]\nname = 'a'\nuntil = 1\n" + row,
                    soft = "stiffness = 400\ndamping = 0.1\n";
  for (const bool from_soft : {false, true}) {
    for (const bool to_soft : {false, true}) {
      const auto model = sheet(first + (from_soft ? soft : "") + "[[pin]]\nname = 'b'\nfrom = 1\n" + row +
                               (to_soft ? soft : ""));
      Simulation simulation = after(model, 23);
      const int held = model->pins[0].vertices.front();
      for (int step = 0; step < 30; ++step) {
        const Vec3 before = simulation.state().positions[static_cast<std::size_t>(held)];
        simulation.step();
        // A vertex that nothing holds falls by 8 mm in a frame; a soft pin gives way by weight over
        // stiffness, 0.05 mm, and swings.
        EXPECT_LT((simulation.state().positions[static_cast<std::size_t>(held)] - before).norm(), 3e-4);
      }
    }
  }
}

TEST(SoftPinRun, AccountClosesWhileTheTargetsMoveAndScale) {
  const std::string move =
      "keyframes = [{ time = 0 }, { time = 1, translate = [0.1, 0.1, 0], rotate = [0, 60, "
      "0], scale = [1, 1, 0.7] }]\nstiffness = 30\ndamping = 0.2\n";
  for (const std::string integrator : {"implicit_euler", "bdf2", "linearly_implicit_euler"}) {
    SCOPED_TRACE(integrator);
    Simulation simulation(sheet("[[pin]]\n" + row + move, "", 2, {"solver.integrator=" + integrator}));
    const double start = simulation.diagnostics().balance();
    double largest = 0;
    while (simulation.frame() < 30) {
      simulation.advance();
      const Diagnostics& now = simulation.diagnostics();
      largest = std::max(largest, std::abs(now.balance() - now.unbalanced - start));
    }
    EXPECT_GT(simulation.diagnostics().work, 1e-3);
    EXPECT_LT(largest, 1e-10);
  }
}

TEST(SoftPinRun, ResumesAndRunsOnAnyNumberOfThreadsWithTheSameBits) {
  const auto model = sheet(
      "[[pin]]\nname = 'hand'\nstiffness = 30\ndamping = 0.2\nfrom = 0.1\nkeyframes = [{ time "
      "= 0 }, { time = 1, translate = [0.1, 0.1, 0] }]\n" +
      row);
  Simulation whole = after(model, 10);
  const std::vector<std::uint8_t> bytes = whole.checkpoint();
  Simulation resumed(model);
  resumed.restore(bytes);
  EXPECT_EQ(resumed.pin_force("hand").sum, whole.pin_force("hand").sum);
  set_thread_count(1);
  while (resumed.frame() < 16) resumed.advance();
  set_thread_count(2);
  while (whole.frame() < 16) whole.advance();
  set_thread_count(0);
  EXPECT_EQ(resumed.state().positions, whole.state().positions);
  EXPECT_EQ(resumed.state().velocities, whole.state().velocities);
}

TEST(PinRun, FirstKeyframeIsAnOffsetFromTheModelledPlaceAndAJumpWarns) {
  const std::string aside =
      "[[pin]]\nname = 'hand'\nkeyframes = [{ time = 0.5, translate = [0.01, 0, 0] }]\n" + row;
  const auto model = sheet(aside);
  EXPECT_THAT(model->warnings,
              testing::Contains(HasSubstr("pin hand: its first keyframe is 0.01 m from where its "
                                          "vertices are modelled")));
  Simulation simulation(model);
  simulation.advance();
  for (const int v : model->pins.front().vertices) {
    const auto i = static_cast<std::size_t>(v);
    EXPECT_LT((simulation.state().positions[i] - model->rest_positions[i] - Vec3(0.01, 0, 0)).norm(), 1e-15);
  }
  EXPECT_THAT(
      sheet("[[pin]]\nfrom = 0.1\nkeyframes = [{ time = 0, translate = [1, 0, 0] }]\n" + row)->warnings,
      testing::Not(testing::Contains(HasSubstr("first keyframe"))));
  EXPECT_THAT(
      sheet("[[pin]]\nkeyframes = [{ time = 0 }, { time = 1, translate = [1, 0, 0] }]\n" + row)->warnings,
      testing::Not(testing::Contains(HasSubstr("first keyframe"))));
}

TEST(SoftPinRun, WrongKeysAreErrors) {
  EXPECT_THAT(message("[[pin]]\nstiffness = 1\ntime = 1\n" + row), HasSubstr("both say how hard"));
  EXPECT_THAT(message("[[pin]]\ndamping = 1\n" + row), HasSubstr("stiffness"));
  EXPECT_THAT(message("[[pin]]\nweight = 0.5\n" + row), HasSubstr("only a soft pin has a weight"));
  EXPECT_THAT(message("[[pin]]\nstiffness = 1\nweight = { keyframes = [{ time = 0.5, value = 2 }] }\n" + row),
              HasSubstr("`weight` is 2 at 0.5 s; give a number from 0 to 1"));
  EXPECT_THAT(message("[[pin]]\nstiffness = 1\nweight = { keyframes = [{ time = 0, value = 0 }] }\n" + row),
              HasSubstr("its `weight` is 0 at every vertex"));
  EXPECT_THAT(message("[[pin]]\nstiffness = 0\n" + row), HasSubstr("stiffness"));
  EXPECT_THAT(message("[[pin]]\nkeyframes = [{ time = 0, scale = 0 }]\n" + row), HasSubstr("scale"));
  EXPECT_THAT(message("[[pin]]\nstiffness = 1\n" + row,
                      "[[collider]]\nshape = 'box'\nsize = [1, 1, 1]\ncenter = "
                      "[0, -3, 0]\nkeyframes = [{ time = 0, scale = 2 }]\n"),
              HasSubstr("colliders keep their size"));
}

TEST(SoftPinRun, OneThatIsStifferThanTheClothIsAWarningBelowEffortExact) {
  const std::string pin = "[[pin]]\nname = 'row'\n" + row + "stiffness = ";
  EXPECT_TRUE(sheet(pin + "1e3\n", "", 2, {"solver.effort='normal'"})->warnings.empty());
  EXPECT_THAT(sheet(pin + "1e7\n", "", 2, {"solver.effort='normal'"})->warnings.front(),
              HasSubstr("pin row: it is"));
  EXPECT_TRUE(sheet(pin + "1e7\n")->warnings.empty());
}

}  // namespace
}  // namespace muslin
