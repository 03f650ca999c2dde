// History is what loads remember of a run from step to step, such as plastic angles: named arrays of numbers,
// usually one for each element. It is part of the State, so that it is saved with it and taken back with a
// step that is rejected.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

namespace muslin {

struct History {
  /// Names, each ended by a zero; how many numbers each has; all of them, one array after the other.
  std::vector<std::uint8_t> names;
  std::vector<std::int64_t> counts;
  std::vector<double> values;

  /// Returns the array of this name, of `count` numbers; empty if nothing was remembered so far. Errors:
  /// input, if it has another count.
  std::span<const double> find(std::string_view name, std::size_t count) const;
  /// Returns the same to write to; zeros at first. Valid until the next call.
  std::span<double> get(std::string_view name, std::size_t count);

  template <class Self, class Arrays>
  static void name_arrays(Self& self, Arrays& arrays) {
    // Runs without history do not write it.
    if (std::is_const_v<Self> && self.counts.empty()) return;
    arrays("history.names", self.names);
    arrays("history.counts", self.counts);
    arrays("history.values", self.values);
  }
};

}  // namespace muslin
