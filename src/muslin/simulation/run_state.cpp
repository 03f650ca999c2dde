#include "muslin/simulation/run_state.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "muslin/core/error.hpp"
#include "muslin/core/hash.hpp"

namespace muslin {

std::vector<PinKey> pin_keys(std::span<const Pin> pins) {
  std::vector<PinKey> keys;
  for (const Pin& pin : pins) {
    std::uint64_t hash = hash_bytes(pin.name.data(), pin.name.size());
    hash = hash_bytes(pin.vertices.data(), pin.vertices.size() * sizeof(int), hash);
    keys.push_back({hash_bytes(&pin.from, sizeof pin.from, hash), pin.vertices.size()});
  }
  return keys;
}

std::vector<std::uint8_t> to_checkpoint(const CheckpointHeader& header, const RunState& state) {
  CheckpointWriter out(header);
  RunState::name_arrays(state, out);
  return std::move(out).finish();
}

RunState from_checkpoint(std::span<const std::uint8_t> bytes, std::size_t vertices) {
  CheckpointReader in(bytes);
  RunState state;
  RunState::name_arrays(state, in);
  in.finish();
  const State& motion = state.motion;
  const auto fits = [vertices](const std::vector<Vec3>& vectors) {
    return vectors.size() == vertices || vectors.empty();
  };
  if (motion.positions.size() != vertices || motion.velocities.size() != vertices ||
      !fits(motion.previous_positions) || !fits(motion.previous_velocities)) {
    throw Error(ErrorKind::input, "the checkpoint has another number of vertices", "restart the run");
  }
  return state;
}

void go_on_with(std::span<const Pin> pins, RunState& state) {
  const std::vector<PinKey> earlier_pins = std::exchange(state.pins, pin_keys(pins));
  const Holds earlier = std::exchange(state.holds, {});
  const std::vector<PinForce> earlier_forces = std::exchange(state.pin_forces, {});
  if (earlier.holding.size() != earlier_pins.size()) return;
  for (const PinKey& key : state.pins) {
    std::vector<Vec3> anchors(key.vertices, Vec3::Zero());
    std::uint8_t holding = 0;
    PinForce force;
    std::size_t first = 0;
    for (std::size_t p = 0; p < earlier_pins.size(); ++p) {
      if (earlier_pins[p] == key && first + key.vertices <= earlier.anchors.size()) {
        holding = earlier.holding[p];
        if (p < earlier_forces.size()) force = earlier_forces[p];
        std::copy_n(earlier.anchors.begin() + static_cast<std::ptrdiff_t>(first), key.vertices,
                    anchors.begin());
        break;
      }
      first += earlier_pins[p].vertices;
    }
    state.holds.holding.push_back(holding);
    state.pin_forces.push_back(force);
    state.holds.anchors.insert(state.holds.anchors.end(), anchors.begin(), anchors.end());
  }
}

}  // namespace muslin
