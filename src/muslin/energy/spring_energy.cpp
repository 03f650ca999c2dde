#include "muslin/energy/spring_energy.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "muslin/core/parallel.hpp"
#include "muslin/core/vector_code.hpp"
#include "muslin/potential/linearization.hpp"

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

/// Runs of one b − a that are less than this many vertices apart become one: springs that are not there cost
/// as little as those that are, short loops cost more. Runs along x stay apart: they are the chains that the
/// preconditioner solves side by side.
constexpr int shortest_run = 64;
constexpr int longest_gap = 8;

/// Runs with a < b, by direction and then by a, close ones joined.
std::vector<CouplingRun> coupling_runs(const Springs& springs) {
  std::vector<CouplingRun> runs;
  for (const SpringRun& run : springs.runs) {
    const Vec3i& offset = springs.directions[static_cast<std::size_t>(run.direction)].offset;
    int axis = -1;
    for (int c = 0; c < 3; ++c)
      if (offset.cwiseAbs().sum() == 1 && offset[c] != 0) axis = c;
    const int a = std::min(run.a, run.b), b = std::max(run.a, run.b);
    if (!runs.empty()) {
      CouplingRun& last = runs.back();
      const int gap = a - last.a - last.length;
      if (last.kind == run.direction && last.b - last.a == b - a && gap >= 0 && gap <= longest_gap &&
          run.length < shortest_run && axis != 0) {
        last.length += gap + run.length;
        continue;
      }
    }
    runs.push_back({run.direction, axis, a, b, run.length});
  }
  return runs;
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
  int vertex_count = 0;
  for (const SpringRun& run : springs.runs)
    vertex_count = std::max({vertex_count, run.a + run.length, run.b + run.length});
  pattern_ = std::make_shared<const CouplingPattern>(coupling_runs(springs), vertex_count);
  if (weights_.empty() && pattern_->slot_count() == count_) return;
  slot_weights_.assign(static_cast<std::size_t>(pattern_->slot_count()), 0.0F);
  std::vector<std::vector<const CouplingPiece*>> pieces(types_.size());  // by kind, then a
  for (const CouplingPiece& piece : pattern_->pieces())
    pieces[static_cast<std::size_t>(piece.kind)].push_back(&piece);
  for (auto& of_kind : pieces)
    std::sort(of_kind.begin(), of_kind.end(), [](const auto* p, const auto* q) { return p->a < q->a; });
  for (const SpringRun& run : springs.runs) {
    const auto& of_kind = pieces[static_cast<std::size_t>(run.direction)];
    const int a = std::min(run.a, run.b);
    auto piece = std::upper_bound(of_kind.begin(), of_kind.end(), a,
                                  [](int v, const CouplingPiece* p) { return v < p->a; }) -
                 1;
    for (int i = 0; i < run.length; ++i) {
      while (a + i >= (*piece)->a + (*piece)->length) ++piece;
      slot_weights_[static_cast<std::size_t>((*piece)->slot + a + i - (*piece)->a)] =
          weights_.empty() ? 1.0F : weights_[static_cast<std::size_t>(run.first + i)];
    }
  }
}

namespace {

constexpr int chunk = 256;  // springs computed together: their forces stay in the first-level cache

/// k (1 − r/|z|) z of consecutive springs; nothing where a spring has no direction.
MUSLIN_VECTOR_CODE void spring_forces(const double* __restrict a, const double* __restrict b, double k,
                                      double rest, const float* __restrict weight, int n,
                                      double* __restrict fx, double* __restrict fy, double* __restrict fz) {
  for (int i = 0; i < n; ++i) {
    const double zx = b[3 * i] - a[3 * i], zy = b[3 * i + 1] - a[3 * i + 1], zz = b[3 * i + 2] - a[3 * i + 2];
    const double length = std::sqrt(zx * zx + zy * zy + zz * zz);
    const double k_i = weight != nullptr ? k * static_cast<double>(weight[i]) : k;
    const double f = length > shortest * rest ? k_i * (1 - rest / length) : 0.0;
    fx[i] = f * zx, fy[i] = f * zy, fz[i] = f * zz;
  }
}

/// g += sign f.
MUSLIN_VECTOR_CODE void add_forces(double sign, int n, const double* __restrict fx,
                                   const double* __restrict fy, const double* __restrict fz,
                                   double* __restrict g) {
  for (int i = 0; i < n; ++i) {
    g[3 * i] += sign * fx[i];
    g[3 * i + 1] += sign * fy[i];
    g[3 * i + 2] += sign * fz[i];
  }
}

/// ½ k (|z| − r)² of consecutive springs.
MUSLIN_VECTOR_CODE void spring_energies(const double* __restrict a, const double* __restrict b, double k,
                                        double rest, const float* __restrict weight, int n,
                                        double* __restrict w) {
  for (int i = 0; i < n; ++i) {
    const double zx = b[3 * i] - a[3 * i], zy = b[3 * i + 1] - a[3 * i + 1], zz = b[3 * i + 2] - a[3 * i + 2];
    const double stretch = std::sqrt(zx * zx + zy * zy + zz * zz) - rest;
    const double k_i = weight != nullptr ? k * static_cast<double>(weight[i]) : k;
    w[i] = 0.5 * k_i * stretch * stretch;
  }
}

}  // namespace

double SpringEnergy::value(ConstVectors x) const {
  return slabs_.sum(0.0, [&](const SpringPiece& piece) {
    const Type& type = types_[static_cast<std::size_t>(piece.direction)];
    alignas(64) double w[chunk];
    double sum = 0;
    for (int i = 0; i < piece.length; i += chunk) {
      const int n = std::min(chunk, piece.length - i);
      spring_energies(x[static_cast<std::size_t>(piece.a + i)].data(),
                      x[static_cast<std::size_t>(piece.b + i)].data(), type.stiffness, type.rest,
                      weights_.empty() ? nullptr : weights_.data() + piece.first + i, n, w);
      for (int l = 0; l < n; ++l) sum += w[l];
    }
    return sum;
  });
}

void SpringEnergy::add_gradient(ConstVectors x, Vectors g) const {
  const auto add = [&](const SpringPiece& piece, bool to_a, bool to_b) {
    const Type& type = types_[static_cast<std::size_t>(piece.direction)];
    alignas(64) double fx[chunk], fy[chunk], fz[chunk];
    for (int i = 0; i < piece.length; i += chunk) {
      const int n = std::min(chunk, piece.length - i);
      const auto a = static_cast<std::size_t>(piece.a + i), b = static_cast<std::size_t>(piece.b + i);
      spring_forces(x[a].data(), x[b].data(), type.stiffness, type.rest,
                    weights_.empty() ? nullptr : weights_.data() + piece.first + i, n, fx, fy, fz);
      if (to_a) add_forces(-1, n, fx, fy, fz, g[a].data());
      if (to_b) add_forces(1, n, fx, fy, fz, g[b].data());
    }
  };
  slabs_.for_each_piece([&](const SpringPiece& piece) { add(piece, true, true); },
                        [&](const SpringPiece& piece) { add(piece, true, false); },
                        [&](const SpringPiece& piece) { add(piece, false, true); });
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

namespace {

/// Vectors between the ends of a piece's springs, in float.
MUSLIN_VECTOR_CODE void edge_vectors(const double* __restrict a, const double* __restrict b, int n,
                                     float* __restrict zx, float* __restrict zy, float* __restrict zz) {
  for (int i = 0; i < n; ++i) {
    zx[i] = static_cast<float>(b[3 * i] - a[3 * i]);
    zy[i] = static_cast<float>(b[3 * i + 1] - a[3 * i + 1]);
    zz[i] = static_cast<float>(b[3 * i + 2] - a[3 * i + 2]);
  }
}

/// B = k ((r/|z|) n nᵀ + (1 − r/|z|) I): s = √(k r/|z|) n and t = k (1 − r/|z|), from z in s.
MUSLIN_VECTOR_CODE void spring_couplings(float k, float rest, const float* __restrict weight, int n,
                                         float* __restrict sx, float* __restrict sy, float* __restrict sz,
                                         float* __restrict t) {
  const float least = static_cast<float>(shortest) * rest;
  for (int i = 0; i < n; ++i) {
    const float square = sx[i] * sx[i] + sy[i] * sy[i] + sz[i] * sz[i];
    const float length = std::sqrt(square);
    const bool collapsed = !(length > least);
    const float k_i = weight != nullptr ? k * weight[i] : k;
    const float ratio = collapsed ? 0.0F : rest / length;
    const float scale = collapsed ? 0.0F : std::sqrt(k_i * ratio) / length;
    sx[i] *= scale, sy[i] *= scale, sz[i] *= scale;
    t[i] = k_i * (1.0F - ratio);
  }
}

/// Adds (c w) n nᵀ to couplings along n ∥ s: s grows to √(|s|² + c w) n. Where s is zero, n is that of z.
void add_dashpots(float c, const float* weight, int n, const float* zx, const float* zy, const float* zz,
                  float* sx, float* sy, float* sz) {
  for (int i = 0; i < n; ++i) {
    const float extra = weight != nullptr ? c * weight[i] : c;
    const float square = sx[i] * sx[i] + sy[i] * sy[i] + sz[i] * sz[i];
    if (square > 0) {
      const float scale = std::sqrt(1 + extra / square);
      sx[i] *= scale, sy[i] *= scale, sz[i] *= scale;
      continue;
    }
    const float length = std::sqrt(zx[i] * zx[i] + zy[i] * zy[i] + zz[i] * zz[i]);
    const float scale = length > 0 ? std::sqrt(extra) / length : 0.0F;
    sx[i] = scale * zx[i], sy[i] = scale * zy[i], sz[i] = scale * zz[i];
  }
}

struct PieceBuffers {
  alignas(64) float zx[CouplingPattern::block_size], zy[CouplingPattern::block_size],
      zz[CouplingPattern::block_size];
  alignas(64) float sx[CouplingPattern::block_size], sy[CouplingPattern::block_size],
      sz[CouplingPattern::block_size], t[CouplingPattern::block_size];
};

template <class Body>
void for_each_piece(const CouplingPattern& pattern, const Body& body) {
  parallel_for(pattern.slabs().size(), 1, [&](std::size_t begin, std::size_t end) {
    PieceBuffers buffers;
    for (int p = pattern.first_piece()[begin]; p < pattern.first_piece()[end]; ++p)
      body(pattern.pieces()[static_cast<std::size_t>(p)], buffers);
  });
}

const float* weights_of(const SpringEnergy& springs, const CouplingPiece& piece) {
  return springs.slot_weights().empty() ? nullptr : springs.slot_weights().data() + piece.slot;
}

}  // namespace

void SpringEnergy::linearize(ConstVectors x, Linearization& into, std::size_t first) const {
  Couplings& couplings = into.couplings(pattern_, first);
  for_each_piece(*pattern_, [&](const CouplingPiece& piece, PieceBuffers& b) {
    edge_vectors(x[static_cast<std::size_t>(piece.a)].data(), x[static_cast<std::size_t>(piece.b)].data(),
                 piece.length, b.sx, b.sy, b.sz);
    const Type& type = types_[static_cast<std::size_t>(piece.kind)];
    spring_couplings(static_cast<float>(into.scale() * type.stiffness), static_cast<float>(type.rest),
                     weights_of(*this, piece), piece.length, b.sx, b.sy, b.sz, b.t);
    couplings.store(piece, b.sx, b.sy, b.sz, b.t);
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
  /// The springs' couplings grow along their own direction. It differs from that of the prediction by as
  /// much as they turn within the step; Newton's method and iterative refinement make up for it.
  void linearize(ConstVectors, Linearization& into, std::size_t first) const override {
    Couplings& couplings = into.couplings(springs_->pattern(), first);
    for_each_piece(*springs_->pattern(), [&](const CouplingPiece& piece, PieceBuffers& b) {
      edge_vectors(predicted_[static_cast<std::size_t>(piece.a)].data(),
                   predicted_[static_cast<std::size_t>(piece.b)].data(), piece.length, b.zx, b.zy, b.zz);
      couplings.load(piece, b.sx, b.sy, b.sz, b.t);
      add_dashpots(static_cast<float>(into.scale() * factor_ * springs_->stiffness_of_kind(piece.kind)),
                   weights_of(*springs_, piece), piece.length, b.zx, b.zy, b.zz, b.sx, b.sy, b.sz);
      couplings.store(piece, b.sx, b.sy, b.sz, b.t);
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
