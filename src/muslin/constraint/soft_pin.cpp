#include "muslin/constraint/soft_pin.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "muslin/constraint/pin_targets.hpp"
#include "muslin/core/error.hpp"
#include "muslin/core/hash.hpp"
#include "muslin/potential/hessian_sink.hpp"

namespace muslin {
namespace {

constexpr std::size_t numbers_of_vertex = 6;  // in the history: anchor, force

/// A pin with other vertices or another beginning starts anew when a run is resumed.
std::string array_of(const Pin& pin) {
  std::uint64_t hash = hash_bytes(pin.vertices.data(), pin.vertices.size() * sizeof(int));
  hash = hash_bytes(&pin.from, sizeof pin.from, hash);
  return fmt::format("pin {} {:016x}", pin.name, hash);
}

Vec3 vector_at(std::span<const double> numbers, std::size_t first) {
  return {numbers[first], numbers[first + 1], numbers[first + 2]};
}

void put(const Vec3& vector, std::span<double> numbers, std::size_t first) {
  for (std::size_t k = 0; k < 3; ++k) numbers[first + k] = vector[static_cast<Eigen::Index>(k)];
}

}  // namespace

/// W = Σ ½ k |x − t|² + ½ (c/dt) |x − a − dt u|² in one step: t is the target of a vertex at its end, u the
/// velocity of the target, and (x − a)/dt the velocity of the vertex.
class SoftPin::Springs : public Potential {
 public:
  Springs(std::shared_ptr<const Pin> pin, std::vector<Vec3> anchors, const StepContext& step)
      : pin_(std::move(pin)),
        anchors_(std::move(anchors)),
        dt_(step.dt),
        weight_(pin_->weight.at(step.time_end)) {
    const PinTargets begin(*pin_, step.time_begin), end(*pin_, step.time_end);
    const double factor = step.dt / step.length;
    for (std::size_t i = 0; i < anchors_.size(); ++i) {
      targets_.push_back(end.at(i, anchors_[i]));
      carried_.push_back(step.anchor[vertex(i)] + factor * (targets_.back() - begin.at(i, anchors_[i])));
    }
  }

  double value(ConstVectors x) const override {
    double sum = 0;
    for (std::size_t i = 0; i < targets_.size(); ++i) {
      const Vec3& at = x[vertex(i)];
      sum += 0.5 * stiffness(i) * (at - targets_[i]).squaredNorm() +
             0.5 * drag(i) * (at - carried_[i]).squaredNorm();
    }
    return sum;
  }
  void add_gradient(ConstVectors x, Vectors g) const override {
    for (std::size_t i = 0; i < targets_.size(); ++i) g[vertex(i)] -= force(i, x);
  }
  void add_hessian_product(ConstVectors, ConstVectors p, Vectors y) const override {
    for (std::size_t i = 0; i < targets_.size(); ++i) y[vertex(i)] += (stiffness(i) + drag(i)) * p[vertex(i)];
  }
  void add_diagonal_blocks(ConstVectors, std::span<Mat3> blocks) const override {
    for (std::size_t i = 0; i < targets_.size(); ++i)
      blocks[vertex(i)].diagonal().array() += stiffness(i) + drag(i);
  }
  void linearize(ConstVectors x, HessianSink& into, std::size_t first) const override {
    const std::span<float> identity = into.identity(first, x.size());
    for (std::size_t i = 0; i < targets_.size(); ++i)
      identity[vertex(i)] += static_cast<float>(into.scale() * (stiffness(i) + drag(i)));
  }

  const Vec3& anchor(std::size_t i) const { return anchors_[i]; }
  Vec3 force(std::size_t i, ConstVectors x) const {
    const Vec3& at = x[vertex(i)];
    return stiffness(i) * (targets_[i] - at) + drag(i) * (carried_[i] - at);
  }

 private:
  std::size_t vertex(std::size_t i) const { return static_cast<std::size_t>(pin_->vertices[i]); }
  double stiffness(std::size_t i) const { return weight_ * pin_->stiffness[i]; }
  double drag(std::size_t i) const { return pin_->damping.empty() ? 0 : weight_ * pin_->damping[i] / dt_; }

  std::shared_ptr<const Pin> pin_;
  std::vector<Vec3> anchors_;
  double dt_;                            // [s]
  double weight_;                        // of the pin at the end of the step
  std::vector<Vec3> targets_, carried_;  // by vertex of the pin [m]
};

SoftPin::SoftPin(Pin pin) : array_(array_of(pin)) {
  const std::size_t count = pin.vertices.size();
  const auto fit = [&](const std::vector<double>& constants) {
    return constants.size() == count &&
           std::all_of(constants.begin(), constants.end(), [](double c) { return c >= 0; });
  };
  require(fit(pin.stiffness) && (pin.damping.empty() || fit(pin.damping)) && pin.weight.least() >= 0,
          "a soft pin needs a stiffness for each vertex, a damping for each or none, and a weight",
          "give numbers of 0 or more");
  pin_ = std::make_shared<const Pin>(std::move(pin));
}

std::unique_ptr<Potential> SoftPin::potential(const StepContext& step) const {
  if (!pin_->acts(step.time_begin, step.time_end)) return nullptr;
  const std::size_t count = pin_->vertices.size();
  const std::span<const double> numbers = step.history != nullptr
                                              ? step.history->find(array_, numbers_of_vertex * count)
                                              : std::span<const double>();
  std::vector<Vec3> anchors;
  anchors.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    anchors.push_back(numbers.empty() ? PinTargets::first_anchor(
                                            *pin_, step.time_begin, i,
                                            step.positions[static_cast<std::size_t>(pin_->vertices[i])])
                                      : vector_at(numbers, numbers_of_vertex * i));
  }
  return std::make_unique<Springs>(pin_, std::move(anchors), step);
}

void SoftPin::end_step(const Potential& potential, ConstVectors x, History& history) const {
  const auto& springs = static_cast<const Springs&>(potential);
  const std::size_t count = pin_->vertices.size();
  const std::span<double> numbers = history.get(array_, numbers_of_vertex * count);
  for (std::size_t i = 0; i < count; ++i) {
    put(springs.anchor(i), numbers, numbers_of_vertex * i);
    put(springs.force(i, x), numbers, numbers_of_vertex * i + 3);
  }
}

std::vector<Vec3> SoftPin::forces(const Pin& pin, const History& history) {
  const std::size_t count = pin.vertices.size();
  const std::span<const double> numbers = history.find(array_of(pin), numbers_of_vertex * count);
  std::vector<Vec3> forces;
  for (std::size_t i = 0; i < count && !numbers.empty(); ++i)
    forces.push_back(vector_at(numbers, numbers_of_vertex * i + 3));
  return forces;
}

}  // namespace muslin
