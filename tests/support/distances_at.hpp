#pragma once

#include "muslin/contact/pair_distances.hpp"

namespace muslin::test {

inline PairDistances distances_at(const ContactCandidates& candidates, ConstVectors x) {
  PairDistances distances(candidates);
  distances.update(x);
  return distances;
}

}  // namespace muslin::test
