// Declares the keys that keyframes have in common.
#pragma once

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

/// The keys of a NumberKeyframe.
const Table& number_keyframe_table();

}  // namespace muslin::schema
