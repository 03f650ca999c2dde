// Yielding lets vertices of animated colliders follow their paths by springs where two obstacles pinch what
// is between them.
//
// Cloth between two parts of a body that pass through each other has no room: a collider that keeps to its
// path presses until gaps are at their floor and no step converges. If a vertex of an animated mesh begins a
// step behind its path, and the path leads into another obstacle, then all vertices of the mesh that are
// behind, or whose paths lead into another obstacle, are free in this step. Springs pull them to their paths,
// and what they press pushes them back.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "muslin/core/vectors.hpp"
#include "muslin/potential/potential.hpp"
#include "muslin/potential/state.hpp"
#include "muslin/scene/model.hpp"

namespace muslin {

/// Stands for the mass of prescribed vertices in the solver [kg].
constexpr double mass_of_prescribed = 1;

class Yielding {
 public:
  Yielding() = default;
  explicit Yielding(const Model& model);

  /// Frees vertices in `before`, where the step begins: sets their fixed[v], masses[v] and
  /// inertial predictions, #V each. Returns the springs to their targets, the places of their paths at the
  /// end of the step; null if none is freed.
  std::unique_ptr<Potential> free(const State& before, StepContext& context, std::span<std::uint8_t> fixed,
                                  ConstVectors targets, std::span<double> masses);
  /// Holds them again; returns how many are behind at x, the end of the step.
  int hold(ConstVectors x, std::span<std::uint8_t> fixed, ConstVectors targets, std::span<double> masses);
  /// Returns the vertices that were freed last.
  std::span<const int> vertices() const { return vertices_; }

 private:
  std::shared_ptr<const ContactModel> contact_;
  double stiffness_ = 0;                   // of a spring [N/m]
  double near_ = 0, clearance_ = 0;        // [m]
  std::vector<const Prescribed*> yields_;  // of the model: animated meshes
  std::vector<int> vertices_;
};

}  // namespace muslin
