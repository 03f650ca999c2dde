// Recorded positions of a small scene: unintended changes of results show here. They are compared to 1e-9 m,
// not bit by bit, so that compilers and libraries may round in their own ways.
//
// After an intended change: MUSLIN_UPDATE_GOLDEN=1 build/release/tests/test_golden, and say in the commit
// why.
#include <cstdlib>
#include <fstream>
#include <iomanip>
#include <string>

#include "support/scene_run.hpp"
#include <gtest/gtest.h>

namespace muslin::test {
namespace {

/// Wind, damping, a pin that lets go, volume conservation and both kinds of diagonals on a few voxels. The
/// tolerance is tight and the time short, so that rounding does not grow to what is compared.
constexpr const char* scene = R"(
[time]
duration = 0.5
frame_rate = 24
steps_per_frame = 4
[solver]
tolerance = 1e-9
linear_tolerance = 1e-12
[[body]]
name = "flag"
mesh = "flag.obj"
thickness = 1.0
voxel_width = 2.0
bracing = "full"
boundary_springs = "shared"
material = { density = 10, edge_modulus = 1000, face_diagonal_modulus = 100, body_diagonal_modulus = 100, volume_modulus = 100, mass_damping = 0.1, stiffness_damping = 1e-3 }
[[pin]]
where = { line = { from = [0, 6, -1], to = [0, 6, 1] } }
[[pin]]
where = { line = { from = [10, 6, -1], to = [10, 6, 1] } }
until = 0.2
[[force]]
type = "gravity"
[[force]]
type = "wind"
velocity = [1, 0, 3]
lift = 0.5
gust = 1
)";

class Golden : public testing::TestWithParam<std::string> {};

TEST_P(Golden, PositionsAreAsRecorded) {
  const std::string& integrator = GetParam();
  const std::string file = std::string(MUSLIN_SOURCE_DIR) + "/tests/golden/" + integrator + ".txt";
  Simulation simulation(std::make_shared<const Model>(
      build_model(parse_scene(scene, std::string(MUSLIN_SOURCE_DIR) + "/scenes/meshes/golden.toml",
                              {"solver.integrator=" + integrator}))));
  for (int frame = 0; frame < 8; ++frame) simulation.advance();
  const std::vector<Vec3>& x = simulation.state().positions;
  if (std::getenv("MUSLIN_UPDATE_GOLDEN") != nullptr) {
    std::ofstream out(file);
    out << std::setprecision(12) << std::fixed;
    for (const Vec3& p : x) out << p.x() << " " << p.y() << " " << p.z() << "\n";
    FAIL() << "recorded " << file << "; run again without MUSLIN_UPDATE_GOLDEN";
  }
  std::ifstream in(file);
  ASSERT_TRUE(in) << file;
  double farthest = 0;
  for (const Vec3& p : x) {
    Vec3 recorded;
    ASSERT_TRUE(in >> recorded.x() >> recorded.y() >> recorded.z()) << file << " is too short";
    farthest = std::max(farthest, (p - recorded).norm());
  }
  double more;
  EXPECT_FALSE(in >> more) << file << " is too long";
  EXPECT_LT(farthest, 1e-9) << "if this is meant, record anew: see the top of this file";
}

INSTANTIATE_TEST_SUITE_P(Integrators, Golden,
                         testing::Values("implicit_euler", "bdf2", "linearly_implicit_euler",
                                         "symplectic_euler"),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace muslin::test
