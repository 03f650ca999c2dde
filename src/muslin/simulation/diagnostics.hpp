// Diagnostics is a row of numbers for each frame of a run; RunCosts is the time that its parts took.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "muslin/api.hpp"
#include "muslin/core/vectors.hpp"
#include "muslin/scene/model.hpp"

namespace muslin {

/// One row of diagnostics.csv. Energies in joule, momentum in kg·m/s, over all bodies. The balance kinetic +
/// elastic + potential − work + dissipated keeps its value of frame 0, up to the solver's residual
/// (docs/theory/energy-balance.md).
struct Diagnostics {
  int frame = 0;
  double time = 0;
  double kinetic = 0, elastic = 0, potential = 0;
  double work = 0;        ///< external work since the start (forces, wind, moving pins)
  /// Share of `work` that changes of the material's numbers did, by keyframes or on a resume: the change of
  /// the elastic energy at the positions of that time.
  double material_work = 0;
  double dissipated = 0;  ///< lost since the start, by damping, internal friction and the integrator
  Vec3 momentum = Vec3::Zero();
  int newton_iterations = 0, linear_iterations = 0;  ///< of this frame
  double residual = 0;                               ///< largest of this frame [m/s²]
  double max_stretch = 1;  ///< largest length / rest length of a spring, or of a shell in any direction
  /// Work of the residual forces at free vertices since the start [J]: the sum over the steps of residual
  /// force times displacement. balance() has changed by this amount.
  double unbalanced = 0;
  /// Smallest gap between surfaces, thickness subtracted, at the ends of all steps of the frame [m]; infinity
  /// if it exceeds the contact distance or nothing can touch. It is 0 or less only while surfaces of a
  /// tangled start still cross: −thickness where triangles cross (distance 0), minus the depth inside a ball
  /// or beneath a plane.
  double min_distance = 0;
  int held_back = 0;        ///< vertices moved along keyframes that an obstacle holds back
  /// Largest distance of such a vertex from its place on its path, at the end of the frame [m].
  double behind = 0;
  int steps = 0;            ///< of this frame
  int converged_steps = 0;  ///< number of them that ended within tolerance
  double error = 0;         ///< largest estimated error of a step of this frame, as a displacement [m]
  int crossings = 0;        ///< pairs of triangles that still cross after a tangled start
  double penetration = 0;   ///< largest depth of a crossing or inside a collider [m]
  double wall_ms = 0;       ///< time this frame took

  double balance() const { return kinetic + elastic + potential - work + dissipated; }

  /// Names all members except wall_ms, which differs between runs.
  template <class Self, class Arrays>
  static void name_arrays(Self& self, Arrays& arrays) {
    arrays("diagnostics.frame", self.frame);
    arrays("diagnostics.time", self.time);
    arrays("diagnostics.kinetic", self.kinetic);
    arrays("diagnostics.elastic", self.elastic);
    arrays("diagnostics.potential", self.potential);
    arrays("diagnostics.work", self.work);
    arrays("diagnostics.material_work", self.material_work);
    arrays("diagnostics.dissipated", self.dissipated);
    arrays("diagnostics.momentum", self.momentum);
    arrays("diagnostics.newton_iterations", self.newton_iterations);
    arrays("diagnostics.linear_iterations", self.linear_iterations);
    arrays("diagnostics.residual", self.residual);
    arrays("diagnostics.max_stretch", self.max_stretch);
    arrays("diagnostics.unbalanced", self.unbalanced);
    arrays("diagnostics.min_distance", self.min_distance);
    arrays("diagnostics.held_back", self.held_back);
    arrays("diagnostics.behind", self.behind);
    arrays("diagnostics.steps", self.steps);
    arrays("diagnostics.converged_steps", self.converged_steps);
    arrays("diagnostics.error", self.error);
    arrays("diagnostics.crossings", self.crossings);
    arrays("diagnostics.penetration", self.penetration);
  }
};

/// Counts of the current frame so far.
struct FrameCounts {
  std::int64_t newton = 0, linear = 0;                            ///< iterations
  double residual = 0;                                            ///< the largest [m/s²]
  double smallest_gap = std::numeric_limits<double>::infinity();  ///< at the ends of its steps [m]
  int held_back = 0;                                              ///< vertices, at the end of the last step
  int steps = 0, converged_steps = 0;                             ///< made, and within their tolerance
  double error = 0;                                               ///< the largest estimate [m]

  template <class Self, class Arrays>
  static void name_arrays(Self& self, Arrays& arrays) {
    arrays("frame.newton_iterations", self.newton);
    arrays("frame.linear_iterations", self.linear);
    arrays("frame.residual", self.residual);
    arrays("frame.smallest_gap", self.smallest_gap);
    arrays("frame.held_back", self.held_back);
    arrays("frame.steps", self.steps);
    arrays("frame.converged_steps", self.converged_steps);
    arrays("frame.error", self.error);
  }
};

/// Time that the parts of a run have taken since its construction.
struct RunCosts {
  double search = 0, limit = 0, contact = 0;  ///< finding candidates, limiting steps, contact potentials [s]
  double linearize = 0, solve = 0;            ///< Hessians and their factors, linear systems [s]
  std::int64_t searches = 0, limits = 0;      ///< how many
  std::int64_t deflected = 0, shortened = 0;  ///< vertices, summed over limits
};

/// Returns the largest ratio of length to rest length over all bodies at x (#V by 3 [m]): of a spring, or of
/// a shell in any direction; 1 without bodies.
MUSLIN_API double max_stretch(const Model& model, ConstVectors x);

/// The stretch of a shell that has a `stretch_limit`, at the end of a frame.
struct LimitedStretch {
  int frame = 0;
  double stretch = 1;  ///< the largest of a triangle in any direction
  double limit = 0;    ///< its `stretch_limit` at that time
  std::string body;
};

/// Returns the stretch of each shell with a limit; `frame` is stored in each.
MUSLIN_API std::vector<LimitedStretch> limited_stretches(const Model& model, const State& state, int frame);

}  // namespace muslin
