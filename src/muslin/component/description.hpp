// Writes what descriptions of components in JSON share.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "muslin/component/component.hpp"

namespace muslin {

/// Appends `vertices`, `voxels`, `tetrahedra`, `springs`, `mass` and `coverage`.
void append_counts(nlohmann::ordered_json& json, const BodyStatistics& statistics);

/// Appends `stable_step`; null if it is infinite.
void append_stable_step(nlohmann::ordered_json& json, const BodyStatistics& statistics);

/// Returns the JSON on one line. Bytes that are no UTF-8 become U+FFFD.
std::string to_line(const nlohmann::ordered_json& json);

}  // namespace muslin
