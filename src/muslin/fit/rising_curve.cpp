#include "muslin/fit/rising_curve.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <Eigen/QR>

#include "muslin/energy/stress_curve.hpp"

namespace muslin {
namespace {

constexpr double least_share = 1e-3;  // of the mean slope, to the least one between two points
constexpr int corrections = 8;        // for the curve between the points, which is not straight

/// Up to most_points of the distinct x, so that the same number of them lies between each two.
std::vector<double> spread_points(const std::vector<Vec2>& data) {
  const double apart = 1e-3 * data.back()[0];
  std::vector<double> distinct;
  for (const Vec2& point : data)
    if (point[0] > (distinct.empty() ? 0 : distinct.back()) + apart) distinct.push_back(point[0]);
  const std::size_t count = std::min(distinct.size(), static_cast<std::size_t>(StressCurve::most_points));
  std::vector<double> chosen;
  for (std::size_t k = 1; k <= count; ++k) chosen.push_back(distinct[k * distinct.size() / count - 1]);
  return chosen;
}

/// The increments of a polyline from the origin through (knots, values) that make up its value at x, as
/// weights.
std::vector<double> weights_at(double x, const std::vector<double>& knots) {
  std::vector<double> weights;
  double before = 0;
  for (const double knot : knots) {
    weights.push_back(std::clamp((x - before) / (knot - before), 0.0, 1.0));
    before = knot;
  }
  return weights;
}

std::vector<Vec2> points_of(const std::vector<double>& knots, const std::vector<double>& increments) {
  std::vector<Vec2> points;
  points.reserve(knots.size());
  double sum = 0;
  for (std::size_t k = 0; k < knots.size(); ++k) points.emplace_back(knots[k], sum += increments[k]);
  return points;
}

}  // namespace

std::vector<double> non_negative_least_squares(const std::vector<std::vector<double>>& a,
                                               const std::vector<double>& b) {
  const auto rows = static_cast<Eigen::Index>(a.size()),
             columns = static_cast<Eigen::Index>(a.front().size());
  Eigen::MatrixXd matrix(rows, columns);
  Eigen::VectorXd right(rows), x = Eigen::VectorXd::Zero(columns);
  for (Eigen::Index i = 0; i < rows; ++i) {
    right[i] = b[static_cast<std::size_t>(i)];
    for (Eigen::Index j = 0; j < columns; ++j)
      matrix(i, j) = a[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
  }
  std::vector<Eigen::Index> free;
  const double small = 1e-12 * (matrix.transpose() * right).cwiseAbs().maxCoeff();
  for (Eigen::Index round = 0; round < 3 * columns; ++round) {
    const Eigen::VectorXd gain = matrix.transpose() * (right - matrix * x);
    Eigen::Index best = -1;
    for (Eigen::Index j = 0; j < columns; ++j) {
      const bool fixed = std::find(free.begin(), free.end(), j) == free.end();
      if (fixed && gain[j] > small && (best < 0 || gain[j] > gain[best])) best = j;
    }
    if (best < 0) break;
    free.push_back(best);
    while (true) {
      Eigen::MatrixXd part(rows, static_cast<Eigen::Index>(free.size()));
      for (std::size_t k = 0; k < free.size(); ++k)
        part.col(static_cast<Eigen::Index>(k)) = matrix.col(free[k]);
      const Eigen::VectorXd solution = part.colPivHouseholderQr().solve(right);
      double step = 1;
      for (std::size_t k = 0; k < free.size(); ++k) {
        const double now = x[free[k]], next = solution[static_cast<Eigen::Index>(k)];
        if (next <= 0) step = std::min(step, now / (now - next));
      }
      std::vector<Eigen::Index> kept;
      for (std::size_t k = 0; k < free.size(); ++k) {
        const double next = solution[static_cast<Eigen::Index>(k)];
        double& now = x[free[k]];
        now += step * (next - now);
        if (next > 0 || now > 0) {
          kept.push_back(free[k]);
        } else {
          now = 0;
        }
      }
      if (step == 1) break;
      free = kept;
      if (free.empty()) break;
    }
  }
  return {x.data(), x.data() + columns};
}

RisingCurve fit_rising_curve(std::vector<Vec2> data) {
  std::sort(data.begin(), data.end(),
            [](const Vec2& a, const Vec2& b) { return a[0] != b[0] ? a[0] < b[0] : a[1] < b[1]; });
  const std::vector<double> knots = spread_points(data);
  double greatest = 0;
  for (const Vec2& point : data) greatest = std::max(greatest, point[1]);
  std::vector<double> least;
  least.reserve(knots.size());
  for (std::size_t k = 0; k < knots.size(); ++k)
    least.push_back(least_share * greatest / knots.back() * (knots[k] - (k == 0 ? 0 : knots[k - 1])));

  std::vector<std::vector<double>> rows;
  rows.reserve(data.size());
  for (const Vec2& point : data) rows.push_back(weights_at(point[0], knots));
  const auto straight = [&](std::size_t i, const std::vector<double>& increments) {
    double sum = 0;
    for (std::size_t k = 0; k < knots.size(); ++k) sum += rows[i][k] * increments[k];
    return sum;
  };
  std::vector<double> bulge(data.size(), 0);  // of the curve over the polyline, at the data
  RisingCurve best;
  for (int round = 0; round <= corrections; ++round) {
    std::vector<double> right;
    right.reserve(data.size());
    for (std::size_t i = 0; i < data.size(); ++i) right.push_back(data[i][1] - bulge[i] - straight(i, least));
    std::vector<double> increments = non_negative_least_squares(rows, right);
    for (std::size_t k = 0; k < knots.size(); ++k) increments[k] += least[k];
    RisingCurve fit{points_of(knots, increments), 0};
    const StressCurve curve(fit.points);
    double off = 0, size = 0;
    for (std::size_t i = 0; i < data.size(); ++i) {
      const double value = curve.at(data[i][0]).stress;
      bulge[i] = value - straight(i, increments);
      off += (value - data[i][1]) * (value - data[i][1]);
      size += data[i][1] * data[i][1];
    }
    fit.residual = std::sqrt(off / size);
    if (round == 0 || fit.residual < best.residual) best = fit;
  }
  return best;
}

}  // namespace muslin
