#include "muslin/material/estimates.hpp"

#include <algorithm>

#include "muslin/core/nearest_name.hpp"

namespace muslin {
namespace {

/// The numbers of both tables of the file, with the name of their table.
std::vector<std::string> numbers_of(const TomlValue& file) {
  std::vector<std::string> names;
  for (const char* table : {"lattice", "shell"}) {
    const TomlValue* numbers = file.find(table);
    if (numbers == nullptr) continue;
    for (const std::string& key : numbers->keys) names.push_back(std::string(table) + "." + key);
  }
  return names;
}

}  // namespace

std::vector<std::string> estimated_numbers(const TomlValue& file) {
  const TomlValue* list = file.find("estimated");
  if (list == nullptr) return {};
  if (list->type != TomlValue::Type::array)
    throw Error(ErrorKind::input, list->place, "`estimated` is not a list",
                "write the names of numbers, such as [\"shell.bending_warp\"]");
  const std::vector<std::string> known = numbers_of(file);
  std::vector<std::string> names;
  for (const TomlValue& name : list->items) {
    if (std::find(known.begin(), known.end(), name.string) == known.end())
      throw Error(ErrorKind::input, name.place, "`" + name.string + "` is no number of this material file",
                  name_advice(name.string, known));
    names.push_back(name.string);
  }
  return names;
}

}  // namespace muslin
