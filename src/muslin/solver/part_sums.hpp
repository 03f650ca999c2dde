// sum_by_part sums over the vertices of each part of a step (a body or a group of bodies), in parallel and
// with the same bits for any thread count.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "muslin/core/parallel.hpp"

namespace muslin {

/// Calls add(sums[part_of(v)], v) for v = 0 … count − 1 and returns the sums of `parts` parts. Sum{} must be
/// zero, and Sum needs an operator+=.
template <class Sum, class PartOf, class Add>
std::vector<Sum> sum_by_part(std::size_t count, std::size_t parts, const PartOf& part_of, const Add& add) {
  // A block has at least four vertices per part, so that adding up the blocks costs little.
  const std::size_t grain = std::max<std::size_t>(2048, 4 * parts);
  std::vector<Sum> sums(parts);
  const std::size_t blocks = std::max<std::size_t>(1, (count + grain - 1) / grain);
  std::vector<std::vector<Sum>> of_block(blocks - 1, sums);
  parallel_for(count, grain, [&](std::size_t begin, std::size_t end) {
    std::vector<Sum>& own = begin == 0 ? sums : of_block[begin / grain - 1];
    for (std::size_t v = begin; v < end; ++v) add(own[part_of(v)], v);
  });
  for (const std::vector<Sum>& block : of_block)
    for (std::size_t p = 0; p < parts; ++p) sums[p] += block[p];
  return sums;
}

}  // namespace muslin
