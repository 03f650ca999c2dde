// ContactMemory holds the contact state that persists from step to step.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string_view>
#include <vector>

#include "muslin/contact/contact_potential.hpp"
#include "muslin/core/vectors.hpp"
#include "muslin/potential/state_arrays.hpp"

namespace muslin {

template <>
struct ArrayElement<PairSlip> {
  static constexpr std::string_view layout = "u64 f64x3";
};

/// Together with the positions this is all that contact keeps between steps: a run that continues from it
/// gives the same bits.
struct ContactMemory {
  std::vector<PairSlip> slips;  ///< by ascending key
  std::vector<Vec3> begin,
      end;               ///< positions candidates were found for, #P by 3 [m]; empty: search again
  double margin = 0;     ///< margin of their boxes [m]
  double smallest_gap =  ///< at the end of the last step [m]; infinite beyond d̂; −thickness
                         ///< where triangles cross
      std::numeric_limits<double>::infinity();
  /// Pairs of triangles that have crossed since a tangled start; their features are not in contact.
  std::vector<std::array<int, 2>> tangled;
  ContactRules::Set rules = 0;   ///< those in force
  std::uint64_t rules_hash = 0;  ///< of all of them

  template <class Self, class Arrays>
  static void name_arrays(Self& self, Arrays& arrays) {
    arrays("contact.slips", self.slips);
    arrays("contact.candidates_begin", self.begin);
    arrays("contact.candidates_end", self.end);
    arrays("contact.candidates_margin", self.margin);
    arrays("contact.smallest_gap", self.smallest_gap);
    arrays("contact.tangled", self.tangled);
    arrays("contact.rules", self.rules);
    arrays("contact.rules_hash", self.rules_hash);
  }
};

}  // namespace muslin
