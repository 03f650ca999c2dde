// selections.json says which vertices pins and point forces hold, and survives being damaged.
#include "muslin/cache/selections.hpp"

#include <limits>

#include "cache/scratch.hpp"
#include "support/small_model.hpp"
#include <gtest/gtest.h>

#include "muslin/cache/run_reader.hpp"
#include "muslin/cache/run_writer.hpp"
#include "muslin/core/error.hpp"

namespace muslin {
namespace {

using test::Scratch;

void begin_run(const std::filesystem::path& directory, Model model, bool resume = false) {
  Simulation simulation(std::make_shared<const Model>(std::move(model)));
  RunWriter writer(directory, simulation, 1, resume);
}

Model with_force() {
  Model model = test::small_model();
  ForceSettings force;
  force.type = "point";
  force.name = "tug";
  force.body = "flag";
  force.where.emplace().nearest = {Vec3(3, 0, 0)};
  model.scene.forces = {ForceSettings{}, force};
  return model;
}

TEST(Selections, AreReadBackAsInTheModel) {
  Scratch scratch;
  const Model model = with_force();
  begin_run(scratch / "run", model);
  const RunReader run(scratch / "run");
  ASSERT_EQ(run.selections().pins.size(), 1u);
  const Chosen& pin = run.selections().pins[0];
  EXPECT_EQ(pin.name, "corners");
  EXPECT_EQ(pin.body, 0);
  EXPECT_EQ(pin.vertices, model.pins[0].vertices);
  EXPECT_EQ(pin.from, 0);
  EXPECT_EQ(pin.until, 0.6);
  ASSERT_EQ(run.selections().point_forces.size(), 1u);
  const Chosen& force = run.selections().point_forces[0];
  EXPECT_EQ(force.name, "tug");
  EXPECT_EQ(force.force, 1);
  ASSERT_EQ(force.vertices.size(), 1u);
  EXPECT_EQ(run.cells(0).rest_positions[static_cast<std::size_t>(force.vertices[0])], Vec3(3, 0, 0));
}

TEST(Selections, OfPinsWithoutEndAreReadBack) {
  Scratch scratch;
  Model model = test::small_model();
  model.pins[0].until = std::numeric_limits<double>::infinity();
  begin_run(scratch / "run", model);
  EXPECT_EQ(RunReader(scratch / "run").selections().pins[0].until, std::numeric_limits<double>::infinity());
}

TEST(Selections, FollowAPinThatChangedOnResume) {
  Scratch scratch;
  Model model = test::small_model();
  begin_run(scratch / "run", model);
  model.pins[0].vertices.resize(1);
  begin_run(scratch / "run", model, true);
  EXPECT_EQ(RunReader(scratch / "run").selections().pins[0].vertices.size(), 1u);
}

TEST(Selections, MayBeMissingButNotDamaged) {
  Scratch scratch;
  begin_run(scratch / "run", test::small_model());
  const auto path = scratch / "run/selections.json";
  const std::string good = test::bytes_of(path);
  const std::string bad[] = {
      "",
      "[]",
      "{\"pins\":3}",
      good.substr(0, good.size() / 2),
      R"({"pins":[{"name":"a","body":"flag","from":0,"until":1,"vertices":[1000]}],)"
      R"("point_forces":[]})",
      R"({"pins":[{"name":"a","body":"none","from":0,"until":1,"vertices":[0]}],)"
      R"("point_forces":[]})",
      R"({"pins":[],"point_forces":[],"cords":[{"name":"a","slackens":true,"from":0,)"
      R"("until":1,"ends":[{"body":"flag","points":[0,1,9999],"weights":[1,0,0]}]}]})"};
  for (const std::string& content : bad) {
    test::write_bytes(path, content);
    try {
      RunReader run(scratch / "run");
      ADD_FAILURE() << content;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input) << content;
    }
  }
  std::filesystem::remove(path);
  EXPECT_TRUE(RunReader(scratch / "run").selections().pins.empty());
}

}  // namespace
}  // namespace muslin
