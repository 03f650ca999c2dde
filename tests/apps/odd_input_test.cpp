// Meshes and scenes of the clumsy and of the hostile: a result or an Error, never a crash, a hang or NaN.
#include <cmath>
#include <cstring>

#include "apps/program.hpp"
#include <fmt/format.h>
#include <gmock/gmock.h>

namespace muslin {
namespace {

namespace fs = std::filesystem;
using test::bytes_of;
using test::Outcome;
using test::run;
using test::Scratch;
using test::two_corners;
using testing::HasSubstr;

using Points = std::vector<std::array<double, 3>>;
using Faces = std::vector<std::vector<int>>;

const Points corners = {{0, 0, 0}, {0, 0, 1}, {0, 1, 0}, {0, 1, 1},
                        {1, 0, 0}, {1, 0, 1}, {1, 1, 0}, {1, 1, 1}};
const Faces sides = {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}};

Points moved(Points points, double scale, double offset) {
  for (auto& p : points)
    for (double& x : p) x = scale * x + offset;
  return points;
}

struct OddMesh {
  const char* name;
  Points points;
  Faces faces;
};

OddMesh mobius() {
  OddMesh mesh{"Möbius strip", {}, {}};
  const int n = 40;
  for (int i = 0; i < n; ++i) {
    const double a = 2 * M_PI * i / n;
    for (double s : {-0.3, 0.3})
      mesh.points.push_back({(1 + s * std::cos(a / 2)) * std::cos(a), (1 + s * std::cos(a / 2)) * std::sin(a),
                             s * std::sin(a / 2)});
  }
  for (int i = 0; i + 1 < n; ++i) mesh.faces.push_back({2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1});
  mesh.faces.push_back({2 * n - 2, 1, 0, 2 * n - 1});
  return mesh;
}

std::vector<OddMesh> odd_meshes() {
  std::vector<OddMesh> meshes = {
      {"a triangle", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}},
      {"three sheets at an edge",
       {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, -1, 0.3}},
       {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}}},
      {"flipped faces", corners, {{2, 3, 1, 0}, sides[1], sides[2], {6, 7, 3, 2}, sides[4], sides[5]}},
      {"faces without area", corners, sides},
      {"far away", moved(corners, 1, 1e8), sides},
      {"tiny in its voxel", moved(corners, 1e-6, 0), sides},
      {"no bottom", corners, {sides.begin(), sides.end() - 1}},
      {"corners of their own", {}, {}},
      {"two boxes through each other", corners, sides},
      {"a needle", {{0, 0, 0}, {100, 1e-9, 0}, {0, 1e-9, 0}}, {{0, 1, 2}}},
      mobius(),
  };
  meshes[3].faces.push_back({0, 0, 1});
  meshes[3].faces.push_back({3, 3, 3});
  for (const auto& side : sides) {
    Faces::value_type face;
    for (int corner : side) {
      face.push_back(static_cast<int>(meshes[7].points.size()));
      meshes[7].points.push_back(corners[static_cast<std::size_t>(corner)]);
    }
    meshes[7].faces.push_back(face);
  }
  for (const auto& p : moved(corners, 1, 0.5)) meshes[8].points.push_back(p);
  for (auto side : sides) {
    for (int& corner : side) corner += 8;
    meshes[8].faces.push_back(side);
  }
  return meshes;
}

std::string obj(const OddMesh& mesh) {
  std::string text;
  for (const auto& p : mesh.points) text += fmt::format("v {} {} {}\n", p[0], p[1], p[2]);
  for (const auto& face : mesh.faces) {
    text += "f";
    for (int v : face) text += fmt::format(" {}", v + 1);
    text += "\n";
  }
  return text;
}

void expect_finite_run(const fs::path& directory) {
  int caches = 0;
  for (const auto& entry : fs::directory_iterator(directory)) {
    if (entry.path().extension() != ".pc2") continue;
    ++caches;
    const std::string bytes = bytes_of(entry.path());
    for (std::size_t at = 32; at + 4 <= bytes.size(); at += 4) {
      float x = 0;
      std::memcpy(&x, bytes.data() + at, 4);
      ASSERT_TRUE(std::isfinite(x)) << entry.path() << " at " << at;
    }
  }
  EXPECT_EQ(caches, 3);
  EXPECT_THAT(bytes_of(directory / "diagnostics.csv"), testing::Not(HasSubstr("nan")));
}

TEST(OddInput, AnyMeshRuns) {
  Scratch scratch;
  for (const OddMesh& mesh : odd_meshes()) {
    SCOPED_TRACE(mesh.name);
    test::write_bytes(scratch / "odd.obj", obj(mesh));
    test::write_scene(scratch / "odd.toml", "odd.obj", "voxel_width = 0.5\nmaterial = \"cotton\"\n",
                      "[[pin]]\nwhere = { nearest = [0, 0, 0] }\n[[force]]\ntype = \"gravity\"\n"
                      "[[force]]\ntype = \"wind\"\nvelocity = [3, 0, 1]\n");
    const Outcome outcome =
        run(scratch, {"run", scratch / "odd.toml", "-o", scratch / "run", "--frames", "1", "--quiet"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    expect_finite_run(scratch / "run");
  }
}

TEST(OddInput, AbsurdNumbersEndInAResultOrAnError) {
  Scratch scratch;
  struct Case {
    std::vector<const char*> settings;
    int code;
    const char* message;
  };
  const std::vector<Case> cases = {
      {{"body.flag.voxel_width=1e-4"}, 3, "voxel"},
      {{"body.flag.voxel_width=0.005"}, 3, "of memory"},
      {{"body.flag.voxel_width=1e300"}, 3, "1e-06 to"},
      {{"body.flag.name=\"../x\""}, 3, "cannot be a name"},
      {{"body.flag.name=\"ü ñ 旗\""}, 0, ""},
      {{"body.flag.velocity=[1e9,0,0]"}, 0, ""},
      {{"body.flag.velocity=[1e200,0,0]"}, 3, "give numbers from -100000000000 to 100000000000 [m/s]"},
      {{"body.flag.translate=[1e9,0,0]"}, 3, "beyond 1e9 m"},
      {{"body.flag.thickness=1e-12"}, 0, ""},
      {{"body.flag.thickness=1e200"}, 3, "`thickness`"},
      {{"force.0.acceleration=[0,1e9,0]"}, 0, ""},
      {{"force.0.acceleration=[0,1e11,0]", "time.frame_rate=0.01", "time.steps_per_frame=1",
        "body.flag.material={density=40,edge_modulus=1e-3}", "solver.integrator=linearly_implicit_euler"},
       4,
       "farther"},
      {{"force.0={type=\"wind\",velocity=[1e6,0,0]}"}, 0, ""},
      {{"body.flag.material={base=\"thesis_flag\",density=1e-30}"}, 0, ""},
      {{"body.flag.material={base=\"thesis_flag\",edge_modulus=1e30}"}, 3, "edge_modulus"},
      {{"body.flag.material={base=\"thesis_flag\",edge_modulus=-1}"}, 3, "edge_modulus"},
      {{"body.flag.material={base=\"thesis_flag\",density=0}"}, 3, "density"},
      {{"body.flag.material.density=3"}, 3, "material={"},
      {{"pin=[{where={box=[[-99,-99,-99],[99,99,99]]}}]"}, 0, ""},
  };
  for (const Case& each : cases) {
    std::vector<std::string> words = {"run", two_corners, "-o", scratch / "run", "--frames", "1", "--quiet"};
    for (const char* setting : each.settings) words.insert(words.end(), {"--set", setting});
    SCOPED_TRACE(each.settings[0]);
    fs::remove_all(scratch / "run");
    const Outcome outcome = run(scratch, words);
    EXPECT_EQ(outcome.code, each.code) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(each.message));
    if (outcome.code == 0 || outcome.code == 4) expect_finite_run(scratch / "run");
  }
}

TEST(OddInput, AbsurdClothAndCollidersEndInAResultOrAnError) {
  Scratch scratch;
  test::write_bytes(scratch / "sheet.obj",
                    "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nv 0.5 0 0.5\n"
                    "f 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n");
  test::write_bytes(
      scratch / "odd.toml",
      "[[body]]\nname = \"cloth\"\nmesh = \"sheet.obj\"\nmodel = \"shell\"\n"
      "material = { areal_density = 0.2, membrane_warp = 500, bending_warp = 1e-4 }\n"
      "[[collider]]\nname = \"ball\"\nshape = \"sphere\"\ncenter = [0.5, -0.21, 0.5]\nradius = 0.2\n"
      "keyframes = [{ time = 0 }, { time = 0.04, translate = [0, 0.05, 0] }]\n"
      "[[collider]]\nname = \"box\"\nshape = \"box\"\nsize = [0.1, 0.1, 0.1]\ncenter = [0.5, 1, 0.5]\n"
      "density = 500\n[[force]]\ntype = \"gravity\"\n");
  struct Case {
    const char* setting;
    int code;
    const char* message;
  };
  const std::vector<Case> cases = {
      {"body.cloth.thickness=1e200", 3, "`thickness` of [[body]] cloth is 1e+200"},
      {"body.cloth.thickness=1e9", 3, "are closer to each other than their thickness allows"},
      {"body.cloth.thickness=0", 0, ""},
      {"body.cloth.warp=[1e9,0,0]", 0, ""},
      {"body.cloth.warp=[1e300,0,0]", 3, "`warp`"},
      {"body.cloth.velocity=[1e300,0,0]", 3, "`velocity`"},
      {"body.cloth.material.membrane_warp=0", 0, "does not resist shear"},
      {"body.cloth.material.membrane_weft=0", 0, ""},
      {"collider.ball.keyframes.1.translate=[0,1e300,0]", 3, "y of `translate` of a keyframe"},
      {"collider.ball.keyframes.1.translate=[0,1e9,0]", 0, ""},
      {"collider.box.velocity=[1e300,0,0]", 3, "`velocity`"},
      {"collider.box.velocity=[0,1e9,0]", 0, ""},
      {"collider.box.angular_velocity=[1e300,0,0]", 3, "`angular_velocity`"},
      {"collider.box.angular_velocity=[1e11,0,0]", 0, ""},
  };
  for (const Case& each : cases) {
    SCOPED_TRACE(each.setting);
    fs::remove_all(scratch / "run");
    const Outcome outcome = run(scratch, {"run", scratch / "odd.toml", "-o", scratch / "run", "--frames", "2",
                                          "--quiet", "--set", each.setting});
    EXPECT_EQ(outcome.code, each.code) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(each.message));
    if (outcome.code != 0) continue;
    EXPECT_THAT(bytes_of(scratch / "run" / "diagnostics.csv"), testing::Not(HasSubstr("nan")));
  }
}

}  // namespace
}  // namespace muslin
