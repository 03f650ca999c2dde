// Colliders that teleport, start at full speed, spin, or move 10 m in a frame, over and under cloth: the
// cloth stays whole, and no frame hangs.
#include <array>
#include <memory>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "muslin/contact/contact_model.hpp"
#include "muslin/contact/crossings.hpp"
#include "muslin/scene/model.hpp"
#include "muslin/simulation/simulation.hpp"

namespace muslin {
namespace {

struct Case {
  std::string name, collider;
  bool pinned;
  bool warns;
};

/// A square of 1 m at y = 0, free or held along two sides, and a collider.
std::shared_ptr<const Model> model_of(const Case& tested) {
  constexpr int across = 11;
  auto mesh = std::make_shared<Mesh>();
  for (int i = 0; i < across; ++i)
    for (int j = 0; j < across; ++j)
      mesh->positions.emplace_back(i / (across - 1.0) - 0.5, 0, j / (across - 1.0) - 0.5);
  for (int i = 0; i + 1 < across; ++i)
    for (int j = 0; j + 1 < across; ++j) {
      const int at = i * across + j;
      mesh->add_face(std::array{at, at + 1, at + across + 1, at + across});
    }
  std::string text =
      "[time]\nduration = 0.75\n[[force]]\ntype = 'gravity'\n[[body]]\nname = 'cloth'\nmodel = 'shell'\n"
      "mesh = 'cloth'\nmaterial = 'cotton'\nwarp = [1, 0, 0]\n[[collider]]\nname = 'fast'\n" +
      tested.collider;
  if (tested.pinned)
    for (const char* z : {"-0.5", "0.5"})
      text += "[[pin]]\nwhere = { line = { from = [-0.5, 0, " + std::string(z) + "], to = [0.5, 0, " + z +
              "] } }\n";
  Scene scene = parse_scene(text, "scene.toml");
  scene.meshes["cloth"] = mesh;
  return std::make_shared<const Model>(build_model(scene));
}

class FastCollider : public ::testing::TestWithParam<Case> {};

TEST_P(FastCollider, LeavesTheClothWhole) {
  const auto model = model_of(GetParam());
  if (GetParam().warns) {
    EXPECT_THAT(model->warnings, testing::Contains(testing::HasSubstr("passes through what is in its way")));
  }
  Simulation simulation(model);
  for (int frame = 0; frame < 18; ++frame) {
    simulation.advance();
    ASSERT_LT(simulation.diagnostics().max_stretch, 1.2) << frame;
  }
  EXPECT_TRUE(find_crossings(*model->contact, simulation.state().positions, 0.75).empty());
}

const std::string ball = "shape = 'sphere'\nradius = 0.2\n", box = "shape = 'box'\nsize = [0.3, 0.3, 0.3]\n";
INSTANTIATE_TEST_SUITE_P(
    Motions, FastCollider,
    ::testing::Values(
        Case{"TeleportsThrough",
             box + "center = [0, -0.5, 0]\nkeyframes = [{ time = 0 }, { time = 0.2 }, { time "
                   "= 0.2001, translate = [0, 3, 0] }]\n",
             false, true},
        Case{"TeleportsAway",
             ball + "center = [0, -0.25, 0]\nkeyframes = [{ time = 0 }, { time = 0.25 }, { time "
                    "= 0.2501, translate = [10, 0, 0] }]\n",
             false, true},
        Case{"UpTenMetresInAFrame",
             box + "center = [0, -0.3, 0]\nkeyframes = [{ time = 0 }, { time = 0.25 }, { time = 0.2917, "
                   "translate "
                   "= [0, 10, 0] }]\n",
             true, true},
        Case{"DownTenMetresInAFrame",
             ball + "center = [0, 0.5, 0]\nkeyframes = [{ time = 0 }, { time = 0.25 }, { time = 0.2917, "
                    "translate "
                    "= [0, -10, 0] }]\n",
             true, true},
        Case{
            "StartsAtFullSpeed",
            box + "center = [0, -0.5, 0]\nkeyframes = [{ time = 0 }, { time = 1, translate = [0, 40, 0] }]\n",
            true, true},
        Case{"Spins",
             box +
                 "center = [0, -0.25, 0]\nkeyframes = [{ time = 0 }, { time = 1, rotate = [0, 10000, 0] }]\n",
             false, false}),
    [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace muslin
