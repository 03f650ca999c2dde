// Each kind of component through the interface that the rest of the program uses.
#include "muslin/component/component.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "cache/scratch.hpp"
#include "support/sheet.hpp"
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "muslin/component/collider/affine_collider.hpp"
#include "muslin/component/component_list.hpp"
#include "muslin/component/kinds.hpp"
#include "muslin/component/lattice/lattice_body.hpp"
#include "muslin/component/select.hpp"
#include "muslin/component/shell/shell_body.hpp"
#include "muslin/core/disjoint_sets.hpp"
#include "muslin/core/error.hpp"
#include "muslin/geometry/shapes.hpp"
#include "muslin/io/mesh_file.hpp"
#include "muslin/scene/scene.hpp"

namespace muslin {
namespace {

using test::Scratch;

/// The keys of a [[body]] of each kind.
const std::map<std::string, std::string> body_keys = {
    {"lattice", "mesh = 'box'\nvoxel_width = 0.5\nmaterial = 'rubber'\n"},
    {"shell", "mesh = 'sheet'\nmaterial = 'cotton'\n"}};

/// Builds one component of a kind.
class Kinds : public testing::Test {
 protected:
  std::shared_ptr<Component> build(const std::string& kind) {
    Mesh two = box_mesh(Vec3(0.5, 0.5, 0.5), Vec3(1, 1, 1));
    scene_.meshes["box"] = std::make_shared<const Mesh>(two);
    scene_.meshes["sheet"] = std::make_shared<const Mesh>(test::flat_sheet(4, 3, 0.4, 0.3));
    for (const int frame : {0, 1}) {
      Mesh moved = two;
      for (Vec3& x : moved.positions) x.x() += frame;
      write_mesh(scratch_ / ("walk." + std::to_string(frame) + ".obj"), moved);
    }
    const SceneFiles files{scratch_ / "scene.toml", scene_.meshes};
    const ComponentInputs inputs{files, 24, 1.0 / 24, Box(), warnings_, {}};
    if (const auto keys = body_keys.find(kind); keys != body_keys.end()) {
      const std::string text = fmt::format("[[body]]\nname = '{}'\nmodel = '{}'\nvelocity = [1, 2, 3]\n{}",
                                           kind, kind, keys->second);
      return source_of(parse_scene(text, "scene.toml").bodies.front()).build(inputs);
    }
    ColliderSettings collider;
    collider.name = kind;
    collider.shape = ColliderSettings::Shape::mesh;
    collider.mesh = "box";
    if (kind == "rigid") collider.density = 100, collider.velocity = Vec3(1, 2, 3);
    if (kind == "mesh") collider.sequence = "walk.#.obj";
    return source_of(collider).build(inputs);
  }

  Scratch scratch_;
  Scene scene_;
  std::vector<std::string> warnings_;
};

class EveryKind : public Kinds, public testing::WithParamInterface<std::string> {};

std::vector<Vec3> rest_of(const Component& component) {
  std::vector<Vec3> rest;
  for (int v = 0; v < component.vertex_count; ++v)
    rest.push_back(component.rest_position(static_cast<std::size_t>(v)));
  return rest;
}

TEST_P(EveryKind, HasOneMassVelocityAndLabelPerVertex) {
  const auto component = build(GetParam());
  const auto count = static_cast<std::size_t>(component->vertex_count);
  ASSERT_GT(count, 0u);
  EXPECT_EQ(component->masses().size(), count);
  EXPECT_EQ(component->velocities().size(), count);
  EXPECT_EQ(component->parts().size(), count);
  double mass = 0;
  for (const double m : component->masses()) mass += m;
  EXPECT_EQ(mass, component->statistics.mass);
  EXPECT_EQ(component->is_prescribed(), mass == 0);
  EXPECT_GT(component->spacing(), 0);
  EXPECT_GT(component->longest_step(), 0);
}

TEST_P(EveryKind, CarriesItsMeshAtRest) {
  const auto component = build(GetParam());
  const std::vector<Vec3> rest = rest_of(*component);
  std::vector<Vec3> skin(component->skin.size());
  component->skin.apply(rest, skin);
  ASSERT_EQ(skin.size(), component->mesh.vertex_count());
  for (std::size_t p = 0; p < skin.size(); ++p)
    EXPECT_LT((skin[p] - component->mesh.positions[p]).norm(), 1e-12);
  if (component->is_mesh()) {
    EXPECT_EQ(rest, component->mesh.positions);
  }
}

TEST_P(EveryKind, ContactPointsLieOnItsSurface) {
  const auto component = build(GetParam());
  const std::optional<ContactPart> part = component->contact_part();
  ASSERT_TRUE(part);
  const std::vector<Vec3> rest = rest_of(*component);
  ASSERT_EQ(part->offsets.size(), part->rest.size() + 1);
  for (std::size_t p = 0; p < part->rest.size(); ++p) {
    Vec3 point = Vec3::Zero();
    for (int e = part->offsets[p]; e < part->offsets[p + 1]; ++e) {
      const SurfaceMap::Entry& entry = part->entries[static_cast<std::size_t>(e)];
      point += entry.weight * rest[static_cast<std::size_t>(entry.vertex)];
    }
    EXPECT_LT((point - part->rest[p]).norm(), 1e-12);
  }
  EXPECT_EQ(part->body.fixed, component->is_prescribed());
  EXPECT_EQ(part->triangles.size(), part->faces.size());
}

TEST_P(EveryKind, HasNoInternalForceAtRest) {
  const auto component = build(GetParam());
  const std::vector<Vec3> rest = rest_of(*component);
  for (const PotentialTerm& term : component->potentials) {
    std::vector<Vec3> gradient(rest.size(), Vec3::Zero());
    term.potential->add_gradient(rest, gradient);
    for (const Vec3& g : gradient) EXPECT_LT(g.norm(), 1e-6) << term.name;
  }
  EXPECT_NEAR(component->max_stretch(rest), 1, 1e-12);
}

TEST_P(EveryKind, AttachesAPointAtTheRequestedPlace) {
  const auto component = build(GetParam());
  const Vec3 at(0.2, 0, 0.1);
  const AttachedPoint attached = component->attach(at);
  Vec3 point;
  attached.point.apply(rest_of(*component), {&point, 1});
  EXPECT_LT((point - at).norm(), 1e-12);
  EXPECT_EQ(attached.warning, "");
}

TEST_P(EveryKind, LoadsOnPointsActOnVerticesWithTheSameSum) {
  const auto component = build(GetParam());
  Selection where;
  where.nearest = {Vec3(0, 0, 0)};
  const std::vector<int> points = select_vertices(*component, where, "test");
  EXPECT_EQ(points, (std::vector<int>{0}));
  const LoadedVertices loaded = component->loaded_vertices(where, "test");
  double sum = loaded.shares.empty() ? static_cast<double>(loaded.vertices.size()) : 0;
  for (const double share : loaded.shares) sum += share;
  EXPECT_NEAR(sum, 1, 1e-12);
  const std::vector<int> held = component->held_vertices(where, "test");
  EXPECT_EQ(held.size(),
            component->selects_vertices() ? 1u : static_cast<std::size_t>(component->vertex_count));
}

TEST_P(EveryKind, HashesDistinguishComponents) {
  const auto component = build(GetParam());
  const std::uint64_t shape = component->shape_hash(1);
  EXPECT_EQ(build(GetParam())->shape_hash(1), shape);
  EXPECT_NE(component->shape_hash(2), shape);
  component->first_vertex = 7;
  EXPECT_NE(component->shape_hash(1), shape);
}

TEST_P(EveryKind, DescribesItselfAndWritesItsStages) {
  const auto component = build(GetParam());
  const auto json = nlohmann::json::parse(component->description_json());
  EXPECT_EQ(json["name"], GetParam());
  EXPECT_TRUE(json.contains("vertices"));
  EXPECT_THAT(component->description(), testing::HasSubstr(GetParam()));
  EXPECT_THAT(component->description(), testing::EndsWith("\n"));
  component->write_stages(scratch_.path(), {});
  EXPECT_TRUE(std::filesystem::exists(scratch_ / (GetParam() + ".skin.obj")));
  for (const CachedPoints& points : component->cached_points()) {
    points.write_rest(scratch_ / (points.name + "." + points.extension));
    EXPECT_TRUE(std::filesystem::exists(scratch_ / (points.name + "." + points.extension)));
  }
}

std::vector<std::string> all_kinds() {
  std::vector<std::string> kinds = {"rigid", "fixed", "mesh"};
  for (const auto& [kind, keys] : body_keys) kinds.push_back(kind);
  return kinds;
}
INSTANTIATE_TEST_SUITE_P(Components, EveryKind, testing::ValuesIn(all_kinds()),
                         [](const auto& info) { return info.param; });

TEST_F(Kinds, EveryBodyKindIsTestedHere) {
  for (const BodyKind& kind : body_kinds()) {
    ASSERT_TRUE(body_keys.contains(kind.name)) << kind.name;
    EXPECT_EQ(build(kind.name)->kind(), kind.name);
    EXPECT_EQ(kind.keys().name, kind.name);
  }
}

TEST_F(Kinds, EveryColliderHasExactlyOneKind) {
  ColliderSettings still, free;
  free.density = 1;
  for (const ColliderSettings& settings : {still, free})
    EXPECT_EQ(std::count_if(collider_kinds().begin(), collider_kinds().end(),
                            [&](const ColliderKind& kind) { return kind.is_meant(settings); }),
              1);
}

TEST_F(Kinds, CastsSucceedForTheirKindOnly) {
  const auto lattice = build("lattice"), shell = build("shell"), rigid = build("rigid");
  EXPECT_NE(as_lattice(*lattice), nullptr);
  EXPECT_EQ(as_lattice(*shell), nullptr);
  EXPECT_NE(as_shell(*shell), nullptr);
  EXPECT_EQ(as_shell(*rigid), nullptr);
}

TEST_F(Kinds, RigidKindsDoNotDeformAndScriptedKindsIgnoreForces) {
  EXPECT_TRUE(build("lattice")->is_soft());
  EXPECT_TRUE(build("shell")->is_soft());
  EXPECT_FALSE(build("rigid")->deforms());
  EXPECT_FALSE(build("fixed")->deforms());
  EXPECT_FALSE(build("mesh")->is_soft());
  EXPECT_LT((build("mesh")->velocities().front() - Vec3(24, 0, 0)).norm(), 1e-4);
  for (const char* kind : {"rigid", "fixed", "mesh"}) EXPECT_TRUE(build(kind)->is_collider()) << kind;
}

TEST(DisjointSets, AreRepresentedByTheirFirstVertex) {
  DisjointSets parts(6);
  parts.join(4, 2);
  parts.join(2, 5);
  parts.join(0, 1);
  EXPECT_EQ(parts.find_all(), (std::vector<int>{0, 0, 2, 3, 2, 2}));
}

}  // namespace
}  // namespace muslin
