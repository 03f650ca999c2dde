// One battery of checks for every Potential: derivatives against finite differences, symmetry, rest state,
// rigid motions, preconditioner blocks, same bits for any thread count. A failure names the check and the
// numbers; wrap calls in SCOPED_TRACE to name the potential.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <random>
#include <vector>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "muslin/core/parallel.hpp"
#include "muslin/potential/potential.hpp"

namespace muslin::test {

/// #V by 3 components, uniform in [−size, size].
inline std::vector<Vec3> random_vectors(std::size_t count, double size, std::uint32_t seed) {
  std::mt19937 engine(seed);
  std::vector<Vec3> result(count);
  for (Vec3& v : result) {
    for (int c = 0; c < 3; ++c) v[c] = size * (2.0 * engine() / 4294967295.0 - 1.0);
  }
  return result;
}

inline std::vector<Vec3> sum(ConstVectors x, double t, ConstVectors d) {
  std::vector<Vec3> result(x.begin(), x.end());
  for (std::size_t v = 0; v < result.size(); ++v) result[v] += t * d[v];
  return result;
}

inline double inner(ConstVectors a, ConstVectors b) {
  double result = 0;
  for (std::size_t v = 0; v < a.size(); ++v) result += a[v].dot(b[v]);
  return result;
}

inline double norm(ConstVectors a) { return std::sqrt(inner(a, a)); }

inline std::vector<Vec3> gradient(const Potential& potential, ConstVectors x) {
  std::vector<Vec3> g(x.size(), Vec3::Zero());
  potential.add_gradient(x, g);
  return g;
}

inline std::vector<Vec3> hessian_product(const Potential& potential, ConstVectors x, ConstVectors p) {
  std::vector<Vec3> y(x.size(), Vec3::Zero());
  potential.add_hessian_product(x, p, y);
  return y;
}

/// ε-sweep: the central difference of the value along a random direction comes within `tolerance` of the
/// gradient, relative to what a direction of this size sees of it, for some ε.
inline void expect_gradient_matches_value(const Potential& potential, ConstVectors x, double size = 1,
                                          double tolerance = 1e-7) {
  for (std::uint32_t seed = 1; seed <= 3; ++seed) {
    const std::vector<Vec3> d = random_vectors(x.size(), 1, seed);
    const std::vector<Vec3> g = gradient(potential, x);
    const double exact = inner(g, d);
    const double scale = std::max(norm(g) * norm(d) / std::sqrt(3.0 * static_cast<double>(x.size())), 1e-12);
    double best = INFINITY;
    for (double epsilon = 1e-2 * size; epsilon > 1e-8 * size; epsilon /= 4) {
      const double difference =
          (potential.value(sum(x, epsilon, d)) - potential.value(sum(x, -epsilon, d))) / (2 * epsilon);
      best = std::min(best, std::abs(difference - exact) / scale);
    }
    EXPECT_LE(best, tolerance) << "gradient against the value's central difference, direction " << seed
                               << ", g·d = " << exact;
  }
}

/// ε-sweep of the Hessian product against central differences of the gradient.
inline void expect_hessian_matches_gradient(const Potential& potential, ConstVectors x, double size = 1,
                                            double tolerance = 1e-6) {
  for (std::uint32_t seed = 11; seed <= 13; ++seed) {
    const std::vector<Vec3> d = random_vectors(x.size(), 1, seed);
    const std::vector<Vec3> exact = hessian_product(potential, x, d);
    const double scale = std::max(norm(exact), 1e-12);
    double best = INFINITY;
    for (double epsilon = 1e-2 * size; epsilon > 1e-8 * size; epsilon /= 4) {
      std::vector<Vec3> difference = gradient(potential, sum(x, epsilon, d));
      const std::vector<Vec3> backward = gradient(potential, sum(x, -epsilon, d));
      for (std::size_t v = 0; v < difference.size(); ++v) {
        difference[v] = (difference[v] - backward[v]) / (2 * epsilon) - exact[v];
      }
      best = std::min(best, norm(difference) / scale);
    }
    EXPECT_LE(best, tolerance) << "Hessian product against the gradient's central difference, direction "
                               << seed << ", |H d| = " << norm(exact);
  }
}

inline void expect_hessian_symmetric(const Potential& potential, ConstVectors x) {
  for (std::uint32_t seed = 21; seed <= 23; ++seed) {
    const std::vector<Vec3> p = random_vectors(x.size(), 1, seed);
    const std::vector<Vec3> q = random_vectors(x.size(), 1, seed + 100);
    const std::vector<Vec3> hp = hessian_product(potential, x, p);
    const std::vector<Vec3> hq = hessian_product(potential, x, q);
    EXPECT_NEAR(inner(q, hp), inner(p, hq), 1e-11 * (norm(hp) * norm(q) + norm(hq) * norm(p)))
        << "qᵀHp against pᵀHq";
  }
}

/// Nothing is stored and nothing pulls at rest. `force` is the size a force has elsewhere [N].
inline void expect_rest_state(const Potential& potential, ConstVectors rest, double force = 1) {
  EXPECT_NEAR(potential.value(rest), 0, 1e-12 * force) << "energy at rest";
  const std::vector<Vec3> g = gradient(potential, rest);
  for (std::size_t v = 0; v < g.size(); ++v) {
    EXPECT_LE(g[v].norm(), 1e-10 * force) << "force at rest on vertex " << v;
  }
}

/// Moving and turning the whole body changes no energy, turns the forces along, and the forces have neither
/// sum nor moment.
inline void expect_rigid_motion_invariant(const Potential& potential, ConstVectors x) {
  const Mat3 turn = Eigen::AngleAxisd(1.1, Vec3(0.3, -0.5, 0.8).normalized()).toRotationMatrix();
  const Vec3 shift(0.7, -1.3, 2.1);
  std::vector<Vec3> moved(x.begin(), x.end());
  for (Vec3& p : moved) p = turn * p + shift;
  const double w = potential.value(x);
  EXPECT_NEAR(potential.value(moved), w, 1e-10 * std::max(1e-12, std::abs(w)))
      << "energy after a rigid motion";
  const std::vector<Vec3> g = gradient(potential, x);
  const std::vector<Vec3> g_moved = gradient(potential, moved);
  const double scale = std::max(norm(g), 1e-12);
  Vec3 force = Vec3::Zero();
  Vec3 moment = Vec3::Zero();
  double lever = 1;
  for (std::size_t v = 0; v < g.size(); ++v) {
    EXPECT_LE((g_moved[v] - turn * g[v]).norm(), 1e-9 * scale) << "force after a rigid motion, vertex " << v;
    force += g[v];
    moment += x[v].cross(g[v]);
    lever = std::max(lever, x[v].norm());
  }
  const double count = std::sqrt(static_cast<double>(x.size()));
  EXPECT_LE(force.norm(), 1e-11 * scale * count) << "internal forces must add up to zero";
  EXPECT_LE(moment.norm(), 1e-11 * scale * count * lever) << "internal moments must add up to zero";
}

inline void expect_diagonal_blocks_positive_semidefinite(const Potential& potential, ConstVectors x) {
  std::vector<Mat3> blocks(x.size(), Mat3::Zero());
  potential.add_diagonal_blocks(x, blocks);
  for (std::size_t v = 0; v < blocks.size(); ++v) {
    ASSERT_TRUE(blocks[v].allFinite()) << "block of vertex " << v;
    const double scale = std::max(blocks[v].norm(), 1e-300);
    EXPECT_LE((blocks[v] - blocks[v].transpose()).norm(), 1e-13 * scale) << "block of vertex " << v;
    const Eigen::SelfAdjointEigenSolver<Mat3> eigen(blocks[v], Eigen::EigenvaluesOnly);
    EXPECT_GE(eigen.eigenvalues()[0], -1e-12 * scale) << "block of vertex " << v;
  }
}

/// add_… adds to what is there instead of overwriting it.
inline void expect_adds(const Potential& potential, ConstVectors x) {
  const std::vector<Vec3> before = random_vectors(x.size(), 1, 31);
  const std::vector<Vec3> p = random_vectors(x.size(), 1, 32);
  std::vector<Vec3> g = before;
  potential.add_gradient(x, g);
  std::vector<Vec3> y = before;
  potential.add_hessian_product(x, p, y);
  std::vector<Mat3> blocks(x.size(), Mat3::Identity());
  potential.add_diagonal_blocks(x, blocks);
  std::vector<Mat3> alone(x.size(), Mat3::Zero());
  potential.add_diagonal_blocks(x, alone);
  const std::vector<Vec3> g_alone = gradient(potential, x);
  const std::vector<Vec3> y_alone = hessian_product(potential, x, p);
  const double tolerance = 1e-12 * (1 + norm(g_alone) + norm(y_alone));
  for (std::size_t v = 0; v < x.size(); ++v) {
    EXPECT_LE((g[v] - before[v] - g_alone[v]).norm(), tolerance) << "add_gradient, vertex " << v;
    EXPECT_LE((y[v] - before[v] - y_alone[v]).norm(), tolerance) << "add_hessian_product, vertex " << v;
    EXPECT_LE((blocks[v] - Mat3::Identity() - alone[v]).norm(), 1e-12 * (1 + alone[v].norm()))
        << "add_diagonal_blocks, vertex " << v;
  }
}

/// One pass gives the bits of two.
inline void expect_one_pass_is_two(const Potential& potential, ConstVectors x) {
  std::vector<Vec3> g(x.size(), Vec3::Zero());
  EXPECT_EQ(potential.add_gradient_and_value(x, g), potential.value(x));
  EXPECT_EQ(g, gradient(potential, x));
}

/// Same bits on one thread and on several.
inline void expect_same_bits_for_any_thread_count(const Potential& potential, ConstVectors x) {
  const std::vector<Vec3> p = random_vectors(x.size(), 1, 41);
  std::vector<double> values[2];
  for (const int threads : {1, 4}) {
    set_thread_count(threads);
    std::vector<double>& out = values[threads == 1 ? 0 : 1];
    out.push_back(potential.value(x));
    for (const Vec3& g : gradient(potential, x)) out.insert(out.end(), g.data(), g.data() + 3);
    for (const Vec3& y : hessian_product(potential, x, p)) out.insert(out.end(), y.data(), y.data() + 3);
    std::vector<Mat3> blocks(x.size(), Mat3::Zero());
    potential.add_diagonal_blocks(x, blocks);
    for (const Mat3& b : blocks) out.insert(out.end(), b.data(), b.data() + 9);
  }
  set_thread_count(0);
  EXPECT_EQ(0, std::memcmp(values[0].data(), values[1].data(), values[0].size() * sizeof(double)));
}

/// Checks the properties of every potential, at a deformed x. `size` is the length over which W changes much
/// [m].
inline void expect_potential_is_sound(const Potential& potential, ConstVectors x, double size = 1) {
  expect_gradient_matches_value(potential, x, size);
  expect_hessian_matches_gradient(potential, x, size);
  expect_hessian_symmetric(potential, x);
  expect_diagonal_blocks_positive_semidefinite(potential, x);
  expect_adds(potential, x);
  expect_one_pass_is_two(potential, x);
  expect_same_bits_for_any_thread_count(potential, x);
}

/// Checks the further properties of every elastic energy: rest state and rigid motions.
inline void expect_elastic_energy_is_sound(const Potential& potential, ConstVectors rest, ConstVectors x,
                                           double size = 1) {
  expect_potential_is_sound(potential, x, size);
  expect_rest_state(potential, rest, norm(gradient(potential, x)));
  expect_rigid_motion_invariant(potential, x);
}

}  // namespace muslin::test
