// Declares `interpolation` of keyframes.
#pragma once

#include <string>
#include <vector>

#include "muslin/core/keyframes.hpp"
#include "muslin/schema/declare.hpp"

namespace muslin::schema {

/// The key `interpolation` of keyframes of type K.
template <class K>
Declaration interpolation_key() {
  return word("interpolation", &K::interpolation, {"linear", "step", "smooth"})
      .means(
          "the way to the next keyframe: `\"linear\"`, at a constant rate · `\"step\"`, at once when it is "
          "reached · `\"smooth\"`, begins and ends at rest and never overshoots");
}

}  // namespace muslin::schema
