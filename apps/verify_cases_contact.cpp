// Contact: nothing crosses in any step of the scenes under scenes/contact, for any thread count, from
// randomly perturbed starts; the same bits; no energy from nothing.
#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include "verify_case.hpp"
#include "verify_experiment.hpp"
#include "verify_referee.hpp"
#include <fmt/format.h>

#include "muslin/contact/contact_model.hpp"

namespace muslin::app {
namespace {

std::filesystem::path scene_file(const std::string& name) {
  const auto file = std::filesystem::path(MUSLIN_SCENES) / "contact" / (name + ".toml");
  if (!std::filesystem::exists(file))
    throw Error(ErrorKind::file, {file.string()}, "the scene is not there",
                "run this test where muslin was built");
  return file;
}

/// The scene with its start perturbed: every free vertex of cloth and solids is displaced by up to a tenth of
/// the contact distance and gets a velocity of up to 5 cm/s.
std::shared_ptr<const Model> shaken(const std::string& name, unsigned seed) {
  auto model = std::make_shared<Model>(build_model(read_scene(scene_file(name))));
  std::vector<bool> free(model->vertex_count(), false);
  for (const Component& body : model->bodies) {
    if (!body.is_soft()) continue;
    std::fill_n(free.begin() + body.first_vertex, body.vertex_count, true);
  }
  for (const Pin& pin : model->pins)
    for (const int v : pin.vertices) free[static_cast<std::size_t>(v)] = false;
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> noise(-1, 1);
  if (model->velocities.empty()) model->velocities.assign(model->vertex_count(), Vec3::Zero());
  for (std::size_t v = 0; v < free.size(); ++v) {
    if (!free[v]) continue;
    for (int axis = 0; axis < 3; ++axis) {
      model->rest_positions[v][axis] += 0.1 * model->contact->distance * noise(random);
      model->velocities[v][axis] += 0.05 * noise(random);
    }
  }
  return model;
}

struct Outcome {
  State state;
  int steps = 0;
  double crossings = 0;  ///< over all steps
  double least_distance = std::numeric_limits<double>::infinity();
};

Outcome watch(const std::string& name, unsigned seed, int threads) {
  set_thread_count(threads);
  const auto model = shaken(name, seed);
  const Referee referee(model);
  Simulation simulation(model);
  Outcome outcome;
  outcome.crossings = static_cast<double>(referee.crossings(simulation.state().positions));
  while (simulation.frame() < model->scene.time.frames()) {
    simulation.step();
    ++outcome.steps;
    outcome.crossings += static_cast<double>(referee.crossings(simulation.state().positions));
    outcome.least_distance = std::min(outcome.least_distance, simulation.diagnostics().min_distance);
  }
  outcome.state = simulation.state();
  return outcome;
}

std::vector<Comparison> nothing_crosses(const std::string& name) {
  const int before = thread_count();
  const Outcome one = watch(name, 1, 1), two = watch(name, 1, 2), other = watch(name, 2, 2);
  set_thread_count(before);
  return {
      {fmt::format("crossings in {} steps, 1 thread", one.steps), 0, one.crossings, 0, false},
      {fmt::format("crossings in {} steps, 2 threads", two.steps), 0, two.crossings, 0, false},
      {fmt::format("crossings in {} steps, shaken otherwise", other.steps), 0, other.crossings, 0, false},
      {"vertices that differ, 2 threads and 1", 0, differing(one.state, two.state), 0, false},
      {fmt::format("min_distance is never 0; least {:.2g} m",
                   std::min(one.least_distance, other.least_distance)),
       1, one.least_distance > 0 && other.least_distance > 0 ? 1.0 : 0.0, 0, false},
  };
}

const std::string drop = R"(
[time]
frame_rate = 60
steps_per_frame = 4
[contact]
friction = 0.3
[[body]]
name = "cloth"
mesh = "cloth.obj"
model = "shell"
material = "cotton"
translate = [-0.25, 0.13, -0.25]
[[collider]]
shape = "sphere"
radius = 0.12
[[force]]
type = "gravity"
)";

std::vector<Comparison> contact_resumes() {
  const Experiment experiment;
  experiment.level_sheet("cloth.obj", 0.5, 0.5, 24);
  Simulation whole = experiment.start(drop);
  advance(whole, 20);
  const std::vector<std::uint8_t> saved = whole.checkpoint();
  advance(whole, 10);
  Simulation resumed = experiment.start(drop);
  resumed.restore(saved);
  advance(resumed, 10);
  return {{"vertices that differ after a stop", 0, differing(whole.state(), resumed.state()), 0, false}};
}

std::vector<Comparison> no_energy_from_nothing() {
  std::vector<Comparison> numbers;
  for (const char* effort : {"draft", "normal", "exact"}) {
    const Experiment experiment;
    experiment.level_sheet("cloth.obj", 0.5, 0.5, 24);
    Simulation simulation = experiment.start(drop, {fmt::format("solver.effort={}", effort)});
    const auto energy = [&] {
      const Diagnostics& now = simulation.diagnostics();
      return now.kinetic + now.elastic + now.potential;
    };
    const double first = energy();
    double least = first, gain = 0;
    for (int frame = 0; frame < 90; ++frame) {
      advance(simulation, 1);
      gain = std::max(gain, energy() - least);
      least = std::min(least, energy());
    }
    numbers.push_back({fmt::format("energy gained over energy fallen, {}", effort), 0, gain / (first - least),
                       1e-4, false});
  }
  return numbers;
}

}  // namespace

std::vector<VerifyCase> contact_cases() {
  std::vector<VerifyCase> cases = {
      {"contact-resume", "contact and friction continue after a stop with the same bits", "promise", false,
       contact_resumes},
      {"contact-energy", "kinetic + stored energy of cloth that falls on a ball never grows", "second law",
       true, no_energy_from_nothing},
  };
  for (const char* name :
       {"sphere_drop", "fold_on_floor", "rotating_sphere", "funnel", "twisted_cylinder", "reef_knot",
        "stack_under_ball", "flag_ball", "flag_on_pole", "lattice_on_stairs", "curtain_walk"}) {
    cases.push_back({fmt::format("crossings-{}", name),
                     fmt::format("nothing crosses in any step of scenes/contact/{}.toml", name), "promise",
                     true, [name] { return nothing_crosses(name); }});
  }
  return cases;
}

}  // namespace muslin::app
