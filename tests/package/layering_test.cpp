// The folders of src/muslin/ include downward only.
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <string>

#include <gtest/gtest.h>

namespace {

const std::map<std::string, int> ranks = {
    {"core", 0},       {"geometry", 1}, {"potential", 1}, {"field", 2},   {"io", 2},
    {"lattice", 3},    {"shell", 3},    {"material", 4},  {"energy", 4},  {"force", 4},
    {"constraint", 4}, {"contact", 4},  {"surface", 4},   {"solver", 4},  {"scene", 5},
    {"simulation", 6}, {"cache", 7},    {"render", 7},    {"picture", 8}, {"view", 8},
};

bool allowed(const std::string& from, const std::string& to) {
  if (from == to || ranks.at(to) < ranks.at(from)) return true;
  return to == "material" && (from == "energy" || from == "force");
}

TEST(Layering, FoldersIncludeOnlyLowerFolders) {
  namespace fs = std::filesystem;
  const fs::path root = fs::path(MUSLIN_SOURCE_DIR) / "src" / "muslin";
  const std::regex include("^\\s*#include \"muslin/([a-z_]+)/.*");
  int files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(root)) {
    if (entry.path().extension() != ".hpp" && entry.path().extension() != ".cpp") continue;
    const std::string folder = fs::relative(entry.path(), root).begin()->string();
    if (entry.path().parent_path() == root) continue;  // muslin.hpp, the façade
    ASSERT_TRUE(ranks.contains(folder))
        << folder << " has no rank: add it to this test and to docs/design.md";
    ++files;
    std::ifstream in(entry.path());
    std::string line;
    for (int number = 1; std::getline(in, line); ++number) {
      std::smatch match;
      if (!std::regex_match(line, match, include)) continue;
      ASSERT_TRUE(ranks.contains(match[1])) << entry.path() << ":" << number;
      EXPECT_TRUE(allowed(folder, match[1])) << entry.path() << ":" << number << ": " << line;
    }
  }
  EXPECT_GT(files, 10);
}

}  // namespace
