// `[[contact.pair]]`, `ignore` of pins, and the contact distance of each body: what is read and refused, and
// what they do in a run.
#include "muslin/scene/contact_pair.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "muslin/contact/contact_model.hpp"
#include "muslin/contact/crossings.hpp"
#include "muslin/core/error.hpp"
#include "muslin/scene/describe.hpp"
#include "muslin/scene/model.hpp"
#include "muslin/simulation/simulation.hpp"

namespace muslin {
namespace {

using testing::HasSubstr;

constexpr int across = 11;  // vertices along a side of a cloth

/// A square of `size` at y = 0; its vertices with x > 0 are the group `right`.
Mesh square(double size) {
  Mesh mesh;
  MeshGroup right{"right", {}, {}};
  for (int i = 0; i < across; ++i) {
    for (int j = 0; j < across; ++j) {
      const double x = size * (i / (across - 1.0) - 0.5), z = size * (j / (across - 1.0) - 0.5);
      if (x > 1e-9) right.vertices.push_back(static_cast<int>(mesh.positions.size()));
      mesh.positions.emplace_back(x, 0, z);
    }
  }
  for (int i = 0; i + 1 < across; ++i) {
    for (int j = 0; j + 1 < across; ++j) {
      const int at = i * across + j;
      mesh.add_face(std::array{at, at + 1, at + across + 1, at + across});
    }
  }
  mesh.groups.push_back(right);
  return mesh;
}

std::string cloth(const std::string& name, double y, const std::string& mesh = "square") {
  return "[[body]]\nname = '" + name + "'\nmodel = 'shell'\nmesh = '" + mesh + "'\ntranslate = [0, " +
         std::to_string(y) +
         ", 0]\nwarp = [1, 0, 0]\nmaterial = { areal_density = 0.2, membrane_warp = 500, bending_warp = "
         "1e-5, "
         "poisson = 0.2, mass_damping = 2 }\n";
}
std::string floor_at(double y) {
  return "[[collider]]\nname = 'floor'\nshape = 'plane'\ncenter = [0, " + std::to_string(y) +
         ", 0]\nnormal = [0, 1, 0]\n";
}
const std::string gravity = "[[force]]\ntype = 'gravity'\n";
const std::string table =
    "[[collider]]\nname = 'table'\nshape = 'box'\ncenter = [0, 0, 0]\nsize = [0.1, 0.02, 0.1]\n";

Scene read(const std::string& text) {
  Scene scene = parse_scene("[time]\nduration = 1\n" + text, "scene.toml");
  scene.meshes["square"] = std::make_shared<const Mesh>(square(0.2));
  scene.meshes["large"] = std::make_shared<const Mesh>(square(4));
  return scene;
}
std::shared_ptr<const Model> model_of(const std::string& text) {
  return std::make_shared<const Model>(build_model(read(text)));
}

std::string message(const std::string& text) {
  try {
    build_model(read(text));
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    return error.what();
  }
  return "no error";
}

/// The lowest vertex of those of the cloth that are not in the group.
double lowest_of_left(const Simulation& simulation) {
  const Model& model = simulation.model();
  const ConstVectors x = model.of(model.body("cloth"), simulation.state().positions);
  double least = 1e9;
  for (std::size_t v = 0; v < across * (across / 2 + 1); ++v) least = std::min(least, x[v].y());
  return least;
}

/// The lowest vertex of a body.
double lowest(const Simulation& simulation, const std::string& name) {
  const Model& model = simulation.model();
  double least = 1e9;
  for (const Vec3& x : model.of(model.body(name), simulation.state().positions))
    least = std::min(least, x.y());
  return least;
}

void run(Simulation& simulation, int frames) {
  for (int frame = 0; frame < frames; ++frame) simulation.advance();
}

TEST(ContactPair, IsReadAndResolved) {
  const Scene scene = read(cloth("cloth", 0.1) + floor_at(0) +
                           "[[contact.pair]]\nbetween = ['cloth', { body = 'floor' }]\nfriction = 0.1\n"
                           "[[contact.pair]]\nbetween = [{ body = 'cloth', group = 'right' }, 'floor']\n"
                           "contact = false\nfrom = 0.2\nuntil = 0.4\n");
  ASSERT_EQ(scene.contact.pairs.size(), 2U);
  EXPECT_EQ(scene.contact.pairs[0].between[1].body, "floor");
  EXPECT_EQ(scene.contact.pairs[0].friction, 0.1);
  EXPECT_EQ(scene.contact.pairs[1].between[0].group, "right");
  EXPECT_FALSE(scene.contact.pairs[1].contact);
  EXPECT_EQ(scene.contact.pairs[1].until, 0.4);
  const auto resolved = nlohmann::json::parse(scene.resolved)["contact"]["pair"];
  EXPECT_EQ(resolved[0]["between"], nlohmann::json({"cloth", "floor"}));
  EXPECT_EQ(resolved[1]["between"][0]["group"], "right");
}

TEST(ContactPair, ErrorsNameThePlaceAndTheNearestName) {
  const std::string scene = cloth("cloth", 0.1) + floor_at(0);
  EXPECT_THAT(message(scene + "[[contact.pair]]\nbetween = ['cloth', 'flor']\n"),
              testing::AllOf(HasSubstr("scene.toml:16:21"), HasSubstr("no body or collider `flor`"),
                             HasSubstr("did you mean `floor`?")));
  EXPECT_THAT(message(scene + "[[contact.pair]]\nbetween = ['cloth']\n"), HasSubstr("`between` has 1 sides"));
  EXPECT_THAT(message(scene + "[[contact.pair]]\nfriction = 1\n"), HasSubstr("has no `between`"));
  EXPECT_THAT(message(scene + "[[contact.pair]]\nbetween = ['cloth', 7]\n"), HasSubstr("a side of"));
  EXPECT_THAT(message(scene + "[[contact.pair]]\nbetween = ['cloth', 'floor']\nfrom = 1\nuntil = 1\n"),
              HasSubstr("is not after `from`"));
  EXPECT_THAT(message(scene + "[[contact.pair]]\nbetween = [{ body = 'cloth', group = 'rigth' }, 'floor']\n"),
              testing::AllOf(HasSubstr("no group `rigth`"), HasSubstr("did you mean `right`?")));
  EXPECT_THAT(message(scene + "[[contact.pair]]\nbetween = ['cloth', 'floor']\nfrictoin = 1\n"),
              HasSubstr("did you mean `friction`?"));
  EXPECT_THAT(message(scene + "[[pin]]\nwhere = { group = 'right' }\nignore = ['flor']\n"),
              HasSubstr("did you mean `floor`?"));
  std::string many = scene;
  for (int i = 0; i < 65; ++i) many += "[[contact.pair]]\nbetween = ['cloth', 'floor']\n";
  EXPECT_THAT(message(many), HasSubstr("more than 64 rules"));
}

TEST(ContactPair, OffLetsTheTwoPassAndLeavesOthersAlone) {
  Simulation simulation(model_of(cloth("falls", 0.05) + cloth("lies", 0.07) + floor_at(0) + gravity +
                                 "[[contact.pair]]\nbetween = ['falls', 'floor']\ncontact = false\n"));
  run(simulation, 12);
  EXPECT_LT(lowest(simulation, "falls"), -0.5);
  EXPECT_GT(lowest(simulation, "lies"), 0);
}

TEST(ContactPair, TheLastOneThatMatchesHolds) {
  Simulation simulation(model_of(cloth("cloth", 0.05) + floor_at(0) + gravity +
                                 "[[contact.pair]]\nbetween = ['cloth', 'floor']\ncontact = false\n"
                                 "[[contact.pair]]\nbetween = ['cloth', 'floor']\n"));
  run(simulation, 12);
  EXPECT_GT(lowest(simulation, "cloth"), 0);
}

TEST(ContactPair, OffForAGroupLetsOnlyItsFeaturesPass) {
  Simulation simulation(model_of(
      cloth("cloth", 0.02) + floor_at(0) + gravity +
      "[[contact.pair]]\nbetween = [{ body = 'cloth', group = 'right' }, 'floor']\ncontact = false\n"));
  run(simulation, 8);
  EXPECT_GT(lowest_of_left(simulation), 0);
  EXPECT_LT(lowest(simulation, "cloth"), -0.02);
}

TEST(ContactPair, DistanceAndThicknessSetTheGapAtRest) {
  const auto height = [](const std::string& keys) {
    Simulation simulation(model_of(cloth("cloth", 0.02) + floor_at(0) + gravity +
                                   "[[contact.pair]]\nbetween = ['floor', 'cloth']\n" + keys));
    run(simulation, 24);
    return lowest(simulation, "cloth");
  };
  const double plain = height("");
  EXPECT_GT(plain, 0.0003);
  EXPECT_LT(plain, 0.001);  // d̂ = 0.4 mm on half the thickness of 1 mm
  const double wide = height("distance = 0.004\n");
  EXPECT_GT(wide, 0.002);
  EXPECT_LT(wide, 0.0046);
  const double thick = height("thickness = 0.01\n");
  EXPECT_GT(thick, 0.01);
  EXPECT_LT(thick, 0.0105);
  EXPECT_LT(height("stiffness = 1\n"), plain);
}

TEST(ContactPair, FrictionIsThatOfThePair) {
  const auto slid = [](const std::string& friction) {
    Simulation simulation(
        model_of(cloth("cloth", 0.002) + floor_at(0) +
                 "[[force]]\ntype = 'gravity'\nacceleration = [3, -9.81, 0]\n"
                 "[contact]\nfriction = 1\n[[contact.pair]]\nbetween = ['floor', 'cloth']\n" +
                 friction));
    run(simulation, 12);
    return simulation.state().positions.front().x() + 0.1;
  };
  EXPECT_LT(slid(""), 0.001);
  EXPECT_GT(slid("friction = 0.1\n"), 0.1);
}

TEST(ContactPair, WhatCrossesWhenContactBeginsIsFreeUntilItParts) {
  // The cloth hangs across the thin table when contact begins, and goes on falling.
  const std::string text = cloth("cloth", 0.02) + table + gravity +
                           "[[contact.pair]]\nbetween = ['cloth', 'table']\ncontact = false\nuntil = 0.1\n";
  const auto model = model_of(text);
  Simulation simulation(model);
  run(simulation, 3);  // 0.125 s: it has just been let through
  run(simulation, 21);
  EXPECT_LT(lowest(simulation, "cloth"), -0.5);
  EXPECT_TRUE(find_crossings(*model->contact, simulation.state().positions, 1).empty());
  EXPECT_LT(simulation.diagnostics().max_stretch, 1.1);
}

TEST(ContactPair, ARunResumesBitForBitWithinAWindow) {
  const std::string text = cloth("cloth", 0.03) + floor_at(0) + gravity +
                           "[[contact.pair]]\nbetween = ['cloth', 'floor']\nthickness = 0.004\nfrom = 0.02\n"
                           "until = 0.3\n";
  const auto model = model_of(text);
  Simulation whole(model);
  for (int frame = 0; frame < 12; ++frame) {
    Simulation resumed(model);
    resumed.restore(whole.checkpoint());
    whole.advance();
    resumed.advance();
    ASSERT_EQ(whole.checkpoint(), resumed.checkpoint()) << frame;
  }
}

TEST(ContactPair, APinIgnoresABodyWhileItHolds) {
  const std::string pin =
      "[[pin]]\nbody = 'cloth'\nwhere = { group = 'right' }\nkeyframes = [{ time = 0 }, { time = 0.4, "
      "translate "
      "= [0, -0.05, 0] }]\n";
  const std::string scene = cloth("cloth", 0.02) + floor_at(0);
  Simulation held(model_of(scene + pin)), led(model_of(scene + pin + "ignore = ['floor']\n"));
  run(held, 12);
  run(led, 12);
  EXPECT_GT(lowest(held, "cloth"), 0);
  EXPECT_NEAR(lowest(led, "cloth"), -0.03, 1e-9);
  EXPECT_GT(lowest_of_left(led), 0);
}

TEST(ContactDistance, IsThatOfTheBodyWhateverElseIsInTheScene) {
  const std::string doll = cloth("dress", 0.002) + floor_at(0) + gravity;
  const auto alone = model_of(doll), staged = model_of(doll + cloth("curtain", 3, "large"));
  const auto distance = [](const Model& model, const std::string& name) {
    const auto json = nlohmann::json::parse(describe_json(model, {}));
    for (const auto& body : json["contact"]["distances"])
      if (body["body"] == name) return body["distance"].get<double>();
    return 0.0;
  };
  EXPECT_NEAR(distance(*alone, "dress"), 0.2 / 500, 1e-12);
  EXPECT_NEAR(distance(*staged, "dress"), 0.2 / 500, 1e-12);
  EXPECT_NEAR(distance(*staged, "curtain"), 4.0 / 500, 1e-12);
  Simulation first(alone), second(staged);
  run(first, 12);
  run(second, 12);
  EXPECT_NEAR(lowest(first, "dress"), lowest(second, "dress"), 1e-5);
}

}  // namespace
}  // namespace muslin
