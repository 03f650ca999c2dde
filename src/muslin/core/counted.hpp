// Words a count: "1 vertex", "3 vertices".
#pragma once

#include <cstddef>
#include <string>

namespace muslin {

inline std::string counted(std::size_t count, const std::string& one, const std::string& many) {
  std::string text = std::to_string(count);
  text += ' ';
  text += count == 1 ? one : many;
  return text;
}
/// Returns the count with a regular plural: `one` + "s".
inline std::string counted(std::size_t count, const std::string& one) {
  std::string many = one;
  many += 's';
  return counted(count, one, many);
}

}  // namespace muslin
