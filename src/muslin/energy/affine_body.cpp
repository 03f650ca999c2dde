#include "muslin/energy/affine_body.hpp"

#include <algorithm>
#include <cassert>
#include <memory>
#include <utility>
#include <vector>

#include <Eigen/Eigenvalues>

#include "muslin/core/error.hpp"
#include "muslin/geometry/affine_frame.hpp"
#include "muslin/potential/hessian_sink.hpp"
#include "muslin/potential/symmetric_pattern.hpp"

namespace muslin {
namespace {

int sign(std::size_t corner, int axis) { return corner_signs[corner][static_cast<std::size_t>(axis)]; }

/// Returns the half axes as columns.
Mat3 half_axes(ConstVectors q) {
  assert(q.size() == 4);
  Mat3 b = Mat3::Zero();
  for (std::size_t c = 0; c < 4; ++c)
    for (int i = 0; i < 3; ++i) b.col(i) += sign(c, i) * q[c] / 4;
  return b;
}

/// Adds the forces on the half axes to the corners.
void spread(const Mat3& to_axes, Vectors corners) {
  for (std::size_t c = 0; c < 4; ++c)
    for (int i = 0; i < 3; ++i) corners[c] += sign(c, i) * to_axes.col(i) / 4;
}

/// All pairs of four vertices: the same for every body.
const std::shared_ptr<const SymmetricPattern>& all_pairs() {
  static const auto pattern = [] {
    std::vector<std::pair<int, int>> pairs;
    for (int a = 0; a < 4; ++a)
      for (int b = a; b < 4; ++b) pairs.emplace_back(a, b);
    return std::make_shared<const SymmetricPattern>(std::move(pairs), 4);
  }();
  return pattern;
}

}  // namespace

AffineBodyEnergy::AffineBodyEnergy(const Vec3& radii, double stiffness)
    : radii_(radii), stiffness_(stiffness) {
  if (!(radii.minCoeff() > 0) || !(stiffness > 0))
    throw Error(ErrorKind::usage, "radii and stiffness of a rigid body are not positive", "check its mass");
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) largest_(i, j) = std::max(radii[i], radii[j]);
}

Mat3 AffineBodyEnergy::strain(const Mat3& b) const {
  const Mat3 rest = radii_.cwiseProduct(radii_).asDiagonal();
  return (b.transpose() * b - rest).cwiseQuotient(largest_);
}

double AffineBodyEnergy::value(ConstVectors q) const {
  return stiffness_ / 8 * strain(half_axes(q)).squaredNorm();
}

void AffineBodyEnergy::add_gradient(ConstVectors q, Vectors g) const {
  const Mat3 b = half_axes(q);
  spread(stiffness_ / 2 * b * strain(b).cwiseQuotient(largest_), g);
}

void AffineBodyEnergy::add_hessian_product(ConstVectors q, ConstVectors p, Vectors y) const {
  const Mat3 b = half_axes(q), d = half_axes(p);
  const Mat3 change = (d.transpose() * b + b.transpose() * d).cwiseQuotient(largest_);
  spread(stiffness_ / 2 * (b * change.cwiseQuotient(largest_) + d * strain(b).cwiseQuotient(largest_)), y);
}

std::array<std::array<Mat3, 3>, 3> AffineBodyEnergy::projected(const Mat3& b) const {
  std::array<std::array<Mat3, 3>, 3> h;
  for (auto& row : h) row.fill(Mat3::Zero());
  // k/4 Σ ∇r ∇rᵀ; r_ij depends on bᵢ by b_j/max and on b_j by bᵢ/max.
  const auto at = [](int i) { return static_cast<std::size_t>(i); };
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const double scale = stiffness_ / 4 / (largest_(i, j) * largest_(i, j));
      h[at(i)][at(i)] += scale * b.col(j) * b.col(j).transpose();
      h[at(i)][at(j)] += scale * b.col(j) * b.col(i).transpose();
      h[at(j)][at(i)] += scale * b.col(i) * b.col(j).transpose();
      h[at(j)][at(j)] += scale * b.col(i) * b.col(i).transpose();
    }
  }
  const Eigen::SelfAdjointEigenSolver<Mat3> eigen(strain(b).cwiseQuotient(largest_));
  const Mat3 positive =
      eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0).asDiagonal() * eigen.eigenvectors().transpose();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) h[at(i)][at(j)] += stiffness_ / 2 * positive(i, j) * Mat3::Identity();
  return h;
}

void AffineBodyEnergy::add_diagonal_blocks(ConstVectors q, std::span<Mat3> blocks) const {
  const auto h = projected(half_axes(q));
  for (std::size_t c = 0; c < 4; ++c)
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        blocks[c] +=
            sign(c, i) * sign(c, j) / 16.0 * h[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
}

void AffineBodyEnergy::linearize(ConstVectors q, HessianSink& into, std::size_t first) const {
  const auto h = projected(half_axes(q));
  const PairBlocks blocks = into.pair_blocks(all_pairs(), first);
  const double scale = into.scale();
  for (int row = 0; row < 4; ++row) {
    for (int column = row; column < 4; ++column) {
      Mat3 block = Mat3::Zero();
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          block += sign(static_cast<std::size_t>(row), i) * sign(static_cast<std::size_t>(column), j) / 16.0 *
                   h[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
      block *= scale;
      Float4* const columns = blocks.block(all_pairs()->find(row, column));
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l < 3; ++l) columns[k][l] += static_cast<float>(block(l, k));
    }
  }
}

}  // namespace muslin
