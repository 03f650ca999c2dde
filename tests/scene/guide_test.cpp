// docs/guide/scene-file.md agrees with the parser: its examples are read, and its tables are
// those of the schema.
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "muslin/material/material.hpp"
#include "muslin/scene/scene.hpp"
#include "muslin/scene/scene_table.hpp"
#include "muslin/schema/publish.hpp"

namespace muslin {
namespace {

std::string guide() {
  std::ifstream in(std::string(MUSLIN_SOURCE_DIR) + "/docs/guide/scene-file.md");
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

std::vector<std::string> toml_blocks(const std::string& page) {
  std::vector<std::string> blocks;
  const std::string open = "```toml\n", close = "```";
  for (std::size_t at = page.find(open); at != std::string::npos; at = page.find(open, at)) {
    at += open.size();
    const std::size_t end = page.find(close, at);
    blocks.push_back(page.substr(at, end - at));
    at = end;
  }
  return blocks;
}

TEST(Guide, EveryExampleIsRead) {
  const std::string body =
      "[[body]]\nname = 'flag'\nmesh = 'flag.obj'\nvoxel_width = 1\nmaterial = 'thesis_flag'\n";
  const auto blocks = toml_blocks(guide());
  EXPECT_GE(blocks.size(), 7u);
  for (const std::string& block : blocks) {
    SCOPED_TRACE(block);
    if (block.find("[lattice]") != std::string::npos) {
      EXPECT_NO_THROW(parse_material(block, "guide.toml"));
    } else {
      const bool whole = block.find("[[body]]") != std::string::npos;
      EXPECT_NO_THROW(parse_scene(whole ? block : block + body, "guide.toml"));
    }
  }
}

TEST(Guide, TablesMatchTheSchema) {
  const std::string page = guide(), mark = "<!-- schema: ";
  const std::string printed = schema::markdown(scene_table());
  std::size_t blocks = 0;
  for (std::size_t at = printed.find(mark); at != std::string::npos;
       at = printed.find(mark, at + 1), ++blocks) {
    const std::string end = "<!-- end -->\n";
    const std::string block = printed.substr(at, printed.find(end, at) + end.size() - at);
    EXPECT_NE(page.find(block), std::string::npos) << "run tools/write_schema: the guide lacks\n" << block;
  }
  std::size_t marks = 0;
  for (std::size_t at = page.find(mark); at != std::string::npos; at = page.find(mark, at + 1)) ++marks;
  EXPECT_EQ(marks, blocks) << "the guide has a table that the schema has not";
  EXPECT_GT(blocks, 15u);
}

}  // namespace
}  // namespace muslin
