// RunQuality collects the defects of a run: missed tolerances, held-back vertices, crossings, exceeded
// stretch limits.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "muslin/api.hpp"
#include "muslin/simulation/diagnostics.hpp"

namespace muslin {

/// Summed over the rows of diagnostics.csv and stretch.csv, including rows written before a resume.
struct MUSLIN_API RunQuality {
  /// A shell that was stretched beyond its `stretch_limit`.
  struct Overstretched {
    std::string body;
    std::vector<int> frames;        ///< at whose end it was
    double stretch = 0, limit = 0;  ///< in the frame with the largest excess
    bool fell = false;              ///< the limit, in a frame before or in the first of these
  };
  /// The limit of a shell in the last row.
  struct Limit {
    std::string body;
    double limit = 0;
    bool fell = false;  ///< in this row or an earlier one
  };

  std::int64_t steps = 0, converged_steps = 0;
  double worst_error = 0;             ///< [m]
  std::vector<int> frames_missed;     ///< with steps that missed their tolerance
  std::vector<int> frames_held_back;  ///< at whose end pins or colliders were behind their keyframes
  int max_held_back = 0;              ///< vertices, in the worst frame
  double farthest_behind = 0;         ///< of a held-back vertex from its path, in the worst frame [m]
  std::vector<int> frames_crossing;   ///< at whose end triangles cross
  int crossings_at_end = 0;           ///< pairs of triangles
  std::vector<Overstretched> overstretched;
  std::vector<Limit> limits;
  int last_frame = 0;

  void add(const Diagnostics& row);
  void add(const LimitedStretch& row);
};

/// Returns "frame 3" or "frames 12 to 15 and 20"; for many frames, the first ranges and the number of further
/// frames. `frames` must ascend and not be empty.
MUSLIN_API std::string describe_frames(const std::vector<int>& frames);

/// Returns how far what is held back is behind, such as ", by up to 4.2 mm"; nothing where a table of an
/// earlier version does not say.
MUSLIN_API std::string behind_text(const RunQuality& quality);

/// Returns warnings for the user, one sentence each; empty if there is no defect.
MUSLIN_API std::vector<std::string> warnings_of(const RunQuality& quality);

}  // namespace muslin
