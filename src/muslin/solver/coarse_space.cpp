#include "muslin/solver/coarse_space.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "muslin/core/index.hpp"
#include "muslin/core/parallel.hpp"

namespace muslin {
namespace {

constexpr int block_lanes = EliminationOrder::lanes;
// The factorisation of couplings leaves smoother errors than that of diagonal blocks.
constexpr double edges_per_cell = 8, edges_per_cell_of_matrices = 4;
constexpr int smallest_component = 64;          // vertices
constexpr std::size_t smallest_part = 1 << 10;  // positions
constexpr std::size_t max_parts = 4;

/// Components of coupled vertices.
class Components {
 public:
  explicit Components(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }
  int find(int v) {
    while (parent_[at(v)] != v) v = parent_[at(v)] = parent_[at(parent_[at(v)])];
    return v;
  }
  void join(int u, int v) {
    u = find(u), v = find(v);
    parent_[at(std::max(u, v))] = std::min(u, v);
  }

 private:
  std::vector<int> parent_;
};

/// Calls body(earlier, later) for the positions of every coupling.
template <class Body>
void for_each_coupling(const EliminationOrder& pattern, const Body& body) {
  for (const EliminationOrder::Block& block : pattern.blocks()) {
    for (int l = 0; l < block_lanes; ++l)
      if (block.used >> l & 1)
        body(l + (l < block.cut ? block.first : block.second), block.group * block_lanes + l);
  }
}
/// Calls body(row, column) for the off-diagonal blocks.
template <class Body>
void for_each_pair(const SymmetricPattern& pattern, const Body& body) {
  for (std::size_t row = 0; row < pattern.vertex_count(); ++row)
    for (int k = pattern.first()[row] + 1; k < pattern.first()[row + 1]; ++k)
      body(static_cast<int>(row), pattern.columns()[at(k)]);
}

/// to += scale w_k w_l for k ≤ l
void add_square(int count, const float* w, float scale, float* to) {
  for (int k = 0; k < count; ++k) {
    const float each = scale * w[k];
    for (int l = k; l < count; ++l) *to++ += each * w[l];
  }
}

}  // namespace

CoarseSpace::CoarseSpace(const Linearization& h, ConstVectors rest_positions)
    : rest_positions_(rest_positions.data()), vertex_count_(rest_positions.size()) {
  std::size_t positions = 0, blocks = 0;
  position_.resize(vertex_count_);
  std::vector<int> vertex;  // by position
  for (const SpringHessian* set : h.sets()) {
    sets_.push_back({set->shared_pattern(), set->first(), positions, blocks});
    blocks += set->pattern().block_count();
    for (std::size_t i = 0; i < set->pattern().position_count(); ++i) {
      const int v = set->pattern().vertex(i);
      vertex.push_back(v < 0 ? -1 : static_cast<int>(set->first()) + v);
      if (v >= 0) position_[set->first() + at(v)] = static_cast<int>(positions + i);
    }
    positions += set->pattern().position_count();
  }
  for (const SymmetricMatrix* matrix : h.matrices())
    matrices_.push_back({matrix->shared_pattern(), matrix->first()});

  // Find bodies and the lengths of their edges.
  const auto for_each_edge = [&](const auto& body) {
    for (const Set& set : sets_)
      for_each_coupling(*set.pattern,
                        [&](int i, int j) { body(vertex[set.begin + at(i)], vertex[set.begin + at(j)]); });
    for (const Matrix& matrix : matrices_) {
      const int first = static_cast<int>(matrix.first);
      for_each_pair(*matrix.pattern, [&](int u, int v) { body(first + u, first + v); });
    }
  };
  Components sets(vertex_count_);
  std::vector<float> shortest(vertex_count_, std::numeric_limits<float>::infinity());
  for_each_edge([&](int u, int v) {
    sets.join(u, v);
    const auto length = static_cast<float>((rest_positions[at(u)] - rest_positions[at(v)]).norm());
    shortest[at(u)] = std::min(shortest[at(u)], length);
    shortest[at(v)] = std::min(shortest[at(v)], length);
  });
  std::vector<int> size(vertex_count_, 0), number(vertex_count_, -1);
  for (std::size_t v = 0; v < vertex_count_; ++v) ++size[at(sets.find(static_cast<int>(v)))];
  std::vector<double> spacings;
  std::vector<int> counts;
  std::vector<int> component(vertex_count_, -1);
  for (std::size_t v = 0; v < vertex_count_; ++v) {
    const std::size_t root = at(sets.find(static_cast<int>(v)));
    if (size[root] < smallest_component) continue;
    if (number[root] < 0) {
      number[root] = static_cast<int>(spacings.size());
      spacings.push_back(0);
      counts.push_back(0);
    }
    component[v] = number[root];
    spacings[at(number[root])] += static_cast<double>(shortest[v]);
    ++counts[at(number[root])];
  }
  std::vector<double> edges(spacings.size(), edges_per_cell);
  for (const Matrix& matrix : matrices_) {
    for (std::size_t v = 0; v < matrix.pattern->vertex_count(); ++v)
      if (const int c = component[matrix.first + v]; c >= 0) edges[at(c)] = edges_per_cell_of_matrices;
  }
  for (std::size_t c = 0; c < spacings.size(); ++c) spacings[c] *= edges[c] / counts[c];
  // Without a length there is no grid.
  for (int& c : component)
    if (c >= 0 && !(spacings[at(c)] > 0 && std::isfinite(spacings[at(c)]))) c = -1;

  std::vector<Vec3> points(positions, Vec3::Zero());
  std::vector<int> components(positions, -1);
  for (std::size_t i = 0; i < positions; ++i) {
    if (vertex[i] < 0) continue;
    points[i] = rest_positions[at(vertex[i])];
    components[i] = component[at(vertex[i])];
  }
  grid_ = BackgroundGrid(points, components, spacings);
  if (grid_.node_count() == 0) return;
  std::vector<std::pair<int, int>> neighbours;
  const auto add = [&](std::size_t i, std::size_t j) {
    const int a = grid_.point(i).cell, b = grid_.point(j).cell;
    if (a == b || a < 0 || b < 0 || (!neighbours.empty() && neighbours.back() == std::pair(a, b))) return;
    neighbours.emplace_back(a, b);
  };
  for (const Set& set : sets_)
    for_each_coupling(*set.pattern, [&](int i, int j) { add(set.begin + at(i), set.begin + at(j)); });
  for (const Matrix& matrix : matrices_) {
    for_each_pair(*matrix.pattern, [&](int u, int v) {
      add(at(position_[matrix.first + at(u)]), at(position_[matrix.first + at(v)]));
    });
  }
  grid_matrix_ = GridMatrix(grid_, std::move(neighbours));
  held_.assign(positions, 0);
  bundle_.resize(block_lanes * blocks);
  bundle();
  const std::size_t parts = std::clamp<std::size_t>(positions / smallest_part, 1, max_parts);
  sums_.resize(parts);
  for (Sums& sums : sums_) {
    sums.half.resize(3 * grid_matrix_.pattern()->block_count());
    sums.right_side.resize(grid_.node_count());
    sums.masses.resize(grid_.cells().size());
  }
  for (double& spacing : spacings) spacing *= 2;
  multilevel_ = std::make_unique<Multilevel>(grid_matrix_.pattern(), grid_.nodes(), grid_.node_components(),
                                             std::move(spacings));
}

bool CoarseSpace::fits(const Linearization& h, ConstVectors rest_positions) const {
  const auto same = [](const auto& kept, const auto* now) {
    return kept.pattern == now->shared_pattern() && kept.first == now->first();
  };
  return rest_positions.data() == rest_positions_ && rest_positions.size() == vertex_count_ &&
         std::equal(sets_.begin(), sets_.end(), h.sets().begin(), h.sets().end(), same) &&
         std::equal(matrices_.begin(), matrices_.end(), h.matrices().begin(), h.matrices().end(), same);
}

/// Groups the couplings into bundles; repeated whenever the held vertices change.
void CoarseSpace::bundle() {
  int kinds = 0;
  for (const Set& set : sets_)
    for (const EliminationOrder::Block& block : set.pattern->blocks())
      kinds = std::max(kinds, block.kind + 1);
  std::vector<int> number(grid_.cells().size() * at(kinds), -1);
  std::fill(bundle_.begin(), bundle_.end(), -1);
  bundles_.clear();
  for (const Set& set : sets_) {
    for (std::size_t b = 0; b < set.pattern->block_count(); ++b) {
      const EliminationOrder::Block& block = set.pattern->blocks()[b];
      for (int l = 0; l < block_lanes; ++l) {
        if ((block.used >> l & 1) == 0) continue;
        BackgroundGrid::Point p = point(set.begin + at(l + (l < block.cut ? block.first : block.second))),
                              q = point(set.begin + at(block.group * block_lanes + l));
        if (!grid_.meet(p, q)) continue;
        int& n = number[at(p.cell) * at(kinds) + at(block.kind)];
        if (n < 0) {
          n = static_cast<int>(bundles_.size());
          bundles_.emplace_back().cell = p.cell;
        }
        float w[8], v[8];
        const BackgroundGrid::Cell& cell = grid_.weights(p, w);
        grid_.weights(q, v);
        for (int k = 0; k < cell.count; ++k) w[k] -= v[k];
        add_square(cell.count, w, 1, bundles_[at(n)].weights.data());
        ++bundles_[at(n)].count;
        bundle_[(set.first_block + b) * block_lanes + at(l)] = n;
      }
    }
  }
  for (Bundle& bundle : bundles_)
    for (float& w : bundle.weights) w /= bundle.count;
}

void CoarseSpace::add_couplings(const SpringHessian& couplings, const Set& set, std::size_t part,
                                Sums& sums) const {
  constexpr std::size_t batch = 16;
  float sx[batch * block_lanes], sy[batch * block_lanes], sz[batch * block_lanes], t[batch * block_lanes];
  const EliminationOrder& pattern = couplings.pattern();
  const auto [begin, end] = share(part, pattern.block_count());
  for (std::size_t b = begin; b < end; b += batch) {
    const std::size_t count = std::min(batch, end - b);
    couplings.load(b, count, sx, sy, sz, t);
    for (std::size_t k = 0; k < count; ++k) {
      const EliminationOrder::Block& block = pattern.blocks()[b + k];
      const int* const bundle = bundle_.data() + (set.first_block + b + k) * block_lanes;
      for (int l = 0; l < block_lanes; ++l) {
        if ((block.used >> l & 1) == 0) continue;
        const std::size_t i = k * block_lanes + at(l);
        const float plus = std::max(t[i], 0.0F);
        const Float4 s = {sx[i], sy[i], sz[i], 0};
        const Block3 matrix = {s * sx[i] + Float4{plus, 0, 0, 0}, s * sy[i] + Float4{0, plus, 0, 0},
                               s * sz[i] + Float4{0, 0, plus, 0}};
        if (bundle[l] >= 0) {
          Block3& sum = sums.couplings[at(bundle[l])];
          sum.x += matrix.x, sum.y += matrix.y, sum.z += matrix.z;
        } else {
          add_coupling(grid_, grid_matrix_,
                       point(set.begin + at(l + (l < block.cut ? block.first : block.second))),
                       point(set.begin + at(block.group * block_lanes + l)), matrix, sums.half.data());
        }
      }
    }
  }
}

void CoarseSpace::add_masses(const Linearization& h, std::size_t part, Sums& sums) const {
  const auto [begin, end] = share(part, vertex_count_);
  for (std::size_t v = begin; v < end; ++v) {
    const BackgroundGrid::Point p = point(at(position_[v]));
    if (p.cell < 0) continue;
    float w[8];
    const BackgroundGrid::Cell& cell = grid_.weights(p, w);
    add_square(cell.count, w, h.identity()[v], sums.masses[at(p.cell)].data());
  }
}

/// Adds the off-diagonal blocks; the diagonal ones are added with those of all potentials.
void CoarseSpace::add_matrix(const SymmetricMatrix& matrix, std::size_t part, Float4* half) const {
  const SymmetricPattern& pattern = matrix.pattern();
  const auto [begin, end] = share(part, pattern.vertex_count());
  for (std::size_t row = begin; row < end; ++row) {
    RowOfBlocks sums(grid_, grid_matrix_, point(at(position_[matrix.first() + row])), half);
    for (int k = pattern.first()[row] + 1; k < pattern.first()[row + 1]; ++k) {
      const auto column = at(pattern.columns()[at(k)]);
      sums.add(point(at(position_[matrix.first() + column])), matrix.block(k));
    }
  }
}

void CoarseSpace::add_rest_diagonal(const Linearization& h, std::size_t part, Float4* half) const {
  const Floats u = h.remainder_upper().data(), l = h.remainder_lower().data();
  const auto [begin, end] = share(part, vertex_count_);
  for (std::size_t v = begin; v < end; ++v) {
    const Block3 block = {
        {u.x[v], u.y[v], u.z[v], 0}, {u.y[v], l.x[v], l.y[v], 0}, {u.z[v], l.y[v], l.z[v], 0}};
    add_block(grid_, grid_matrix_, point(at(position_[v])), block, half);
  }
}

void CoarseSpace::assemble(const Linearization& h) {
  bool same = true;
  for (std::size_t v = 0; v < vertex_count_; ++v) {
    std::uint8_t& held = held_[at(position_[v])];
    same = same && held == h.fixed()[v];
    held = h.fixed()[v];
  }
  if (!same) bundle();
  parallel_for(sums_.size(), 1, [&](std::size_t part, std::size_t) {
    Sums& sums = sums_[part];
    std::fill(sums.half.begin(), sums.half.end(), Float4{0, 0, 0, 0});
    std::fill(sums.masses.begin(), sums.masses.end(), Square{});
    sums.couplings.assign(bundles_.size(), Block3{});
    for (std::size_t s = 0; s < sets_.size(); ++s) add_couplings(*h.sets()[s], sets_[s], part, sums);
    add_masses(h, part, sums);
    for (const SymmetricMatrix* matrix : h.matrices()) add_matrix(*matrix, part, sums.half.data());
    if (h.has_remainder()) add_rest_diagonal(h, part, sums.half.data());
  });
  Sums& all = sums_[0];
  for (std::size_t part = 1; part < sums_.size(); ++part) {
    const Sums& sums = sums_[part];
    for (std::size_t i = 0; i < all.half.size(); ++i) all.half[i] += sums.half[i];
    for (std::size_t i = 0; i < all.masses.size(); ++i)
      for (std::size_t k = 0; k < all.masses[i].size(); ++k) all.masses[i][k] += sums.masses[i][k];
    for (std::size_t i = 0; i < all.couplings.size(); ++i) {
      Block3& sum = all.couplings[i];
      sum.x += sums.couplings[i].x, sum.y += sums.couplings[i].y, sum.z += sums.couplings[i].z;
    }
  }
  for (std::size_t n = 0; n < bundles_.size(); ++n) {
    const Bundle& bundle = bundles_[n];
    add_weighted(grid_, grid_matrix_, bundle.cell, bundle.weights.data(), all.couplings[n], all.half.data());
  }
  constexpr Block3 identity = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};
  for (std::size_t c = 0; c < all.masses.size(); ++c)
    add_weighted(grid_, grid_matrix_, static_cast<int>(c), all.masses[c].data(), identity, all.half.data());
  multilevel_->matrix().reset(*grid_matrix_.pattern());
  grid_matrix_.finish(all.half.data(), multilevel_->matrix());
  multilevel_->prepare();
}

double CoarseSpace::correct(const float* r, Floats t) {
  const std::size_t positions = held_.size();
  parallel_for(sums_.size(), 1, [&](std::size_t part, std::size_t) {
    std::vector<Float4>& sum = sums_[part].right_side;
    std::fill(sum.begin(), sum.end(), Float4{0, 0, 0, 0});
    const auto [begin, end] = share(part, positions);
    for (std::size_t i = begin; i < end; ++i) {
      const BackgroundGrid::Point p = point(i);
      if (p.cell < 0) continue;
      const float* const from = r + i / block_lanes * (3 * block_lanes) + i % block_lanes;
      const Float4 value = {from[0], from[block_lanes], from[2 * block_lanes], 0};
      float w[8];
      const BackgroundGrid::Cell& cell = grid_.weights(p, w);
      for (int k = 0; k < cell.count; ++k) sum[at(cell.nodes[at(k)])] += w[k] * value;
    }
  });
  std::vector<Float4>& b = multilevel_->right_side();
  b = sums_[0].right_side;
  for (std::size_t part = 1; part < sums_.size(); ++part)
    for (std::size_t n = 0; n < b.size(); ++n) b[n] += sums_[part].right_side[n];
  const std::vector<Float4> right_side = b;
  multilevel_->solve();
  const std::vector<Float4>& x = multilevel_->solution();
  double product = 0;
  for (std::size_t n = 0; n < x.size(); ++n) {
    for (int c = 0; c < 3; ++c)
      product += static_cast<double>(x[n][c]) * static_cast<double>(right_side[n][c]);
  }
  parallel_for(positions, 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const BackgroundGrid::Point p = point(i);
      Float4 value = {0, 0, 0, 0};
      if (p.cell >= 0) {
        float w[8];
        const BackgroundGrid::Cell& cell = grid_.weights(p, w);
        for (int k = 0; k < cell.count; ++k) value += w[k] * x[at(cell.nodes[at(k)])];
      }
      t.x[i] = value[0], t.y[i] = value[1], t.z[i] = value[2];
    }
  });
  return product;
}

std::size_t CoarseSpace::bytes() const {
  std::size_t bytes = grid_.bytes() + grid_matrix_.bytes() + position_.capacity() * sizeof(int) +
                      held_.capacity() + bundle_.capacity() * sizeof(int) +
                      bundles_.capacity() * sizeof(Bundle);
  for (const Sums& sums : sums_) {
    bytes += (sums.half.capacity() + sums.right_side.capacity()) * sizeof(Float4) +
             sums.couplings.capacity() * sizeof(Block3) + sums.masses.capacity() * sizeof(Square);
  }
  return bytes + (multilevel_ ? multilevel_->bytes() : 0);
}

}  // namespace muslin
