// Damaged files: every outcome is a mesh that can be used, or an Error; never a crash, a hang or a flood.
#include <functional>
#include <random>

#include "io/fixtures.hpp"
#include <gtest/gtest.h>

#include "muslin/core/error.hpp"
#include "muslin/geometry/inspect.hpp"
#include "muslin/io/mesh_file.hpp"

namespace muslin {
namespace {

struct Fixture {
  const char* name;
  const char* suffix;
  std::string (*bytes)();
  int mutations;
};

std::string mutated(std::string bytes, std::mt19937& random) {
  const auto below = [&](std::size_t bound) { return bound == 0 ? 0 : random() % bound; };
  static const char* const words[] = {"nan",
                                      "-1",
                                      "1e30",
                                      "4294967295",
                                      "-2147483648",
                                      "0",
                                      "99999999999999999999",
                                      "\n",
                                      "\xff\xff\xff\xff",
                                      "\\\n",
                                      "\"",
                                      "[",
                                      "#",
                                      " "};
  for (std::size_t edits = 1 + below(3); edits > 0 && !bytes.empty(); --edits) {
    const std::size_t at = below(bytes.size());
    switch (below(6)) {
      case 0:
        bytes[at] = static_cast<char>(random());
        break;
      case 1:
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
        break;
      case 2:
        bytes.erase(at, 1 + below(8));
        break;
      case 3:
        bytes.insert(at, words[below(std::size(words))]);
        break;
      case 4:
        bytes.resize(at);
        break;
      case 5:
        bytes.insert(below(bytes.size()), bytes.substr(at, below(40)));
        break;
    }
  }
  return bytes;
}

class Mutations : public testing::TestWithParam<Fixture> {};

TEST_P(Mutations, GiveAMeshOrAnError) {
  const Fixture& fixture = GetParam();
  const std::string whole = fixture.bytes();
  std::mt19937 random(20260);
  int accepted = 0, refused = 0;
  for (int round = 0; round < fixture.mutations; ++round) {
    const std::string bytes = mutated(whole, random);
    try {
      const MeshFile file = read_mesh_from(bytes, fixture.suffix, "damaged");
      EXPECT_NO_THROW(require_usable(file.mesh, "damaged"));
      inspect(file.mesh);
      ++accepted;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input);
      EXPECT_FALSE(error.remedy().empty());
      ++refused;
    }
  }
  EXPECT_GT(accepted, fixture.mutations / 200);
  EXPECT_GT(refused, fixture.mutations / 20);
}

TEST_P(Mutations, EveryTruncationIsHandled) {
  const Fixture& fixture = GetParam();
  const std::string whole = fixture.bytes();
  const std::size_t step = fixture.mutations < 1000 ? 37 : 1;
  for (std::size_t size = 0; size < whole.size(); size += step) {
    try {
      read_mesh_from(std::string_view(whole).substr(0, size), fixture.suffix, "cut");
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Formats, Mutations,
    testing::Values(
        Fixture{"obj", ".obj", fixtures::obj, 5000}, Fixture{"ply", ".ply", fixtures::ply_ascii, 5000},
        Fixture{"ply_little", ".ply", [] { return fixtures::ply_binary(false); }, 5000},
        Fixture{"ply_big", ".ply", [] { return fixtures::ply_binary(true); }, 5000},
        Fixture{"stl", ".stl", fixtures::stl_ascii, 5000},
        Fixture{"stl_binary", ".stl", fixtures::stl_binary, 5000},
        Fixture{"gltf", ".gltf", fixtures::gltf, 3000}, Fixture{"glb", ".glb", fixtures::glb, 3000},
        Fixture{"collada", ".dae", fixtures::collada, 500}, Fixture{"fbx", ".fbx", fixtures::fbx, 500}),
    [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace muslin
