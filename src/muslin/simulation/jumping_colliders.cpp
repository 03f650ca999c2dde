#include "muslin/simulation/jumping_colliders.hpp"

#include <algorithm>

#include "muslin/scene/build_contact.hpp"

namespace muslin {
namespace {

Vec3 mean(ConstVectors all) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& v : all) sum += v;
  return sum / static_cast<double>(std::max<std::size_t>(all.size(), 1));
}

}  // namespace

std::vector<const Prescribed*> jumping_colliders(const Model& model, const State& state, double length) {
  std::vector<const Prescribed*> jumping;
  std::vector<Vec3> target;
  for (const Prescribed& motion : model.prescribed) {
    if (!motion.moves()) continue;
    target.resize(motion.start.size());
    motion.positions(state.time + length, target);
    const auto first = static_cast<std::size_t>(motion.first);
    const Vec3 velocity =
        (mean(target) - mean(ConstVectors(state.positions).subspan(first, target.size()))) / length;
    if (!(velocity.norm() > jump_speed)) continue;
    const bool is_fast = std::all_of(model.bodies.begin(), model.bodies.end(), [&](const Component& body) {
      return body.is_prescribed() || (velocity - mean(model.of(body, state.velocities))).norm() > jump_speed;
    });
    if (is_fast) jumping.push_back(&motion);
  }
  return jumping;
}

}  // namespace muslin
