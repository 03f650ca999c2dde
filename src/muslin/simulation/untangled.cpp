#include "muslin/simulation/untangled.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace muslin {

std::string describe(const Untangled& repair) {
  if (!repair.needed()) return "";
  std::vector<std::string> found;
  if (repair.crossings > 0) found.push_back(fmt::format("{} pairs of triangles crossed", repair.crossings));
  if (repair.lost > 0) found.push_back(fmt::format("{} points were on a wrong side", repair.lost));
  if (repair.close > 0)
    found.push_back(fmt::format("{} places were closer than the thickness", repair.close));
  std::string text = fmt::format(
      "the start was tangled: {}, up to {:.3g} mm deep; it was pulled apart in {} steps, by up to {:.3g} mm",
      fmt::join(found, ", "), 1e3 * repair.depth, repair.steps, 1e3 * repair.moved);
  if (repair.left > 0) {
    text += fmt::format("; {} pairs of triangles still cross and are free of each other until they part: {}",
                        repair.left, fmt::join(repair.places, "; "));
  }
  return text;
}

}  // namespace muslin
