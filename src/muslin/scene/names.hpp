// Lists the words of the scene file for each enumeration, in the enumeration's order.
#pragma once

#include <string>
#include <vector>

namespace muslin {

const std::vector<std::string>& integrator_names();  ///< Integrator
const std::vector<std::string>& effort_names();      ///< Effort

template <class Enumeration>
const std::string& name_of(const std::vector<std::string>& names, Enumeration value) {
  return names[static_cast<std::size_t>(value)];
}

}  // namespace muslin
