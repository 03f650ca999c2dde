// An animated collider whose parts pass through each other, with cloth between them: both give way by what
// the cloth needs, steps converge, and nothing crosses or is stretched.
#include "muslin/simulation/yielding.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "cache/scratch.hpp"
#include <gtest/gtest.h>

#include "muslin/cache/point_cache.hpp"
#include "muslin/contact/contact_model.hpp"
#include "muslin/contact/crossings.hpp"
#include "muslin/core/parallel.hpp"
#include "muslin/io/mesh_writers.hpp"
#include "muslin/scene/model.hpp"
#include "muslin/simulation/simulation.hpp"

namespace muslin {
namespace {

using test::Scratch;

constexpr double crossing = 0.012;  // of the two blocks [m]

/// Adds the surface of a block of cells × 2 × cells cubes of the given size.
void add_block(const Vec3& low, const Vec3& size, int cells, Mesh& mesh) {
  const std::array<int, 3> count{cells, 2, cells};
  std::map<std::array<int, 3>, int> numbers;
  const auto corner = [&](std::array<int, 3> at) {
    const auto [known, is_new] = numbers.try_emplace(at, static_cast<int>(mesh.positions.size()));
    if (is_new)
      mesh.positions.emplace_back(low.x() + size.x() * at[0] / count[0],
                                  low.y() + size.y() * at[1] / count[1],
                                  low.z() + size.z() * at[2] / count[2]);
    return known->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (const int side : {0, count[axis]})
      for (int i = 0; i < count[u]; ++i)
        for (int j = 0; j < count[v]; ++j) {
          std::array<int, 4> face{};
          for (std::size_t k = 0; k < 4; ++k) {
            std::array<int, 3> at{};
            at[axis] = side;
            at[u] = i + (k == 1 || k == 2 ? 1 : 0);
            at[v] = j + (k > 1 ? 1 : 0);
            face[k] = corner(at);
          }
          if (side == 0) std::swap(face[1], face[3]);
          mesh.add_face(face);
        }
  }
}

/// A sheet on a block that is fixed; another block of the same mesh comes down through it, stays and lifts.
std::shared_ptr<const Model> pinch(const Scratch& scratch) {
  Mesh body, sheet;
  sheet.positions.reserve(225);
  add_block({-0.1, -0.1, -0.1}, {0.2, 0.1, 0.2}, 4, body);
  const std::size_t lower = body.positions.size();
  add_block({-0.1, 0.03, -0.1}, {0.2, 0.1, 0.2}, 4, body);
  constexpr int across = 15;
  for (int i = 0; i < across; ++i)
    for (int j = 0; j < across; ++j)
      sheet.positions.emplace_back(0.28 * i / (across - 1) - 0.143, 0.003, 0.28 * j / (across - 1) - 0.138);
  for (int i = 0; i + 1 < across; ++i)
    for (int j = 0; j + 1 < across; ++j) {
      const int at = i * across + j;
      sheet.add_face(std::array{at, at + 1, at + across + 1, at + across});
    }
  test::write_bytes(scratch / "body.obj", to_obj(body, body.positions));
  test::write_bytes(scratch / "sheet.obj", to_obj(sheet, sheet.positions));
  constexpr std::array down{0.0, 0.0, 0.25, 0.5, 0.75, 1.0, 1.0, 1.0, 0.75, 0.5, 0.25, 0.0, 0.0, 0.0};
  write_pc2(scratch / "body.pc2", static_cast<int>(down.size()), body.positions.size(), [&](int sample) {
    std::vector<Vec3f> x;
    x.reserve(body.positions.size());
    for (std::size_t v = 0; v < body.positions.size(); ++v) {
      const double by = v < lower ? 0 : down[static_cast<std::size_t>(sample)] * (0.03 + crossing);
      x.push_back((body.positions[v] - Vec3(0, by, 0)).cast<float>());
    }
    return x;
  });
  test::write_bytes(scratch / "scene.toml",
                    "[time]\nduration = 0.54\n[[force]]\ntype = 'gravity'\n[contact]\nfriction = 0.3\n"
                    "[[body]]\nname = 'sheet'\nmodel = 'shell'\nmesh = 'sheet.obj'\nmaterial = 'cotton'\n"
                    "warp = [1, 0, 0]\n[[collider]]\nname = 'body'\nshape = 'mesh'\nmesh = 'body.obj'\n"
                    "sequence = 'body.pc2'\n");
  return std::make_shared<const Model>(build_model(read_scene(scratch / "scene.toml")));
}

TEST(Yielding, BothSidesGiveWayByWhatTheClothNeeds) {
  const Scratch scratch;
  const auto model = pinch(scratch);
  const Prescribed& body = model->prescribed.front();
  Simulation simulation(model);
  double farthest = 0, deepest_of_lower = 0;
  std::vector<Vec3> path(body.start.size());
  while (simulation.frame() < model->scene.time.frames()) {
    simulation.advance();
    const Diagnostics& now = simulation.diagnostics();
    SCOPED_TRACE(now.frame);
    ASSERT_EQ(now.converged_steps, now.steps);
    ASSERT_LT(now.max_stretch, 1.05);
    ASSERT_TRUE(find_crossings(*model->contact, simulation.state().positions).empty());
    farthest = std::max(farthest, now.behind);
    body.positions(now.time, path);
    for (std::size_t v = 0; v < path.size() / 2; ++v)
      deepest_of_lower =
          std::max(deepest_of_lower,
                   path[v].y() - simulation.state().positions[static_cast<std::size_t>(body.first) + v].y());
  }
  // Inside, each by half of the crossing and of the room of the cloth; at the rim only the block that moves.
  const double least = crossing / 2;
  EXPECT_GT(farthest, least);
  EXPECT_LT(farthest, crossing + 0.003);
  EXPECT_GT(deepest_of_lower, least - 0.002);
  EXPECT_EQ(simulation.diagnostics().held_back, 0);
  for (std::size_t v = 0; v < path.size(); ++v)
    EXPECT_EQ(simulation.state().positions[static_cast<std::size_t>(body.first) + v], path[v]) << v;
}

TEST(Yielding, ResumedRunsAndAnyThreadCountHaveTheSameBits) {
  const Scratch scratch;
  const auto model = pinch(scratch);
  set_thread_count(1);
  Simulation whole(model);
  while (whole.frame() < 5) whole.advance();
  EXPECT_GT(whole.diagnostics().held_back, 0);
  Simulation resumed(model);
  resumed.restore(whole.checkpoint());
  while (whole.frame() < 7) whole.advance();
  set_thread_count(2);
  while (resumed.frame() < 7) {
    resumed.forget_scratch();
    resumed.advance();
  }
  set_thread_count(0);
  EXPECT_EQ(whole.checkpoint(), resumed.checkpoint());
}

}  // namespace
}  // namespace muslin
