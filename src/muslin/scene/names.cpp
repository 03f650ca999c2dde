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
const std::vector<std::string>& body_model_names() {
  static const std::vector<std::string> names = {"lattice", "shell", "rigid", "sequence"};
  return names;
}
const std::vector<std::string>& collider_shape_names() {
  static const std::vector<std::string> names = {"plane", "sphere", "capsule", "box", "mesh"};
  return names;
}
const std::vector<std::string>& voxel_rule_names() {
  static const std::vector<std::string> names = {"cover", "threshold"};
  return names;
}
const std::vector<std::string>& bracing_names() {
  static const std::vector<std::string> names = {"kuhn", "full"};
  return names;
}
const std::vector<std::string>& mass_names() {
  static const std::vector<std::string> names = {"solid", "cells"};
  return names;
}
const std::vector<std::string>& boundary_spring_names() {
  static const std::vector<std::string> names = {"full", "shared"};
  return names;
}
const std::vector<std::string>& force_type_names() {
  static const std::vector<std::string> names = {"gravity", "point", "wind"};
  return names;
}
const std::vector<std::string>& force_value_names() {
  static const std::vector<std::string> names = {"acceleration", "force", "velocity"};
  return names;
}

}  // namespace muslin
