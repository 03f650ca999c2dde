// Colliders, rigid bodies and contact settings: every key, what is built, and every way to get them wrong.
#include <filesystem>
#include <numbers>

#include "support/sheet.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "muslin/component/shell/shell_body_settings.hpp"
#include "muslin/contact/contact_model.hpp"
#include "muslin/geometry/shapes.hpp"
#include "muslin/io/mesh_file.hpp"
#include "muslin/scene/describe.hpp"
#include "muslin/scene/model.hpp"

namespace muslin {
namespace {

using testing::HasSubstr;

/// A folder with a sheet of 4 x 3 squares of 0.2 m, a box, and a bowl that is open.
class ColliderModel : public testing::Test {
 protected:
  static std::filesystem::path folder() {
    return std::filesystem::temp_directory_path() / ("muslin_collider_test_" + std::to_string(getpid()));
  }
  static void SetUpTestSuite() {
    std::filesystem::create_directories(folder());
    write_mesh(folder() / "sheet.obj", test::flat_sheet(4, 3, 0.8, 0.6));
    write_mesh(folder() / "box.obj", box_mesh(Vec3(0, 0, 0), Vec3(1, 2, 3)));
  }
  static void TearDownTestSuite() { std::filesystem::remove_all(folder()); }

  static Scene parse(const std::string& text, const std::vector<std::string>& overrides = {}) {
    return parse_scene(text, folder() / "scene.toml", overrides);
  }
  static Model build(const std::string& text) { return build_model(parse(text)); }
  static std::string message(const std::string& text) {
    try {
      build(text);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input);
      return error.what();
    }
    return "no error";
  }
  static std::vector<Vec3> surface(const Model& model) {
    std::vector<Vec3> x(model.contact->map->point_count());
    model.contact->map->apply(model.rest_positions, x);
    return x;
  }
};

const std::string cloth =
    "[[body]]\nname = 'cloth'\nmesh = 'sheet.obj'\nmodel = 'shell'\nmaterial = { areal_density = 0.5, "
    "membrane_warp = 100, membrane_weft = 400, bending_warp = 1e-4 }\n";

TEST_F(ColliderModel, KeyframesTurnByTheAnglesWritten) {
  const auto motion = [](const std::string& keys) {
    return parse(
               "[[body]]\nmesh = 'sheet.obj'\nvoxel_width = 0.1\nmaterial = 'rubber'\n[[pin]]\nwhere = { "
               "nearest = [[0, "
               "0, 0]] }\nkeyframes = [" +
               keys + "]\n")
        .pins.front()
        .motion;
  };
  const auto turned = [](const Motion& motion, double time) { return Vec3(motion.at(time) * Vec3(1, 0, 0)); };
  const Motion full = motion("{ time = 0 }, { time = 1, rotate = [0, 0, 360] }");
  EXPECT_TRUE(full.turns());
  EXPECT_LT((turned(full, 0.25) - Vec3(0, 1, 0)).norm(), 1e-12);
  EXPECT_LT((turned(full, 0.5) - Vec3(-1, 0, 0)).norm(), 1e-12);
  EXPECT_LT((turned(full, 0.75) - Vec3(0, -1, 0)).norm(), 1e-12);
  EXPECT_LT((turned(full, 1) - Vec3(1, 0, 0)).norm(), 1e-12);
  const Motion far = motion("{ time = 0 }, { time = 3, rotate = [0, 0, 270] }");
  EXPECT_LT((turned(far, 1) - Vec3(0, 1, 0)).norm(), 1e-12);
  const Motion twice = motion("{ time = 1, rotate = [0, 0, -360] }, { time = 2, rotate = [0, 0, 360] }");
  EXPECT_LT((turned(twice, 1.125) - Vec3(0, 1, 0)).norm(), 1e-12);
  EXPECT_LT((turned(twice, 0) - Vec3(1, 0, 0)).norm(), 1e-12);
}

TEST_F(ColliderModel, EveryKeyIsRead) {
  const Scene scene = parse(cloth + R"(thickness = 0.002
self_contact = false
[contact]
distance = 0.003
friction = 0.5
[[collider]]
shape = "plane"
name = "floor"
center = [0, -1, 0]
normal = [0, 2, 0]
keyframes = [{ time = 0 }, { time = 1, translate = [0, 1, 0] }]
[[collider]]
shape = "sphere"
name = "ball"
center = [0, 1, 0]
radius = 0.25
density = 1000
velocity = [1, 0, 0]
angular_velocity = [0, 0, 90]
colour = [1, 0, 0]
[[collider]]
shape = "capsule"
points = [[0, 0, 0], [1, 0, 0]]
radius = 0.1
contact = false
[[collider]]
shape = "box"
center = [0, 2, 0]
size = [1, 2, 3]
rotate = [0, 0, 90]
pivot = [1, 1, 1]
keyframes = [{ time = 0, rotate = [0, 90, 0] }]
[[collider]]
shape = "mesh"
mesh = "box.obj"
translate = [1, 2, 3]
rotate = [0, 90, 0]
scale = 2
)",
                            {"collider.ball.radius=0.5", "contact.friction=0.4"});
  EXPECT_EQ(scene.bodies[0].own.as<ShellBodySettings>().thickness, 0.002);
  EXPECT_FALSE(scene.bodies[0].self_contact);
  EXPECT_EQ(scene.contact.distance, 0.003);
  EXPECT_EQ(scene.contact.friction, 0.4);
  ASSERT_EQ(scene.colliders.size(), 5u);
  EXPECT_EQ(scene.colliders[0].normal, Vec3(0, 1, 0));
  EXPECT_EQ(scene.colliders[2].name, "capsule2");
  EXPECT_EQ(scene.colliders[1].radius, 0.5);
  EXPECT_EQ(scene.colliders[1].density, 1000);
  EXPECT_EQ(scene.colliders[1].colour, Vec3(1, 0, 0));
  EXPECT_FALSE(scene.colliders[2].contact);
  EXPECT_EQ(scene.colliders[3].pivot, Vec3(1, 1, 1));
  EXPECT_EQ(scene.colliders[4].name, "box");
  const auto json = nlohmann::json::parse(scene.resolved);
  EXPECT_EQ(json["collider"][0]["keyframes"][1]["translate"][1], 1);
  EXPECT_EQ(json["collider"][1]["angular_velocity"][2], 90);
  EXPECT_EQ(json["contact"], nlohmann::json({{"distance", 0.003}, {"friction", 0.4}, {"tangled", "repair"}}));
}

TEST_F(ColliderModel, FrictionDefaultsToThatOfTheScene) {
  const Model model = build(cloth + R"(friction = 0.8
[contact]
friction = 0.45
[[collider]]
shape = "plane"
center = [0, -1, 0]
friction = 0.05
[[collider]]
shape = "box"
center = [0, -1, 0]
size = [1, 1, 1]
[[collider]]
shape = "sphere"
center = [0, 1, 0]
radius = 0.1
friction = 0
)");
  const ContactSurface& surface = *model.contact->surface;
  EXPECT_EQ(model.contact->friction, 0.45);
  const auto friction = [&](int body_a, int body_b) {
    int a = 0, b = 0;
    while (surface.body_of(a) != body_a) ++a;
    while (surface.body_of(b) != body_b) ++b;
    const double one = 1;
    return surface.friction({{&a, 1}, {&one, 1}}, {{&b, 1}, {&one, 1}}, model.contact->friction.at(0), 0);
  };
  EXPECT_EQ(friction(0, 0), 0.8);
  EXPECT_DOUBLE_EQ(friction(0, 1), 0.2);
  EXPECT_DOUBLE_EQ(friction(0, 2), 0.6);
  EXPECT_EQ(friction(2, 2), 0.45);
  EXPECT_EQ(friction(0, 3), 0);
  const auto json = nlohmann::json::parse(model.scene.resolved);
  EXPECT_EQ(json["body"][0]["friction"], 0.8);
  EXPECT_EQ(json["collider"][0]["friction"], 0.05);
  EXPECT_FALSE(json["collider"][1].contains("friction"));
  EXPECT_THAT(message(cloth + "friction = -0.1\n"), HasSubstr("`friction`"));
}

TEST_F(ColliderModel, RotatingPlanePassesThroughThreePoints) {
  const std::string floor = cloth + "[[collider]]\nshape = 'plane'\ncenter = [5, -1, 0]\nkeyframes = ";
  const Model turning = build(floor + "[{ time = 0, rotate = [0, 0, 10] }, { time = 1 }]\n");
  const ContactPlane& plane = turning.contact->surface->planes()[0];
  ASSERT_TRUE(plane.turns());
  const std::vector<Vec3> x = surface(turning);
  const Vec3 a = x[static_cast<std::size_t>(plane.point)], b = x[static_cast<std::size_t>(plane.span[0])],
             c = x[static_cast<std::size_t>(plane.span[1])];
  const double angle = 10 * std::numbers::pi / 180;
  const Vec3 normal(-std::sin(angle), std::cos(angle), 0);
  EXPECT_LT(((b - a).cross(c - a).normalized() - normal).norm(), 1e-12);
  EXPECT_NEAR(normal.dot(a - Vec3(5, -1, 0)), 0, 1e-12);  // it turns about its centre
  // Turned once and for all is not turning.
  const Model still = build(floor + "[{ time = 0, rotate = [0, 0, 10] }]\n");
  EXPECT_FALSE(still.contact->surface->planes()[0].turns());
  EXPECT_LT((still.contact->surface->planes()[0].normal - normal).norm(), 1e-12);
}

TEST_F(ColliderModel, FixedShapesAreBodiesWithoutMass) {
  const Model model = build(cloth +
                            "[[collider]]\nshape = 'box'\ncenter = [0, -1, 0]\nsize = [1, 1, 1]\n"
                            "[[collider]]\nshape = 'plane'\ncenter = [0, -2, 0]\n");
  ASSERT_EQ(model.bodies.size(), 3u);
  EXPECT_EQ(model.vertex_count(), 20u + 8);
  const Component& box = model.bodies[1];
  EXPECT_TRUE(box.is_prescribed() && !box.deforms());
  for (int v = box.first_vertex; v < 28; ++v) EXPECT_EQ(model.masses[static_cast<std::size_t>(v)], 0);
  ASSERT_EQ(model.prescribed.size(), 2u);
  std::vector<Vec3> skin(box.mesh.vertex_count());
  box.skin.apply(model.of(box, model.rest_positions), skin);
  for (std::size_t v = 0; v < skin.size(); ++v) EXPECT_LT((skin[v] - box.mesh.positions[v]).norm(), 1e-12);
  // The plane lies below the middle of what is around it and reaches beyond.
  const Box patch = model.bodies[2].mesh.bounds();
  EXPECT_NEAR(patch.center().y(), -2, 1e-12);
  EXPECT_GT(patch.sizes().x(), 2);
  EXPECT_LT(patch.sizes().x(), 6);
  const auto json = nlohmann::json::parse(describe_json(model));
  EXPECT_EQ(json["bodies"].size(), 1u);
  EXPECT_EQ(json["colliders"][0]["movement"], "fixed");
  EXPECT_EQ(json["colliders"][1]["shape"], "plane");
  EXPECT_EQ(json["contact"]["friction"], 0.3);
  EXPECT_THAT(describe_text(model), HasSubstr("collider box0: box, fixed\n"));
}

TEST_F(ColliderModel, KeyframesBeginAtTimeZero) {
  const Model model =
      build(cloth +
            "[[collider]]\nshape = 'capsule'\npoints = [[0, 0, -1], [2, 0, -1]]\nradius = 0.1\n"
            "keyframes = [{ time = 0, translate = [0, 3, 0], rotate = [0, 0, 90] },"
            " { time = 1, translate = [0, 4, 0], rotate = [0, 0, 90] }]\n");
  // Turned about its middle, then lifted.
  const auto x = surface(model);
  EXPECT_LT((x[20] - Vec3(1, 2, -1)).norm(), 1e-12);
  EXPECT_LT((x[21] - Vec3(1, 4, -1)).norm(), 1e-12);
  EXPECT_LT((x[20] - model.contact->rest[20]).norm(), 1e-12);
  std::vector<Vec3> later(4);
  model.prescribed[0].positions(1, later);
  Vec3 middle = Vec3::Zero(), speed = Vec3::Zero();
  for (std::size_t i = 0; i < 4; ++i) middle += later[i] / 4, speed += model.velocities[20 + i] / 4;
  EXPECT_LT((middle - Vec3(1, 4, -1)).norm(), 1e-12);
  EXPECT_LT((speed - Vec3(0, 1, 0)).norm(), 1e-9);
}

TEST_F(ColliderModel, DensityMakesARigidBody) {
  const Model model = build(
      "[[collider]]\nname = 'ball'\nshape = 'sphere'\ncenter = [1, 2, 3]\nradius = 0.1\ndensity = 500\n"
      "velocity = [0, 1, 0]\nangular_velocity = [0, 0, 180]\n"
      "[[collider]]\nshape = 'plane'\n[[force]]\ntype = 'gravity'\n");
  const double mass = 500 * 4.0 / 3 * std::numbers::pi * 1e-3;
  const Component& ball = model.body("ball");
  EXPECT_FALSE(ball.is_prescribed());
  EXPECT_NEAR(ball.statistics.mass, mass, 1e-12);
  Vec3 momentum = Vec3::Zero(), spin = Vec3::Zero();
  double inertia = 0;
  for (std::size_t v = 0; v < 4; ++v) {
    const Vec3 arm = model.rest_positions[v] - Vec3(1, 2, 3);
    EXPECT_NEAR(model.masses[v], mass / 4, 1e-12);
    momentum += model.masses[v] * model.velocities[v];
    spin += model.masses[v] * arm.cross(model.velocities[v]);
    inertia += model.masses[v] * (arm.x() * arm.x() + arm.y() * arm.y());
  }
  EXPECT_LT((momentum - mass * Vec3(0, 1, 0)).norm(), 1e-12);
  EXPECT_NEAR(inertia, 0.4 * mass * 0.01, 1e-12);
  EXPECT_LT((spin - 0.4 * mass * 0.01 * std::numbers::pi * Vec3(0, 0, 1)).norm(), 1e-12);
  ASSERT_EQ(model.potentials.size(), 1u);
  EXPECT_EQ(model.potentials[0].name, "ball: rigidity");
  EXPECT_NEAR(model.potentials[0].potential->value(model.rest_positions), 0, 1e-20);
  const ContactBody& contact = model.contact->surface->bodies()[0];
  EXPECT_EQ(contact.radius, 0.1);
  EXPECT_FALSE(contact.fixed);
  EXPECT_EQ(model.contact->limits.groups[0], model.contact->limits.groups[3]);
  EXPECT_EQ(model.contact->limits.prescribed, (std::vector<std::uint8_t>{0, 0, 0, 0, 1, 1, 1, 1}));
  EXPECT_THAT(describe_text(model), HasSubstr("collider ball: sphere, rigid body of 2.0944 kg"));
}

TEST_F(ColliderModel, MeshesHaveTheMassOfTheirVolume) {
  const Model model =
      build("[[collider]]\nshape = 'mesh'\nmesh = 'box.obj'\nrotate = [0, 30, 0]\nscale = 2\ndensity = 10\n");
  EXPECT_NEAR(model.bodies[0].statistics.mass, 10 * 2 * 4 * 6, 1e-9);
  EXPECT_EQ(model.contact, nullptr);  // alone, it touches nothing
  EXPECT_THAT(message("[[collider]]\nshape = 'mesh'\nmesh = 'sheet.obj'\ndensity = 1\n"),
              testing::AllOf(HasSubstr("scene.toml:3:8: "), HasSubstr("does not enclose a solid")));
}

TEST_F(ColliderModel, SequencesAreMeshesWhoseVerticesMove) {
  const auto frames = folder() / "frames";
  std::filesystem::create_directories(frames);
  for (const int frame : {0, 1, 2})
    write_mesh(frames / ("walk." + std::to_string(frame) + ".obj"),
               box_mesh(Vec3(frame, 0, 0), Vec3(1, 2, 3)));
  const std::string walker =
      "[[collider]]\nname = 'walker'\nshape = 'mesh'\nmesh = 'box.obj'\nscale = 2\ntranslate = [0, -9, 0]\n";
  const Model model =
      build(cloth + walker + "sequence = 'frames/walk.#.obj'\nframe_rate = 10\nstart = -0.05\n");
  const Component& body = model.body("walker");
  EXPECT_EQ(body.kind(), "sequence");
  EXPECT_EQ(body.vertex_count, 8);
  // Half a sample has gone by at time 0; scaled and moved as the mesh.
  EXPECT_LT((model.rest_positions[20] - Vec3(2 * (0.5 - 0.5), -9 - 2, -3)).norm(), 1e-6);
  EXPECT_LT((model.velocities[20] - Vec3(20, 0, 0)).norm(), 1e-3);
  std::vector<Vec3> later(8);
  model.prescribed[0].positions(0.05, later);
  EXPECT_LT((later[0] - Vec3(1, -11, -3)).norm(), 1e-6);
  EXPECT_EQ(model.contact->limits.groups[20], -1);
  EXPECT_EQ(model.contact->limits.prescribed[20], 1);
  EXPECT_THAT(describe_text(model), HasSubstr("collider walker: box.obj, sequence, 12 triangles"));
  write_mesh(frames / "walk.3.obj", test::flat_sheet(1, 1, 1, 1));
  EXPECT_THAT(message(cloth + walker + "sequence = 'frames/walk.#.obj'\n"),
              testing::AllOf(HasSubstr("scene.toml:12:12: "), HasSubstr("it has 4 vertices, the first")));
  for (const int frame : {0, 1, 2})
    std::filesystem::remove(frames / ("walk." + std::to_string(frame) + ".obj"));
  EXPECT_THAT(message(cloth + walker + "sequence = 'frames/walk.#.obj'\n"),
              HasSubstr("it moves 4 points, box.obj has 8 vertices"));
}

TEST_F(ColliderModel, ContactIsOnIfSurfacesCanTouch) {
  EXPECT_EQ(build(cloth).contact, nullptr);
  EXPECT_NE(build(cloth + "[contact]\n").contact, nullptr);
  EXPECT_EQ(build(cloth + "self_contact = false\n[contact]\n").contact, nullptr);
  EXPECT_EQ(build(cloth + "contact = false\n[[collider]]\nshape = 'plane'\ncenter = [0, -1, 0]\n").contact,
            nullptr);
  const std::string other =
      "[[body]]\nname = 'other'\nmesh = 'sheet.obj'\nmodel = 'shell'\n"
      "material = 'cotton'\ntranslate = [0, 1, 0]\n";
  const Model two = build(cloth + other);
  ASSERT_NE(two.contact, nullptr);
  EXPECT_TRUE(two.contact->map->is_identity());
  EXPECT_FALSE(two.contact->map->is_convex() && two.contact->limits.prescribed.empty());
  EXPECT_EQ(build(cloth + other + "contact = false\n").contact->surface->bodies().size(), 1u);
}

TEST_F(ColliderModel, SurfacesAreThoseOfTheBodies) {
  const Model model = build(cloth +
                            "thickness = 0.004\n"
                            "[[body]]\nname = 'mat'\nmesh = 'sheet.obj'\nvoxel_width = 0.2\nthickness = "
                            "0.1\ntranslate = [0, -1, 0]\n"
                            "material = { density = 100, edge_modulus = 1000 }\n"
                            "[[collider]]\nshape = 'sphere'\ncenter = [0, 2, 0]\nradius = 0.3\n"
                            "[[collider]]\nshape = 'plane'\ncenter = [0, -3, 0]\n"
                            "[[collider]]\nshape = 'mesh'\nmesh = 'box.obj'\ntranslate = [9, 0, 0]\n");
  const ContactSurface& surface = *model.contact->surface;
  ASSERT_EQ(surface.bodies().size(), 5u);
  EXPECT_EQ(surface.bodies()[0].radius, 0.002);
  // Heavy and soft, both are carried at half the range by a tenth of their points.
  const auto carrying = [&](std::size_t b, double points) {
    return 9.81 * model.bodies[b].statistics.mass / (0.1 * points * 1.5 * model.contact->distance);
  };
  EXPECT_NEAR(surface.bodies()[0].stiffness,
              carrying(0, static_cast<double>(model.bodies[0].mesh.positions.size())), 1e-6);
  EXPECT_EQ(surface.bodies()[1].radius, 0.05);
  EXPECT_NEAR(surface.bodies()[1].stiffness,
              carrying(1, static_cast<double>(model.bodies[1].mesh.positions.size())), 1e-6);
  EXPECT_EQ(surface.bodies()[2].radius, 0.3);
  EXPECT_TRUE(surface.bodies()[2].fixed);
  EXPECT_EQ(surface.triangles().size(), 24u + 24 + 1 + 12);
  EXPECT_EQ(surface.point_count(), 20u + 20 + 1 + 1 + 8);
  ASSERT_EQ(surface.planes().size(), 1u);
  EXPECT_EQ(surface.planes()[0].point, 41);
  const auto x = this->surface(model);
  for (std::size_t p = 0; p < x.size(); ++p) EXPECT_LT((x[p] - model.contact->rest[p]).norm(), 1e-12) << p;
  EXPECT_LT((x[20] - Vec3(0, -1, 0)).norm(), 1e-12);
  // The cloth is 0.8 m wide; its edges are 0.2 m and more.
  EXPECT_NEAR(model.contact->distance, 0.8 / 500, 1e-12);
  EXPECT_EQ(model.contact->friction, 0.3);
}

TEST_F(ColliderModel, CoarseMeshesAreWarnings) {
  std::string even = cloth;
  even.replace(even.find("membrane_weft = 400"), 19, "membrane_weft = 100");
  const std::string floor = "[[collider]]\nshape = 'plane'\ncenter = [0, -1, 0]\n";
  EXPECT_THAT(build(even + floor).warnings, testing::IsEmpty());
  EXPECT_THAT(
      build("[[body]]\nmesh = 'sheet.obj'\nvoxel_width = 0.05\nmaterial = 'rubber'\nthickness = 0.05\n" +
            floor)
          .warnings,
      testing::ElementsAre(HasSubstr("subdivide the mesh")));
}

TEST_F(ColliderModel, AStartWithinTheContactDistanceIsAWarning) {
  const std::string sheet =
      "[[body]]\nname = 'cloth'\nmesh = 'sheet.obj'\nmodel = 'shell'\nthickness = 0.002\n"
      "material = { areal_density = 0.1, membrane_warp = 100, bending_warp = 1e-5 }\n";
  // A gap of 1 mm to the floor, of 2 mm to the ball.
  const std::string near = sheet +
                           "[[collider]]\nname = 'floor'\nshape = 'plane'\ncenter = [0, -0.002, 0]\n"
                           "[[collider]]\nname = 'ball'\nshape = 'sphere'\ncenter = [0.4, 0.103, 0.4]\n"
                           "radius = 0.1\n[contact]\ndistance = ";
  EXPECT_THAT(
      build(near + "0.01\n").warnings,
      testing::ElementsAre(testing::AllOf(
          HasSubstr("\"cloth\" and \"floor\" start with a gap of 0.001 m (the closest of 2 such pairs)"),
          HasSubstr("within 0.01 m"), HasSubstr("set `contact.distance` below the gap"))));
  EXPECT_THAT(build(near + "0.0015\n").warnings,
              testing::ElementsAre(HasSubstr("start with a gap of 0.001 m, and")));
  EXPECT_THAT(build(near + "0.001\n").warnings, testing::IsEmpty());
  // Bodies that cross are errors of their own: advice on the distance would mislead.
  const std::string crossing = sheet +
                               "[[collider]]\nname = 'box'\nshape = 'box'\ncenter = [0.4, 0, 0.3]\n"
                               "size = [0.1, 0.1, 0.1]\n[contact]\ndistance = 0.06\n";
  EXPECT_THAT(build(crossing).warnings, testing::Not(testing::Contains(HasSubstr("start with a gap"))));
  // It is about pairs of bodies: a sheet is not too close to itself.
  EXPECT_THAT(build(sheet + "[contact]\ndistance = 1\n").warnings, testing::IsEmpty());
}

TEST_F(ColliderModel, WrongCollidersAreErrorsWithARemedy) {
  const std::vector<std::pair<std::string, std::string>> wrong = {
      {"name = 'a'\n", "[[collider]] a has no `shape`; add `shape = …`, one of `plane`, `sphere`"},
      {"shape = 'spher'\n", "did you mean `sphere`?"},
      {"shape = 'sphere'\n", "[[collider]] 0 of shape sphere has no `radius`"},
      {"shape = 'sphere'\nradius = 0\n", "give a number from 1e-06 to 1000000000 [m]"},
      {"shape = 'sphere'\nraduis = 1\n", "did you mean `radius`?"},
      {"shape = 'sphere'\nradius = 1\nsize = [1, 1, 1]\n", "unknown key `size`"},
      {"shape = 'plane'\nnormal = [0, 0, 0]\n", "`normal` has no direction"},
      {"shape = 'plane'\ndensity = 1\n", "unknown key `density`"},
      {"shape = 'plane'\nfriction = 'ice'\n", "`friction`"},
      {"shape = 'plane'\npivot = [0, 0, 0]\n", "`pivot` needs `keyframes`"},
      {"shape = 'box'\n", "has no `size`"},
      {"shape = 'box'\nsize = [1, 0, 1]\n", "`size`"},
      {"shape = 'capsule'\nradius = 1\n", "give the ends of its axis"},
      {"shape = 'capsule'\nradius = 1\npoints = [[0, 0, 0], [0, 0, 0]]\n", "are one"},
      {"shape = 'mesh'\n", "has no `mesh`"},
      {"shape = 'mesh'\nmesh = 'missing.obj'\n", "missing.obj"},
      {"shape = 'sphere'\nradius = 1\npivot = [0, 0, 0]\n", "`pivot` needs `keyframes`"},
      {"shape = 'sphere'\nradius = 1\nvelocity = [0, 0, 0]\n", "needs `density`"},
      {"shape = 'sphere'\nradius = 1\ndensity = 1\nkeyframes = [{ time = 0 }]\n", "keep one of them"},
      {"shape = 'mesh'\nmesh = 'box.obj'\nsequence = 'a.mdd'\nframe_rate = 25\n",
       "stores its own frame times"},
      {"shape = 'mesh'\nmesh = 'box.obj'\nstart = 1\n", "`start` needs `sequence`"},
      {"shape = 'mesh'\nmesh = 'box.obj'\nsequence = 'a.pc2'\ndensity = 1\n", "keep one of them"},
      {"shape = 'mesh'\nmesh = 'box.obj'\nsequence = 'missing.pc2'\n", "missing.pc2"},
      {"shape = 'sphere'\nradius = 1\nsequence = 'a.pc2'\n", "unknown key `sequence`"},
      {"shape = 'sphere'\nradius = 1\nname = 'cloth'\n", "a [[body]] and a [[collider]] called `cloth`"},
      {"shape = 'sphere'\nradius = 1e12\n", "`radius`"},
      {"shape = 'sphere'\nradius = 1\ncenter = [1e10, 0, 0]\n", "collider sphere0"},
      {"shape = 'sphere'\nradius = 1\nkeyframes = [{ time = 0, translate = [0, 1e10, 0] }]\n",
       "collider sphere0"},
      {"shape = 'capsule'\nradius = 1\npoints = [[0, 0, 0], [1e200, 0, 0]]\n",
       "x of a point of `points` is 1e+200; give numbers from -100000000000"},
      {"shape = 'mesh'\nmesh = 'box.obj'\nscale = 1e-9\ndensity = 1\n", "too small to have mass"},
      {"shape = 'sphere'\nname = 'post'\nradius = 1\n[[pin]]\nbody = 'post'\nwhere = { nearest = [0, 0, 0] "
       "}\n",
       "has no mass, so nothing holds or pushes it"},
      {"shape = 'plane'\n[contact]\nmode = 'fast'\n",
       "scene.toml:9:1: contact.mode no longer exists: every scene is solved in one way"},
      {"shape = 'plane'\n[contact]\ndistance = 0\n", "`distance`"},
      {"shape = 'plane'\n[contact]\nfriction = -1\n", "`friction`"},
      {"shape = 'plane'\n[solver]\nintegrator = 'symplectic_euler'\n",
       "symplectic_euler does not support contact"},
  };
  for (const auto& [text, expected] : wrong) {
    SCOPED_TRACE(text);
    try {
      build(cloth + "[[collider]]\n" + text);
      ADD_FAILURE() << "no error";
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr(expected));
    }
  }
  EXPECT_THAT(message("[[collider]]\nshape = 'plane'\n"), HasSubstr("the scene has no body"));
}

}  // namespace
}  // namespace muslin
