// DisjointSets joins numbered things to sets (union-find).
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace muslin {

/// Sets of 0 … count − 1, each thing in one of its own at first. The lowest of a set represents it.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : above_(count) { std::iota(above_.begin(), above_.end(), 0); }

  int find(int thing) {
    while (above(thing) != thing) thing = above(thing) = above(above(thing));
    return thing;
  }
  void join(int a, int b) {
    a = find(a), b = find(b);
    above(std::max(a, b)) = std::min(a, b);
  }
  /// Returns find(thing) of each.
  std::vector<int> find_all() {
    std::vector<int> all(above_.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = find(static_cast<int>(i));
    return all;
  }

 private:
  int& above(int thing) { return above_[static_cast<std::size_t>(thing)]; }
  std::vector<int> above_;
};

}  // namespace muslin
