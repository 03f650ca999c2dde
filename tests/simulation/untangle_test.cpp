// Starts at which surfaces cross are pulled apart before the first frame: afterwards the exact test finds no
// crossing, everything is on its side, and the run keeps it so.
#include <algorithm>

#include "support/tangles.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "muslin/contact/crossings.hpp"
#include "muslin/core/parallel.hpp"
#include "muslin/simulation/simulation.hpp"

namespace muslin {
namespace {

using test::TangledScene;
using testing::HasSubstr;

std::size_t crossings(const Simulation& simulation) {
  return find_crossings(*simulation.model().contact, simulation.state().positions).size();
}

ConstVectors points(const Simulation& simulation, const std::string& body) {
  return simulation.model().of(simulation.model().body(body), simulation.state().positions);
}

/// The start is repaired, and three frames later nothing crosses either.
void expect_repaired(Simulation& simulation) {
  const Untangled& repair = simulation.untangled();
  EXPECT_TRUE(repair.needed());
  EXPECT_EQ(repair.left, 0U) << describe(repair);
  EXPECT_LE(repair.steps, 30) << "half a second";
  EXPECT_EQ(crossings(simulation), 0U);
  EXPECT_EQ(simulation.frame(), 0);
  EXPECT_EQ(simulation.state().time, 0);
  for (int frame = 0; frame < 3; ++frame) simulation.advance();
  EXPECT_EQ(crossings(simulation), 0U);
  EXPECT_EQ(simulation.tangled(), 0U);
}

TEST(Untangle, ASleeveWithADentLeavesTheArm) {
  TangledScene scene;
  scene.tube("sleeve", 0.3, 60, 24, test::dented_sleeve, false);
  scene.tube("arm", 0.6, 40, 20, [](double, double) { return 0.05; }, true);
  Simulation simulation(scene.build());
  expect_repaired(simulation);
  for (const Vec3& x : points(simulation, "sleeve")) EXPECT_GT(std::hypot(x.x(), x.z()), 0.0498);
}

TEST(Untangle, ASleeveInsideTheArmEverywhereComesOut) {
  TangledScene scene;  // crosses nothing
  scene.tube("sleeve", 0.3, 60, 24, [](double, double) { return 0.048; }, false);
  scene.tube("arm", 0.6, 40, 20, [](double, double) { return 0.05; }, true);
  Simulation simulation(scene.build());
  EXPECT_EQ(simulation.untangled().crossings, 0U);
  EXPECT_EQ(simulation.untangled().lost, 1500U);
  EXPECT_NEAR(simulation.untangled().depth, 0.002, 3e-4);
  expect_repaired(simulation);
  for (const Vec3& x : points(simulation, "sleeve")) EXPECT_GT(std::hypot(x.x(), x.z()), 0.0498);
}

TEST(Untangle, ATightSleeveOfStiffClothComesOutOfACoarseArm) {
  // The arm has ten corners, between which it is inside the sleeve: contours are everywhere. To be outside,
  // the sleeve has to stretch by some percent, and its membrane is five times as stiff as contact.
  TangledScene scene;
  scene.cloth("'wool'").tube("sleeve", 0.2, 19, 10, [](double, double) { return 0.049; }, false);
  scene.tube("arm", 0.4, 10, 16, [](double, double) { return 0.05; }, true);
  Simulation simulation(scene.build());
  EXPECT_GT(simulation.untangled().crossings, 200U);
  expect_repaired(simulation);
  EXPECT_EQ(simulation.untangled().lost_left, 0U);
  const Diagnostics last = simulation.diagnostics();
  EXPECT_EQ(last.converged_steps, last.steps);
  EXPECT_LT(last.max_stretch, 1.06);
  EXPECT_GT(last.min_distance, 0);
}

TEST(Untangle, ADentInAJacketComesBackOverTheShirt) {
  TangledScene scene;  // two meshes of one grid, so that edges meet edges
  scene.sheet("shirt", 0.4, 40, [](double, double) { return 0.0; });
  scene.sheet("jacket", 0.4, 40, test::dent);
  Simulation simulation(scene.build());
  expect_repaired(simulation);
  const ConstVectors shirt = points(simulation, "shirt"), jacket = points(simulation, "jacket");
  for (std::size_t v = 0; v < shirt.size(); ++v) EXPECT_GT(jacket[v].y(), shirt[v].y());
}

TEST(Untangle, SheetsThatWeaveThroughEachOtherBecomeLayers) {
  TangledScene scene;
  scene.sheet("shirt", 0.4, 24, [](double, double) { return 0.0; });
  scene.sheet("jacket", 0.38, 24,
              [](double x, double z) { return 0.001 + 0.006 * std::sin(40 * x) * std::cos(35 * z); });
  Simulation simulation(scene.build());
  expect_repaired(simulation);
}

TEST(Untangle, LayersDecideWhichSideIsRight) {
  for (const bool inner_first : {true, false}) {
    TangledScene scene;  // the lesser area would have to move if the lower sheet stayed below
    scene.sheet(
        "low", 0.4, 24, [](double x, double) { return 0.002 - 0.006 * std::cos(9 * x); },
        inner_first ? "layer = 1" : "layer = 2");
    scene.sheet(
        "high", 0.38, 24, [](double, double) { return 0.0; }, inner_first ? "layer = 2" : "layer = 1");
    Simulation simulation(scene.build());
    expect_repaired(simulation);
    double height = 0;
    for (const Vec3& x : points(simulation, "high")) height += x.y() / 625;
    for (const Vec3& x : points(simulation, "low")) height -= x.y() / 625;
    EXPECT_EQ(height > 0, inner_first) << height;
  }
}

TEST(Untangle, ABladeThroughASheetIsDrawnOut) {
  TangledScene scene;
  scene.sheet("sheet", 0.5, 40, [](double, double) { return 0.0; });
  scene.sheet("blade", 0.25, 25, TangledScene::Place([](double x, double z) {
                return Vec3(x, z + 0.063 + 0.02 * x, 0.011 + 0.02 * x);
              }));
  Simulation simulation(scene.build());
  double low = 1;  // was −0.064
  for (const Vec3& x : points(simulation, "blade")) low = std::min(low, x.y());
  EXPECT_GT(low, -0.02);  // the sheet gives way a little
  expect_repaired(simulation);
}

TEST(Untangle, ClothUnderAPlaneAndInABallComesOut) {
  TangledScene scene;
  scene.sheet("cloth", 0.4, 24, [](double x, double) { return 0.01 * std::sin(20 * x); });
  scene.add("[[collider]]\nname = 'floor'\nshape = 'plane'\n");
  scene.add("[[collider]]\nname = 'ball'\nshape = 'sphere'\ncenter = [0, -0.09, 0]\nradius = 0.1\n");
  Simulation simulation(scene.build());
  expect_repaired(simulation);
  for (const Vec3& x : points(simulation, "cloth")) {
    EXPECT_GT(x.y(), 0);
    EXPECT_GT((x - Vec3(0, -0.09, 0)).norm(), 0.1);
  }
}

TEST(Untangle, SurfacesCloserThanTheirThicknessMoveApartWithoutAJump) {
  TangledScene scene;
  scene.sheet("low", 0.3, 15, [](double, double) { return 0.0; }, "thickness = 0.002");
  scene.sheet("high", 0.28, 15, [](double, double) { return 0.0005; }, "thickness = 0.002");
  Simulation simulation(scene.build());
  EXPECT_EQ(simulation.untangled().crossings, 0U);
  EXPECT_GT(simulation.untangled().close, 0U);
  expect_repaired(simulation);
  EXPECT_LT(simulation.untangled().moved, 0.004);
  EXPECT_LT(simulation.diagnostics().kinetic, 1e-4);
}

TEST(Untangle, ClothDeepInsideAClosedBoxStays) {
  TangledScene scene;
  scene.sheet("cloth", 0.3, 15, [](double, double) { return 0.0; });
  scene.add("[[collider]]\nname = 'room'\nshape = 'box'\ncenter = [0, 0, 0]\nsize = [2, 2, 2]\n");
  Simulation simulation(scene.build());
  EXPECT_FALSE(simulation.untangled().needed());
  EXPECT_EQ(simulation.state().positions, simulation.model().rest_positions);
}

TEST(Untangle, ACleanStartKeepsItsBits) {
  TangledScene scene;
  scene.sheet("low", 0.3, 15, [](double, double) { return 0.0; });
  scene.sheet("high", 0.28, 15, [](double, double) { return 0.01; });
  scene.add("[[force]]\ntype = 'gravity'\n");
  Simulation repaired(scene.build()), refused(scene.build("tangled = 'refuse'"));
  for (int frame = 0; frame < 2; ++frame) {
    repaired.advance();
    refused.advance();
    EXPECT_EQ(repaired.state().positions, refused.state().positions);
  }
}

TEST(Untangle, GivesTheSameBitsForAnyThreadCount) {
  TangledScene scene;
  scene.sheet("shirt", 0.4, 30, [](double, double) { return 0.0; });
  scene.sheet("jacket", 0.4, 30, test::dent);
  const auto model = scene.build();
  set_thread_count(1);
  const Simulation one(model);
  set_thread_count(3);
  const Simulation three(model);
  set_thread_count(0);
  EXPECT_EQ(one.state().positions, three.state().positions);
}

TEST(Untangle, PinsStayAndWhatTheyHoldTogetherIsNamed) {
  TangledScene scene;
  scene.sheet("low", 0.2, 8, [](double, double) { return 0.0; });
  scene.sheet("high", 0.18, 8, [](double x, double) { return 0.1 * x; });
  scene.add("[[pin]]\nbody = 'low'\nwhere = { box = [[-1, -1, -1], [1, 1, 1]] }\n");
  scene.add("[[pin]]\nbody = 'high'\nwhere = { box = [[-1, -1, -1], [1, 1, 1]] }\n");
  const Simulation simulation(scene.build());
  EXPECT_EQ(simulation.state().positions, simulation.model().rest_positions);
  EXPECT_GT(simulation.untangled().left, 0U);
  EXPECT_EQ(simulation.tangled(), simulation.untangled().left);
  const std::string text = describe(simulation.untangled());
  EXPECT_THAT(text, HasSubstr("pairs of triangles still cross"));
  EXPECT_THAT(text, HasSubstr("of \"low\" crosses face"));
}

TEST(Untangle, SaysWhatStaysInsideThoughNothingCrosses) {
  TangledScene scene;
  scene.sheet("cloth", 0.4, 8, [](double, double) { return 0.095; });
  scene.add("[[collider]]\nname = 'table'\nshape = 'box'\ncenter = [0, 0, 0]\nsize = [1, 0.2, 1]\n");
  scene.add("[[pin]]\nbody = 'cloth'\nwhere = { box = [[-1, -1, -1], [1, 1, 1]] }\n");
  const Simulation simulation(scene.build());
  EXPECT_EQ(simulation.untangled().left, 0U);
  EXPECT_EQ(simulation.untangled().lost_left, 81U);
  EXPECT_THAT(describe(simulation.untangled()), HasSubstr("81 points are still on a wrong side"));
}

TEST(Untangle, RefusesOrIgnoresIfTheSceneSaysSo) {
  TangledScene scene;
  scene.sheet("shirt", 0.4, 20, [](double, double) { return 0.0; });
  scene.sheet("jacket", 0.4, 20, test::dent);
  try {
    const Simulation simulation(scene.build("tangled = 'refuse'"));
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("surfaces cross at the start"));
    EXPECT_THAT(error.what(), HasSubstr("contact.tangled"));
  }
  const Simulation ignored(scene.build("tangled = 'ignore'"));
  EXPECT_EQ(ignored.state().positions, ignored.model().rest_positions);
  EXPECT_FALSE(ignored.untangled().needed());
  EXPECT_GT(ignored.tangled(), 0U);
}

TEST(Untangle, CanBeInterrupted) {
  TangledScene scene;
  scene.sheet("shirt", 0.4, 20, [](double, double) { return 0.0; });
  scene.sheet("jacket", 0.4, 20, test::dent);
  Progress progress;
  std::vector<std::string> stages;
  progress.report = [&](double, std::string_view stage) { stages.emplace_back(stage); };
  progress.cancelled = [&] { return !stages.empty(); };
  try {
    const Simulation simulation(scene.build(), {}, progress);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::interrupted);
  }
  ASSERT_FALSE(stages.empty());
  EXPECT_THAT(stages.front(), HasSubstr("places left"));
}

}  // namespace
}  // namespace muslin
