#include "muslin/force/point_force.hpp"

#include <utility>

namespace muslin {

namespace {

class DeadLoad : public Potential {
 public:
  DeadLoad(std::shared_ptr<const std::vector<int>> vertices, const Vec3& force)
      : vertices_(std::move(vertices)), force_(force) {}

  double value(ConstVectors x) const override {
    Vec3 sum = Vec3::Zero();
    for (const int v : *vertices_) sum += x[static_cast<std::size_t>(v)];
    return -force_.dot(sum);
  }
  void add_gradient(ConstVectors, Vectors g) const override {
    for (const int v : *vertices_) g[static_cast<std::size_t>(v)] -= force_;
  }
  void add_hessian_product(ConstVectors, ConstVectors, Vectors) const override {}
  void add_diagonal_blocks(ConstVectors, std::span<Mat3>) const override {}
  void linearize(ConstVectors, Linearization&, std::size_t) const override {}

 private:
  std::shared_ptr<const std::vector<int>> vertices_;
  Vec3 force_;
};

}  // namespace

PointForce::PointForce(std::vector<int> vertices, Keyed force, Window window)
    : vertices_(std::make_shared<const std::vector<int>>(std::move(vertices))),
      force_(std::move(force)),
      window_(window) {}

std::unique_ptr<Potential> PointForce::potential(const StepContext& step) const {
  const double share = window_.share(step.time_begin, step.time_end);
  if (share == 0) return nullptr;
  return std::make_unique<DeadLoad>(vertices_, share * force_.at(window_.sample(step.time_end)));
}

}  // namespace muslin
