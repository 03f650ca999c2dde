#include "muslin/contact/contact_hessian.hpp"

#include <algorithm>

#include "muslin/core/parallel.hpp"

namespace muslin {
namespace {

constexpr std::size_t grain = 1024;

}  // namespace

ContactHessian::ContactHessian(const SurfaceMap& map, const std::vector<ContactRow>& rows) {
  rows_.reserve(rows.size());
  row_offsets_.reserve(rows.size() + 1);
  row_offsets_.push_back(0);
  vertex_offsets_.assign(map.vertex_count() + 1, 0);
  std::vector<Entry> entries;
  for (const ContactRow& row : rows) {
    rows_.push_back({row.normal, row.normal_stiffness, row.tangential});
    // The contact's weights on vertices: points of one pair may share some.
    entries.clear();
    const auto add = [&](int vertex, double weight) {
      const auto same = std::find_if(entries.begin(), entries.end(),
                                     [&](const Entry& known) { return known.index == vertex; });
      if (same != entries.end()) {
        same->weight += weight;
      } else {
        entries.push_back({vertex, weight});
      }
    };
    for (std::size_t i = 0; i < 4; ++i) {
      if (row.points[i] < 0 || row.weights[i] == 0) continue;
      for (const SurfaceMap::Entry& e : map.row(static_cast<std::size_t>(row.points[i])))
        add(e.vertex, row.weights[i] * e.weight);
    }
    for (const SurfaceMap::Entry& e : row.carried) add(e.vertex, e.weight);
    for (const Entry& e : entries) ++vertex_offsets_[static_cast<std::size_t>(e.index) + 1];
    by_row_.insert(by_row_.end(), entries.begin(), entries.end());
    row_offsets_.push_back(static_cast<int>(by_row_.size()));
  }
  for (std::size_t v = 0; v < map.vertex_count(); ++v) vertex_offsets_[v + 1] += vertex_offsets_[v];
  by_vertex_.resize(by_row_.size());
  std::vector<int> next(vertex_offsets_.begin(), vertex_offsets_.end() - 1);
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    for (int k = row_offsets_[r]; k < row_offsets_[r + 1]; ++k) {
      const Entry& e = by_row_[static_cast<std::size_t>(k)];
      by_vertex_[static_cast<std::size_t>(next[static_cast<std::size_t>(e.index)]++)] = {static_cast<int>(r),
                                                                                         e.weight};
    }
  }
}

Vec3 ContactHessian::relative(std::size_t row, ConstVectors p) const {
  Vec3 sum = Vec3::Zero();
  for (int k = row_offsets_[row]; k < row_offsets_[row + 1]; ++k) {
    const Entry& e = by_row_[static_cast<std::size_t>(k)];
    sum += e.weight * p[static_cast<std::size_t>(e.index)];
  }
  return sum;
}

void ContactHessian::for_each_row(const std::function<void(const StepGuard::Contact&)>& visit) const {
  std::vector<StepGuard::Weight> weights;
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    weights.clear();
    for (int k = row_offsets_[r]; k < row_offsets_[r + 1]; ++k) {
      const Entry& e = by_row_[static_cast<std::size_t>(k)];
      weights.push_back({e.index, e.weight});
    }
    visit({rows_[r].normal, rows_[r].a, rows_[r].b, weights});
  }
}

double ContactHessian::value(ConstVectors q) const {
  return parallel_sum(rows_.size(), grain, 0.0, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t r = begin; r < end; ++r) {
      const Vec3 u = relative(r, q);
      sum += u.dot(rows_[r].times(u)) / 2;
    }
    return sum;
  });
}

void ContactHessian::add_hessian_product(ConstVectors /*q*/, ConstVectors p, Vectors y) const {
  std::vector<Vec3> forces(rows_.size());
  parallel_for(rows_.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t r = begin; r < end; ++r) forces[r] = rows_[r].times(relative(r, p));
  });
  parallel_for(y.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      for (int k = vertex_offsets_[v]; k < vertex_offsets_[v + 1]; ++k) {
        const Entry& e = by_vertex_[static_cast<std::size_t>(k)];
        y[v] += e.weight * forces[static_cast<std::size_t>(e.index)];
      }
    }
  });
}

void ContactHessian::linearize(ConstVectors /*q*/, Linearization& into, std::size_t first) const {
  RelativeStiffness& stiffness = into.relative_stiffness(first, vertex_offsets_.size() - 1);
  const std::uint8_t* fixed = into.fixed() + first;
  std::vector<RelativeStiffness::Weight> weights;
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    weights.clear();
    for (int k = row_offsets_[r]; k < row_offsets_[r + 1]; ++k) {
      const Entry& e = by_row_[static_cast<std::size_t>(k)];
      if (fixed[e.index] == 0) weights.push_back({e.index, static_cast<float>(e.weight)});
    }
    if (weights.empty()) continue;
    stiffness.add(rows_[r].normal, into.scale() * rows_[r].a, into.scale() * rows_[r].b, weights);
  }
}

void ContactHessian::add_diagonal_blocks(ConstVectors /*q*/, std::span<Mat3> blocks) const {
  parallel_for(blocks.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      for (int k = vertex_offsets_[v]; k < vertex_offsets_[v + 1]; ++k) {
        const Entry& e = by_vertex_[static_cast<std::size_t>(k)];
        const Stiffness& s = rows_[static_cast<std::size_t>(e.index)];
        const double square = e.weight * e.weight;
        blocks[v] += square * (s.b * Mat3::Identity() + (s.a - s.b) * s.normal * s.normal.transpose());
      }
    }
  });
}

}  // namespace muslin
