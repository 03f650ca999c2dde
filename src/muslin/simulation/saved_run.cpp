#include "muslin/simulation/saved_run.hpp"

#include <algorithm>
#include <utility>

#include "muslin/core/error.hpp"

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

std::vector<std::uint8_t> to_bytes(const SavedRun& saved) {
  ByteWriter out(saved.header);
  out.values(saved.state.positions);
  out.values(saved.state.velocities);
  out.values(saved.state.previous_positions);
  out.values(saved.state.previous_velocities);
  out.value(saved.state.previous_dt);
  out.value(saved.state.time);
  out.value(saved.state.step);

  out.values(saved.pins);
  out.values(saved.holds.holding);
  out.values(saved.holds.anchors);

  const Tally& tally = saved.tally;
  out.value(tally.work);
  out.value(tally.dissipated);
  out.value(tally.unbalanced);
  out.values(saved.terms);
  out.values(tally.stored);
  out.value(tally.newton);
  out.value(tally.linear);
  out.value(tally.residual);
  out.value(tally.pressed);
  out.value(tally.smallest_gap);
  out.value(tally.held_back);

  out.values(saved.contact.slips);
  out.values(saved.contact.begin);
  out.values(saved.contact.end);
  out.value(saved.contact.margin);
  out.value(saved.contact.smallest_gap);

  const Diagnostics& row = saved.diagnostics;
  for (double number :
       {row.kinetic, row.elastic, row.potential, row.work, row.dissipated, row.unbalanced, row.momentum.x(),
        row.momentum.y(), row.momentum.z(), row.residual, row.max_stretch, row.min_distance, row.time})
    out.value(number);
  out.value(row.newton_iterations);
  out.value(row.linear_iterations);
  out.value(row.held_back);
  return std::move(out).finish();
}

SavedRun saved_run(std::span<const std::uint8_t> bytes, std::size_t vertices) {
  SavedRun saved;
  saved.header = read_checkpoint_header(bytes);
  ByteReader in(bytes);
  State& state = saved.state;
  state.positions = in.values<Vec3>();
  state.velocities = in.values<Vec3>();
  state.previous_positions = in.values<Vec3>();
  state.previous_velocities = in.values<Vec3>();
  const auto fits = [vertices](const std::vector<Vec3>& vectors) {
    return vectors.size() == vertices || vectors.empty();
  };
  if (state.positions.size() != vertices || state.velocities.size() != vertices ||
      !fits(state.previous_positions) || !fits(state.previous_velocities)) {
    throw Error(ErrorKind::input, "the checkpoint has another number of vertices", "start the run anew");
  }
  state.previous_dt = in.value<double>();
  state.time = in.value<double>();
  state.step = in.value<std::int64_t>();

  saved.pins = in.values<PinKey>();
  saved.holds.holding = in.values<std::uint8_t>();
  saved.holds.anchors = in.values<Vec3>();

  Tally& tally = saved.tally;
  tally.work = in.value<double>();
  tally.dissipated = in.value<double>();
  tally.unbalanced = in.value<double>();
  saved.terms = in.values<std::uint64_t>();
  tally.stored = in.values<double>();
  tally.newton = in.value<std::int64_t>();
  tally.linear = in.value<std::int64_t>();
  tally.residual = in.value<double>();
  tally.pressed = in.value<double>();
  tally.smallest_gap = in.value<double>();
  tally.held_back = in.value<int>();

  saved.contact.slips = in.values<PairSlip>();
  saved.contact.begin = in.values<Vec3>();
  saved.contact.end = in.values<Vec3>();
  saved.contact.margin = in.value<double>();
  saved.contact.smallest_gap = in.value<double>();

  Diagnostics& row = saved.diagnostics;
  for (double* number : {&row.kinetic, &row.elastic, &row.potential, &row.work, &row.dissipated,
                         &row.unbalanced, &row.momentum.x(), &row.momentum.y(), &row.momentum.z(),
                         &row.residual, &row.max_stretch, &row.min_distance, &row.time})
    *number = in.value<double>();
  row.newton_iterations = in.value<int>();
  row.linear_iterations = in.value<int>();
  row.held_back = in.value<int>();
  row.frame = static_cast<int>(saved.header.frame);
  return saved;
}

Holds holds_of(std::span<const Pin> pins, const SavedRun& saved) {
  Holds holds;
  if (saved.holds.holding.size() != saved.pins.size()) return holds;
  const std::vector<PinKey> keys = pin_keys(pins);
  for (const PinKey& key : keys) {
    std::vector<Vec3> anchors(key.vertices, Vec3::Zero());
    std::uint8_t holding = 0;
    std::size_t first = 0;
    for (std::size_t p = 0; p < saved.pins.size(); ++p) {
      if (saved.pins[p] == key && first + key.vertices <= saved.holds.anchors.size()) {
        holding = saved.holds.holding[p];
        std::copy_n(saved.holds.anchors.begin() + static_cast<std::ptrdiff_t>(first), key.vertices,
                    anchors.begin());
        break;
      }
      first += saved.pins[p].vertices;
    }
    holds.holding.push_back(holding);
    holds.anchors.insert(holds.anchors.end(), anchors.begin(), anchors.end());
  }
  return holds;
}

}  // namespace muslin
