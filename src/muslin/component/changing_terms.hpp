// Terms of a component whose numbers change over time.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "muslin/component/component.hpp"

namespace muslin {

/// A component as a function of time [s].
struct ChangingComponent {
  std::vector<double> times;  ///< of keyframes: every term exists at one of them
  /// Returns the numbers that change.
  std::function<std::vector<double>(double time)> numbers;
  /// Returns the component, with its terms, that has the numbers of a time.
  std::function<std::shared_ptr<const Component>(double time)> make;
};

/// Gives `component` the terms of `changing`: in each step those with the numbers of its end, made anew only
/// where numbers have changed. A term is the same at all times by its name. Sets statistics to those of the
/// time of a keyframe at which the stable step is shortest.
void add_changing_terms(Component& component, ChangingComponent changing);

}  // namespace muslin
