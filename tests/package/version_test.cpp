// The version is the same wherever it is written.
#include <fstream>
#include <regex>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

namespace {

std::string found_in(const std::string& file, const std::string& pattern) {
  std::ifstream in(std::string(MUSLIN_SOURCE_DIR) + "/" + file);
  std::stringstream text;
  text << in.rdbuf();
  const std::string whole = text.str();
  std::smatch match;
  return std::regex_search(whole, match, std::regex(pattern)) ? match[1].str() : file + ": not found";
}

TEST(Version, CitationHasThatOfTheProject) {
  EXPECT_EQ(found_in("CITATION.cff", "\nversion: ([0-9.]+)\n"),
            found_in("CMakeLists.txt", "project\\(muslin VERSION ([0-9.]+)"));
}

}  // namespace
