#include "muslin/simulation/pin_force.hpp"

#include <algorithm>
#include <cstddef>

#include "muslin/constraint/soft_pin.hpp"

namespace muslin {
namespace {

PinForce summed(ConstVectors of_vertices, double most) {
  PinForce force;
  for (const Vec3& f : of_vertices) {
    force.sum += f;
    force.mean += f.norm() / static_cast<double>(of_vertices.size());
    force.largest = std::max(force.largest, f.norm());
  }
  force.most = std::max(most, force.sum.norm());
  return force;
}

}  // namespace

void update_pin_forces(std::span<const Pin> pins, double time_begin, double time_end, ConstVectors reactions,
                       const History& history, std::vector<PinForce>& forces) {
  forces.resize(pins.size());
  std::vector<int> owner(reactions.size(), -1);  // of the held vertices
  for (std::size_t p = 0; p < pins.size(); ++p) {
    if (pins[p].is_soft() || !pins[p].acts(time_begin, time_end)) continue;
    for (const int v : pins[p].vertices) owner[static_cast<std::size_t>(v)] = static_cast<int>(p);
  }
  for (std::size_t p = 0; p < pins.size(); ++p) {
    std::vector<Vec3> of_vertices;
    if (pins[p].is_soft() && pins[p].acts(time_begin, time_end))
      of_vertices = SoftPin::forces(pins[p], history);
    for (const int v : pins[p].vertices)
      if (owner[static_cast<std::size_t>(v)] == static_cast<int>(p))
        of_vertices.push_back(reactions[static_cast<std::size_t>(v)]);
    forces[p] = summed(of_vertices, forces[p].most);
  }
}

}  // namespace muslin
