// Reproducibility: the same bits for any thread count, and after a stop and resume.
#include <algorithm>

#include "verify_case.hpp"
#include "verify_experiment.hpp"

namespace muslin::app {
namespace {

const char* const windy_sheet = R"(
[time]
frame_rate = 24
steps_per_frame = 2
[[body]]
mesh = "sheet.obj"
thickness = 0.02
voxel_width = 0.02
bracing = "full"
material = { density = 100, edge_modulus = 2e4, face_diagonal_modulus = 1e3, body_diagonal_modulus = 1e3, volume_modulus = 1e3, stiffness_damping = 1e-3 }
[[pin]]
where = { plane = { point = [0, 0, 0], normal = [1, 0, 0] } }
[[force]]
type = "gravity"
[[force]]
type = "wind"
velocity = [0, 5, 1]
gust = 2
)";

std::vector<Comparison> threads() {
  const Experiment experiment;
  experiment.level_sheet("sheet.obj", 1.6, 1.6, 80);
  const int before = thread_count();
  const auto end_state = [&](int count) {
    set_thread_count(count);
    Simulation simulation = experiment.start(windy_sheet);
    advance(simulation, 1);
    return simulation.state();
  };
  const State one = end_state(1), two = end_state(2), three = end_state(3);
  set_thread_count(before);
  return {{"vertices that differ, 2 threads and 1", 0, differing(one, two), 0, false},
          {"vertices that differ, 3 threads and 1", 0, differing(one, three), 0, false}};
}

std::vector<Comparison> resume() {
  const Experiment experiment;
  experiment.level_sheet("sheet.obj", 0.4, 0.2, 20);
  Simulation whole = experiment.start(windy_sheet);
  advance(whole, 3);
  const std::vector<std::uint8_t> saved = whole.checkpoint();
  advance(whole, 3);
  Simulation resumed = experiment.start(windy_sheet);
  resumed.restore(saved);
  advance(resumed, 3);
  const bool same_account = whole.diagnostics().balance() == resumed.diagnostics().balance();
  return {{"vertices that differ after a stop", 0, differing(whole.state(), resumed.state()), 0, false},
          {"energy balances that differ", 0, same_account ? 0.0 : 1.0, 0, false}};
}

}  // namespace

std::vector<VerifyCase> promise_cases() {
  return {
      {"threads", "the same bits for any number of threads", "promise", true, threads},
      {"resume", "the same bits after a stop", "promise", false, resume},
  };
}

}  // namespace muslin::app
