#include "muslin/energy/spring_slabs.hpp"

#include <algorithm>

namespace muslin {
namespace {

constexpr int slab_size = 2048;  // vertices: positions and forces of a slab stay in the second-level cache

}  // namespace

SpringSlabs::SpringSlabs(const Springs& springs) {
  int last = 0;
  for (const SpringRun& run : springs.runs) last = std::max({last, run.a + run.length, run.b + run.length});
  slabs_.resize(static_cast<std::size_t>((last + slab_size - 1) / slab_size));
  for (const SpringRun& run : springs.runs) {
    for (int i = 0; i < run.length;) {
      const int slab_a = (run.a + i) / slab_size;
      const int slab_b = (run.b + i) / slab_size;
      const int end =
          std::min({run.length, (slab_a + 1) * slab_size - run.a, (slab_b + 1) * slab_size - run.b});
      const SpringPiece piece{run.direction, run.a + i, run.b + i, end - i, run.first + i};
      if (slab_a == slab_b) {
        slabs_[static_cast<std::size_t>(slab_a)].inner.push_back(piece);
      } else {
        slabs_[static_cast<std::size_t>(slab_a)].leaving.push_back(piece);
        slabs_[static_cast<std::size_t>(slab_b)].entering.push_back(piece);
      }
      i = end;
    }
  }
}

}  // namespace muslin
