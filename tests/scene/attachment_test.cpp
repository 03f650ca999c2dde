// `[[attachment]]`: springs in closed form, momentum, breaking, the energy account, contact at joints, resume
// and threads, and what is refused.
#include "muslin/scene/attachment.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "cache/scratch.hpp"
#include "support/potential_battery.hpp"
#include "support/sheet.hpp"
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "muslin/constraint/attachment.hpp"
#include "muslin/contact/contact_model.hpp"
#include "muslin/core/error.hpp"
#include "muslin/core/parallel.hpp"
#include "muslin/geometry/shapes.hpp"
#include "muslin/scene/model.hpp"
#include "muslin/simulation/simulation.hpp"

namespace muslin {
namespace {

using testing::HasSubstr;

constexpr double g = 9.8;  // of gravity [m/s²]

std::string cloth(const std::string& name, const std::string& translate) {
  return "[[body]]\nname = '" + name + "'\nmesh = 'sheet'\nmodel = 'shell'\ntranslate = " + translate + R"(
compression = 'elastic'
material = { areal_density = 0.1, membrane_warp = 200, bending_warp = 1e-4 }
)";
}
const std::string block = R"([[body]]
name = 'block'
mesh = 'box'
model = 'lattice'
voxel_width = 0.05
material = { density = 100, edge_modulus = 2e4, face_diagonal_modulus = 1e4, body_diagonal_modulus = 1e4 }
)";
const std::string gravity = "[[force]]\ntype = 'gravity'\n";
const std::string ball = R"([[collider]]
name = 'ball'
shape = 'sphere'
center = [0, 0.3, 0]
radius = 0.05
density = 20
)";
const std::string post =
    "[[collider]]\nname = 'post'\nshape = 'box'\nsize = [0.1, 0.1, 0.1]\ncenter = [0, 0.6, 0]\n";
const std::string corner = "where = { nearest = [0, 0, 0] }\n";

/// A scene of 4 s with the tables of `text`. Meshes: `sheet`, 0.2 m by 0.1 m in 32 squares from the origin;
/// `box` of 0.1 m about (0, 0.3, 0).
std::shared_ptr<const Model> model_of(const std::string& text,
                                      const std::vector<std::string>& overrides = {}) {
  Scene scene =
      parse_scene("[time]\nduration = 4\n[solver]\neffort = 'exact'\n" + text, "scene.toml", overrides);
  scene.meshes["sheet"] = std::make_shared<const Mesh>(test::flat_sheet(8, 4, 0.2, 0.1));
  scene.meshes["box"] = std::make_shared<const Mesh>(box_mesh(Vec3(0, 0.3, 0), Vec3::Constant(0.1)));
  return std::make_shared<const Model>(build_model(scene));
}

Simulation after(const std::shared_ptr<const Model>& model, int frames) {
  Simulation simulation(model);
  while (simulation.frame() < frames) simulation.advance();
  return simulation;
}

std::string message(const std::string& text) {
  try {
    model_of(text);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    return error.what();
  }
  return "no error";
}

Vec3 centre_of(const Simulation& simulation, const std::string& body) {
  const Component& component = simulation.model().body(body);
  Vec3 sum = Vec3::Zero();
  double total = 0;
  for (int i = component.first_vertex; i < component.first_vertex + component.vertex_count; ++i) {
    const auto v = static_cast<std::size_t>(i);
    sum += simulation.model().masses[v] * simulation.state().positions[v];
    total += simulation.model().masses[v];
  }
  return sum / total;
}

TEST(Attachment, PassesTheBattery) {
  for (const auto rest :
       {AttachmentRules::Rest::joined, AttachmentRules::Rest::distance, AttachmentRules::Rest::cord}) {
    auto joints = std::make_shared<Joints>();
    using Weight = Joints::Weight;
    joints->add_points(std::array{Weight{0, 1}}, std::array{Weight{1, 0.2}, Weight{2, 0.3}, Weight{3, 0.5}});
    joints->add_points(std::array{Weight{4, 1}}, std::array{Weight{0, 1}});
    joints->stiffness = {300, 20};
    joints->damping = {4, 1};
    joints->strength = {1e9, 1e9};
    AttachmentRules rules;
    rules.rest = rest;
    const auto attachment = std::make_shared<const Attachment>("a", rules, joints);
    std::vector<Vec3> start = test::random_vectors(5, 1, 3), x = start;
    for (Vec3& p : x) p *= 1.7;  // stretched
    StepContext step;
    step.time_end = step.dt = step.length = 0.1;
    step.anchor = start;
    step.positions = start;
    const auto springs = attachment->potential(step),
               dashpots = AttachmentDamping(attachment).potential(step);
    for (const Potential* potential : {springs.get(), dashpots.get()}) {
      test::expect_gradient_matches_value(*potential, x);
      test::expect_hessian_matches_gradient(*potential, x);
      Vec3 sum = Vec3::Zero();
      for (const Vec3& f : test::gradient(*potential, x)) sum += f;
      EXPECT_LT(sum.norm(), 1e-12);
    }
    if (rest != AttachmentRules::Rest::joined) {
      EXPECT_LT(springs->value(start), 1e-20);
    }
  }
}

TEST(AttachmentRun, CordOfStiffnessKGivesWayByTheWeightOverK) {
  const auto model =
      model_of(ball + post + gravity +
               "[[attachment]]\nname = 'string'\nbody = 'ball'\nwhere = { nearest = [0, 0.35, 0] }\n"
               "to = 'post'\nrest = 'cord'\nstiffness = 50\ndamping = 4\n");
  const Simulation simulation = after(model, 72);
  const double weight = g * model->body("ball").statistics.mass;
  EXPECT_NEAR(centre_of(simulation, "ball").y(), 0.3 - weight / 50, 1e-3 * weight / 50);
  EXPECT_NEAR(simulation.attachment_force("string").sum.y(), weight, 1e-3 * weight);
  EXPECT_EQ(simulation.attachment_force("string").holding, 1);
}

TEST(AttachmentRun, WeightsAreFactorsOfTheJoints) {
  const test::Scratch scratch;
  const std::string ramp = (scratch.path() / "ramp.csv").string();
  std::ofstream(ramp) << [] {
    std::string lines;
    for (const Vec3& p : test::flat_sheet(8, 4, 0.2, 0.1).positions)
      lines += fmt::format("{}\n", p.x() / 0.2);
    return lines;
  }();
  const auto held = [](const std::string& weight) {
    return model_of(cloth("a", "[0, 0, 0]") + post +
                    "[[attachment]]\nname = 'hem'\nbody = 'a'\nto = 'post'\nat = [0, 0.6, 0]\nrest = "
                    "'distance'\nstiffness = 10\ndamping = 2\nbreak_force = 4\nwhere = { box = [[-1, -1, "
                    "-1], [1, 1, 1]] }\n" +
                    weight);
  };
  const auto joints = [](const std::shared_ptr<const Model>& model) -> const Joints& {
    return model->attachments.at(0).springs->joints();
  };
  const auto all = held(""), half = held("weight = 0.5\n"),
             painted = held("weight = { map = '" + ramp + "', from = 0, to = 0.8 }\n"),
             flat = held("weight = { map = '" + ramp + "', from = 0.5, to = 0.5 }\n");
  ASSERT_EQ(joints(all).size(), 45u);
  ASSERT_EQ(joints(painted).size(), 40u) << "the five vertices without weight are not attached";
  EXPECT_EQ(joints(flat).stiffness, joints(half).stiffness) << "bit for bit";
  EXPECT_EQ(joints(flat).damping, joints(half).damping);
  EXPECT_EQ(joints(flat).strength, joints(half).strength);
  double sum = 0;
  for (std::size_t j = 0; j < 45; ++j) {
    EXPECT_DOUBLE_EQ(joints(half).stiffness[j], joints(all).stiffness[j] / 2);
    sum += joints(all).stiffness[j];
  }
  EXPECT_NEAR(sum, 10, 1e-12);
  const Model& model = *painted;
  double mass = 0;
  for (std::size_t j = 0; j < 40; ++j)
    mass += model.masses[static_cast<std::size_t>(joints(painted).of(j)[0].vertex)];
  for (std::size_t j = 0; j < 40; ++j) {
    const auto v = static_cast<std::size_t>(joints(painted).of(j)[0].vertex);
    const double share = 0.8 * model.rest_positions[v].x() / 0.2 * model.masses[v] / mass;
    EXPECT_NEAR(joints(painted).stiffness[j], 10 * share, 1e-12);
    EXPECT_NEAR(joints(painted).strength[j], 4 * share, 1e-12);
  }
}

TEST(AttachmentRun, BallHangsLowerOnAnAttachmentOfHalfTheWeight) {
  const auto model =
      model_of(ball + post + gravity +
               "[[attachment]]\nname = 'string'\nbody = 'ball'\nwhere = { nearest = [0, 0.35, 0] }\n"
               "to = 'post'\nrest = 'cord'\nstiffness = 100\ndamping = 8\nweight = 0.5\n");
  const double weight = g * model->body("ball").statistics.mass;
  EXPECT_NEAR(centre_of(after(model, 72), "ball").y(), 0.3 - weight / 50, 1e-3 * weight / 50);
}

TEST(AttachmentRun, CordIsSlackAndARodIsNot) {
  // The ball is thrown up, towards the post.
  const std::string rest =
      "[[attachment]]\nname = 'string'\nbody = 'ball'\nwhere = { nearest = [0, 0.35, 0] }\nto "
      "= 'post'\nrest = '";
  const std::string thrown = ball + "velocity = [0, 1, 0]\n" + post;
  const Simulation cord = after(model_of(thrown + rest + "cord'\n"), 3),
                   rod = after(model_of(thrown + rest + "distance'\n"), 3);
  EXPECT_NEAR(centre_of(cord, "ball").y(), 0.3 + 0.125, 1e-6);
  EXPECT_LT(centre_of(rod, "ball").y(), 0.3 + 0.01);
}

TEST(AttachmentRun, AttachedBodiesKeepTheirMomentumAndTheAccountCloses) {
  const std::string two = cloth("a", "[0, 0, 0]") + cloth("b", "[0, 0.02, 0]") + ball;
  const std::string joints =
      "[[attachment]]\nbody = 'a'\nwhere = { nearest = [0, 0, 0] }\nto = 'b'\nstiffness = 50\ndamping = 0.1\n"
      "[[attachment]]\nbody = 'b'\nwhere = { nearest = [0, 0.02, 0.1] }\nto = 'ball'\nrest = 'cord'\n";
  for (const std::string integrator : {"implicit_euler", "bdf2"}) {
    SCOPED_TRACE(integrator);
    Simulation simulation(
        model_of(two + "velocity = [0, 0.5, 0.1]\n" + joints, {"solver.integrator=" + integrator}));
    const Vec3 momentum = simulation.diagnostics().momentum;
    const double start = simulation.diagnostics().balance();
    while (simulation.frame() < 12) {
      simulation.advance();
      const Diagnostics& now = simulation.diagnostics();
      EXPECT_LT((now.momentum - momentum).norm(), 1e-3 * momentum.norm());
      EXPECT_LT(std::abs(now.balance() - now.unbalanced - start), 1e-10);
    }
    EXPECT_GT(centre_of(simulation, "b").y(), 0.021);  // the cord pulls it along
  }
}

TEST(AttachmentRun, BreaksAtTheStatedForceAndItsEnergyIsLost) {
  const double weight = g * model_of(ball)->body("ball").statistics.mass;
  // Slowly loaded: damping is critical for the ball.
  const auto with = [&](double strength) {
    return model_of(
        ball + post + gravity +
        fmt::format("[[attachment]]\nname = 'string'\nbody = 'ball'\nwhere = {{ nearest = [0, 0.35, 0] }}\n"
                    "to = 'post'\nrest = 'cord'\nstiffness = 100\ndamping = 20\nbreak_force = {}\n",
                    strength));
  };
  EXPECT_EQ(after(with(1.02 * weight), 48).attachment_force("string").holding, 1);
  Simulation simulation(with(0.98 * weight));
  const double start = simulation.diagnostics().balance();
  double largest = 0;
  while (simulation.frame() < 48) {
    simulation.advance();
    largest = std::max(largest, simulation.attachment_force("string").largest);
    const Diagnostics& now = simulation.diagnostics();
    EXPECT_LT(std::abs(now.balance() - now.unbalanced - start), 1e-9);
  }
  EXPECT_EQ(simulation.attachment_force("string").holding, 0);
  EXPECT_LE(largest, 0.98 * weight);
  EXPECT_GT(largest, 0.8 * weight);
  EXPECT_LT(centre_of(simulation, "ball").y(), 0.1);  // it has fallen
}

TEST(AttachmentRun, SpringThatBeginsStretchedIsWorkButNotOfTheMaterial) {
  const std::string joint = ball + post +
                            "[[attachment]]\nbody = 'ball'\nwhere = { nearest = [0, 0.35, 0] }\nto = "
                            "'post'\nstiffness = 10\nfrom = 0.02\n";
  const Diagnostics now = after(model_of(joint), 2).diagnostics();
  EXPECT_NEAR(now.work, 0.5 * 10 * 0.2 * 0.2, 0.02);  // over 0.2 m, before anything else moves
  EXPECT_EQ(now.material_work, 0);
  EXPECT_GT(now.elastic, 0);
}

TEST(AttachmentRun, GapThatBreaksJointsAtOnceIsAWarning) {
  const std::string joint = ball + post +
                            "[[attachment]]\nbody = 'ball'\nwhere = { nearest = [0, 0.35, 0] }\nto = "
                            "'post'\nstiffness = 10\nbreak_force = ";
  EXPECT_TRUE(model_of(joint + "2.1\n")->warnings.empty());  // over 0.2 m
  EXPECT_THAT(model_of(joint + "1.9\n")->warnings.front(), HasSubstr("1 of 1 joints break at once"));
}

TEST(AttachmentRun, StiffJointsHoldShellsLatticesAndCollidersTogether) {
  const std::string hung =
      "[[attachment]]\nname = 'seam'\nbody = 'a'\nwhere = { plane = { point = [0, 0, 0], normal = "
      "[1, 0, 0] } }\nto = '";
  const std::string still =
      "[[collider]]\nname = 'rail'\nshape = 'capsule'\nradius = 0.01\npoints = [[-0.01, 0, -0.1], "
      "[-0.01, 0, 0.2]]\n";
  for (const auto& [other, scene] :
       {std::pair<std::string, std::string>{"rail", still},
        {"b",
         cloth("b", "[-0.2, 0, 0]") +
             "[[pin]]\nbody = 'b'\nwhere = { plane = { point = [-0.2, 0, 0], normal = [1, 0, 0] } }\n"}}) {
    SCOPED_TRACE(other);
    const auto model = model_of(cloth("a", "[0, 0, 0]") + scene + gravity + hung + other + "'\n");
    const Simulation simulation = after(model, 24);
    const AttachmentForce force = simulation.attachment_force("seam");
    EXPECT_EQ(force.holding, 5);
    for (std::size_t j = 0; j < 5; ++j) {
      const Joints& joints = model->attachments[0].springs->joints();
      EXPECT_LT(joints.apart(j, simulation.state().positions).norm(), 1e-3);
    }
    EXPECT_EQ(simulation.diagnostics().converged_steps, simulation.diagnostics().steps);
  }
  // A lattice hangs on a sheet that is held by its edge.
  const auto model =
      model_of(cloth("a", "[-0.1, 0.4, -0.05]") + block + gravity +
               "[[pin]]\nbody = 'a'\nwhere = { plane = { point = [-0.1, 0, 0], normal = [1, 0, 0] } }\n"
               "[[attachment]]\nname = 'seam'\nbody = 'block'\nwhere = { plane = { point = [0, 0.35, 0], "
               "normal = [0, 1, 0] } }\nto = 'a'\n");
  const Simulation simulation = after(model, 6);
  EXPECT_GT(simulation.attachment_force("seam").holding, 4);
  EXPECT_GT(centre_of(simulation, "block").y(), 0.2);  // a free fall would have taken it to 0
}

TEST(AttachmentRun, ContactLeavesJointsAlone) {
  // The sheet lies on the rail it is attached to, without a gap.
  const std::string scene = cloth("a", "[0, 0, 0]") +
                            "[[collider]]\nname = 'rail'\nshape = 'box'\nsize = [0.2, 0.1, 0.4]\n"
                            "center = [-0.1, 0, 0]\n[contact]\ndistance = 0.002\n";
  const std::string joint =
      "[[attachment]]\nname = 'seam'\nbody = 'a'\nwhere = { plane = { point = [0, 0, 0], normal = [1, "
      "0, 0] } }\nto = 'rail'\n";
  EXPECT_THROW(Simulation{model_of(scene + "tangled = 'refuse'\n")}, Error);
  const auto model = model_of(scene + gravity + joint);
  EXPECT_FALSE(model->contact->exempt.point_triangles.empty());
  const Simulation simulation = after(model, 12);
  // A pendulum that falls from the horizontal pulls by three times its weight.
  EXPECT_LT(simulation.attachment_force("seam").largest, 3 * 0.002 * g / 5);
  const std::string ground = cloth("a", "[0, 0.0001, 0]") + "[[collider]]\nname = 'floor'\nshape = 'plane'\n";
  EXPECT_EQ(model_of(ground + "[[attachment]]\nbody = 'a'\n" + corner + "to = 'floor'\n")
                ->contact->exempt.point_planes.size(),
            1U);
}

TEST(AttachmentRun, ResumesAndRunsOnAnyNumberOfThreadsWithTheSameBits) {
  const auto model =
      model_of(cloth("a", "[0, 0, 0]") + ball + post + gravity +
               "[[attachment]]\nname = 'x'\nbody = 'a'\nwhere = { box = [[-1, -1, -1], [1, 1, 1]] }\nto = "
               "'ball'\nrest = 'cord'\nfrom = 0.1\nbreak_force = 0.4\n"
               "[[attachment]]\nbody = 'ball'\nwhere = { nearest = [0, 0.35, 0] }\nto = 'post'\nrest = "
               "'distance'\nuntil = 0.6\n");
  Simulation whole = after(model, 10);
  Simulation resumed(model);
  resumed.restore(whole.checkpoint());
  EXPECT_EQ(resumed.attachment_force("x").sum, whole.attachment_force("x").sum);
  set_thread_count(1);
  while (resumed.frame() < 20) resumed.advance();
  set_thread_count(2);
  while (whole.frame() < 20) whole.advance();
  set_thread_count(0);
  EXPECT_EQ(resumed.state().positions, whole.state().positions);
  EXPECT_EQ(resumed.attachment_force("x").holding, whole.attachment_force("x").holding);
}

TEST(AttachmentRun, WrongTablesAreErrors) {
  const std::string a = cloth("a", "[0, 0, 0]"),
                    to_post = post + "[[attachment]]\nbody = 'a'\n" + corner + "to = 'post'\n";
  EXPECT_THAT(message(a + "[[attachment]]\n" + corner + "to = 'pots'\n" + post), HasSubstr("post"));
  EXPECT_THAT(message(a + post + "[[attachment]]\nto = 'post'\n"), HasSubstr("where"));
  EXPECT_THAT(message(a + post + "[[attachment]]\nbody = 'post'\n" + corner + "to = 'a'\n"),
              HasSubstr("mass"));
  EXPECT_THAT(
      message(a + post +
              "[[attachment]]\nwhere = { sphere = { center = [5, 0, 0], radius = 1 } }\nto = 'post'\n"),
      HasSubstr("nearest is"));
  EXPECT_THAT(message(a + "[[attachment]]\n" + corner + "to = 'a'\n"), HasSubstr("its own nearest"));
  EXPECT_THAT(message(a + "[[attachment]]\n" + corner + "to = 'a'\nwhere_to = { nearest = [0, 0, 0] }\n"),
              HasSubstr("attached to itself"));
  EXPECT_THAT(message(a + "[[pin]]\nname = 'p'\nbody = 'a'\n" + corner + to_post),
              HasSubstr("pin `p` holds"));
  EXPECT_THAT(message(a + to_post + "stiffness = 0\n"), HasSubstr("stiffness"));
  EXPECT_THAT(message(a + to_post + "weight = 0\n"), HasSubstr("0 at every vertex"));
  EXPECT_THAT(message(a + to_post + "weight = { map = 'ramp', from = 0, to = 1 }\n"), HasSubstr("ramp"));
  EXPECT_THAT(message(a + to_post + "from = 2\nuntil = 1\n"), HasSubstr("until"));
  EXPECT_THAT(message(a + to_post + "at = [0, 0, 0]\nwhere_to = { nearest = [0, 0, 0] }\n"),
              HasSubstr("both choose"));
}

}  // namespace
}  // namespace muslin
