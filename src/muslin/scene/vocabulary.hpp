// Lists the vocabulary of the scene file: every table and its keys.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace muslin {

struct VocabularyTable {
  std::string name;  ///< such as "body", "pin.where", "force.gravity"; "" is the top of the file
  std::vector<std::string> keys;
};
const std::vector<VocabularyTable>& scene_vocabulary();

/// Returns the keys of one table of scene_vocabulary().
const std::vector<std::string>& known_keys(std::string_view table);

}  // namespace muslin
