// Friction varies over time by keyframes.
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <numeric>
#include <string>
#include <vector>

#include "cache/scratch.hpp"
#include "support/sheet.hpp"
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "muslin/contact/contact_surface.hpp"
#include "muslin/core/keyed_number.hpp"
#include "muslin/core/parallel.hpp"
#include "muslin/simulation/simulation.hpp"

namespace muslin {
namespace {

using testing::HasSubstr;

constexpr double slope = 20 * std::numbers::pi / 180, g = 9.81;
constexpr int frame_rate = 24, steps_per_frame = 8;

constexpr const char* shell =
    "model = 'shell'\nthickness = 0.001\nmaterial = { areal_density = 0.3, membrane_warp = 3000, "
    "bending_warp = 0.01 }\n";
constexpr const char* block =
    "thickness = 0.01\nvoxel_width = 0.025\nmaterial = { density = 90, youngs_modulus = 3000 }\n";
constexpr const char* all_faces =
    "[[body.fabric]]\nfaces = 'all'\nmaterial = { areal_density = 0.3, membrane_warp = 3000, bending_warp = "
    "0.01 }\n";

/// Keys of the owners of friction in a scene.
struct Owners {
  std::string body = shell, slope = {}, contact = {}, rest = {};
};

/// A square on a slope of 20° that falls along x.
class KeyedFriction : public testing::Test {
 protected:
  KeyedFriction() : mesh_(test::flat_sheet(4, 4, 0.1, 0.1)) {
    MeshGroup all{"all", {}, {}};
    for (int f = 0; f < static_cast<int>(mesh_.face_count()); ++f) all.faces.push_back(f);
    mesh_.groups = {all};
  }

  std::shared_ptr<const Model> model(const Owners& owners) const {
    Scene scene = parse_scene(
        fmt::format("[time]\nduration = 2\nframe_rate = {}\nsteps_per_frame = {}\n[contact]\ndistance = "
                    "0.002\n{}\n[[body]]\nname = "
                    "'square'\nmesh = 'square'\nself_contact = false\ntranslate = [0, 0.0025, 0]\n{}\n"
                    "[[collider]]\nname = 'slope'\nshape = 'plane'\n{}\n[[force]]\ntype = 'gravity'\n"
                    "acceleration = [{}, {}, 0]\n{}",
                    frame_rate, steps_per_frame, owners.contact, owners.body, owners.slope,
                    g * std::sin(slope), -g * std::cos(slope), owners.rest),
        scratch_.path() / "scene.toml");
    scene.meshes["square"] = std::make_shared<Mesh>(mesh_);
    return std::make_shared<const Model>(build_model(scene));
  }
  static void advance(Simulation& simulation, int frames) {
    for (int f = 0; f < frames; ++f) simulation.advance();
  }
  std::vector<Vec3> run(const Owners& owners, int frames = 8) const {
    Simulation simulation(model(owners));
    advance(simulation, frames);
    return simulation.state().positions;
  }
  /// Returns the mean over the vertices of the square, which come first.
  static Vec3 mean(const Simulation& simulation, ConstVectors values) {
    const ConstVectors own =
        values.first(static_cast<std::size_t>(simulation.model().bodies[0].vertex_count));
    return std::accumulate(own.begin(), own.end(), Vec3(Vec3::Zero())) / static_cast<double>(own.size());
  }
  static Vec3 position(const Simulation& simulation) {
    return mean(simulation, simulation.state().positions);
  }
  static double speed(const Simulation& simulation) {
    return mean(simulation, simulation.state().velocities).x();
  }
  std::string complaint(const Owners& owners) const {
    try {
      model(owners);
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  }

  test::Scratch scratch_;
  Mesh mesh_;
};

TEST_F(KeyedFriction, OfOneValueEqualsTheNumberBitForBit) {
  const std::string number = "friction = 0.3\n",
                    keys =
                        "friction = { keyframes = [{ time = 0, value = 0.3 }, { time = 0.1, value = 0.3, "
                        "interpolation = 'smooth' }, { time = 0.2, value = 0.3 }] }\n";
  const std::string pair = "[[contact.pair]]\nbetween = ['square', 'slope']\n";
  const auto expect_equal = [&](const Owners& constant, const Owners& keyed) {
    EXPECT_EQ(run(constant, 4), run(keyed, 4));
  };
  for (const char* body : {shell, block}) expect_equal({body + number}, {body + keys});
  expect_equal({.slope = number}, {.slope = keys});
  expect_equal({.contact = number}, {.contact = keys});
  expect_equal({.rest = pair + number}, {.rest = pair + keys});
  expect_equal({std::string(shell) + all_faces + number}, {std::string(shell) + all_faces + keys});
}

TEST_F(KeyedFriction, IsThatOfEveryOwner) {
  const std::string keys =
      "friction = { keyframes = [{ time = 0.1, value = 0.6 }, { time = 0.2, value = 0.1 }] }\n";
  const std::vector<Vec3> common = run({.contact = keys});
  EXPECT_NE(common, run({.contact = "friction = 0.6\n"}));
  EXPECT_EQ(run({.body = shell + keys, .slope = keys}), common);
  EXPECT_EQ(run({.body = std::string(shell) + all_faces + keys, .slope = keys}), common);
  EXPECT_EQ(run({.rest = "[[contact.pair]]\nbetween = ['square', 'slope']\n" + keys}), common);
}

// Friction falls from 0.8 by 0.8 per second from 0.2 s on. The square slides once μ < tan 20°, from t on, and
// its acceleration is then g (sin 20° − μ cos 20°), so that it has the velocity 0.4 g cos 20° (T − t)² at T.
TEST_F(KeyedFriction, LetsASquareSlideOnceItFallsBelowTheSlope) {
  const std::string keys =
      "friction = { keyframes = [{ time = 0.2, value = 0.8 }, { time = 1.2, value = 0 }] }\n";
  constexpr double rate = 0.8;
  const double slides = 0.2 + (0.8 - std::tan(slope)) / rate;
  for (const char* body : {shell, block}) {
    Simulation simulation(model({.body = body, .contact = keys}));
    advance(simulation, 4);
    const Vec3 start = position(simulation);
    for (int frame = 5; frame <= 1.2 * frame_rate; ++frame) {
      simulation.advance();
      const double time = static_cast<double>(frame) / frame_rate, sliding = std::max(0.0, time - slides);
      const Vec3 way = position(simulation) - start;
      const double velocity = speed(simulation),
                   expected = 0.5 * rate * g * std::cos(slope) * sliding * sliding;
      if (time < slides) {
        EXPECT_LT(std::abs(way.x()), 1e-5) << time;
      }
      EXPECT_NEAR(velocity, expected, 0.01 * expected + 2.5e-3) << time;
    }
  }
}

TEST_F(KeyedFriction, StopsASquareThatSlides) {
  // μ steps from 0 to 0.8 just after 0.25 s, when v = g sin 20° 0.25 s; then a = g (sin 20° − 0.8 cos 20°).
  Simulation simulation(model({.contact = "friction = { keyframes = [{ time = 0, value = 0, interpolation = "
                                          "'step' }, { time = 0.2501, value = 0.8 }] }\n"}));
  advance(simulation, 6);
  const double fast = g * std::sin(slope) * 0.25, braking = g * (0.8 * std::cos(slope) - std::sin(slope));
  EXPECT_NEAR(speed(simulation), fast, 0.01 * fast);
  const double before = position(simulation).x();
  advance(simulation, 8);
  EXPECT_NEAR(speed(simulation), 0, 1e-3);
  EXPECT_NEAR(position(simulation).x() - before, fast * fast / (2 * braking),
              0.03 * fast * fast / (2 * braking));
}

TEST_F(KeyedFriction, HasTheSameBitsAcrossAResumeAndForAnyNumberOfThreads) {
  const Owners owners = {.contact =
                             "friction = { keyframes = [{ time = 0.1, value = 0.6, interpolation = "
                             "'smooth' }, { time = 0.3, value = 0.1 }] }\n"};
  const std::vector<Vec3> whole = run(owners, 8);
  Simulation before(model(owners));
  advance(before, 5);
  Simulation after(model(owners));
  after.restore(before.checkpoint());
  advance(after, 3);
  EXPECT_EQ(after.state().positions, whole);
  set_thread_count(1);
  EXPECT_EQ(run(owners, 8), whole);
  set_thread_count(0);
}

TEST_F(KeyedFriction, ChangesOnAResumeFromAnyFrame) {
  Simulation before(model({.contact = "friction = 0.6\n"}));
  advance(before, 5);
  EXPECT_LT(std::abs(speed(before)), 1e-3);
  Simulation after(model({.contact = "friction = { keyframes = [{ time = 0, value = 0.6, interpolation = "
                                     "'step' }, { time = 0.2501, value = 0 }] }\n"}));
  after.restore(before.checkpoint());
  advance(after, 7);
  const double expected = g * std::sin(slope) * 0.25;
  EXPECT_NEAR(speed(after), expected, 0.01 * expected);
}

TEST_F(KeyedFriction, IsRefusedByNameAndPlace) {
  const std::string bad =
      "friction = { keyframes = [{ time = 0, value = 1 }, { time = 0.5, value = -0.1 }] }\n";
  EXPECT_THAT(complaint({.contact = bad}), HasSubstr("scene.toml:7:12: `friction` is -0.1 at 0.5 s"));
  EXPECT_THAT(complaint({.body = shell + bad}), HasSubstr("`friction` is -0.1 at 0.5 s"));
  EXPECT_THAT(complaint({.slope = bad}),
              HasSubstr("scene.toml:20:12: `friction` is -0.1 at 0.5 s; give a number from 0 to 100"));
  EXPECT_THAT(complaint({.rest = "[[contact.pair]]\nbetween = ['square', 'slope']\n" + bad}),
              HasSubstr("`friction` is -0.1 at 0.5 s"));
  EXPECT_THAT(
      complaint({.contact = "friction = { keyframes = [{ time = 1, value = 1 }, { time = 1, value = 0 "
                            "}] }\n"}),
      HasSubstr("time"));
  EXPECT_THAT(complaint({.contact = "friction = { map = 'all', from = 0, to = 1 }\n"}),
              HasSubstr("`friction` cannot vary by a map"));
}

TEST_F(KeyedFriction, HasNoKeysOfThicknessAndDistanceBesideIt) {
  const std::string pair = "[[contact.pair]]\nbetween = ['square', 'slope']\n",
                    keys = " = { keyframes = [{ time = 0, value = 0.001 }] }\n";
  const std::string thickness =
      "`thickness` cannot vary by keyframes: surfaces that thicken would cross those that they touch";
  EXPECT_THAT(complaint({.body = "model = 'shell'\nmaterial = 'cotton'\nthickness" + keys}),
              HasSubstr(thickness));
  EXPECT_THAT(complaint({.rest = pair + "thickness" + keys}), HasSubstr(thickness));
  EXPECT_THAT(complaint({.rest = pair + "distance" + keys}),
              HasSubstr("`distance` cannot vary by keyframes: a longer one would throw apart"));
}

TEST(KeyedFrictionOfSurfaces, IsTakenAtATimeAndNeverNegative) {
  KeyedNumber falls, negative;
  falls.keys = {{0, 0.4}, {1, 0.1}};
  negative.keys = {{0, 0.4}, {1, -0.1}};
  const ContactSurface surface({{0, 1, 2}}, {0, 0, 0, 1}, {{.friction = falls}, {}}, {}, {},
                               {.friction = {-1, -1, falls, -1}, .radius = {}});
  const std::array triangle = {0, 1, 2}, other = {3, 3, 3};
  const std::array weights = {-0.2, -0.5, -0.3};
  const std::array one = {1.0};
  for (const double time : {-1.0, 0.0, 0.5, 2.0})
    EXPECT_DOUBLE_EQ(surface.friction({{other.data(), 1}, one}, {triangle, weights}, 0.9, time),
                     std::sqrt(0.9 * falls.at(time)));
  EXPECT_THROW(ContactSurface({{0, 1, 2}}, {0, 0, 0}, {{.friction = negative}}), Error);
  ContactRule rule;
  rule.friction = negative;
  EXPECT_THROW(ContactRules({rule}, 1), Error);
}

}  // namespace
}  // namespace muslin
