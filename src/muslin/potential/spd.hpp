// Computes the positive semidefinite part of small symmetric matrices, for preconditioners.
#pragma once

#include <Eigen/Core>
#include <Eigen/Eigenvalues>

namespace muslin {

/// Returns the symmetric positive semidefinite matrix nearest to the symmetric `a` in the Frobenius norm:
/// negative eigenvalues become zero (Higham 1988). `a` must be finite; only its lower triangle is read.
template <int N>
Eigen::Matrix<double, N, N> positive_semidefinite_part(const Eigen::Matrix<double, N, N>& a) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, N, N>> eigen(a);
  if (eigen.eigenvalues()[0] >= 0) return a.template selfadjointView<Eigen::Lower>();
  const auto& q = eigen.eigenvectors();
  return q * eigen.eigenvalues().cwiseMax(0.0).asDiagonal() * q.transpose();
}

}  // namespace muslin
