#include "muslin/energy/law.hpp"

#include <algorithm>

namespace muslin {

LaneArray::LaneArray(std::vector<double> values) : values_(std::move(values)) {
  // The last batch's worth pads the array.
  const auto end = values_.end() - std::min<std::ptrdiff_t>(element_lanes, std::ssize(values_));
  uniform_ = std::all_of(values_.begin(), end, [&](double value) { return value == values_.front(); });
  if (!uniform_ || values_.empty()) return;
  values_.assign(element_lanes, values_.front());
  values_.shrink_to_fit();
}

}  // namespace muslin
