#include "muslin/simulation/untangled.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace muslin {

namespace {

std::string counted(std::size_t count, const char* one, const char* several) {
  return fmt::format("{} {}", count, count == 1 ? one : several);
}

}  // namespace

std::string describe(const Untangled& repair) {
  if (!repair.needed()) return "";
  std::vector<std::string> found;
  if (repair.crossings > 0)
    found.push_back(counted(repair.crossings, "pair of triangles crossed", "pairs of triangles crossed"));
  if (repair.lost > 0)
    found.push_back(counted(repair.lost, "point was on a wrong side", "points were on a wrong side"));
  if (repair.close > 0) {
    found.push_back(counted(repair.close, "place was closer than the thickness",
                            "places were closer than the thickness"));
  }
  std::string text = fmt::format(
      "the start was tangled: {}, up to {:.3g} mm deep; it was pulled apart in {}, by up to {:.3g} mm",
      fmt::join(found, ", "), 1e3 * repair.depth,
      counted(static_cast<std::size_t>(repair.steps), "step", "steps"), 1e3 * repair.moved);
  if (repair.left > 0) {
    text += fmt::format("; {} of each other until they part: {}",
                        counted(repair.left, "pair of triangles still crosses and is free",
                                "pairs of triangles still cross and are free"),
                        fmt::join(repair.places, "; "));
  }
  if (repair.lost_left > 0) {
    text += fmt::format("; {} on a wrong side: look at what pins and colliders leave no room for",
                        counted(repair.lost_left, "point is still", "points are still"));
  }
  return text;
}

}  // namespace muslin
