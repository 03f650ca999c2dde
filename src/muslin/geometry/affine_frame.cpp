#include "muslin/geometry/affine_frame.hpp"

#include <Eigen/Eigenvalues>

namespace muslin {

std::array<Vec3, 4> AffineFrame::corners() const {
  std::array<Vec3, 4> result;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto& s = corner_signs[i];
    result[i] = centre + axes * Vec3(s[0] * radii.x(), s[1] * radii.y(), s[2] * radii.z());
  }
  return result;
}

std::array<double, 4> AffineFrame::weights(const Vec3& point) const {
  const Vec3 local = (axes.transpose() * (point - centre)).cwiseQuotient(radii);
  std::array<double, 4> result;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto& s = corner_signs[i];
    result[i] = (1 + s[0] * local.x() + s[1] * local.y() + s[2] * local.z()) / 4;
  }
  return result;
}

AffineFrame equimomental_frame(const MassProperties& body) {
  AffineFrame frame;
  frame.centre = body.centre;
  const Mat3 square = body.second_moment / body.volume;
  Vec3 squares = square.diagonal();
  // Uses the coordinate axes where these are principal; those of a ball or cube are arbitrary.
  const double off_diagonal = (square - Mat3(squares.asDiagonal())).cwiseAbs().maxCoeff();
  if (off_diagonal > 1e-12 * squares.cwiseAbs().maxCoeff()) {
    const Eigen::SelfAdjointEigenSolver<Mat3> solver(square);
    squares = solver.eigenvalues();
    frame.axes = solver.eigenvectors();
    if (frame.axes.determinant() < 0) frame.axes.col(0) *= -1;
  }
  const double largest = squares.maxCoeff();
  frame.radii = squares.cwiseMax(1e-6 * largest).cwiseSqrt();
  return frame;
}

}  // namespace muslin
