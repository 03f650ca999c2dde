#include "muslin/simulation/diagnostics.hpp"

#include <algorithm>
#include <optional>

namespace muslin {

double max_stretch(const Model& model, ConstVectors x) {
  double largest = model.bodies.empty() ? 1 : 0;
  for (const Component& body : model.bodies) largest = std::max(largest, body.max_stretch(model.of(body, x)));
  return largest;
}

std::vector<LimitedStretch> limited_stretches(const Model& model, const State& state, int frame) {
  std::vector<LimitedStretch> rows;
  for (const Component& body : model.bodies)
    if (const std::optional<double> limit = body.stretch_limit(state.time))
      rows.push_back({frame, body.max_stretch(model.of(body, state.positions)), *limit, body.name});
  return rows;
}

}  // namespace muslin
