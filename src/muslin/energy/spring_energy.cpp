#include "muslin/energy/spring_energy.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "muslin/core/error.hpp"
#include "muslin/core/parallel.hpp"
#include "muslin/potential/hessian_sink.hpp"

namespace muslin {
namespace {

auto load(ConstVectors x) {
  return [x](std::size_t v, int n, const std::array<Columns, 1>& to) { load_columns(x[v].data(), n, to[0]); };
}

/// Merges consecutive runs of one b − a, the shorter ones also across gaps: a missing spring costs as little
/// as a present one, the end of a loop more.
constexpr int shortest_run = 512;
constexpr int longest_gap = 8;

/// Runs with a < b, and for each slot which spring (counted as in Springs) it has, −1 for none.
struct JoinedRuns {
  std::vector<CouplingRun> runs;
  std::vector<std::int64_t> springs;
};

JoinedRuns join(const Springs& springs) {
  JoinedRuns joined;
  for (const SpringRun& run : springs.runs) {
    const int a = std::min(run.a, run.b), b = std::max(run.a, run.b);
    if (!joined.runs.empty()) {
      CouplingRun& last = joined.runs.back();
      const int gap = a - last.a - last.length;
      const bool worth_it = gap == 0 || (gap <= longest_gap && run.length < shortest_run);
      if (last.kind == run.direction && last.b - last.a == b - a && gap >= 0 && worth_it) {
        last.length += gap + run.length;
        joined.springs.insert(joined.springs.end(), static_cast<std::size_t>(gap), -1);
        for (int i = 0; i < run.length; ++i) joined.springs.push_back(run.first + i);
        continue;
      }
    }
    joined.runs.push_back({run.direction, a, b, run.length});
    for (int i = 0; i < run.length; ++i) joined.springs.push_back(run.first + i);
  }
  return joined;
}

}  // namespace

SpringEnergy::SpringEnergy(const Springs& springs, double width, const std::array<double, 3>& moduli,
                           std::vector<float> weights, std::shared_ptr<const SpringNetwork> network)
    : weights_(std::move(weights)), count_(springs.count), network_(std::move(network)) {
  require(width > 0, "the width of a voxel is not positive", "give metres");
  assert(weights_.empty() || weights_.size() == static_cast<std::size_t>(count_));
  for (const SpringDirection& direction : springs.directions) {
    types_.push_back({width * direction.offset.cast<double>().norm(),
                      width * moduli[static_cast<std::size_t>(direction.kind)]});
  }
  SpringNetwork made;
  for (const SpringRun& run : springs.runs) {
    made.vertex_count = std::max({made.vertex_count, run.a + run.length, run.b + run.length});
    made.runs.push_back({run.direction, run.a, run.b, run.length});
  }
  const JoinedRuns joined = join(springs);
  slabs_ = SpringSlabs(joined.runs, made.vertex_count);
  const auto weight = [&](std::int64_t spring) {
    return spring < 0 ? 0.0F : weights_.empty() ? 1.0F : weights_[static_cast<std::size_t>(spring)];
  };
  if (!weights_.empty() || static_cast<std::int64_t>(joined.springs.size()) != count_) {
    slot_weights_.resize(joined.springs.size());
    std::transform(joined.springs.begin(), joined.springs.end(), slot_weights_.begin(), weight);
  }

  if (network_) return;
  if (!weights_.empty()) {
    for (const SpringRun& run : springs.runs)
      for (int i = 0; i < run.length; ++i) made.weights.push_back(weight(run.first + i));
  }
  network_ = std::make_shared<const SpringNetwork>(std::move(made));
}

std::vector<CentralSpring> SpringEnergy::kinds(double factor) const {
  std::vector<CentralSpring> kinds;
  for (const Type& type : types_)
    kinds.push_back({static_cast<float>(factor * type.stiffness), static_cast<float>(type.rest)});
  return kinds;
}

double SpringEnergy::value(ConstVectors x) const {
  return slabs_.sweep<1>({}, load(x), [&](const SpringPiece& piece, const SpringColumns<1>& c) {
    add_spring_energies(type(piece.direction, piece.slot), piece.length, c.a[0], c.b[0], c.w);
  });
}

double SpringEnergy::add_gradient_and_value(ConstVectors x, Vectors g) const {
  return slabs_.sweep<1>(g, load(x), [&](const SpringPiece& piece, const SpringColumns<1>& c) {
    add_spring_forces(type(piece.direction, piece.slot), piece.length, c.a[0], c.b[0], c.to, c.w);
  });
}

void SpringEnergy::add_gradient(ConstVectors x, Vectors g) const { add_gradient_and_value(x, g); }

void SpringEnergy::add_hessian_product(ConstVectors x, ConstVectors p, Vectors y) const {
  const auto load_both = [&](std::size_t v, int n, const std::array<Columns, 2>& to) {
    load_columns(x[v].data(), n, to[0]);
    load_columns(p[v].data(), n, to[1]);
  };
  slabs_.sweep<2>(y, load_both, [&](const SpringPiece& piece, const SpringColumns<2>& c) {
    add_spring_products(type(piece.direction, piece.slot), piece.length, c.a[0], c.b[0], c.a[1], c.b[1],
                        c.to);
  });
}

void SpringEnergy::add_diagonal_blocks(ConstVectors x, std::span<Mat3> blocks) const {
  slabs_.add_blocks(blocks, [&](const SpringPiece& piece, int i) -> Mat3 {
    const SpringType of = type(piece.direction, piece.slot + i);
    const double k = of.weight != nullptr ? of.k * static_cast<double>(*of.weight) : of.k;
    const Vec3 z = difference(x, piece, i);
    const double length = z.norm();
    if (!(length > shortest_spring * of.rest)) return k * Mat3::Identity();
    const double transverse = std::max(0.0, k * (1 - of.rest / length));
    const Vec3 n = z / length;
    Mat3 block = ((k - transverse) * n) * n.transpose();
    block.diagonal().array() += transverse;
    return block;
  });
}

void SpringEnergy::linearize(ConstVectors x, HessianSink& into, std::size_t first) const {
  into.set_springs(network_, kinds(into.scale()), x, first);
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
             const SpringType of = type(piece.direction, piece.slot);
             double largest = 0;
             for (int i = 0; i < piece.length; ++i) {
               if (of.weight != nullptr && of.weight[i] == 0) continue;
               largest = std::max(largest, difference(x, piece, i).squaredNorm());
             }
             return Largest{std::sqrt(largest) / of.rest};
           })
      .value;
}

}  // namespace muslin
