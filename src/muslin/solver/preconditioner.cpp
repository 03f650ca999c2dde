#include "muslin/solver/preconditioner.hpp"

#include <Eigen/Cholesky>

#include "muslin/solver/vector_operations.hpp"

namespace muslin {

BlockJacobi::BlockJacobi(const IncrementalPotential& function, std::span<const Mat3> blocks)
    : inverse_(blocks.size()) {
  parallel_for(blocks.size(), vector_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      if (function.held(v)) {
        inverse_[v].setZero();
      } else {
        inverse_[v] = blocks[v].ldlt().solve(Mat3::Identity());
      }
    }
  });
}

void BlockJacobi::apply(ConstVectors r, Vectors z) const {
  parallel_for(r.size(), vector_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) z[v] = inverse_[v] * r[v];
  });
}

}  // namespace muslin
