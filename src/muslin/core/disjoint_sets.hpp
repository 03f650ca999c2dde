// DisjointSets is a union-find over the elements 0 … count − 1.
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace muslin {

/// At first every element is a set by itself. The smallest element of a set represents it.
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
  /// Returns the representative of every element.
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
