// Every scene of the thesis in steps of a whole frame, dt = 1/24 s, over its whole duration: a user who wants
// speed gives up substeps, and no step may fail for it.
#include <filesystem>
#include <set>
#include <string>

#include "support/scene_run.hpp"
#include <gtest/gtest.h>

namespace muslin::test {
namespace {

std::set<std::string> thesis_scenes() {
  std::set<std::string> names;
  const std::string folder = std::string(MUSLIN_SOURCE_DIR) + "/scenes/thesis";
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".toml") names.insert(entry.path().stem().string());
  return names;
}

class LongSteps : public testing::TestWithParam<std::string> {};

TEST_P(LongSteps, ConvergeWithoutHalving) {
  SceneRun run("thesis/" + GetParam() + ".toml", {"time.steps_per_frame=1"});
  const Scene& scene = run.model().scene;
  ASSERT_EQ(scene.time.step(), 1.0 / 24);
  const int frames = static_cast<int>(scene.time.duration * scene.time.frame_rate);
  ASSERT_GE(frames, 24);
  for (int frame = 1; frame <= frames; ++frame) {
    run.until_frame(frame);
    const Diagnostics& row = run.simulation().diagnostics();
    EXPECT_EQ(row.converged_steps, row.steps) << "frame " << frame;
    ASSERT_EQ(run.simulation().state().step, frame) << "a halved step counts as two";
  }
}

INSTANTIATE_TEST_SUITE_P(Thesis, LongSteps, testing::ValuesIn(thesis_scenes()),
                         [](const auto& parameter) { return "Scene" + parameter.param; });

}  // namespace
}  // namespace muslin::test
