#include "textbook.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace muslin::bench {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }
std::size_t at(std::int64_t i) { return static_cast<std::size_t>(i); }

double dot(ConstVectors a, ConstVectors b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i].dot(b[i]);
  return sum;
}

Mat3 spring_hessian(const TextbookSpring& s, const Vec3& d, bool projected) {
  const double length = d.norm();
  const Vec3 n = length > 0 ? Vec3(d / length) : Vec3(Vec3::UnitX());
  double transverse = length > 0 ? 1 - s.rest_length / length : 0;
  if (projected) transverse = std::max(transverse, 0.0);
  const Mat3 along = n * n.transpose();
  return s.stiffness * (along + transverse * (Mat3::Identity() - along));
}

}  // namespace

TextbookSolver::TextbookSolver(TextbookProblem problem) : problem_(std::move(problem)) {
  const std::size_t count = problem_.masses.size();
  std::vector<std::vector<int>> neighbours(count);
  for (const TextbookSpring& s : problem_.springs) {
    neighbours[at(s.a)].push_back(s.b);
    neighbours[at(s.b)].push_back(s.a);
  }
  row_.assign(1, 0);
  diagonal_.resize(count);
  for (std::size_t v = 0; v < count; ++v) {
    neighbours[v].push_back(static_cast<int>(v));
    std::sort(neighbours[v].begin(), neighbours[v].end());
    for (int column : neighbours[v]) {
      if (column == static_cast<int>(v)) diagonal_[v] = static_cast<std::int64_t>(column_.size());
      column_.push_back(column);
    }
    row_.push_back(static_cast<std::int64_t>(column_.size()));
  }
  const auto find = [&](int row, int column) -> std::int64_t {
    const auto begin = column_.begin() + row_[at(row)], end = column_.begin() + row_[at(row) + 1];
    return std::lower_bound(begin, end, column) - column_.begin();
  };
  for (const TextbookSpring& s : problem_.springs) coupling_.push_back({find(s.a, s.b), find(s.b, s.a)});
  blocks_.resize(column_.size());
  inverse_diagonal_.resize(count);
  for (auto* vector : {&r_, &z_, &p_, &q_}) vector->resize(count);
}

double TextbookSolver::energy(ConstVectors x, ConstVectors predicted) const {
  double sum = 0;
  for (std::size_t v = 0; v < x.size(); ++v)
    sum += 0.5 * problem_.masses[v] * (x[v] - predicted[v]).squaredNorm();
  const double dt2 = problem_.dt * problem_.dt;
  for (const TextbookSpring& s : problem_.springs) {
    const double stretch = (x[at(s.a)] - x[at(s.b)]).norm() - s.rest_length;
    sum += dt2 * 0.5 * s.stiffness * stretch * stretch;
  }
  return sum;
}

void TextbookSolver::gradient(ConstVectors x, ConstVectors predicted, Vectors g) const {
  for (std::size_t v = 0; v < x.size(); ++v) g[v] = problem_.masses[v] * (x[v] - predicted[v]);
  const double dt2 = problem_.dt * problem_.dt;
  for (const TextbookSpring& s : problem_.springs) {
    const Vec3 d = x[at(s.a)] - x[at(s.b)];
    const double length = d.norm();
    if (length == 0) continue;
    const Vec3 force = dt2 * s.stiffness * (1 - s.rest_length / length) * d;
    g[at(s.a)] += force;
    g[at(s.b)] -= force;
  }
  for (std::size_t v = 0; v < x.size(); ++v)
    if (problem_.fixed[v]) g[v].setZero();
}

void TextbookSolver::assemble(ConstVectors x, bool projected) {
  std::fill(blocks_.begin(), blocks_.end(), Mat3::Zero());
  for (std::size_t v = 0; v < x.size(); ++v)
    blocks_[at(diagonal_[v])] = problem_.masses[v] * Mat3::Identity();
  const double dt2 = problem_.dt * problem_.dt;
  for (std::size_t i = 0; i < problem_.springs.size(); ++i) {
    const TextbookSpring& s = problem_.springs[i];
    const Mat3 h = dt2 * spring_hessian(s, x[at(s.a)] - x[at(s.b)], projected);
    blocks_[at(diagonal_[at(s.a)])] += h;
    blocks_[at(diagonal_[at(s.b)])] += h;
    blocks_[at(coupling_[i][0])] -= h;
    blocks_[at(coupling_[i][1])] -= h;
  }
  for (std::size_t v = 0; v < x.size(); ++v) inverse_diagonal_[v] = blocks_[at(diagonal_[v])].inverse();
}

void TextbookSolver::multiply(ConstVectors p, Vectors y) const {
  for (std::size_t v = 0; v < p.size(); ++v) {
    Vec3 sum = Vec3::Zero();
    if (!problem_.fixed[v])
      for (std::size_t i = at(row_[v]); i < at(row_[v + 1]); ++i) sum += blocks_[i] * p[at(column_[i])];
    y[v] = sum;
  }
}

int TextbookSolver::conjugate_gradients(ConstVectors rhs, double forcing, const GiveUp& give_up,
                                        Vectors solution) {
  const std::size_t count = rhs.size();
  std::fill(solution.begin(), solution.end(), Vec3::Zero());
  std::copy(rhs.begin(), rhs.end(), r_.begin());
  for (std::size_t v = 0; v < count; ++v) p_[v] = z_[v] = inverse_diagonal_[v] * r_[v];
  const double goal = forcing * forcing * dot(rhs, rhs);
  double rz = dot(r_, z_);
  int iterations = 0;
  while (dot(r_, r_) > goal && iterations < 20000 && !give_up()) {
    multiply(p_, q_);
    const double curvature = dot(p_, q_);
    if (curvature <= 0) break;
    const double alpha = rz / curvature;
    for (std::size_t v = 0; v < count; ++v) {
      solution[v] += alpha * p_[v];
      r_[v] -= alpha * q_[v];
      z_[v] = inverse_diagonal_[v] * r_[v];
    }
    const double next = dot(r_, z_);
    const double beta = next / rz;
    rz = next;
    for (std::size_t v = 0; v < count; ++v) p_[v] = z_[v] + beta * p_[v];
    ++iterations;
  }
  return iterations;
}

std::vector<Vec3> TextbookSolver::inertial_prediction(ConstVectors x, ConstVectors v) const {
  std::vector<Vec3> predicted(x.size());
  const double dt = problem_.dt;
  for (std::size_t i = 0; i < x.size(); ++i) predicted[i] = x[i] + dt * v[i] + dt * dt * problem_.gravity;
  return predicted;
}

double TextbookSolver::residual(ConstVectors g) const {
  double largest = 0;
  for (std::size_t i = 0; i < g.size(); ++i)
    largest = std::max(largest, g[i].norm() / (problem_.masses[i] * problem_.dt * problem_.dt));
  return largest;
}

TextbookMeasure TextbookSolver::measure(ConstVectors x, ConstVectors v, ConstVectors result) const {
  const std::vector<Vec3> predicted = inertial_prediction(x, v);
  std::vector<Vec3> g(x.size());
  gradient(result, predicted, g);
  return {energy(result, predicted), residual(g)};
}

TextbookReport TextbookSolver::implicit_euler(double forcing, const Watch& watch, const GiveUp& give_up,
                                              std::vector<Vec3>& x, std::vector<Vec3>& v) {
  const std::size_t count = x.size();
  const double dt = problem_.dt;
  const std::vector<Vec3> predicted = inertial_prediction(x, v);
  std::vector<Vec3> now(x), g(count), direction(count), trial(count);
  for (std::size_t i = 0; i < count; ++i)
    if (!problem_.fixed[i]) now[i] = predicted[i];
  TextbookReport report;
  for (; report.newton_iterations < 1000 && !give_up(); ++report.newton_iterations) {
    gradient(now, predicted, g);
    report.residual = residual(g);
    if (watch(now, report)) {
      report.converged = true;
      break;
    }
    assemble(now, true);
    for (Vec3& value : g) value = -value;
    report.linear_iterations += conjugate_gradients(g, forcing, give_up, direction);
    const double slope = -dot(g, direction);
    const double start = energy(now, predicted);
    double step = 1;
    for (int halvings = 0; halvings < 40; ++halvings, step *= 0.5) {
      for (std::size_t i = 0; i < count; ++i) trial[i] = now[i] + step * direction[i];
      if (energy(trial, predicted) <= start + 1e-4 * step * slope + 1e-14 * std::abs(start)) break;
    }
    std::swap(now, trial);
  }
  for (std::size_t i = 0; i < count; ++i) {
    v[i] = (now[i] - x[i]) / dt;
    x[i] = now[i];
  }
  return report;
}

TextbookReport TextbookSolver::linearly_implicit_euler(double forcing, std::vector<Vec3>& x,
                                                       std::vector<Vec3>& v) {
  const std::size_t count = x.size();
  // The Newton step from x_n on E: the gradient there is −M (dt v + dt² a_gravity) + dt² ∂W/∂x.
  const std::vector<Vec3> predicted = inertial_prediction(x, v);
  std::vector<Vec3> g(count), direction(count);
  gradient(x, predicted, g);
  assemble(x, false);
  for (Vec3& value : g) value = -value;
  TextbookReport report;
  report.newton_iterations = 1;
  report.linear_iterations = conjugate_gradients(g, forcing, [] { return false; }, direction);
  report.converged = true;
  for (std::size_t i = 0; i < count; ++i) {
    x[i] += direction[i];
    v[i] = direction[i] / problem_.dt;
  }
  return report;
}

std::size_t TextbookSolver::bytes() const {
  return blocks_.size() * sizeof(Mat3) + column_.size() * sizeof(int) + row_.size() * sizeof(std::int64_t) +
         inverse_diagonal_.size() * sizeof(Mat3) + 4 * r_.size() * sizeof(Vec3);
}

}  // namespace muslin::bench
