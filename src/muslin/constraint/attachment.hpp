// Attachment holds points of bodies together by springs and dashpots, for some time or until they break.
// docs/theory/attachments.md.
#pragma once

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "muslin/constraint/attachment_force.hpp"
#include "muslin/constraint/joints.hpp"
#include "muslin/core/keyed_number.hpp"
#include "muslin/core/vectors.hpp"
#include "muslin/potential/potential.hpp"

namespace muslin {

struct AttachmentRules {
  enum class Rest {
    joined,    ///< the points are pulled together
    distance,  ///< they keep the distance that they had when the attachment began, in any direction
    cord,      ///< they come as close as they like, but not farther apart than that
  } rest = Rest::joined;
  double from = 0, until = std::numeric_limits<double>::infinity();  ///< [s]
  KeyedNumber stiffness = 1, damping = 1, strength = 1;  ///< over time, as factors of those of the joints
};

/// The springs W = Σ ½ k (|z| − L)², with L = 0 if the points are joined and k that of the end of the step. A
/// joint whose force exceeds its strength at the end of a step is broken from then on; its energy is lost.
/// The lengths L and what is broken are in the history.
class Attachment : public Load {
 public:
  /// `name` is unique among the attachments of a run. Errors: usage, if a factor of the rules is negative.
  Attachment(std::string name, const AttachmentRules& rules, std::shared_ptr<const Joints> joints);

  std::unique_ptr<Potential> potential(const StepContext& step) const override;
  void end_step(const Potential& potential, ConstVectors x, History& history) const override;

  const std::string& name() const { return name_; }
  const AttachmentRules& rules() const { return rules_; }
  const Joints& joints() const { return *joints_; }
  /// Returns the force of the springs at x, after a step that ended at `time`.
  AttachmentForce force(double time, ConstVectors x, const History& history) const;

 private:
  friend class AttachmentDamping;
  class Springs;

  /// Returns #joints, the length L of each, −1 where it is broken; empty while the attachment does not act.
  std::vector<double> lengths(const StepContext& step) const;
  JointAnswer answer(double stiffness, double length, const Vec3& z) const;
  /// Returns the stiffness of joint j at a time [N/m].
  double stiffness(std::size_t j, double time) const {
    return rules_.stiffness.at(time) * joints_->stiffness[j];
  }
  /// True for a cord of that length whose ends are `apart` [m].
  bool is_slack(double length, double apart) const {
    return rules_.rest == AttachmentRules::Rest::cord && apart <= length;
  }

  std::string name_, array_;  // of the history
  AttachmentRules rules_;
  std::shared_ptr<const Joints> joints_;
};

/// The dashpots of an attachment, W = Σ c/(2 dt) (n·(z − z₀))² with z₀ at the anchor of the step and n along
/// the joint at its beginning, and with c that of its end; points that are joined resist in all directions,
/// slack cords not at all.
class AttachmentDamping : public Load {
 public:
  explicit AttachmentDamping(std::shared_ptr<const Attachment> attachment);
  std::unique_ptr<Potential> potential(const StepContext& step) const override;

 private:
  class Dashpots;

  std::shared_ptr<const Attachment> attachment_;
};

}  // namespace muslin
