#include "muslin/solver/multilevel.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/LU>

#include "muslin/core/index.hpp"
#include "muslin/core/parallel.hpp"

namespace muslin {
namespace {

constexpr std::size_t direct_limit = 48;  // nodes of the coarsest level
constexpr int sweeps_without = 8;         // there, where it has more

Float4 operator*(const Block3& b, const Float4& v) { return b.x * v[0] + b.y * v[1] + b.z * v[2]; }

/// A sweep goes through chunks of so many nodes side by side. Within a chunk it is Gauss-Seidel's, between
/// chunks Jacobi's.
constexpr std::size_t chunk = 512;

std::size_t chunk_begin(std::size_t row) { return row / chunk * chunk; }

/// Σ A x over entries k = begin … end − 1.
Float4 times(const BlockPattern& pattern, const BlockMatrix& matrix, int begin, int end, const Float4* x) {
  Float4 sum = {0, 0, 0, 0}, further = {0, 0, 0, 0};
  for (int k = begin; k < end; ++k) {
    const Float4* const a = matrix.block(k);
    const Float4& v = x[at(pattern.columns()[at(k)])];
    sum += a[0] * v[0] + a[1] * v[1];
    further += a[2] * v[2];
  }
  return sum + further;
}

/// Returns the Frobenius norm of a block.
float norm(const Float4* a) {
  const Float4 squares = a[0] * a[0] + a[1] * a[1] + a[2] * a[2];
  return std::sqrt(squares[0] + squares[1] + squares[2]);
}

/// Returns the inverse of a block with `more` on its diagonal; zero for a node whose points are all held.
Block3 inverse(const Float4* a, float more) {
  if (!(a[0][0] > 0)) return Block3{};
  Mat3 m;
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) m(r, c) = static_cast<double>(a[c][r]);
  m.diagonal().array() += static_cast<double>(more);
  const Mat3 n = m.inverse();
  const auto column = [&](int c) {
    return Float4{static_cast<float>(n(0, c)), static_cast<float>(n(1, c)), static_cast<float>(n(2, c)), 0};
  };
  return {column(0), column(1), column(2)};
}

}  // namespace

Multilevel::Multilevel(std::shared_ptr<const BlockPattern> pattern, ConstVectors points,
                       std::span<const int> components, std::vector<double> spacings) {
  std::vector<Vec3> x(points.begin(), points.end());
  std::vector<int> parts(components.begin(), components.end());
  for (;;) {
    Level& level = levels_.emplace_back();
    level.pattern = std::move(pattern);
    const std::size_t count = x.size();
    level.inverse.resize(count), level.added.resize(count);
    level.b.resize(count), level.x.resize(count), level.before.resize(count);
    level.inside.resize(count);
    for (std::size_t row = 0; row < count; ++row) {
      const int* const columns = level.pattern->columns().data();
      const int* const first = columns + level.pattern->first()[row];
      const int* const last = columns + level.pattern->first()[row + 1];
      const auto begin = static_cast<int>(chunk_begin(row)), end = static_cast<int>(chunk_begin(row) + chunk);
      level.inside[row] = {static_cast<int>(std::lower_bound(first, last, begin) - columns),
                           static_cast<int>(std::lower_bound(first, last, end) - columns)};
    }
    has_direct_ = count <= direct_limit;
    if (has_direct_) return;
    level.grid = BackgroundGrid(x, parts, spacings);
    if (4 * level.grid.node_count() > 3 * count) {  // as coarse as it gets
      level.grid = {};
      return;
    }
    std::vector<std::pair<int, int>> neighbours;
    for (std::size_t row = 0; row < count; ++row) {
      for (int k = level.pattern->first()[row]; k < level.pattern->first()[row + 1]; ++k) {
        const auto column = at(level.pattern->columns()[at(k)]);
        if (column < row) neighbours.emplace_back(level.grid.point(row).cell, level.grid.point(column).cell);
      }
    }
    level.coarser = GridMatrix(level.grid, std::move(neighbours));
    level.half.resize(3 * level.coarser.pattern()->block_count());
    pattern = level.coarser.pattern();
    x = level.grid.nodes();
    parts = level.grid.node_components();
    for (double& spacing : spacings) spacing *= 2;
  }
}

void Multilevel::prepare() {
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    Level& level = levels_[l];
    parallel_for(level.inverse.size(), chunk, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        float norms = 0;
        for (int k = level.pattern->first()[i]; k < level.inside[i][0]; ++k)
          norms += norm(level.matrix.block(k));
        for (int k = level.inside[i][1]; k < level.pattern->first()[i + 1]; ++k)
          norms += norm(level.matrix.block(k));
        level.added[i] = norms / 2;
        level.inverse[i] = inverse(level.matrix.block(level.pattern->diagonal()[i]), level.added[i]);
      }
    });
    if (l + 1 < levels_.size()) make_coarser_matrix(l);
  }
  if (!has_direct_) return;
  const Level& last = levels_.back();
  const auto count = static_cast<Eigen::Index>(last.b.size());
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(3 * count, 3 * count);
  for (Eigen::Index row = 0; row < count; ++row) {
    for (int k = last.pattern->first()[at(row)]; k < last.pattern->first()[at(row) + 1]; ++k) {
      for (Eigen::Index c = 0; c < 3; ++c)
        for (Eigen::Index r = 0; r < 3; ++r)
          dense(3 * row + r, 3 * last.pattern->columns()[at(k)] + c) =
              static_cast<double>(last.matrix.block(k)[c][r]);
    }
  }
  for (Eigen::Index i = 0; i < dense.rows(); ++i)
    if (!(dense(i, i) > 0)) dense(i, i) = 1;  // a node whose points are all held
  // Rounding in float may have destroyed definiteness.
  constexpr double rounding = 1e-6;
  dense.diagonal() *= 1 + rounding;
  direct_.compute(dense);
  for (double shift = rounding; direct_.info() != Eigen::Success && shift < 1; shift *= 10) {
    dense.diagonal() *= 1 + 10 * shift;
    direct_.compute(dense);
  }
}

void Multilevel::make_coarser_matrix(std::size_t l) {
  Level& level = levels_[l];
  std::fill(level.half.begin(), level.half.end(), Float4{0, 0, 0, 0});
  for (std::size_t row = 0; row < level.b.size(); ++row) {
    const int diagonal = level.pattern->diagonal()[row];
    const Float4* const a = level.matrix.block(diagonal);
    add_block(level.grid, level.coarser, level.grid.point(row), {a[0], a[1], a[2]}, level.half.data());
    RowOfBlocks sums(level.grid, level.coarser, level.grid.point(row), level.half.data());
    for (int k = level.pattern->first()[row]; k < diagonal; ++k)
      sums.add(level.grid.point(at(level.pattern->columns()[at(k)])), level.matrix.block(k));
  }
  levels_[l + 1].matrix.reset(*level.coarser.pattern());
  level.coarser.finish(level.half.data(), levels_[l + 1].matrix);
}

void Multilevel::solve(std::size_t l) {
  Level& level = levels_[l];
  const std::size_t count = level.b.size();
  const Float4* const b = level.b.data();
  Float4* const x = level.x.data();
  const bool last = l + 1 == levels_.size();
  if (last && has_direct_) {
    Eigen::VectorXd v(3 * static_cast<Eigen::Index>(count));
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t c = 0; c < 3; ++c)
        v[static_cast<Eigen::Index>(3 * i + c)] = static_cast<double>(b[i][static_cast<int>(c)]);
    v = direct_.solve(v);
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t c = 0; c < 3; ++c)
        x[i][static_cast<int>(c)] = static_cast<float>(v[static_cast<Eigen::Index>(3 * i + c)]);
    return;
  }
  if (last) {
    std::fill(level.x.begin(), level.x.end(), Float4{0, 0, 0, 0});
    for (int n = 0; n < sweeps_without; ++n) {
      sweep(level, Direction::forward);
      sweep(level, Direction::backward);
    }
    return;
  }
  const BlockPattern& pattern = *level.pattern;
  // Forward sweep from zero. b − A x is then Λ x less the product with all entries that the sweep did not
  // use.
  parallel_for(count, chunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      x[i] = level.inverse[i] *
             (b[i] - times(pattern, level.matrix, level.inside[i][0], pattern.diagonal()[i], x));
    }
  });
  std::vector<Float4>& residual = level.before;
  parallel_for(count, chunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      residual[i] = level.added[i] * x[i] -
                    times(pattern, level.matrix, pattern.first()[i], level.inside[i][0], x) -
                    times(pattern, level.matrix, pattern.diagonal()[i] + 1, pattern.first()[i + 1], x);
    }
  });
  Level& coarser = levels_[l + 1];
  std::fill(coarser.b.begin(), coarser.b.end(), Float4{0, 0, 0, 0});
  for (std::size_t i = 0; i < count; ++i) {
    float w[8];
    const BackgroundGrid::Cell& cell = level.grid.weights(level.grid.point(i), w);
    for (int k = 0; k < cell.count; ++k) coarser.b[at(cell.nodes[at(k)])] += w[k] * residual[i];
  }
  solve(l + 1);
  parallel_for(count, chunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      float w[8];
      const BackgroundGrid::Cell& cell = level.grid.weights(level.grid.point(i), w);
      for (int k = 0; k < cell.count; ++k) x[i] += w[k] * coarser.x[at(cell.nodes[at(k)])];
    }
  });
  sweep(level, Direction::backward);
}

void Multilevel::sweep(Level& level, Direction direction) {
  const BlockPattern& pattern = *level.pattern;
  level.before = level.x;
  Float4* const x = level.x.data();
  const Float4* const before = level.before.data();
  parallel_for(level.b.size(), chunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      const std::size_t i = direction == Direction::forward ? n : begin + end - 1 - n;
      const auto [inside, after] = level.inside[i];
      const int diagonal = pattern.diagonal()[i];
      const Float4 others = times(pattern, level.matrix, pattern.first()[i], inside, before) +
                            times(pattern, level.matrix, inside, diagonal, x) +
                            times(pattern, level.matrix, diagonal + 1, after, x) +
                            times(pattern, level.matrix, after, pattern.first()[i + 1], before);
      x[i] = level.inverse[i] * (level.b[i] - others + level.added[i] * before[i]);
    }
  });
}

std::size_t Multilevel::bytes() const {
  std::size_t bytes = 0;
  for (const Level& level : levels_) {
    bytes += level.matrix.bytes() + level.grid.bytes() + level.coarser.bytes() +
             level.inverse.capacity() * sizeof(Block3) +
             (level.b.capacity() + level.x.capacity() + level.before.capacity() + level.half.capacity()) *
                 sizeof(Float4) +
             level.added.capacity() * sizeof(float) + level.inside.capacity() * sizeof(level.inside[0]);
  }
  return bytes;
}

}  // namespace muslin
