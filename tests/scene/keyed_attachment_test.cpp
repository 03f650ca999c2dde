// Stiffness, damping and breaking force of attachments vary over time by keyframes.
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "support/potential_battery.hpp"
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "muslin/constraint/attachment.hpp"
#include "muslin/core/error.hpp"
#include "muslin/core/parallel.hpp"
#include "muslin/scene/model.hpp"
#include "muslin/simulation/simulation.hpp"

namespace muslin {
namespace {

using testing::HasSubstr;

constexpr double g = 9.8, height = 0.3;  // of the ball at the start [m]

/// A ball hung by `string`, of 0.2 m, below a post; `keys` are those of the string.
std::string hung(const std::string& keys, const std::string& name = "string") {
  return fmt::format(
      "[[attachment]]\nname = '{}'\nbody = 'ball'\nwhere = {{ nearest = [0, 0.35, 0] }}\nto = 'post'\n"
      "rest = 'cord'\n{}",
      name, keys);
}
std::shared_ptr<const Model> model_of(const std::string& attachments) {
  const Scene scene = parse_scene(
      fmt::format("[time]\nduration = 5\nsteps_per_frame = 4\n[solver]\neffort = 'exact'\n"
                  "[[collider]]\nname = 'ball'\nshape = 'sphere'\ncenter = [0, {}, 0]\nradius = 0.05\n"
                  "density = 20\n"
                  "[[collider]]\nname = 'post'\nshape = 'box'\nsize = [0.1, 0.1, 0.1]\ncenter = [0, 0.6, 0]\n"
                  "[[force]]\ntype = 'gravity'\n{}",
                  height, attachments),
      "scene.toml");
  return std::make_shared<const Model>(build_model(scene));
}
double weight() { return g * model_of("")->body("ball").statistics.mass; }
/// How far the ball has sunk.
double sunk(const Simulation& simulation) {
  const Component& ball = simulation.model().body("ball");
  double sum = 0, mass = 0;
  for (int i = ball.first_vertex; i < ball.first_vertex + ball.vertex_count; ++i) {
    const auto v = static_cast<std::size_t>(i);
    sum += simulation.model().masses[v] * simulation.state().positions[v].y();
    mass += simulation.model().masses[v];
  }
  return height - sum / mass;
}
double closed(const Simulation& simulation) {
  return simulation.diagnostics().balance() - simulation.diagnostics().unbalanced;
}
void advance_to(Simulation& simulation, int frame) {
  while (simulation.frame() < frame) simulation.advance();
}
std::string message(const std::string& keys) {
  try {
    model_of(hung(keys));
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    return error.what();
  }
  return "no error";
}

constexpr const char* softening =
    "stiffness = { keyframes = [{ time = 1, value = 100, interpolation = 'smooth' }, { time = 4, value = 50 "
    "}] }\ndamping = 1\n";

// The load hangs at W/k(t), the account closes, and the work from outside is ∫ ½ (W/k)² dk = ½ W² (1/k₀ −
// 1/k₁).
TEST(KeyedAttachment, SlowlyChangingSpringGivesWayByTheWeightOverK) {
  Simulation simulation(model_of(hung(softening)));
  const double w = weight();
  advance_to(simulation, 23);
  const double start = closed(simulation), work = simulation.diagnostics().work;
  while (simulation.frame() < 108) {
    simulation.advance();
    const double share = std::min(1.0, std::max(0.0, (simulation.state().time - 1) / 3));
    const double k = 100 - 50 * share * share * (3 - 2 * share);
    EXPECT_NEAR(sunk(simulation), w / k, 0.02 * w / k) << simulation.frame();
    EXPECT_NEAR(closed(simulation), start, 1e-10);
  }
  EXPECT_NEAR(sunk(simulation), w / 50, 1e-3 * w / 50);
  EXPECT_NEAR(simulation.attachment_force("string").sum.y(), w, 1e-3 * w);
  const double expected = 0.5 * w * w * (1.0 / 100 - 1.0 / 50);
  EXPECT_NEAR(simulation.diagnostics().work - work, expected, 0.02 * std::abs(expected));
  EXPECT_EQ(simulation.diagnostics().material_work, 0) << "it is no material";
}

TEST(KeyedAttachment, StepOfTheStiffnessPutsInHalfOfTheChangeTimesTheSquare) {
  Simulation simulation(
      model_of(hung("stiffness = { keyframes = [{ time = 0, value = 50, interpolation = 'step' }, { time = "
                    "2, value = 80 }] }\ndamping = 1\n")));
  advance_to(simulation, 47);
  const double x = simulation.attachment_force("string").sum.y() / 50, work = simulation.diagnostics().work;
  advance_to(simulation, 60);
  EXPECT_NEAR(simulation.diagnostics().work - work, 0.5 * 30 * x * x, 1e-3 * 15 * x * x);
}

TEST(KeyedAttachment, KeyframesOfOneNumberEqualItBitForBit) {
  const auto keyed = [](double value) {
    return fmt::format("{{ keyframes = [{{ time = 0, value = {} }}, {{ time = 0.1, value = {} }}] }}", value,
                       value);
  };
  Simulation number(model_of(hung("stiffness = 70\ndamping = 0.3\nbreak_force = 1\n"))),
      keys(model_of(hung(
          fmt::format("stiffness = {}\ndamping = {}\nbreak_force = {}\n", keyed(70), keyed(0.3), keyed(1)))));
  advance_to(number, 10);
  advance_to(keys, 10);
  EXPECT_EQ(number.state().positions, keys.state().positions);
}

TEST(KeyedAttachment, OneLetsGoWhileAnotherTakesOver) {
  const auto keys = [](double first, double last) {
    return fmt::format(
        "stiffness = {{ keyframes = [{{ time = 0.5, value = {} }}, {{ time = 1.5, value = {} }}] }}\n"
        "damping = 1\n",
        first, last);
  };
  Simulation simulation(model_of(hung(keys(60, 0), "a") + hung(keys(0, 60), "b")));
  const double w = weight();
  advance_to(simulation, 70);
  EXPECT_EQ(simulation.attachment_force("a").sum.norm(), 0);
  EXPECT_EQ(simulation.attachment_force("a").holding, 1) << "it could hold again";
  EXPECT_NEAR(simulation.attachment_force("b").sum.y(), w, 1e-3 * w);
  EXPECT_NEAR(sunk(simulation), w / 60, 1e-3 * w / 60);
}

// The strength falls below the weight after two seconds.
TEST(KeyedAttachment, BreaksWhenItsStrengthFallsBelowItsForce) {
  const double w = weight();
  Simulation simulation(model_of(
      hung(fmt::format("stiffness = 100\ndamping = 2\nbreak_force = {{ keyframes = [{{ time = 1, value = {} "
                       "}}, {{ time = 2.5, value = {} }}] }}\n",
                       2 * w, 0.5 * w))));
  advance_to(simulation, 47);
  EXPECT_EQ(simulation.attachment_force("string").holding, 1);
  const double start = closed(simulation);
  advance_to(simulation, 49);
  EXPECT_EQ(simulation.attachment_force("string").holding, 0);
  EXPECT_NEAR(closed(simulation), start, 1e-10);
}

// A dashpot pulls by c(t) times the velocity, a spring by k(t) times the stretch.
TEST(KeyedAttachment, ForcesHaveTheNumbersOfTheEndOfTheStep) {
  using Weight = Joints::Weight;
  const auto joints = std::make_shared<Joints>();
  joints->add_points(std::array{Weight{0, 1}}, std::array{Weight{1, 1}});
  joints->stiffness = {10};
  joints->damping = {2};
  joints->strength = {1e9};
  AttachmentRules rules;
  rules.stiffness.keys = {{0, 1}, {1, 0.5}};
  rules.damping.keys = {{0, 0}, {1, 1}};
  const auto attachment = std::make_shared<const Attachment>("a", rules, joints);
  const std::vector<Vec3> start = {Vec3::Zero(), Vec3::Zero()}, x = {Vec3(0.3, 0, 0), Vec3::Zero()};
  StepContext step;
  step.time_begin = 0.3, step.time_end = 0.4;
  step.dt = step.length = 0.1;
  step.anchor = start;
  step.positions = start;
  EXPECT_NEAR(test::gradient(*attachment->potential(step), x)[0].x(), 10 * 0.8 * 0.3, 1e-14);
  EXPECT_NEAR(test::gradient(*AttachmentDamping(attachment).potential(step), x)[0].x(), 2 * 0.4 * 0.3 / 0.1,
              1e-14);
  rules.stiffness = -1;
  EXPECT_THROW(Attachment("a", rules, joints), Error);
}

TEST(KeyedAttachment, ResumesAndRunsOnAnyNumberOfThreadsWithTheSameBits) {
  const auto model = model_of(
      hung("stiffness = { keyframes = [{ time = 0.1, value = 100 }, { time = 0.7, value = 20 }] }\n"
           "damping = { keyframes = [{ time = 0, value = 0 }, { time = 0.6, value = 1 }] }\n"
           "break_force = { keyframes = [{ time = 0, value = 10 }, { time = 0.8, value = 0.01 }] }\n"));
  Simulation whole(model);
  advance_to(whole, 10);
  Simulation resumed(model);
  resumed.restore(whole.checkpoint());
  EXPECT_EQ(resumed.attachment_force("string").sum, whole.attachment_force("string").sum);
  set_thread_count(1);
  advance_to(resumed, 20);
  set_thread_count(2);
  advance_to(whole, 20);
  set_thread_count(0);
  EXPECT_EQ(resumed.state().positions, whole.state().positions);
  EXPECT_EQ(resumed.diagnostics().work, whole.diagnostics().work);
  EXPECT_EQ(whole.attachment_force("string").holding, 0);
}

TEST(KeyedAttachment, MayChangeOnAResumeAndTheAccountKnows) {
  Simulation simulation(model_of(hung("stiffness = 100\ndamping = 1\n")));
  advance_to(simulation, 24);
  const double x = simulation.attachment_force("string").sum.y() / 100, start = closed(simulation),
               work = simulation.diagnostics().work;
  Simulation resumed(
      model_of(hung("stiffness = { keyframes = [{ time = 0, value = 60 }, { time = 1, value = "
                    "50 }] }\ndamping = 1\n")));
  resumed.restore(simulation.checkpoint());
  advance_to(resumed, 60);
  EXPECT_NEAR(sunk(resumed), weight() / 50, 1e-3 * weight() / 50);
  EXPECT_NEAR(closed(resumed), start, 1e-10);
  EXPECT_NEAR(resumed.diagnostics().work - work, -0.5 * 50 * x * x, 1e-3 * 25 * x * x);
}

TEST(KeyedAttachment, WrongKeyframesAreErrors) {
  EXPECT_THAT(message("stiffness = { keyframes = [{ time = 0.5, value = -2 }] }\n"),
              testing::AllOf(HasSubstr("scene.toml:25"), HasSubstr("`stiffness` is -2 at 0.5 s; give")));
  EXPECT_THAT(message("stiffness = { keyframes = [{ time = 0, value = 0 }, { time = 1, value = 0 }] }\n"),
              testing::AllOf(HasSubstr("scene.toml:25"), HasSubstr("holds nothing")));
  EXPECT_THAT(message("stiffness = 0\n"), HasSubstr("holds nothing"));
  EXPECT_THAT(message("break_force = { keyframes = [{ time = 1, value = 0 }] }\n"),
              HasSubstr("`break_force` is 0 at 1 s; give"));
  EXPECT_THAT(message("damping = { keyframes = [{ time = 1, value = 1 }, { time = 1, value = 2 }] }\n"),
              HasSubstr("time"));
  EXPECT_THAT(message("damping = { map = 'paint', from = 0, to = 1 }\n"),
              HasSubstr("`damping` cannot vary by a map"));
}

}  // namespace
}  // namespace muslin
