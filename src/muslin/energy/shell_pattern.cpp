#include "muslin/energy/shell_pattern.hpp"

#include <utility>
#include <vector>

namespace muslin {

std::shared_ptr<const SymmetricPattern> block_pattern(const Shell& shell) {
  std::vector<std::pair<int, int>> pairs;
  for (const Vec3i& t : shell.triangles) {
    for (int c = 0; c < 3; ++c) pairs.emplace_back(t[c], t[(c + 1) % 3]);
  }
  for (const Hinge& hinge : shell.hinges) pairs.emplace_back(hinge.vertices[2], hinge.vertices[3]);
  return std::make_shared<SymmetricPattern>(std::move(pairs), shell.vertex_count());
}

}  // namespace muslin
