#include "muslin/io/weld.hpp"

#include <bit>
#include <cstdint>

namespace muslin {
namespace {

std::uint64_t hash(const Vec3& position) {
  std::uint64_t mixed = 0;
  for (int axis = 0; axis < 3; ++axis) {
    mixed ^= std::bit_cast<std::uint64_t>(position[axis] + 0.0);  // −0 + 0 = 0
    mixed *= 0x9E3779B97F4A7C15u;
    mixed ^= mixed >> 29;
  }
  return mixed;
}

}  // namespace

std::size_t Welder::slot(const Vec3& position) const {
  const std::size_t mask = slots_.size() - 1;
  std::size_t at = hash(position) & mask;
  while (slots_[at] >= 0 && positions_[static_cast<std::size_t>(slots_[at])] != position)
    at = (at + 1) & mask;
  return at;
}

int Welder::vertex(const Vec3& position) {
  std::size_t at = slot(position);
  if (slots_[at] >= 0) return slots_[at];
  if (2 * ++used_ > slots_.size()) {
    std::vector<int> old(2 * slots_.size(), -1);
    old.swap(slots_);
    for (const int vertex : old)
      if (vertex >= 0) slots_[slot(positions_[static_cast<std::size_t>(vertex)])] = vertex;
    at = slot(position);
  }
  positions_.push_back(position);
  return slots_[at] = static_cast<int>(positions_.size() - 1);
}

void Welder::start_anew() {
  slots_.assign(64, -1);
  used_ = 0;
}

}  // namespace muslin
