// A kind of component that nothing else knows: a net of knots and threads that carries a finer mesh. A scene
// with it is built, held, blown, touched, saved, resumed, cached, exported and shown.
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "cache/scratch.hpp"
#include "support/sheet.hpp"
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "muslin/cache/export.hpp"
#include "muslin/cache/run_reader.hpp"
#include "muslin/cache/run_writer.hpp"
#include "muslin/cache/stages.hpp"
#include "muslin/component/component.hpp"
#include "muslin/contact/contact_model.hpp"
#include "muslin/contact/crossings.hpp"
#include "muslin/core/error.hpp"
#include "muslin/io/mesh_file.hpp"
#include "muslin/picture/run_pictures.hpp"
#include "muslin/scene/describe.hpp"
#include "muslin/scene/model.hpp"
#include "muslin/simulation/simulation.hpp"
#include "muslin/view/page_content.hpp"

namespace muslin {
namespace {

using test::Scratch;
using testing::HasSubstr;

constexpr double knot_mass = 0.01, thread_stiffness = 200, thread_radius = 2e-3;  // [kg], [N/m], [m]

/// W = Σ ½ k (l − L)² over threads.
class Threads : public Potential {
 public:
  struct Thread {
    std::size_t a = 0, b = 0;
    double length = 0;  ///< at rest [m]
  };
  explicit Threads(std::vector<Thread> threads) : threads_(std::move(threads)) {}

  double value(ConstVectors x) const override {
    double w = 0;
    for (const Thread& t : threads_)
      w += 0.5 * thread_stiffness * std::pow((x[t.b] - x[t.a]).norm() - t.length, 2);
    return w;
  }
  void add_gradient(ConstVectors x, Vectors g) const override {
    for (const Thread& t : threads_) {
      const Vec3 d = x[t.b] - x[t.a];
      const Vec3 force = thread_stiffness * (1 - t.length / d.norm()) * d;
      g[t.b] += force;
      g[t.a] -= force;
    }
  }
  void add_hessian_product(ConstVectors x, ConstVectors p, Vectors y) const override {
    for (const Thread& t : threads_) {
      const Vec3 product = block(x, t, false) * (p[t.b] - p[t.a]);
      y[t.b] += product;
      y[t.a] -= product;
    }
  }
  void add_diagonal_blocks(ConstVectors x, std::span<Mat3> blocks) const override {
    for (const Thread& t : threads_) {
      blocks[t.a] += block(x, t, true);
      blocks[t.b] += block(x, t, true);
    }
  }

 private:
  static Mat3 block(ConstVectors x, const Thread& t, bool semidefinite) {
    const Vec3 d = x[t.b] - x[t.a];
    const Vec3 n = d.normalized();
    double across = 1 - t.length / d.norm();
    if (semidefinite) across = std::max(across, 0.0);
    return thread_stiffness * (n * n.transpose() + across * (Mat3::Identity() - n * n.transpose()));
  }
  std::vector<Thread> threads_;
};

/// n by n meshes between knots, in the plane y = 0; every second point of its mesh is a knot.
class Net final : public Component {
 public:
  Net(const std::string& the_name, int n, double size) {
    name = the_name;
    const Mesh coarse = test::flat_sheet(n, n, size, size);
    knots_ = coarse.positions;
    mesh = test::flat_sheet(2 * n, 2 * n, size, size);
    report = inspect(mesh);
    sheet = true;
    for (int k = 0; k <= 2 * n; ++k) {
      for (int i = 0; i <= 2 * n; ++i) {
        std::array<int, 8> vertices{};
        std::array<double, 8> weights{};
        vertices.fill(i / 2 + k / 2 * (n + 1));
        std::size_t slot = 0;
        for (int b = 0; b <= k % 2; ++b)
          for (int a = 0; a <= i % 2; ++a) {
            vertices[slot] = i / 2 + a + (k / 2 + b) * (n + 1);
            weights[slot++] = 1.0 / ((1 + i % 2) * (1 + k % 2));
          }
        skin.vertices.push_back(vertices);
        skin.weights.push_back(weights);
      }
    }
    skin.prepare_transpose(knots_.size());
    std::vector<Threads::Thread> threads;
    for (int k = 0; k <= n; ++k)
      for (int i = 0; i <= n; ++i) {
        const auto v = static_cast<std::size_t>(i + k * (n + 1));
        if (i < n) threads.push_back({v, v + 1, size / n});
        if (k < n) threads.push_back({v, v + static_cast<std::size_t>(n) + 1, size / n});
      }
    spacing_ = size / n;
    vertex_count = static_cast<int>(knots_.size());
    potentials.push_back({"threads", EnergyRole::elastic, std::make_shared<Threads>(std::move(threads))});
    weigh(*this);
  }

  std::string kind() const override { return "net"; }
  Vec3 rest_position(std::size_t v) const override { return knots_[v]; }
  std::vector<double> masses() const override { return std::vector<double>(knots_.size(), knot_mass); }
  double spacing() const override { return spacing_; }
  bool is_mesh() const override { return false; }
  std::size_t selectable_count() const override { return knots_.size(); }
  Vec3 selectable(std::size_t i) const override { return knots_[i]; }
  AttachedPoint attach(const Vec3& at) const override {
    AttachedPoint attached;
    std::size_t nearest = 0;
    for (std::size_t p = 0; p < mesh.vertex_count(); ++p)
      if ((mesh.positions[p] - at).norm() < (mesh.positions[nearest] - at).norm()) nearest = p;
    attached.point.vertices.push_back(skin.vertices[nearest]);
    attached.point.weights.push_back(skin.weights[nearest]);
    return attached;
  }
  std::optional<ContactPart> contact_part() const override {
    ContactPart part;
    part.body.radius = thread_radius;
    part.body.stiffness = contact_stiffness_share * thread_stiffness;
    part.edge = spacing_ / 2;
    part.size = mesh.bounds().sizes().maxCoeff();
    part.add_mesh(mesh, triangulate(mesh), skin);
    return part;
  }
  std::vector<CachedPoints> cached_points() const override {
    return {{"knots", "obj", [this](const std::filesystem::path& file) {
               Mesh points;
               points.positions = knots_;
               for (int v = 0; v + 2 < vertex_count; v += 3) points.add_face(std::array{v, v + 1, v + 2});
               write_mesh(file, points);
             }}};
  }

 private:
  std::vector<Vec3> knots_;
  double spacing_ = 0;
};

/// A net above a ball, held at a corner, blown at and with a probe in its middle.
Scene scene_with_net() {
  Scene scene = parse_scene(
      "title = 'net'\n[time]\nduration = 0.5\n"
      "[[collider]]\nname = 'ball'\nshape = 'sphere'\ncenter = [0.2, -0.2, 0.2]\nradius = 0.15\ndensity = 1\n"
      "[[force]]\nname = 'gravity'\ntype = 'gravity'\n[[force]]\nname = 'breeze'\ntype = 'wind'\nvelocity = "
      "[1, 0, 0]\n",
      "scene.toml");
  scene.colliders[0].density.reset();  // in a file, something must be free to move
  scene.components.push_back(
      {"net", [](const ComponentInputs&) { return std::make_shared<Net>("net", 8, 0.4); }});
  PinSettings pin;
  pin.name = "corner";
  pin.body = "net";
  pin.where.nearest = {Vec3(0.4, 0, 0.4)};
  scene.pins.push_back(pin);
  scene.probes.push_back({"middle", "net", Vec3(0.2, 0, 0.2), {}});
  return scene;
}

std::shared_ptr<const Model> model_with_net() {
  return std::make_shared<const Model>(build_model(scene_with_net()));
}

TEST(NewKind, IsBuiltIntoAModelWithOthers) {
  const auto model = model_with_net();
  ASSERT_EQ(model->bodies.size(), 2u);
  const Component& net = model->body("net");
  EXPECT_EQ(net.first_vertex, 4);  // after the corners that carry the ball
  EXPECT_EQ(model->vertex_count(), 4u + 81);
  EXPECT_NEAR(net.statistics.mass, 81 * knot_mass, 1e-12);
  ASSERT_EQ(model->pins.size(), 1u);
  EXPECT_EQ(model->pins[0].vertices, std::vector<int>{4 + 80});
  std::vector<std::string> names;
  for (const PotentialTerm& term : model->potentials) names.push_back(term.name);
  for (const LoadTerm& term : model->loads) names.push_back(term.name);
  EXPECT_THAT(names, testing::ElementsAre("net: threads", "gravity", "breeze"));
  ASSERT_NE(model->contact, nullptr);
  EXPECT_THAT(model->contact->names, testing::ElementsAre("ball", "net"));
  EXPECT_THAT(describe_text(*model), HasSubstr("body net: net of 81 vertices, 0.81 kg\n"));
  EXPECT_EQ(nlohmann::json::parse(describe_json(*model))["bodies"][0]["model"], "net");
}

TEST(NewKind, DrapesOverABallWithoutCrossingIt) {
  Simulation simulation(model_with_net());
  for (int frame = 0; frame < 12; ++frame) simulation.advance();
  const Model& model = simulation.model();
  const std::vector<Vec3>& x = simulation.state().positions;
  EXPECT_TRUE(find_crossings(*model.contact, x).empty());
  EXPECT_EQ(simulation.diagnostics().converged_steps, simulation.diagnostics().steps);
  EXPECT_EQ(x[4 + 80], Vec3(0.4, 0, 0.4)) << "the pin holds the corner";
  const double height = simulation.probe("middle").y();
  EXPECT_LT(height, -0.02);
  EXPECT_GT(height, -0.05 + thread_radius) << "the ball carries the middle";
  double lowest = 0;
  for (const Vec3& p : model.of(model.body("net"), x)) lowest = std::min(lowest, p.y());
  EXPECT_LT(lowest, -0.15) << "the other corners hang beside the ball";
  const Diagnostics& row = simulation.diagnostics();
  EXPECT_GT(row.elastic, 0);
  EXPECT_GE(row.dissipated, -1e-6);
}

TEST(NewKind, ResumesWithTheSameBits) {
  Simulation whole(model_with_net()), stopped(model_with_net());
  for (int frame = 0; frame < 6; ++frame) whole.advance();
  for (int frame = 0; frame < 3; ++frame) stopped.advance();
  Simulation resumed(model_with_net());
  resumed.restore(stopped.checkpoint());
  for (int frame = 3; frame < 6; ++frame) resumed.advance();
  EXPECT_EQ(resumed.state().positions, whole.state().positions);
  Scene other = scene_with_net();
  other.components[0].build = [](const ComponentInputs&) { return std::make_shared<Net>("net", 8, 0.41); };
  Simulation different(std::make_shared<const Model>(build_model(other)));
  EXPECT_THROW(different.restore(stopped.checkpoint()), Error);
}

TEST(NewKind, IsCachedExportedAndDrawn) {
  const Scratch scratch;
  const std::filesystem::path run = scratch / "run";
  const auto model = model_with_net();
  {
    Simulation simulation(model);
    RunWriter writer(run, simulation, 2, false);
    for (int frame = 0; frame < 2; ++frame) {
      simulation.advance();
      writer.write_frame();
    }
    writer.finish(RunStatus::finished);
  }
  const Pc2Reader knots(run / "net.knots.pc2");
  EXPECT_EQ(knots.points(), 81u);
  EXPECT_EQ(knots.samples(), 3);

  const RunReader reader(run);
  EXPECT_EQ(reader.bodies(), (std::vector<std::string>{"ball", "net"}));
  const int net = reader.find_body("net");
  EXPECT_EQ(reader.find_body(""), net) << "the only one that is no collider";
  EXPECT_FALSE(reader.has_cells(net));
  EXPECT_EQ(reader.points(net, SurfaceKind::skin, 2).size(), 289u);
  EXPECT_EQ(reader.points(net, SurfaceKind::skin, 2)[2], knots.read(2)[1]);

  for (const char* file : {"net.obj", "net.glb", "net.vtu", "net.usda"})
    export_run(reader, scratch / file, {"net", SurfaceKind::skin});
  for (const char* file : {"net.0002.obj", "net.glb", "net.0002.vtu", "net.usda"})
    EXPECT_TRUE(std::filesystem::exists(scratch / file)) << file;

  const PageContent page = page_content(reader, false, {});
  ASSERT_EQ(page.head["bodies"].size(), 2u);
  EXPECT_EQ(page.head["bodies"][1]["name"], "net");
  EXPECT_TRUE(page.head["bodies"][1]["surfaces"].contains("skin"));
  ASSERT_EQ(reader.selections().pins.size(), 1u);
  EXPECT_EQ(reader.selections().pins[0].vertices, std::vector<int>{80}) << "counted among knots";
  EXPECT_EQ(reader.selectable_count(net), 81u);
  const std::size_t pin = page.head["pins"][0]["track"];
  EXPECT_EQ(page.tracks[pin].at(reader, 2), std::vector<Vec3f>{Vec3f(0.4f, 0, 0.4f)});
  EXPECT_EQ(draw_start(*model, {}).width, 960);

  write_stages(scratch / "stages", *model);
  EXPECT_TRUE(std::filesystem::exists(scratch / "stages/net.skin.obj"));

  // A run that takes its place removes its files, those of the new kind as well.
  Scene without = scene_with_net();
  without.components.clear();
  without.pins.clear();
  without.probes.clear();
  Simulation other(std::make_shared<const Model>(build_model(without)));
  const RunWriter replaced(run, other, 1, false);
  EXPECT_FALSE(std::filesystem::exists(run / "net.knots.pc2"));
  EXPECT_FALSE(std::filesystem::exists(run / "net.knots.obj"));
  EXPECT_TRUE(std::filesystem::exists(run / "ball.skin.pc2"));
}

TEST(NewKind, ASourceThatBuildsNothingIsAnError) {
  Scene scene = scene_with_net();
  scene.components[0].build = [](const ComponentInputs&) { return nullptr; };
  try {
    build_model(scene);
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::usage);
  }
}

}  // namespace
}  // namespace muslin
