// A reader in a process of its own: results and errors come back, crashes and endless loops become failures.
#include "muslin/io/isolated.hpp"

#include <csignal>
#include <string>

#include "io/fixtures.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "muslin/core/error.hpp"
#include "muslin/io/mesh_bytes.hpp"
#include "muslin/io/mesh_file.hpp"

namespace muslin {
namespace {

using testing::HasSubstr;

std::string failure(const std::function<std::string()>& work, const IsolationLimits& limits = {}) {
  try {
    run_isolated(work, limits);
  } catch (const IsolatedFailure& failed) {
    return failed.what();
  }
  return "no failure";
}

TEST(Isolated, ReturnsBytesOfAnyLength) {
  EXPECT_EQ(run_isolated([] { return std::string(); }), "");
  const std::string large = std::string(3'000'000, 'x') + std::string("\0y", 2);
  EXPECT_EQ(run_isolated([&] { return large; }), large);
}

TEST(Isolated, PassesErrorsOn) {
  try {
    run_isolated([]() -> std::string {
      throw Error(ErrorKind::input, Place{"a.dae"}, "it is bent", "straighten it");
    });
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    EXPECT_STREQ(error.what(), "a.dae: it is bent; straighten it");
  }
}

TEST(Isolated, SurvivesCrashesAndEndlessLoops) {
  EXPECT_THAT(failure([]() -> std::string {
                std::raise(SIGSEGV);
                return "";
              }),
              HasSubstr("it crashed"));
  EXPECT_THAT(failure(
                  []() -> std::string {
                    volatile int turns = 0;
                    for (;;) turns = turns + 1;
                  },
                  {1, 1e9}),
              HasSubstr("it took too long"));
}

TEST(Isolated, MeshesComeBackAsTheyWere) {
  MeshFile file = read_mesh_from(fixtures::obj(), ".obj", "a.obj");
  file.note = "a note";
  file.attributes = {{"paint", {0.5, 1}}};
  file.mesh.materials = {{"Blue Cotton", {0}}};
  const MeshFile back = from_bytes(to_bytes(file));
  EXPECT_EQ(back.mesh.positions, file.mesh.positions);
  EXPECT_EQ(back.mesh.uvs, file.mesh.uvs);
  EXPECT_EQ(back.mesh.corner_uvs, file.mesh.corner_uvs);
  EXPECT_EQ(back.mesh.face_vertices, file.mesh.face_vertices);
  EXPECT_EQ(back.mesh.groups.size(), file.mesh.groups.size());
  ASSERT_EQ(back.mesh.materials.size(), 1u);
  EXPECT_EQ(back.mesh.materials[0].name, "Blue Cotton");
  EXPECT_EQ(back.mesh.materials[0].faces, std::vector<int>{0});
  EXPECT_EQ(back.note, file.note);
  EXPECT_EQ(back.attributes[0].values, file.attributes[0].values);
  const std::string bytes = to_bytes(file);
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_THROW(from_bytes(std::string_view(bytes).substr(0, size)), Error) << size;
}

}  // namespace
}  // namespace muslin
