// KeyedStretchLimit is the stretch limit of a shell (stretch_limit.hpp) that changes over time.
//
// Each triangle has a limit a of its own, which follows the keyed limit s without a jump. Over a step of
// length h, with the largest stretch λ of the triangle at its beginning,
//
//   a ← s                                s ≥ a
//   a ← max(s, min(a, 2 λ − 1) − r h)    s < a,
//
// so that the limit grows at once, and shrinks at once as far as the triangle stores no energy of it: the
// onset of the limit 2 λ − 1 is λ. From there it shrinks by r = 1/s, all of the rest length in a second, at
// most. docs/theory/shells.md.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "muslin/core/keyed_number.hpp"
#include "muslin/energy/stretch_limit.hpp"
#include "muslin/potential/potential.hpp"

namespace muslin {

/// Yields a StretchLimitEnergy. The limits of the triangles are in the history.
class KeyedStretchLimit : public Load {
 public:
  /// `body` names the limits in the history; `stiffness` returns κ [N/m] of a limit; `pattern` is the shell's
  /// block_pattern, or null. Errors: usage, if a limit is not above 1.
  KeyedStretchLimit(const std::string& body, const Shell& shell, KeyedNumber limit,
                    std::function<double(double limit)> stiffness,
                    std::shared_ptr<const SymmetricPattern> pattern = nullptr);

  std::unique_ptr<Potential> potential(const StepContext& step) const override;
  void end_step(const Potential& potential, ConstVectors x, History& history) const override;

 private:
  class Energy;

  std::vector<double> limits(const StepContext& step) const;
  std::vector<double> stiffnesses(const std::vector<double>& limits) const;

  std::string name_;  // of the history
  KeyedNumber limit_;
  std::function<double(double)> stiffness_;
  std::vector<Vec3i> triangles_;
  std::vector<Mat2> inverses_;
  std::unique_ptr<const StretchLimitEnergy> first_;  // whose triangles all others share
};

}  // namespace muslin
