#include "muslin/lattice/embedding.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "muslin/core/error.hpp"
#include "muslin/core/parallel.hpp"
#include "muslin/lattice/rows.hpp"

namespace muslin {
namespace {

constexpr std::size_t grain = 4096;

/// Returns the squared distance along one axis from x to the interval [i, i+1].
double gap(double x, int i) {
  const double d = std::max({i - x, x - (i + 1.0), 0.0});
  return d * d;
}

/// Returns the kept voxel nearest to a point outside all of them, ties to the lower index.
class NearestVoxel {
 public:
  explicit NearestVoxel(const RowIndex& rows) : rows_(rows) {}

  int find(const Vec3& local, const Vec3i& extent) const {
    best_ = -1;
    best_distance_ = std::numeric_limits<double>::infinity();
    const int j0 = static_cast<int>(std::clamp(local.y(), 0.0, extent.y() - 1.0));
    const int k0 = static_cast<int>(std::clamp(local.z(), 0.0, extent.z() - 1.0));
    // Rings of rows around the point's own; a ring is at least `ring − 1` away.
    constexpr int rings = 32;
    for (int ring = 0; ring < rings; ++ring) {
      if (best_ >= 0 && best_distance_ < (ring - 1.0) * (ring - 1.0)) return best_;
      for (int j = j0 - ring; j <= j0 + ring; ++j) {
        const int step = std::abs(j - j0) == ring ? 1 : 2 * ring;
        for (int k = k0 - ring; k <= k0 + ring; k += std::max(step, 1)) {
          if (const Row* row = rows_.find(j, k)) try_row(*row, local);
        }
      }
    }
    for (std::size_t r = 0; r < rows_.size(); ++r) try_row(rows_[r], local);
    return best_;
  }

 private:
  void try_row(const Row& row, const Vec3& local) const {
    const double across = gap(local.y(), row.j) + gap(local.z(), row.k);
    if (across > best_distance_) return;
    const Vec3i* begin = rows_.items().data() + row.begin;
    const Vec3i* end = rows_.items().data() + row.end;
    const double x = std::floor(local.x());
    const Vec3i* after = std::partition_point(begin, end, [&](const Vec3i& voxel) { return voxel.x() < x; });
    for (const Vec3i* voxel : {after - 1, after}) {
      if (voxel < begin || voxel >= end) continue;
      const double distance = across + gap(local.x(), voxel->x());
      const int index = static_cast<int>(voxel - rows_.items().data());
      if (distance < best_distance_ || (distance == best_distance_ && index < best_)) {
        best_distance_ = distance;
        best_ = index;
      }
    }
  }

  const RowIndex& rows_;
  mutable int best_ = -1;
  mutable double best_distance_ = 0;
};

}  // namespace

void Embedding::apply(ConstVectors q, Vectors points) const {
  require(points.size() == size(), "an embedding needs room for each of its points", "give #P vectors");
  parallel_for(size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      Vec3 sum = Vec3::Zero();
      for (std::size_t c = 0; c < 8; ++c) sum += weights[p][c] * q[vertices[p][c]];
      points[p] = offsets.empty() ? sum : sum + offsets[p];
    }
  });
}

void Embedding::prepare_transpose(std::size_t vertex_count) {
  first_.assign(vertex_count + 1, 0);
  for (std::size_t p = 0; p < size(); ++p)
    for (std::size_t c = 0; c < 8; ++c)
      if (weights[p][c] != 0) ++first_[vertices[p][c] + 1];
  for (std::size_t v = 0; v < vertex_count; ++v) first_[v + 1] += first_[v];
  slots_.resize(first_.back());
  std::vector<std::int64_t> next(first_.begin(), first_.end() - 1);
  for (std::size_t p = 0; p < size(); ++p)
    for (std::size_t c = 0; c < 8; ++c)
      if (weights[p][c] != 0) slots_[next[vertices[p][c]]++] = static_cast<std::int64_t>(8 * p + c);
}

void Embedding::add_transpose(ConstVectors f, Vectors forces_q) const {
  require(f.size() == size(), "an embedding needs a force for each of its points", "give #P vectors");
  if (first_.empty()) {
    for (std::size_t p = 0; p < size(); ++p)
      for (std::size_t c = 0; c < 8; ++c)
        if (weights[p][c] != 0) forces_q[vertices[p][c]] += weights[p][c] * f[p];
    return;
  }
  assert(forces_q.size() + 1 == first_.size());
  parallel_for(forces_q.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      for (std::int64_t s = first_[v]; s < first_[v + 1]; ++s) {
        const std::int64_t slot = slots_[s];
        forces_q[v] += weights[slot >> 3][slot & 7] * f[slot >> 3];
      }
    }
  });
}

Embedding embed(const Lattice& lattice, ConstVectors points) {
  assert(lattice.voxel_count() > 0);
  Embedding embedding;
  embedding.vertices.resize(points.size());
  embedding.weights.resize(points.size());
  const RowIndex rows(lattice.voxels);
  parallel_for(points.size(), grain, [&](std::size_t begin, std::size_t end) {
    const NearestVoxel nearest(rows);
    for (std::size_t p = begin; p < end; ++p) {
      const Vec3 local = (points[p] - lattice.origin) / lattice.width;
      // Points in the grid's upper faces belong to the last voxel.
      const Vec3 bounded = local.cwiseMax(0.0).cwiseMin((lattice.extent - Vec3i::Ones()).cast<double>());
      int voxel = lattice.find_voxel(bounded.array().floor().matrix().cast<int>());
      if (voxel < 0) voxel = nearest.find(local, lattice.extent);
      const Vec3 t = local - lattice.voxels[voxel].cast<double>();
      embedding.vertices[p] = lattice.voxel_vertices[voxel];
      for (int c = 0; c < 8; ++c) {
        embedding.weights[p][c] =
            (c & 1 ? t.x() : 1 - t.x()) * (c & 2 ? t.y() : 1 - t.y()) * (c & 4 ? t.z() : 1 - t.z());
      }
    }
  });
  embedding.prepare_transpose(lattice.vertex_count());
  return embedding;
}

}  // namespace muslin
