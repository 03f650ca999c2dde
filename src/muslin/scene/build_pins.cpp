#include "muslin/scene/build_pins.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "muslin/component/body_maps.hpp"
#include "muslin/constraint/soft_pin.hpp"
#include "muslin/core/index.hpp"
#include "muslin/scene/pin_sequence.hpp"
#include "muslin/scene/pin_table.hpp"
#include "muslin/schema/over_time.hpp"

namespace muslin {
namespace {

std::vector<int> to_model(const Component& body, std::vector<int> vertices) {
  for (int& v : vertices) v += body.first_vertex;
  return vertices;
}

Vec3 centre_of(const Model& model, const std::vector<int>& vertices) {
  Vec3 sum = Vec3::Zero();
  for (const int v : vertices) sum += model.rest_positions[static_cast<std::size_t>(v)];
  return sum / static_cast<double>(vertices.size());
}

/// A pin warns that it moves its vertices in the first step if it moves one by more than this [m].
constexpr double smallest_jump = 1e-6;

/// The product of rate and time after which (1 + rate·time) exp(−rate·time), the share of the way that is
/// left with critical damping, is 1 %.
constexpr double settled = 6.638;

/// Lets vertices without weight go.
void drop_weightless(const PinSettings& settings, Pin& pin, std::vector<double>& weights) {
  std::size_t kept = 0;
  for (std::size_t k = 0; k < weights.size(); ++k) {
    if (weights[k] == 0) continue;
    pin.vertices[kept] = pin.vertices[k];
    weights[kept++] = weights[k];
  }
  pin.vertices.resize(kept);
  weights.resize(kept);
  if (kept == 0)
    throw Error(ErrorKind::input, settings.place,
                fmt::format("pin {}: its `weight` is 0 at every vertex", pin.name),
                "raise it somewhere, or remove the pin");
}

/// Shares the stiffness and damping of a soft pin among its vertices, by their masses: the pin pulls as hard
/// at any resolution of the mesh.
void soften(const Model& model, const PinSettings& settings, const Component& body,
            std::span<const double> weights, Pin& pin) {
  double stiffness = settings.stiffness.value_or(0), damping = settings.damping;
  if (settings.time) {
    const double rate = settled / *settings.time;
    stiffness = body.statistics.mass * rate * rate;
    damping = 2 * body.statistics.mass * rate;
  }
  double mass = 0;
  for (const int v : pin.vertices) mass += model.masses[static_cast<std::size_t>(v)];
  for (std::size_t k = 0; k < weights.size(); ++k) {
    const double share = weights[k] * model.masses[at(pin.vertices[k])] / mass;
    pin.stiffness.push_back(stiffness * share);
    pin.damping.push_back(damping * share);
  }
}

/// A pin that places its vertices elsewhere than they are modelled moves them there in the first step.
void warn_of_jump(Model& model, const Pin& pin) {
  if (pin.begins_late()) return;
  const Eigen::Affine3d motion = pin.motion.from_model(0);
  double farthest = 0;
  for (const int v : pin.vertices) {
    const Vec3& modelled = model.rest_positions[at(v)];
    farthest = std::max(farthest, (motion * modelled - modelled).norm());
  }
  if (farthest > smallest_jump)
    model.warnings.push_back(
        fmt::format("pin {}: its first keyframe is {:.3g} m from where its vertices are modelled, and the "
                    "first step moves them there; let the first keyframe be at rest, or move the body by "
                    "`translate`",
                    pin.name, farthest));
}

}  // namespace

void build_pins(Model& model) {
  for (const PinSettings& settings : model.scene.pins) {
    const Component& body = model.body(settings.body);
    Pin pin;
    pin.name = settings.name;
    const std::vector<int> held = body.held_vertices(settings.where, "pin " + settings.name);
    pin.vertices = to_model(body, held);
    pin.weight = *schema::over_time(settings.variations, "weight", settings.weight);
    const double greatest = pin.weight.greatest();
    std::vector<double> weights = numbers_at(settings.variations, pin_table(), "weight",
                                             {model.scene.file, model.scene.meshes}, body, held, greatest);
    drop_weightless(settings, pin, weights);
    for (KeyedNumber::Key& key : pin.weight.keys) key.value /= greatest;
    pin.from = settings.from;
    pin.until = settings.until;
    pin.motion = settings.motion;
    pin.motion.pivot = settings.pivot.value_or(centre_of(model, pin.vertices));
    if (!settings.sequence.empty()) follow_sequence(model.scene, settings, body, pin);
    if (settings.is_soft()) {
      if (model.scene.solver.integrator == Integrator::symplectic_euler)
        throw Error(ErrorKind::input, settings.place,
                    fmt::format("pin {}: symplectic_euler does not support soft pins", pin.name),
                    "choose an implicit integrator");
      soften(model, settings, body, weights, pin);
      model.loads.push_back({pin.name, EnergyRole::support, std::make_shared<SoftPin>(pin)});
    } else {
      warn_of_jump(model, pin);
    }
    model.pins.push_back(std::move(pin));
  }
}

void warn_of_stiff_pins(Model& model) {
  if (model.scene.solver.effort_at(0) == Effort::exact) return;
  const double rate = model.scene.time.frame_rate;  // of the longest steps [1/s]
  for (const Pin& pin : model.pins) {
    double worst = 0;
    for (std::size_t k = 0; pin.is_soft() && k < pin.vertices.size(); ++k) {
      const auto v = static_cast<std::size_t>(pin.vertices[k]);
      const double step = model.body_of(v).statistics.undamped_step;
      const double stiffest = 4 * model.masses[v] / (step * step);  // bounds the material at the vertex
      if (std::isfinite(step)) worst = std::max(worst, (pin.stiffness[k] + pin.damping[k] * rate) / stiffest);
    }
    if (worst > 1)
      model.warnings.push_back(fmt::format(
          "pin {}: it is {:.2g} times as stiff as the material it holds, so that its force is only accurate "
          "at "
          "effort exact; lower `stiffness` and `damping`, lengthen `time`, or leave them out for a hard pin",
          pin.name, worst));
  }
}

void build_probes(Model& model) {
  for (const ProbeSettings& settings : model.scene.probes) {
    const Component& body = model.body(settings.body);
    Probe probe;
    probe.name = settings.name;
    probe.body = model.bodies.index_of(body);
    AttachedPoint attached = body.attach(settings.at);
    probe.point = std::move(attached.point);
    if (!attached.warning.empty())
      model.warnings.push_back(fmt::format("probe {}: `at` {}", settings.name, attached.warning));
    model.probes.push_back(std::move(probe));
  }
}

}  // namespace muslin
