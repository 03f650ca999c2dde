#include "muslin/energy/spring_energy.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace muslin {
namespace {

constexpr double shortest = 1e-12;  // of the rest length: below, a spring has no direction

/// ∂²W/∂z² = axial n nᵀ + transverse (I − n nᵀ).
struct Curvature {
  Vec3 n;
  double axial = 0;
  double transverse = 0;

  Vec3 operator*(const Vec3& d) const { return transverse * d + ((axial - transverse) * n.dot(d)) * n; }
};

Curvature curvature(const Vec3& z, double k, double rest) {
  const double length = z.norm();
  if (!(length > shortest * rest)) return {Vec3::UnitX(), k, k};
  return {z / length, k, k * (1 - rest / length)};
}

Vec3 force(const Vec3& z, double k, double rest) {
  const double length = z.norm();
  if (!(length > shortest * rest)) return Vec3::Zero();
  return (k * (1 - rest / length)) * z;
}

/// y_b += f(i), y_a −= f(i) over the springs of all pieces.
template <class Force>
void add_pairs(const SpringSlabs& slabs, Vectors y, const Force& f) {
  slabs.for_each_piece(
      [&](const SpringPiece& piece) {
        for (int i = 0; i < piece.length; ++i) {
          const Vec3 pair = f(piece, i);
          y[static_cast<std::size_t>(piece.a + i)] -= pair;
          y[static_cast<std::size_t>(piece.b + i)] += pair;
        }
      },
      [&](const SpringPiece& piece) {
        for (int i = 0; i < piece.length; ++i) y[static_cast<std::size_t>(piece.a + i)] -= f(piece, i);
      },
      [&](const SpringPiece& piece) {
        for (int i = 0; i < piece.length; ++i) y[static_cast<std::size_t>(piece.b + i)] += f(piece, i);
      });
}

/// blocks of both ends += f(i) over the springs of all pieces.
template <class Block>
void add_blocks(const SpringSlabs& slabs, std::span<Mat3> blocks, const Block& f) {
  slabs.for_each_piece(
      [&](const SpringPiece& piece) {
        for (int i = 0; i < piece.length; ++i) {
          const Mat3 block = f(piece, i);
          blocks[static_cast<std::size_t>(piece.a + i)] += block;
          blocks[static_cast<std::size_t>(piece.b + i)] += block;
        }
      },
      [&](const SpringPiece& piece) {
        for (int i = 0; i < piece.length; ++i) blocks[static_cast<std::size_t>(piece.a + i)] += f(piece, i);
      },
      [&](const SpringPiece& piece) {
        for (int i = 0; i < piece.length; ++i) blocks[static_cast<std::size_t>(piece.b + i)] += f(piece, i);
      });
}

Vec3 difference(ConstVectors x, const SpringPiece& piece, int i) {
  return x[static_cast<std::size_t>(piece.b + i)] - x[static_cast<std::size_t>(piece.a + i)];
}

}  // namespace

SpringEnergy::SpringEnergy(const Springs& springs, double width, const std::array<double, 3>& moduli,
                           std::vector<float> weights)
    : weights_(std::move(weights)), slabs_(springs), count_(springs.count) {
  assert(width > 0);
  assert(weights_.empty() || weights_.size() == static_cast<std::size_t>(count_));
  for (const SpringDirection& direction : springs.directions) {
    types_.push_back({width * direction.offset.cast<double>().norm(),
                      width * moduli[static_cast<std::size_t>(direction.kind)]});
  }
}

double SpringEnergy::value(ConstVectors x) const {
  return slabs_.sum(0.0, [&](const SpringPiece& piece) {
    const double rest = rest_length(piece.direction);
    double sum = 0;
    for (int i = 0; i < piece.length; ++i) {
      const double stretch = difference(x, piece, i).norm() - rest;
      sum += 0.5 * stiffness(piece.direction, piece.first + i) * stretch * stretch;
    }
    return sum;
  });
}

void SpringEnergy::add_gradient(ConstVectors x, Vectors g) const {
  add_pairs(slabs_, g, [&](const SpringPiece& piece, int i) {
    return force(difference(x, piece, i), stiffness(piece.direction, piece.first + i),
                 rest_length(piece.direction));
  });
}

void SpringEnergy::add_hessian_product(ConstVectors x, ConstVectors p, Vectors y) const {
  add_pairs(slabs_, y, [&](const SpringPiece& piece, int i) -> Vec3 {
    return curvature(difference(x, piece, i), stiffness(piece.direction, piece.first + i),
                     rest_length(piece.direction)) *
           difference(p, piece, i);
  });
}

void SpringEnergy::add_diagonal_blocks(ConstVectors x, std::span<Mat3> blocks) const {
  add_blocks(slabs_, blocks, [&](const SpringPiece& piece, int i) -> Mat3 {
    const Curvature c = curvature(difference(x, piece, i), stiffness(piece.direction, piece.first + i),
                                  rest_length(piece.direction));
    const double transverse = std::max(0.0, c.transverse);
    Mat3 block = ((c.axial - transverse) * c.n) * c.n.transpose();
    block.diagonal().array() += transverse;
    return block;
  });
}

double SpringEnergy::max_stretch(ConstVectors x) const {
  struct Largest {
    double value = 0;
    Largest operator+(const Largest& other) const { return {std::max(value, other.value)}; }
  };
  if (count_ == 0) return 1;
  return slabs_
      .sum(Largest{},
           [&](const SpringPiece& piece) {
             Largest largest;
             for (int i = 0; i < piece.length; ++i) {
               largest.value = std::max(largest.value, difference(x, piece, i).squaredNorm());
             }
             return Largest{std::sqrt(largest.value) / rest_length(piece.direction)};
           })
      .value;
}

namespace {

/// W = Σ ½ c (nᵀ(z − z_anchor))², n of the predicted positions; c = β k / dt.
class Dashpots : public Potential {
 public:
  Dashpots(std::shared_ptr<const SpringEnergy> springs, double factor, std::vector<Vec3> anchor,
           std::vector<Vec3> predicted)
      : springs_(std::move(springs)),
        factor_(factor),
        anchor_(std::move(anchor)),
        predicted_(std::move(predicted)) {}

  double value(ConstVectors x) const override {
    return springs_->slabs().sum(0.0, [&](const SpringPiece& piece) {
      double sum = 0;
      for (int i = 0; i < piece.length; ++i) {
        const double rate = direction(piece, i).dot(difference(x, piece, i) - difference(anchor_, piece, i));
        sum += 0.5 * coefficient(piece, i) * rate * rate;
      }
      return sum;
    });
  }
  void add_gradient(ConstVectors x, Vectors g) const override {
    add_pairs(springs_->slabs(), g, [&](const SpringPiece& piece, int i) -> Vec3 {
      const Vec3 n = direction(piece, i);
      return (coefficient(piece, i) * n.dot(difference(x, piece, i) - difference(anchor_, piece, i))) * n;
    });
  }
  void add_hessian_product(ConstVectors, ConstVectors p, Vectors y) const override {
    add_pairs(springs_->slabs(), y, [&](const SpringPiece& piece, int i) -> Vec3 {
      const Vec3 n = direction(piece, i);
      return (coefficient(piece, i) * n.dot(difference(p, piece, i))) * n;
    });
  }
  void add_diagonal_blocks(ConstVectors, std::span<Mat3> blocks) const override {
    add_blocks(springs_->slabs(), blocks, [&](const SpringPiece& piece, int i) -> Mat3 {
      const Vec3 n = direction(piece, i);
      return (coefficient(piece, i) * n) * n.transpose();
    });
  }

 private:
  double coefficient(const SpringPiece& piece, int i) const {
    return factor_ * springs_->stiffness(piece.direction, piece.first + i);
  }
  Vec3 direction(const SpringPiece& piece, int i) const {
    const Vec3 z = difference(predicted_, piece, i);
    const double length = z.norm();
    if (!(length > shortest * springs_->rest_length(piece.direction))) return Vec3::Zero();
    return z / length;
  }

  std::shared_ptr<const SpringEnergy> springs_;
  double factor_;
  std::vector<Vec3> anchor_;
  std::vector<Vec3> predicted_;
};

}  // namespace

SpringDamping::SpringDamping(std::shared_ptr<const SpringEnergy> springs, double beta)
    : springs_(std::move(springs)), beta_(beta) {}

std::unique_ptr<Potential> SpringDamping::potential(const StepContext& step) const {
  if (beta_ == 0) return nullptr;
  std::vector<Vec3> predicted(step.positions.begin(), step.positions.end());
  for (std::size_t v = 0; v < predicted.size(); ++v) {
    predicted[v] += (step.velocity_time - step.time_begin) * step.velocities[v];
  }
  return std::make_unique<Dashpots>(springs_, beta_ / step.dt, step.anchor, std::move(predicted));
}

}  // namespace muslin
