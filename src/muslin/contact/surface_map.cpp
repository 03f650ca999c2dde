#include "muslin/contact/surface_map.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "muslin/core/error.hpp"
#include "muslin/core/parallel.hpp"

namespace muslin {
namespace {

constexpr std::size_t map_grain = 2048;

}  // namespace

SurfaceMap SurfaceMap::identity(std::size_t vertex_count) {
  std::vector<int> offsets(vertex_count + 1);
  std::iota(offsets.begin(), offsets.end(), 0);
  std::vector<Entry> entries(vertex_count);
  for (std::size_t v = 0; v < vertex_count; ++v) entries[v].vertex = static_cast<int>(v);
  SurfaceMap map(vertex_count, std::move(offsets), std::move(entries));
  map.identity_ = true;
  return map;
}

SurfaceMap::SurfaceMap(std::size_t vertex_count, std::vector<int> offsets, std::vector<Entry> entries)
    : vertex_count_(vertex_count), offsets_(std::move(offsets)), entries_(std::move(entries)) {
  if (offsets_.empty() || offsets_.front() != 0 || !std::is_sorted(offsets_.begin(), offsets_.end()) ||
      static_cast<std::size_t>(offsets_.back()) != entries_.size())
    throw Error(ErrorKind::usage, "offsets of a surface map do not cover its entries", "give #P + 1 offsets");
  column_offsets_.assign(vertex_count + 1, 0);
  for (const Entry& e : entries_) {
    if (e.vertex < 0 || static_cast<std::size_t>(e.vertex) >= vertex_count)
      throw Error(ErrorKind::usage, "a surface map names a vertex that does not exist", "check its entries");
    ++column_offsets_[static_cast<std::size_t>(e.vertex) + 1];
    convex_ = convex_ && e.weight >= 0;
  }
  std::partial_sum(column_offsets_.begin(), column_offsets_.end(), column_offsets_.begin());
  columns_.resize(entries_.size());
  std::vector<int> next(column_offsets_.begin(), column_offsets_.end() - 1);
  for (std::size_t p = 0; p + 1 < offsets_.size(); ++p) {
    double sum = 0;
    for (const Entry& e : row(p)) {
      sum += e.weight;
      columns_[static_cast<std::size_t>(next[static_cast<std::size_t>(e.vertex)]++)] = {static_cast<int>(p),
                                                                                        e.weight};
    }
    if (!(std::fabs(sum - 1) <= 1e-9))
      throw Error(ErrorKind::usage, "weights of a surface point do not sum to 1", "normalise them");
  }
}

void SurfaceMap::apply(ConstVectors q, Vectors x) const {
  if (identity_) {
    parallel_for(q.size(), map_grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) x[v] = q[v];
    });
    return;
  }
  parallel_for(point_count(), map_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      Vec3 sum = Vec3::Zero();
      for (const Entry& e : row(p)) sum += e.weight * q[static_cast<std::size_t>(e.vertex)];
      x[p] = sum;
    }
  });
}

void SurfaceMap::add_transpose(ConstVectors f, Vectors g) const {
  parallel_for(vertex_count_, map_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      Vec3 sum = Vec3::Zero();
      for (const Entry& e : column(v)) sum += e.weight * f[static_cast<std::size_t>(e.vertex)];
      g[v] += sum;
    }
  });
}

}  // namespace muslin
