// `stretch_limit` of a body varies over time by keyframes: hung and stretched cloth, the energy account,
// resume and threads, and what is refused.
#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "support/sheet.hpp"
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "muslin/core/error.hpp"
#include "muslin/core/parallel.hpp"
#include "muslin/simulation/simulation.hpp"

namespace muslin {
namespace {

using testing::HasSubstr;

constexpr const char* material =
    "material = { areal_density = 0.3, membrane_warp = 4, bending_warp = 1e-6, mass_damping = 2 }\n";
constexpr const char* hung =
    "[[pin]]\nwhere = { plane = { point = [0, 0, 0], normal = [1, 0, 0] } }\n[[force]]\ntype = 'gravity'\n"
    "acceleration = [9.8, 0, 0]\n";

/// A sheet of 0.5 m by 0.2 m with the keys of the body, and other tables.
std::shared_ptr<const Model> model_of(const std::string& keys, const std::string& tables = hung) {
  Scene scene = parse_scene(
      fmt::format("[time]\nduration = 3\nsteps_per_frame = 4\n[solver]\neffort = 'exact'\n[[body]]\n"
                  "name = 'cloth'\nmesh = 'sheet'\nmodel = 'shell'\ncontact = false\nwarp = [1, 0, 0]\n{}{}",
                  keys, tables),
      "scene.toml");
  Mesh sheet = test::flat_sheet(8, 3, 0.5, 0.2);
  MeshGroup half{"half", {}, {}};
  for (int f = 0; f < static_cast<int>(sheet.face_count()) / 2; ++f) half.faces.push_back(f);
  sheet.groups = {half};
  scene.meshes["sheet"] = std::make_shared<const Mesh>(sheet);
  return std::make_shared<const Model>(build_model(scene));
}
std::string limit(const std::string& keyframes) {
  return fmt::format("stretch_limit = {{ keyframes = [{}] }}\n{}", keyframes, material);
}
void advance_to(Simulation& simulation, int frame) {
  while (simulation.frame() < frame) simulation.advance();
}
double stretch(const Simulation& simulation) { return simulation.diagnostics().max_stretch; }
double fastest(const Simulation& simulation) {
  double most = 0;
  for (const Vec3& v : simulation.state().velocities) most = std::max(most, v.norm());
  return most;
}
double closed(const Simulation& simulation) {
  return simulation.diagnostics().balance() - simulation.diagnostics().unbalanced;
}
std::string message(const std::string& keys) {
  try {
    model_of(keys);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    return error.what();
  }
  return "no error";
}

// A limit that was 1.05 at once would pull the sheet up within one time step, at several m/s.
TEST(KeyedStretchLimitRun, StepPullsHungClothUpWithoutAJump) {
  Simulation simulation(
      model_of(limit("{ time = 0, value = 1.4, interpolation = 'step' }, { time = 1, value = 1.05 }")));
  advance_to(simulation, 23);
  EXPECT_GT(stretch(simulation), 1.15);
  const double before = closed(simulation), work = simulation.diagnostics().material_work;
  double speed = 0;
  while (simulation.frame() < 60) {
    simulation.advance();
    speed = std::max(speed, fastest(simulation));
    EXPECT_NEAR(closed(simulation), before, 1e-9);
  }
  EXPECT_LT(speed, 1.0) << "length [m] times the rate of 1/s, and what it swings";
  EXPECT_LT(stretch(simulation), 1.05);
  EXPECT_GT(simulation.diagnostics().material_work, work);
  EXPECT_EQ(simulation.diagnostics().converged_steps, simulation.diagnostics().steps);
}

TEST(KeyedStretchLimitRun, SlowKeyframesHoldAtAllTimes) {
  Simulation simulation(model_of(limit("{ time = 0.5, value = 1.3 }, { time = 1.5, value = 1.03 }")));
  while (simulation.frame() < 48) {
    simulation.advance();
    const double now = 1.3 - 0.27 * std::clamp(simulation.state().time - 0.5, 0.0, 1.0);
    EXPECT_LT(stretch(simulation), now + 0.01) << simulation.frame();
    const auto rows = limited_stretches(simulation.model(), simulation.state(), simulation.frame());
    ASSERT_EQ(rows.size(), 1U);
    EXPECT_NEAR(rows[0].limit, now, 1e-9);
  }
}

TEST(KeyedStretchLimitRun, GrowingLimitLetsTheClothDown) {
  Simulation simulation(
      model_of(limit("{ time = 0, value = 1.03, interpolation = 'step' }, { time = 1, value = 2 }")));
  advance_to(simulation, 23);
  EXPECT_LT(stretch(simulation), 1.03);
  const double before = closed(simulation), work = simulation.diagnostics().material_work;
  advance_to(simulation, 60);
  EXPECT_GT(stretch(simulation), 1.15);
  EXPECT_LT(simulation.diagnostics().material_work, work) << "the energy of the limit is let go";
  EXPECT_NEAR(closed(simulation), before, 1e-9);
}

// Pins that hold the sheet beyond the limit: the end is that of a limit from the start.
TEST(KeyedStretchLimitRun, ClothHeldApartEndsAsWithTheSameConstantLimit) {
  const std::string held =
      "[[pin]]\nwhere = { plane = { point = [0, 0, 0], normal = [1, 0, 0] } }\n[[pin]]\nwhere = { plane = { "
      "point = [0.5, 0, 0], normal = [1, 0, 0] } }\nkeyframes = [{ time = 0 }, { time = 0.5, translate = "
      "[0.05, 0, 0] }]\n";
  Simulation keyed(model_of(
      limit("{ time = 0, value = 1.4, interpolation = 'step' }, { time = 0.7, value = 1.05 }"), held)),
      constant(model_of(fmt::format("stretch_limit = 1.05\n{}", material), held));
  advance_to(keyed, 72);
  advance_to(constant, 72);
  for (std::size_t v = 0; v < keyed.state().positions.size(); ++v)
    EXPECT_LT((keyed.state().positions[v] - constant.state().positions[v]).norm(), 1e-4) << v;
  EXPECT_GT(stretch(keyed), 1.05);
  EXPECT_EQ(keyed.diagnostics().converged_steps, keyed.diagnostics().steps);
}

TEST(KeyedStretchLimitRun, KeyframesOfOneLimitEqualItBitForBit) {
  Simulation keyed(model_of(limit("{ time = 0, value = 1.05 }, { time = 1, value = 1.05 }"))),
      number(model_of(fmt::format("stretch_limit = 1.05\n{}", material)));
  advance_to(keyed, 6);
  advance_to(number, 6);
  EXPECT_EQ(keyed.state().positions, number.state().positions);
}

TEST(KeyedStretchLimitRun, ReplacesThoseOfAllFabricsAndVariesBesideOtherNumbers) {
  const std::string falling =
      "stretch_limit = { keyframes = [{ time = 0, value = 1.4 }, { time = 1.5, value = 1.03 }] }\n";
  const std::string fabrics =
      falling +
      "[body.material]\nareal_density = 0.3\nmembrane_warp = 4\nbending_warp = 1e-6\nstretch_limit = 1.9\n"
      "[[body.fabric]]\nfaces = 'half'\nmaterial = { areal_density = 0.3, membrane_warp = 6, bending_warp = "
      "1e-6 }\n";
  const std::string stiffening =
      falling +
      "rest_scale_weft = 0.9\nrest_scale_share = { keyframes = [{ time = 0.2, value = 0 }, { time = 1, value "
      "= 1 }] }\nmaterial = { areal_density = 0.3, membrane_warp = { keyframes = [{ time = 0, value = 4 }, { "
      "time = 1, value = 6 }] }, bending_warp = 1e-6 }\n";
  for (const std::string& keys : {fabrics, stiffening}) {
    Simulation simulation(model_of(keys));
    const double start = closed(simulation);
    advance_to(simulation, 60);
    EXPECT_LT(stretch(simulation), 1.03 + 0.01);
    EXPECT_NEAR(closed(simulation), start, 1e-9);
  }
}

TEST(KeyedStretchLimitRun, ResumesAndRunsOnAnyNumberOfThreadsWithTheSameBits) {
  const auto model =
      model_of(limit("{ time = 0, value = 1.4, interpolation = 'step' }, { time = 0.8, value = 1.05 }"));
  Simulation whole(model);
  advance_to(whole, 21);  // while it follows
  Simulation resumed(model);
  resumed.restore(whole.checkpoint());
  set_thread_count(1);
  advance_to(resumed, 28);
  set_thread_count(2);
  advance_to(whole, 28);
  set_thread_count(0);
  EXPECT_EQ(resumed.state().positions, whole.state().positions);
  EXPECT_EQ(resumed.diagnostics().material_work, whole.diagnostics().material_work);
}

TEST(KeyedStretchLimitRun, WrongKeyframesAreErrors) {
  EXPECT_THAT(message(limit("{ time = 2, value = 1 }")),
              testing::AllOf(HasSubstr("scene.toml:12"), HasSubstr("`stretch_limit` is 1 at 2 s; give")));
  EXPECT_THAT(message(limit("{ time = 2, value = 1.1 }, { time = 1, value = 1.2 }")), HasSubstr("time"));
  EXPECT_THAT(message("stretch_limit = { map = 'paint', from = 1.1, to = 1.2 }\n" + std::string(material)),
              HasSubstr("`stretch_limit` cannot vary by a map"));
  EXPECT_THAT(
      message(
          "material = { base = 'cotton', stretch_limit = { keyframes = [{ time = 0, value = 1.1 }] } }\n"),
      HasSubstr("`stretch_limit` cannot vary by keyframes: that of the body can"));
  EXPECT_THAT(model_of(limit("{ time = 0, value = 1.1 }, { time = 1, value = 1.002 }"))->warnings,
              testing::Contains(HasSubstr("`stretch_limit` of less than 1.005")));
}

// A weight that changes is one of gravity: what hangs at rest depends on density times gravity.
TEST(KeyedGravity, StretchesAsADensityThatChanges) {
  const auto sheet = [](double density, const std::string& gravity) {
    return model_of(fmt::format("material = {{ areal_density = {}, membrane_warp = 20, bending_warp = 1e-6, "
                                "mass_damping = 8 }}\n",
                                density),
                    fmt::format("[[pin]]\nwhere = {{ plane = {{ point = [0, 0, 0], normal = [1, 0, 0] }} }}\n"
                                "[[force]]\ntype = 'gravity'\nbody = 'cloth'\n{}\n",
                                gravity));
  };
  Simulation wet(sheet(0.2,
                       "keyframes = [{ time = 0, value = [9.8, 0, 0] }, { time = 1, value "
                       "= [14.7, 0, 0] }]")),
      dense(sheet(0.3, "acceleration = [9.8, 0, 0]"));
  advance_to(wet, 72);
  advance_to(dense, 72);
  for (std::size_t v = 0; v < wet.state().positions.size(); ++v)
    EXPECT_LT((wet.state().positions[v] - dense.state().positions[v]).norm(), 2e-4) << v;
  EXPECT_THAT(
      message("material = { base = 'cotton', areal_density = { keyframes = [{ time = 0, value = 1 }] } }\n"),
      HasSubstr("`areal_density` cannot vary by keyframes: mass would appear or vanish; give keyframes to a "
                "gravity force with this `body`"));
}

}  // namespace
}  // namespace muslin
