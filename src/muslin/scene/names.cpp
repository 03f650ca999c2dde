#include "muslin/scene/names.hpp"

namespace muslin {

const std::vector<std::string>& integrator_names() {
  static const std::vector<std::string> names = {"implicit_euler", "bdf2", "linearly_implicit_euler",
                                                 "symplectic_euler"};
  return names;
}
const std::vector<std::string>& effort_names() {
  static const std::vector<std::string> names = {"draft", "normal", "exact"};
  return names;
}

}  // namespace muslin
