#include "muslin/constraint/attachment.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include "muslin/constraint/acting.hpp"
#include "muslin/core/error.hpp"
#include "muslin/core/hash.hpp"

namespace muslin {
namespace {

constexpr double broken = -1;

std::vector<std::size_t> holding(const std::vector<double>& lengths) {
  std::vector<std::size_t> joints;
  for (std::size_t j = 0; j < lengths.size(); ++j)
    if (lengths[j] != broken) joints.push_back(j);
  return joints;
}

/// An attachment between other points starts anew when a run is resumed.
std::string array_of(const std::string& name, const Joints& joints) {
  std::uint64_t hash = 0;
  for (const Joints::Weight& w : joints.weights) {
    hash = hash_bytes(&w.vertex, sizeof w.vertex, hash);
    hash = hash_bytes(&w.weight, sizeof w.weight, hash);
  }
  return fmt::format("attachment {} {:016x}", name, hash);
}

}  // namespace

class Attachment::Springs : public JointPotential {
 public:
  Springs(const Attachment& attachment, std::vector<double> lengths, double time)
      : JointPotential(attachment.joints_, holding(lengths)),
        attachment_(attachment),
        lengths_(std::move(lengths)),
        stiffness_(attachment.rules_.stiffness.at(time)),
        strength_(attachment.rules_.strength.at(time)) {}

  double dissipated(ConstVectors x) const override {
    double lost = 0;
    for (const std::size_t j : acting())
      if (breaks(j, x)) lost += answer(j, joints().apart(j, x)).energy;
    return lost;
  }
  bool breaks(std::size_t j, ConstVectors x) const {
    return answer(j, joints().apart(j, x)).gradient.norm() > strength_ * joints().strength[j];
  }
  /// Returns the lengths after a step that ends at x.
  std::vector<double> lengths_after(ConstVectors x) const {
    std::vector<double> after = lengths_;
    for (const std::size_t j : acting())
      if (breaks(j, x)) after[j] = broken;
    return after;
  }

 protected:
  JointAnswer answer(std::size_t j, const Vec3& z) const override {
    return attachment_.answer(stiffness_ * joints().stiffness[j], lengths_[j], z);
  }

 private:
  const Attachment& attachment_;
  std::vector<double> lengths_;
  double stiffness_, strength_;  // factors
};

Attachment::Attachment(std::string name, const AttachmentRules& rules, std::shared_ptr<const Joints> joints)
    : name_(std::move(name)), array_(array_of(name_, *joints)), rules_(rules), joints_(std::move(joints)) {
  require(std::min({rules.stiffness.least(), rules.damping.least(), rules.strength.least()}) >= 0,
          "the stiffness, damping or strength of an attachment is negative", "give factors of 0 or more");
}

JointAnswer Attachment::answer(double stiffness, double length, const Vec3& z) const {
  JointAnswer a;
  const double d = z.norm(), stretch = d - length;
  if (is_slack(length, d)) return a;
  a.energy = 0.5 * stiffness * stretch * stretch;
  a.along = a.across = stiffness;
  if (length == 0) {
    a.gradient = stiffness * z;
    return a;
  }
  if (d > 0) a.normal = z / d;
  a.gradient = stiffness * stretch * a.normal;
  a.across = d > 0 ? stiffness * stretch / d : 0;
  return a;
}

std::vector<double> Attachment::lengths(const StepContext& step) const {
  if (!acting(rules_.from, rules_.until, step.time_begin, step.time_end)) return {};
  if (step.history != nullptr) {
    const std::span<const double> known = step.history->find(array_, joints_->size());
    if (!known.empty()) return {known.begin(), known.end()};
  }
  std::vector<double> lengths(joints_->size(), 0);
  if (rules_.rest != AttachmentRules::Rest::joined)
    for (std::size_t j = 0; j < lengths.size(); ++j) lengths[j] = joints_->apart(j, step.positions).norm();
  return lengths;
}

std::unique_ptr<Potential> Attachment::potential(const StepContext& step) const {
  std::vector<double> now = lengths(step);
  if (now.empty()) return nullptr;
  return std::make_unique<Springs>(*this, std::move(now), step.time_end);
}

void Attachment::end_step(const Potential& potential, ConstVectors x, History& history) const {
  const std::vector<double> after = static_cast<const Springs&>(potential).lengths_after(x);
  std::copy(after.begin(), after.end(), history.get(array_, joints_->size()).begin());
}

AttachmentForce Attachment::force(double time, ConstVectors x, const History& history) const {
  AttachmentForce force;
  const std::span<const double> lengths = history.find(array_, joints_->size());
  if (lengths.empty() || !acting(rules_.from, rules_.until, time, time)) return force;
  for (std::size_t j = 0; j < lengths.size(); ++j) {
    if (lengths[j] == broken) continue;
    const Vec3 pull = -answer(stiffness(j, time), lengths[j], joints_->apart(j, x)).gradient;
    force.sum += pull;
    force.mean += pull.norm();
    force.largest = std::max(force.largest, pull.norm());
    ++force.holding;
  }
  if (force.holding > 0) force.mean /= force.holding;
  return force;
}

class AttachmentDamping::Dashpots : public JointPotential {
 public:
  Dashpots(const Attachment& attachment, const std::vector<double>& lengths, const StepContext& step)
      : JointPotential(attachment.joints_, holding(lengths)), all_(lengths.size()) {
    const double factor = attachment.rules_.damping.at(step.time_end);
    for (const std::size_t j : acting()) {
      const Vec3 z = joints().apart(j, step.positions);
      const double d = z.norm();
      const double along = attachment.is_slack(lengths[j], d) ? 0 : factor * joints().damping[j] / step.dt;
      all_[j] = {joints().apart(j, step.anchor), d > 0 ? Vec3(z / d) : Vec3::UnitX(), along,
                 lengths[j] == 0 ? along : 0};
    }
  }

 protected:
  JointAnswer answer(std::size_t j, const Vec3& z) const override {
    const auto& [start, normal, along, across] = all_[j];
    const Vec3 moved = z - start;
    const Vec3 gradient = across * moved + (along - across) * normal.dot(moved) * normal;
    return {0.5 * gradient.dot(moved), gradient, normal, along, across};
  }

 private:
  struct Dashpot {
    Vec3 start, normal;  // z₀, n
    double along, across;
  };
  std::vector<Dashpot> all_;  // by joint
};

AttachmentDamping::AttachmentDamping(std::shared_ptr<const Attachment> attachment)
    : attachment_(std::move(attachment)) {}

std::unique_ptr<Potential> AttachmentDamping::potential(const StepContext& step) const {
  const std::vector<double> lengths = attachment_->lengths(step);
  if (lengths.empty()) return nullptr;
  return std::make_unique<Dashpots>(*attachment_, lengths, step);
}

}  // namespace muslin
