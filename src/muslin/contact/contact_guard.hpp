// ContactGuard combines search, limiter and energy of contact into the StepGuard that the solver uses. State
// that persists between steps is in a ContactMemory; the guard itself can be discarded between steps.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "muslin/contact/contact_candidates.hpp"
#include "muslin/contact/contact_memory.hpp"
#include "muslin/contact/contact_model.hpp"
#include "muslin/contact/contact_potential.hpp"
#include "muslin/contact/step_limiter.hpp"
#include "muslin/potential/step_guard.hpp"

namespace muslin {

/// Counts of a guard's work since its construction.
struct ContactCounts {
  std::size_t searches = 0;   ///< of candidates
  std::size_t limits = 0;     ///< displacements limited
  std::size_t deflected = 0;  ///< vertices that lost normal approach, summed over displacements
  std::size_t shortened = 0;  ///< vertices shortened by conservative advancement
  double search_seconds = 0, limit_seconds = 0, potential_seconds = 0;
};

/// Throws Error(input) if `memory` does not belong to the model's surfaces.
void require_fit(const ContactMemory& memory, const ContactModel& model);

class ContactGuard : public StepGuard {
 public:
  /// Continues from `memory` and writes to it; the next step gives the same bits as with the guard that wrote
  /// it. The memory must outlive the guard and must not be changed elsewhere. Errors: input, if it belongs to
  /// another surface.
  ContactGuard(std::shared_ptr<const ContactModel> model, ContactMemory& memory);

  void begin(ConstVectors q, std::span<const std::uint8_t> held) override;
  double slack() const override;
  void limit(ConstVectors q, Vectors d) override;
  void limit(ConstVectors q, Vectors d, std::span<const int> groups) override;
  void advance(Vectors q, ConstVectors d) override;
  const Potential& potential(ConstVectors q, StepGuard::Friction friction) override;
  void for_each_contact(const std::function<void(const Contact&)>& visit) const override;
  void end(ConstVectors q) override;

  /// Prepares for a step from q between two times [s]: with the rules in force in its middle and the friction
  /// of its end. Triangles that cross when a rule's contact begins are free until they part.
  void follow_time(ConstVectors q, double begin, double end);

  /// Excludes contact between the features of triangles that cross at q, as below, after vertices were moved
  /// without a limit.
  void free_crossings(ConstVectors q);

  /// Excludes contact between the features of triangles that cross at q, until these triangles part. While
  /// some pairs cross, neighbouring triangles may begin to cross; once no pair crosses, none can cross again.
  void allow_initial_intersections(ConstVectors q);
  /// Excludes contact between the features of these pairs of triangles, as long as they cross, and between
  /// points that are free of each other, until the next call.
  void leave_free(std::vector<std::array<int, 2>> crossing, FreeParts parts);
  /// Returns the number of excluded pairs of triangles that still cross.
  std::size_t tangled() const { return memory_.tangled.size(); }

  /// Returns the potential requested last.
  const ContactPotential& last_potential() const { return *potential_; }
  const ContactMemory& memory() const { return memory_; }
  const ContactCounts& counts() const { return counts_; }

 private:
  std::vector<std::array<int, 2>> crossing(ConstVectors q);
  void find_candidates(ConstVectors begin, ConstVectors end, double margin);
  /// Repeats the last search for candidates.
  void rebuild();
  void forget_renewed();
  template <class Inside>
  std::size_t find_outside(const Inside& inside);
  void renew();
  bool requery_clamped(ConstVectors d);
  void measure(ConstVectors q);
  void ensure_coverage(ConstVectors q, ConstVectors d);
  void shorten(Vectors d) const;

  std::shared_ptr<const ContactModel> model_;
  ContactMemory& memory_;
  ContactCandidates candidates_;
  PairDistances distances_;
  StepLimiter limiter_;
  double margin_;        ///< by which boxes of candidates exceed the motion [m]
  double reach_ = 0;     ///< the same in the present displacement, including pushed vertices [m]
  double edge_;          ///< mean edge length of deformable bodies [m]
  double longest_;       ///< displacement that is limited in one piece [m]
  double longest_push_;  ///< the same for prescribed vertices
  muslin::Friction friction_;
  std::vector<Vec3> start_;  ///< q where the step began
  std::vector<std::uint8_t> held_;
  std::optional<ContactPotential> potential_;
  ContactCounts counts_;
  std::vector<Vec3> x_, to_, piece_;
  std::vector<std::uint8_t> outside_;  ///< points that leave the boxes of the candidates
  bool renewed_ = false;               ///< true if candidates of some points differ from those of memory_
};

}  // namespace muslin
