// ElementSlabs loops over the elements of a mesh (triangles, hinges) in parallel, in batches for vector code,
// with the same bits for any thread count.
//
// Vertices are cut into slabs of consecutive indices. A slab's task writes to its own vertices only: an
// element between slabs is computed by each of them and owned by the slab of its smallest vertex. All sizes
// depend on the mesh alone.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "muslin/core/parallel.hpp"
#include "muslin/core/vectors.hpp"
#include "muslin/potential/symmetric_pattern.hpp"

namespace muslin {

/// Elements computed at once: the doubles of the widest vector registers.
inline constexpr int element_lanes = 8;

/// Vectors of a batch by corner, axis and lane.
template <int N>
using Batch = double[N][3][element_lanes];

/// The masses that a stiffness may use: see Stiffness::bounded.
struct MassBound {
  double scale = 1;
  double held[element_lanes] = {};  ///< by lane [kg]
};

template <int N>
class ElementSlabs {
 public:
  struct Slab {
    int vertex_begin = 0, vertex_end = 0;
    int begin = 0, owned_end = 0, end = 0;  ///< entries
  };

  /// `vertex_count` is that of the body; elements index its vertices. A slab has at least `smallest`
  /// vertices.
  ElementSlabs(const std::vector<std::array<int, N>>& elements, std::size_t vertex_count, int smallest = 1) {
    const int count = static_cast<int>(vertex_count);
    // Slabs of equal size. Smaller ones would have more elements between them.
    int slabs = std::max({1, std::min(8, count / 640), count / 4096});
    const int size = std::max(smallest, (count + slabs - 1) / slabs);
    slabs = std::max(1, (count + size - 1) / size);
    std::vector<std::vector<int>> owned(static_cast<std::size_t>(slabs)), borrowed = owned;
    for (std::size_t e = 0; e < elements.size(); ++e) {
      std::array<int, N> at = elements[e];
      for (int& v : at) v /= size;
      std::sort(at.begin(), at.end());
      for (int c = 0; c < N; ++c) {
        if (c > 0 && at[c] == at[c - 1]) continue;
        (c == 0 ? owned : borrowed)[static_cast<std::size_t>(at[c])].push_back(static_cast<int>(e));
      }
    }
    for (int s = 0; s < slabs; ++s) {
      const auto& first = owned[static_cast<std::size_t>(s)];
      const auto& second = borrowed[static_cast<std::size_t>(s)];
      Slab slab{s * size, std::min(count, (s + 1) * size), static_cast<int>(elements_.size())};
      elements_.insert(elements_.end(), first.begin(), first.end());
      slab.owned_end = static_cast<int>(elements_.size());
      elements_.insert(elements_.end(), second.begin(), second.end());
      slab.end = static_cast<int>(elements_.size());
      slabs_.push_back(slab);
    }
    for (const int e : elements_) vertices_.push_back(elements[static_cast<std::size_t>(e)]);
  }

  /// Entry e stands for element elements()[e] with these vertices.
  const std::vector<int>& elements() const { return elements_; }
  const std::vector<std::array<int, N>>& vertices() const { return vertices_; }
  const std::vector<Slab>& slabs() const { return slabs_; }

  /// Calls batch(first, count, slab) for at most element_lanes entries at a time; slabs run in parallel.
  template <class Body>
  void for_each_batch(const Body& batch) const {
    parallel_for(slabs_.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t s = begin; s < end; ++s) {
        for (int e = slabs_[s].begin; e < slabs_[s].end; e += element_lanes)
          batch(e, std::min(element_lanes, slabs_[s].end - e), slabs_[s]);
      }
    });
  }

  /// Calls batch(first, count) likewise for every element once.
  template <class Body>
  void for_each_owned_batch(const Body& batch) const {
    parallel_for(slabs_.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t s = begin; s < end; ++s) {
        for (int e = slabs_[s].begin; e < slabs_[s].owned_end; e += element_lanes)
          batch(e, std::min(element_lanes, slabs_[s].owned_end - e));
      }
    });
  }

  /// As for_each_batch; returns the sum of batch(first, count, owned, slab). A call must return the sum over
  /// its first `owned` entries only, so that each element counts once.
  template <class Body>
  double sum_of_batches(const Body& batch) const {
    return parallel_sum(slabs_.size(), 1, 0.0, [&](std::size_t begin, std::size_t end) {
      double total = 0;
      for (std::size_t s = begin; s < end; ++s) {
        for (int e = slabs_[s].begin; e < slabs_[s].end; e += element_lanes) {
          total += batch(e, std::min(element_lanes, slabs_[s].end - e),
                         std::clamp(slabs_[s].owned_end - e, 0, element_lanes), slabs_[s]);
        }
      }
      return total;
    });
  }

  /// Returns the combination by + of term(first, count) over all elements, each taken once.
  template <class Value, class Term>
  Value sum(Value zero, const Term& term) const {
    return parallel_sum(slabs_.size(), 1, zero, [&](std::size_t begin, std::size_t end) {
      Value total = zero;
      for (std::size_t s = begin; s < end; ++s) {
        for (int e = slabs_[s].begin; e < slabs_[s].owned_end; e += element_lanes)
          total = total + term(e, std::min(element_lanes, slabs_[s].owned_end - e));
      }
      return total;
    });
  }

  /// Loads x at the corners of entries first … first + count − 1; further lanes repeat the last.
  void gather(int first, int count, ConstVectors x, Batch<N>& out) const {
    for (int l = 0; l < element_lanes; ++l) {
      const auto& vertices = vertices_[static_cast<std::size_t>(first + std::min(l, count - 1))];
      for (int c = 0; c < N; ++c) {
        const Vec3& from = x[static_cast<std::size_t>(vertices[static_cast<std::size_t>(c)])];
        for (int axis = 0; axis < 3; ++axis) out[c][axis][l] = from[axis];
      }
    }
  }

  /// Sets, by entry, a bit for each corner that lies in the slab.
  void corners_in(int first, int count, const Slab& slab, unsigned* bits) const {
    for (int l = 0; l < count; ++l) {
      bits[l] = 0;
      for (int c = 0; c < N; ++c) {
        const int v = vertices_[static_cast<std::size_t>(first + l)][static_cast<std::size_t>(c)];
        if (v >= slab.vertex_begin && v < slab.vertex_end) bits[l] |= 1U << c;
      }
    }
  }

  /// Adds to those corners that lie in the slab.
  void scatter(int first, int count, const Slab& slab, const Batch<N>& from, Vectors to) const {
    for (int l = 0; l < count; ++l) {
      const auto& vertices = vertices_[static_cast<std::size_t>(first + l)];
      for (int c = 0; c < N; ++c) {
        const int v = vertices[static_cast<std::size_t>(c)];
        if (v < slab.vertex_begin || v >= slab.vertex_end) continue;
        to[static_cast<std::size_t>(v)] += Vec3(from[c][0][l], from[c][1][l], from[c][2][l]);
      }
    }
  }

  /// Returns, by entry, the blocks of the pairs of corners i ≤ j in the order (0,0), (0,1), …, (1,1), …;
  /// ~block where corner i has the higher vertex index, so that the block has row j and column i.
  static constexpr int pair_count = N * (N + 1) / 2;
  using Slots = std::array<int, pair_count>;
  std::vector<Slots> slots(const SymmetricPattern& pattern) const {
    std::vector<Slots> slots(vertices_.size());
    for (std::size_t e = 0; e < slots.size(); ++e) {
      std::size_t pair = 0;
      for (std::size_t i = 0; i < N; ++i) {
        for (std::size_t j = i; j < N; ++j) {
          const int v = vertices_[e][i], u = vertices_[e][j];
          slots[e][pair++] = v <= u ? pattern.find(v, u) : ~pattern.find(u, v);
        }
      }
    }
    return slots;
  }

  /// Converts values by element to an array by entry, long enough to read whole batches.
  template <class Value, class Get>
  std::vector<Value> by_entry(const Get& value_of_element) const {
    std::vector<Value> values;
    values.reserve(elements_.size() + element_lanes);
    for (const int e : elements_) values.push_back(value_of_element(static_cast<std::size_t>(e)));
    values.resize(values.size() + element_lanes, Value{});
    return values;
  }

 private:
  std::vector<Slab> slabs_;
  std::vector<int> elements_;
  std::vector<std::array<int, N>> vertices_;
};

}  // namespace muslin
