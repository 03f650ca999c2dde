#include "muslin/schema/variation.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace muslin::schema {

double Variation::at_weight(double weight) const {
  double share = weight;
  if (!curve.empty()) {
    const auto next = std::find_if(curve.begin(), curve.end(), [&](const Vec2& p) { return p[0] > weight; });
    share = next == curve.end() ? curve.back()[1] : (*next)[1];
    if (next != curve.begin() && next != curve.end()) {
      const Vec2& last = *std::prev(next);
      share = last[1] + (weight - last[0]) / ((*next)[0] - last[0]) * ((*next)[1] - last[1]);
    }
  }
  return from + share * (to - from);
}

double Variation::nominal() const { return is_map() ? from + 0.5 * (to - from) : keyframes.front().value; }

const Variation* find_variation(const Variations& variations, std::string_view key) {
  const auto at =
      std::find_if(variations.begin(), variations.end(), [&](const Variation& v) { return v.key == key; });
  return at != variations.end() ? &*at : nullptr;
}

void forget_variation(Variations& variations, std::string_view key) {
  std::erase_if(variations, [&](const Variation& v) { return v.key == key; });
}

void copy_variation(Variations& variations, std::string_view model, const std::string& key) {
  forget_variation(variations, key);
  const Variation* found = find_variation(variations, model);
  if (found == nullptr) return;
  Variation copy = *found;
  copy.key = key;
  variations.push_back(std::move(copy));
}

}  // namespace muslin::schema
