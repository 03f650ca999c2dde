#include "muslin/component/description.hpp"

#include <cmath>

#include <nlohmann/json.hpp>

namespace muslin {

void append_counts(nlohmann::ordered_json& json, const BodyStatistics& s) {
  json["vertices"] = s.vertices;
  json["voxels"] = s.voxels;
  json["tetrahedra"] = s.tetrahedra;
  json["springs"] = {
      {"edge", s.springs[0]}, {"face_diagonal", s.springs[1]}, {"body_diagonal", s.springs[2]}};
  json["mass"] = s.mass;
  json["coverage"] = s.coverage;
}

void append_stable_step(nlohmann::ordered_json& json, const BodyStatistics& s) {
  json["stable_step"] =
      std::isfinite(s.stable_step) ? nlohmann::ordered_json(s.stable_step) : nlohmann::ordered_json(nullptr);
}

std::string to_line(const nlohmann::ordered_json& json) {
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace muslin
