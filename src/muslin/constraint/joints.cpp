#include "muslin/constraint/joints.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "muslin/potential/hessian_sink.hpp"

namespace muslin {

void Joints::add_points(std::span<const Weight> first, std::span<const Weight> second) {
  std::vector<Weight> both;
  const auto add = [&](const Weight& w, double sign) {
    const auto known =
        std::find_if(both.begin(), both.end(), [&](const Weight& each) { return each.vertex == w.vertex; });
    if (known == both.end()) {
      both.push_back({w.vertex, sign * w.weight});
    } else {
      known->weight += sign * w.weight;
    }
  };
  for (const Weight& w : first) add(w, 1);
  for (const Weight& w : second) add(w, -1);
  std::copy_if(both.begin(), both.end(), std::back_inserter(weights),
               [](const Weight& w) { return w.weight != 0; });
  offsets.push_back(weights.size());
}

Vec3 Joints::apart(std::size_t j, ConstVectors x) const {
  Vec3 z = Vec3::Zero();
  for (const Weight& w : of(j)) z += w.weight * x[static_cast<std::size_t>(w.vertex)];
  return z;
}

JointPotential::JointPotential(std::shared_ptr<const Joints> joints, std::vector<std::size_t> acting)
    : joints_(std::move(joints)), acting_(std::move(acting)) {}

double JointPotential::value(ConstVectors x) const {
  double sum = 0;
  for (const std::size_t j : acting_) sum += answer(j, joints_->apart(j, x)).energy;
  return sum;
}

void JointPotential::add_gradient(ConstVectors x, Vectors g) const {
  for (const std::size_t j : acting_) {
    const Vec3 force = answer(j, joints_->apart(j, x)).gradient;
    for (const Joints::Weight& w : joints_->of(j)) g[static_cast<std::size_t>(w.vertex)] += w.weight * force;
  }
}

void JointPotential::add_hessian_product(ConstVectors x, ConstVectors p, Vectors y) const {
  for (const std::size_t j : acting_) {
    const JointAnswer a = answer(j, joints_->apart(j, x));
    const Vec3 d = joints_->apart(j, p);
    const Vec3 change = a.across * d + (a.along - a.across) * a.normal.dot(d) * a.normal;
    for (const Joints::Weight& w : joints_->of(j)) y[static_cast<std::size_t>(w.vertex)] += w.weight * change;
  }
}

void JointPotential::add_diagonal_blocks(ConstVectors x, std::span<Mat3> blocks) const {
  for (const std::size_t j : acting_) {
    const JointAnswer a = answer(j, joints_->apart(j, x));
    const double across = std::max(a.across, 0.0);
    const Mat3 block = across * Mat3::Identity() + (a.along - across) * a.normal * a.normal.transpose();
    for (const Joints::Weight& w : joints_->of(j))
      blocks[static_cast<std::size_t>(w.vertex)] += w.weight * w.weight * block;
  }
}

void JointPotential::linearize(ConstVectors x, HessianSink& into, std::size_t first) const {
  const std::span<const std::uint8_t> fixed = into.fixed().subspan(first);
  const auto is_free = [&](const Joints::Weight& w) {
    return fixed[static_cast<std::size_t>(w.vertex)] == 0;
  };
  std::size_t count = 0;
  for (const std::size_t j : acting_)
    count += static_cast<std::size_t>(std::count_if(joints_->of(j).begin(), joints_->of(j).end(), is_free));
  const RelativeTerms terms = into.relative_terms(first, x.size(), acting_.size(), count);
  std::size_t next = 0;
  for (std::size_t t = 0; t < acting_.size(); ++t) {
    const std::size_t j = acting_[t];
    const JointAnswer a = answer(j, joints_->apart(j, x));
    std::vector<RelativeTerms::Weight> of_term;
    for (const Joints::Weight& w : joints_->of(j))
      if (is_free(w)) of_term.push_back({w.vertex, static_cast<float>(w.weight)});
    terms.set(t, next, a.normal, into.scale() * a.along, into.scale() * std::max(a.across, 0.0), of_term);
    next += of_term.size();
  }
}

}  // namespace muslin
