// The façade of a run: a model and its state, advanced frame by frame.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "muslin/core/progress.hpp"
#include "muslin/core/vectors.hpp"
#include "muslin/potential/state.hpp"
#include "muslin/scene/model.hpp"
#include "muslin/solver/solver.hpp"

namespace muslin {

/// One row of diagnostics.csv. Energies in joule, momentum in kg·m/s, over all bodies. The balance
/// kinetic + elastic + potential − work + dissipated stays what it was at frame 0, up to the solver's
/// residual (docs/theory/energy-balance.md).
struct Diagnostics {
  int frame = 0;
  double time = 0;
  double kinetic = 0, elastic = 0, potential = 0;
  double work = 0;        ///< done from outside since the start (forces, wind, moving pins)
  double dissipated = 0;  ///< lost since the start: damping and the integrator's own
  Vec3 momentum = Vec3::Zero();
  int newton_iterations = 0, linear_iterations = 0;  ///< of this frame
  double residual = 0;                               ///< largest of this frame [m/s²]
  double max_stretch = 1;  ///< largest length / rest length of a spring, or of a shell in any direction
  /// Work of what is out of balance at free vertices since the start: the steps' residual forces times
  /// displacements [J]. By that much balance() has changed.
  double unbalanced = 0;
  /// Smallest gap between surfaces, thickness taken off, at the ends of all steps of the frame [m]; infinity
  /// where it is more than the contact distance, or nothing can touch. Not above 0 only while something is
  /// still as it was in a start that was allowed to be tangled: where triangles cross, at distance 0, it is
  /// −thickness, in a ball or beneath a plane minus the depth.
  double min_distance = 0;
  int held_back = 0;   ///< vertices moved along keyframes that something in their way holds back
  double wall_ms = 0;  ///< time this frame took

  double balance() const { return kinetic + elastic + potential - work + dissipated; }
};

/// Where the time of a run with contact went, since it was made or restored.
struct RunCosts {
  double search = 0, limit = 0, contact = 0;  ///< finding candidates, limiting steps, contact potentials [s]
  double linearize = 0, solve = 0;            ///< Hessians and their factors, linear systems [s]
  std::int64_t searches = 0, limits = 0;      ///< how many
  std::int64_t deflected = 0, shortened = 0;  ///< vertices, summed over limits
};

struct SimulationOptions {
  /// Start although surfaces cross: these are left free of each other until they part.
  bool allow_tangled = false;
};

class Simulation {
 public:
  /// Errors: input, if surfaces cross at the start and may not; usage, if symplectic_euler meets contact.
  explicit Simulation(std::shared_ptr<const Model> model, const SimulationOptions& options = {});
  ~Simulation();
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;

  const Model& model() const;
  const SimulationOptions& options() const;
  const State& state() const;
  int frame() const;                       ///< the last finished frame
  int steps_done() const;                  ///< steps of the frame in work; 0 unless it was interrupted
  const Diagnostics& diagnostics() const;  ///< of the last finished frame
  std::size_t tangled() const;             ///< pairs of triangles that cross still, where that is allowed
  RunCosts costs() const;

  /// Advances to the end of the next frame. A step that fails is halved, up to 8 times; if that fails too,
  /// throws Error(solver) with frame, time, place and what to change, and the state is that of the last good
  /// step. Polls progress.cancelled before each step; after Error(interrupted), or whatever else a load or a
  /// callback throws, the next call goes on from the last whole step.
  void advance(const Progress& progress = {});
  /// One step of that, which finishes the frame if it is the frame's last.
  void step();

  /// Loads besides those of the model, in the energy balance by their role. They may depend on what changes
  /// outside, so they are no part of checkpoints: add them again before restore().
  void add_load(LoadTerm load);

  /// Puts all vertices (#V by 3 [m]) somewhere else, as one would by hand: velocities stay, BDF2 starts anew,
  /// pins that hold take hold where their vertices are now and move on from there, and the change of energy
  /// counts as work. Colliders that move as they are told stay. Contact forgets what stuck. Errors: usage,
  /// for another count or for numbers that are not finite or beyond 1.5e11 m; input, if surfaces would cross.
  void set_positions(ConstVectors positions);
  /// The same for velocities (#V by 3 [m/s]). Errors: usage, for another count or numbers not finite.
  void set_velocities(ConstVectors velocities);

  /// The complete state as bytes, and back: a run continued from it gives the same bits as one that never
  /// stopped. Only the bodies must be the same; pins, loads, duration and solver settings may have changed
  /// (pins that are new take hold of their vertices where they are). restore throws Error(input) if the
  /// bytes are damaged, of other bodies, or inside a frame that now has another number of steps.
  std::vector<std::uint8_t> checkpoint() const;
  void restore(const std::vector<std::uint8_t>& bytes);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace muslin
