// History stores internal variables of loads from step to step, such as plastic angles: named arrays of
// numbers, usually one number per element. It is part of the State: it is saved with it and restored when a
// step is rejected.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

namespace muslin {

struct History {
  /// The names, each terminated by a zero; the length of each array; all arrays, one after the other.
  std::vector<std::uint8_t> names;
  std::vector<std::int64_t> counts;
  std::vector<double> values;

  /// Returns the array of this name, `count` numbers; empty if it was never written. Errors: input, if it has
  /// another length.
  std::span<const double> find(std::string_view name, std::size_t count) const;
  /// Returns the same array for writing; new arrays are zero. Valid until the next call.
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
