// Runs of welded bodies write the vertices of the mesh file in its order.
#include <filesystem>
#include <memory>

#include "support/panels.hpp"
#include <gtest/gtest.h>
#include <unistd.h>

#include "muslin/cache/run.hpp"
#include "muslin/cache/run_reader.hpp"
#include "muslin/cache/selections.hpp"
#include "muslin/scene/model.hpp"

namespace muslin {
namespace {

TEST(WeldRun, FilesHaveTheVerticesOfTheMeshFile) {
  const auto directory =
      std::filesystem::temp_directory_path() / ("muslin_weld_run_" + std::to_string(getpid()));
  Scene scene = parse_scene(
      "[time]\nduration = 1\n[[body]]\nname = \"cloth\"\nmesh = \"cloth.obj\"\nmodel = \"shell\"\nwarp = [1, "
      "0, 0]\n"
      "weld = 2e-5\nmaterial = \"cotton\"\n[[pin]]\nwhere = { line = { from = [0.5, 0, 0], to = [0.5, 0, 1], "
      "distance = 0.001 } }\n[[force]]\ntype = \"gravity\"\n[contact]\n",
      "scene.toml");
  const Mesh panels = test::two_panels(1.5e-5);
  scene.meshes["cloth.obj"] = std::make_shared<Mesh>(panels);
  RunOptions options;
  options.directory = directory;
  options.frames = 2;
  EXPECT_TRUE(run_scene(scene, options).warnings.empty());

  const RunReader run(directory);
  EXPECT_EQ(run.mesh(0, SurfaceKind::skin).face_vertices, panels.face_vertices);
  const std::vector<Vec3f> points = run.points(0, SurfaceKind::skin, 2);
  ASSERT_EQ(points.size(), panels.vertex_count());
  for (std::size_t k = 0; k <= 20; ++k) EXPECT_EQ(points[10 + 11 * k], points[231 + 11 * k]);
  EXPECT_LT(points[0].y(), -0.005F);

  // Both sides of the seam are held.
  const Selections selections = selections_of(build_model(scene));
  ASSERT_EQ(selections.pins.size(), 1U);
  EXPECT_EQ(selections.pins[0].vertices.size(), 42U);
  EXPECT_EQ(selections.pins[0].vertices[0], 10);
  EXPECT_EQ(selections.pins[0].vertices[21], 231);
  std::filesystem::remove_all(directory);
}

}  // namespace
}  // namespace muslin
