#include "muslin/energy/spring_energy.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "muslin/core/parallel.hpp"
#include "muslin/potential/linearization.hpp"

namespace muslin {
namespace {

auto load(ConstVectors x) {
  return [x](std::size_t v, int n, const std::array<Columns, 1>& to) { load_columns(x[v].data(), n, to[0]); };
}

/// Runs of one b − a that follow one another become one, the shorter ones also across gaps: springs that are
/// not there cost as little as those that are, ends of loops cost more. Runs along x stay apart: they are the
/// chains that the preconditioner solves side by side.
constexpr int shortest_run = 512;
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
      const bool worth_it = gap == 0 || (gap <= longest_gap && run.length < shortest_run);
      if (last.kind == run.direction && last.b - last.a == b - a && gap >= 0 && worth_it && axis != 0) {
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
    : weights_(std::move(weights)), count_(springs.count) {
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
  slabs_ = SpringSlabs(*pattern_);
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

void SpringEnergy::linearize(ConstVectors x, Linearization& into, std::size_t first) const {
  Couplings& couplings = into.couplings(pattern_, first);
  for_each_coupling(*pattern_, x, [&](const CouplingPiece& piece, Columns a, Columns b) {
    alignas(64) float sx[most_springs], sy[most_springs], sz[most_springs], t[most_springs];
    spring_couplings(type(piece.kind, piece.slot, into.scale()), piece.length, a, b, sx, sy, sz, t);
    couplings.store(piece, sx, sy, sz, t);
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
