// The folders of src/muslin/ include downward only.
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

namespace {

const std::map<std::string, int> ranks = {
    {"core", 0},       {"topology", 1}, {"schema", 1},     {"geometry", 2}, {"potential", 2}, {"field", 3},
    {"io", 3},         {"lattice", 4},  {"shell", 4},      {"material", 5}, {"energy", 5},    {"force", 5},
    {"constraint", 5}, {"contact", 5},  {"surface", 5},    {"solver", 5},   {"component", 6}, {"post", 6},
    {"untangle", 6},   {"scene", 7},    {"simulation", 8}, {"fit", 9},      {"cache", 9},     {"render", 9},
    {"picture", 10},   {"view", 10},    {"report", 11},
};

bool allowed(const std::string& from, const std::string& to) {
  if (from == to || ranks.at(to) < ranks.at(from)) return true;
  return to == "energy" && from == "material";
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

std::string text_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

std::set<std::string> matches(const std::string& text, const std::string& pattern) {
  const std::regex expression(pattern);
  std::set<std::string> found;
  for (std::sregex_iterator at(text.begin(), text.end(), expression), end; at != end; ++at)
    found.insert((*at)[1]);
  return found;
}

void include_all(const std::filesystem::path& root, const std::string& header, std::set<std::string>& seen) {
  if (!seen.insert(header).second) return;
  for (const std::string& next : matches(text_of(root / header), "#include \"muslin/([^\"]+)\""))
    include_all(root, next, seen);
}

TEST(Package, PublicHeadersAreThoseThatTheFacadeIncludes) {
  const auto root = std::filesystem::path(MUSLIN_SOURCE_DIR) / "src" / "muslin";
  std::set<std::string> included;
  include_all(root, "muslin.hpp", included);
  EXPECT_EQ(included, matches(text_of(root / "public_headers.cmake"), "([a-z_/]+\\.hpp)[\n)]"))
      << "list them in src/muslin/public_headers.cmake";
}

TEST(Package, PublicHeadersNeedOnlyEigen) {
  const auto root = std::filesystem::path(MUSLIN_SOURCE_DIR) / "src" / "muslin";
  std::set<std::string> included;
  include_all(root, "muslin.hpp", included);
  for (const std::string& header : included)
    for (const std::string& other : matches(text_of(root / header), "#include <([A-Za-z0-9_+]+/)"))
      EXPECT_EQ(other, "Eigen/") << header;
}

TEST(Package, EverySourceIncludesItsOwnHeaderFirst) {
  namespace fs = std::filesystem;
  const fs::path root = fs::path(MUSLIN_SOURCE_DIR) / "src";
  const std::regex first("#include +[<\"]([^>\"]+)");
  int sources = 0;
  for (const auto& entry : fs::recursive_directory_iterator(root / "muslin")) {
    if (entry.path().extension() != ".cpp") continue;
    const fs::path own = fs::path(entry.path()).replace_extension(".hpp");
    if (!fs::exists(own)) continue;
    ++sources;
    const std::string text = text_of(entry.path());
    std::smatch match;
    ASSERT_TRUE(std::regex_search(text, match, first)) << entry.path();
    EXPECT_EQ(match[1].str(), fs::relative(own, root).string()) << entry.path();
  }
  EXPECT_GT(sources, 100);
}

}  // namespace
