// Parts of a mesh that are nearer than a voxel move by themselves if they are kept apart.
#include "muslin/component/lattice/separate_parts.hpp"

#include <array>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "muslin/component/lattice/lattice_body.hpp"
#include "muslin/geometry/shapes.hpp"
#include "muslin/scene/model.hpp"
#include "muslin/simulation/simulation.hpp"

namespace muslin {
namespace {

Mesh together(const std::vector<Mesh>& parts) {
  Mesh mesh;
  for (const Mesh& part : parts) {
    const int first = static_cast<int>(mesh.vertex_count());
    mesh.positions.insert(mesh.positions.end(), part.positions.begin(), part.positions.end());
    for (std::size_t f = 0; f < part.face_count(); ++f) {
      std::vector<int> face;
      for (const int v : part.face(f)) face.push_back(first + v);
      mesh.add_face(face);
    }
  }
  return mesh;
}

Mesh box_at(const Vec3& middle) { return box_mesh(middle, Vec3::Constant(0.1)); }

/// Between the two boxes [m].
constexpr double middle = 0.052;

/// Boxes of 5 voxels, 0.2 voxels apart.
const Mesh& two_boxes() {
  static const Mesh mesh = together({box_at(Vec3::Zero()), box_at({0.104, 0, 0})});
  return mesh;
}

std::shared_ptr<const Model> model_of(const Mesh& mesh, const std::string& keys,
                                      const std::string& more = "") {
  Scene scene = parse_scene(
      "[[body]]\nname = \"boxes\"\nmesh = \"boxes.obj\"\nvoxel_width = 0.02\nmaterial = \"rubber\"\n" + keys +
          "\n" + more,
      "scene.toml");
  scene.meshes["boxes.obj"] = std::make_shared<Mesh>(mesh);
  return std::make_shared<Model>(build_model(scene));
}

const LatticeBody& lattice_of(const Model& model) { return *as_lattice(model.bodies.front()); }

std::size_t part_count(const LatticeBody& body) {
  const std::vector<int> parts = body.parts();
  return std::set<int>(parts.begin(), parts.end()).size();
}

TEST(SeparateParts, ShareNoVoxel) {
  const auto apart = model_of(two_boxes(), "separate_parts = true");
  EXPECT_TRUE(apart->warnings.empty());
  const LatticeBody& body = lattice_of(*apart);
  // The grid need not begin where the boxes do: up to 6 layers carry each.
  EXPECT_GE(body.lattice.voxel_count(), 2U * 5 * 5 * 5);
  EXPECT_LE(body.lattice.voxel_count(), 2U * 6 * 5 * 5);
  EXPECT_EQ(part_count(body), 2U);
  EXPECT_EQ(part_count(lattice_of(*model_of(two_boxes(), ""))), 1U);
  const auto alone = model_of(box_at(Vec3::Zero()), "separate_parts = true");
  EXPECT_NEAR(body.statistics.mass, 2 * lattice_of(*alone).statistics.mass, 1e-9);
  EXPECT_NE(body.description().find("parts       2, kept apart"), std::string::npos);
}

TEST(SeparateParts, LieWhereTheMeshIs) {
  const auto apart = model_of(two_boxes(), "separate_parts = true");
  const LatticeBody& body = lattice_of(*apart);
  std::vector<Vec3> rest(body.lattice.vertex_count()), skin(body.mesh.vertex_count());
  Box bounds;
  for (std::size_t v = 0; v < rest.size(); ++v) bounds.extend(rest[v] = body.rest_position(v));
  const double width = body.lattice.width;
  EXPECT_LT((bounds.min() - body.mesh.bounds().min()).norm(), width);
  EXPECT_LT((bounds.max() - body.mesh.bounds().max()).norm(), width);
  body.skin.apply(rest, skin);
  for (std::size_t v = 0; v < skin.size(); ++v)
    EXPECT_LT((skin[v] - body.mesh.positions[v]).norm(), 1e-12) << v;
  Box contour;
  for (const Vec3& p : body.contour.mesh.positions) contour.extend(p);
  EXPECT_LT((contour.min() - body.mesh.bounds().min()).norm(), width);
  EXPECT_LT((contour.max() - body.mesh.bounds().max()).norm(), width);
}

TEST(SeparateParts, FallByThemselves) {
  // The left box is held; the right one falls freely. Gravity 10 for 0.2 s in 12 steps of implicit Euler.
  const auto model = model_of(two_boxes(), "separate_parts = true",
                              "[time]\nduration = 0.2\nframe_rate = 60\nsteps_per_frame = 1\n"
                              "[[pin]]\nwhere = { box = [[-1, -1, -1], [-0.04, 1, 1]] }\n"
                              "[[force]]\ntype = \"gravity\"\nacceleration = [0, -10, 0]\n");
  Simulation simulation(model);
  for (int frame = 0; frame < 12; ++frame) simulation.advance();
  const LatticeBody& body = lattice_of(*model);
  const double fall = 10.0 / 60 / 60 * 12 * 13 / 2;
  std::vector<Vec3> skin(body.mesh.vertex_count());
  body.skin.apply(simulation.state().positions, skin);
  for (std::size_t v = 0; v < skin.size(); ++v) {
    const Vec3 moved = skin[v] - body.mesh.positions[v];
    if (body.mesh.positions[v].x() > middle) {
      EXPECT_LT((moved - Vec3(0, -fall, 0)).norm(), 1e-6);
    } else {
      EXPECT_LT(moved.norm(), 0.02);
    }
  }
}

TEST(SeparateParts, CarryWhatIsAttachedToTheNearerOne) {
  const auto model = model_of(two_boxes(), "separate_parts = true");
  const LatticeBody& body = lattice_of(*model);
  const std::vector<int> parts = body.parts();
  const auto part = [&](const Vec3& at) {
    return parts[static_cast<std::size_t>(body.attach(at).point.vertices.front()[0])];
  };
  const int left = part({-0.049, 0, 0}), right = part({0.153, 0, 0});
  EXPECT_NE(left, right);
  EXPECT_EQ(part({middle - 0.001, 0.01, 0}), left);
  EXPECT_EQ(part({middle + 0.001, 0.01, 0}), right);
}

TEST(SeparateParts, AreOneWhereTheyCrossOrContainEachOther) {
  const LatticeSettings settings{0.02};
  EXPECT_TRUE(SeparateParts(box_at(Vec3::Zero()), settings).empty());
  EXPECT_TRUE(SeparateParts(together({box_at(Vec3::Zero()), box_at({0.09, 0.01, 0.01})}), settings).empty());
  const Mesh inner = box_mesh(Vec3::Constant(0.01), Vec3::Constant(0.04));
  EXPECT_TRUE(SeparateParts(together({box_at(Vec3::Zero()), inner}), settings).empty());
  EXPECT_EQ(SeparateParts(two_boxes(), settings).count(), 2U);
}

TEST(SeparateParts, ChangeNothingInAMeshOfOnePart) {
  const auto with = model_of(box_at(Vec3::Zero()), "separate_parts = true");
  const auto without = model_of(box_at(Vec3::Zero()), "");
  EXPECT_EQ(lattice_of(*with).lattice.vertices, lattice_of(*without).lattice.vertices);
  EXPECT_EQ(lattice_of(*with).lattice.origin, lattice_of(*without).lattice.origin);
  EXPECT_EQ(lattice_of(*with).lattice.fill, lattice_of(*without).lattice.fill);
}

TEST(SeparateParts, StayApartWithAThresholdAndAsSheets) {
  const auto wide = model_of(two_boxes(), "separate_parts = true\nvoxels = \"threshold\"\nthreshold = 2");
  EXPECT_EQ(part_count(lattice_of(*wide)), 2U);
  // Two flat squares, one above the other at a quarter of a voxel.
  Mesh squares;
  for (const double y : {0.0, 0.005})
    squares.positions.insert(squares.positions.end(), {{0, y, 0}, {0.2, y, 0}, {0.2, y, 0.2}, {0, y, 0.2}});
  squares.add_face(std::array{0, 3, 2, 1});
  squares.add_face(std::array{4, 7, 6, 5});
  const auto sheets = model_of(squares, "separate_parts = true\nthickness = 0.002");
  EXPECT_EQ(part_count(lattice_of(*sheets)), 2U);
  EXPECT_EQ(part_count(lattice_of(*model_of(squares, "thickness = 0.002"))), 1U);
}

}  // namespace
}  // namespace muslin
