#include "muslin/force/point_force.hpp"

#include <utility>

namespace muslin {

class PointForce::DeadLoad : public Potential {
 public:
  DeadLoad(std::shared_ptr<const std::vector<Share>> shares, const Vec3& force)
      : shares_(std::move(shares)), force_(force) {}

  double value(ConstVectors x) const override {
    Vec3 sum = Vec3::Zero();
    for (const Share& s : *shares_) sum += s.weight * x[static_cast<std::size_t>(s.vertex)];
    return -force_.dot(sum);
  }
  void add_gradient(ConstVectors, Vectors g) const override {
    for (const Share& s : *shares_) g[static_cast<std::size_t>(s.vertex)] -= s.weight * force_;
  }
  void add_hessian_product(ConstVectors, ConstVectors, Vectors) const override {}
  void add_diagonal_blocks(ConstVectors, std::span<Mat3>) const override {}
  void linearize(ConstVectors, HessianSink&, std::size_t) const override {}

 private:
  std::shared_ptr<const std::vector<Share>> shares_;
  Vec3 force_;
};

PointForce::PointForce(const std::vector<int>& vertices, Keyed force, Window window,
                       const std::vector<double>& weights)
    : force_(std::move(force)), window_(window) {
  std::vector<Share> shares;
  for (std::size_t i = 0; i < vertices.size(); ++i)
    shares.push_back({vertices[i], weights.empty() ? 1.0 : weights[i]});
  shares_ = std::make_shared<const std::vector<Share>>(std::move(shares));
}

std::unique_ptr<Potential> PointForce::potential(const StepContext& step) const {
  const double share = window_.share(step.time_begin, step.time_end);
  if (share == 0) return nullptr;
  return std::make_unique<DeadLoad>(shares_, share * force_.at(window_.sample(step.time_end)));
}

}  // namespace muslin
