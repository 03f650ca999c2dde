// Simulation is the façade of a run: a model and its state, advanced frame by frame.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "muslin/api.hpp"
#include "muslin/constraint/attachment_force.hpp"
#include "muslin/core/progress.hpp"
#include "muslin/core/vectors.hpp"
#include "muslin/potential/state.hpp"
#include "muslin/scene/model.hpp"
#include "muslin/simulation/diagnostics.hpp"
#include "muslin/simulation/pin_force.hpp"
#include "muslin/simulation/simulated_body.hpp"
#include "muslin/simulation/untangled.hpp"
#include "muslin/solver/solver.hpp"

namespace muslin {

struct SimulationOptions {
  /// Start although surfaces cross, as with the scene's `tangled = "ignore"`.
  bool allow_tangled = false;
  /// The start is about to be replaced by a checkpoint: it is neither refused nor repaired.
  bool resumes = false;
};

class MUSLIN_API Simulation {
 public:
  /// Pulls surfaces apart that cross at the start, if the scene says so; that reports to `progress`. Errors:
  /// input, if surfaces cross at the start and the scene refuses that; usage, if the model has contact and
  /// the integrator is symplectic_euler; interrupted.
  explicit Simulation(std::shared_ptr<const Model> model, const SimulationOptions& options = {},
                      const Progress& progress = {});
  ~Simulation();
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;

  const Model& model() const;
  std::shared_ptr<const Model> shared_model() const;  ///< replaced by cut and change_model
  const SimulationOptions& options() const;
  const State& state() const;              ///< positions and velocities of all bodies
  int frame() const;                       ///< the last finished frame
  int steps_done() const;                  ///< steps of the current frame; 0 unless it was interrupted
  const Diagnostics& diagnostics() const;  ///< of the last finished frame
  const Untangled& untangled() const;      ///< the repair of the start
  std::size_t tangled() const;             ///< pairs of triangles that still cross after a tangled start
  RunCosts costs() const;
  /// Returns the body or collider of that name. Errors: usage, with the nearest name.
  SimulatedBody body(const std::string& name);
  /// Returns the position of the probe of that name [m]. Errors: usage, with the nearest name.
  Vec3 probe(const std::string& name) const;
  /// Returns the force of the pin of that name in the last step. Errors: usage, with the nearest name.
  PinForce pin_force(const std::string& name) const;
  /// Returns the force of the springs of the attachment of that name. Errors: usage, with the nearest name.
  AttachmentForce attachment_force(const std::string& name) const;

  /// Advances to the end of the next frame. A step that fails is halved, up to 8 times; if that fails too,
  /// throws Error(solver) with frame, time, place and remedy, and the state is that of the last good step.
  /// Polls progress.cancelled before each step. After Error(interrupted), or an exception from a load or a
  /// callback, the next call continues from the last completed step.
  void advance(const Progress& progress = {});
  /// Advances one step and finishes the frame if this is its last step.
  void step();

  /// Adds a load besides those of the model; its role places it in the energy balance. Added loads are not
  /// part of checkpoints, because they may depend on external data: add them again before restore(). Errors:
  /// usage, if it is null.
  void add_load(LoadTerm load);

  /// Moves all vertices to `positions` (#V by 3 [m]), as if by hand: velocities are kept, BDF2 restarts,
  /// active pins hold their vertices at the new positions and move them on from there, and the change of
  /// energy counts as work. Prescribed colliders keep their scripted positions. Contact loses its friction
  /// memory. Errors: usage, for another number of vertices, or coordinates that are not finite or beyond
  /// 1.5e11 m; input, if surfaces would cross.
  void set_positions(ConstVectors positions);
  /// Sets the velocities (#V by 3 [m/s]), likewise. Errors: usage, for another number of vertices or numbers
  /// that are not finite.
  void set_velocities(ConstVectors velocities);

  /// Cuts a shell open along edges, given by pairs of vertices of its mesh counted from 0, and continues with
  /// the changed shell. cut() in muslin/topology states where vertices are split and how new ones are
  /// numbered. Vertices keep their motion and pins their vertices; the energy of removed hinges counts as
  /// work. Contact loses its friction memory, and both sides of the cut do not touch until they have parted.
  /// Forces and energies that a program added are dropped, as is the history of loads, and references to
  /// bodies and the model become invalid. Later checkpoints belong to the new model(). Errors: usage, for a
  /// body that is not a shell or a pair that is not an edge; input, if a pin or contact cannot continue.
  void cut(const std::string& body, std::span<const std::array<int, 2>> edges);
  /// Continues with another model, whose vertex v takes over the motion of vertex origins[v] of the current
  /// model. The change of energy counts as work. Errors: usage, if the number of origins is wrong or one is
  /// out of range; input, if surfaces would cross.
  void change_model(std::shared_ptr<const Model> model, std::span<const int> origins);

  /// Save the complete state as bytes and restore it: a run continued from a checkpoint gives the same bits
  /// as one that never stopped. Only the bodies must be the same; pins, loads, duration and solver settings
  /// may have changed (new pins hold their vertices where they are). restore throws Error(input) if the bytes
  /// are damaged, belong to other bodies, or were saved inside a frame that now has another number of steps.
  std::vector<std::uint8_t> checkpoint() const;
  void restore(const std::vector<std::uint8_t>& bytes);

  /// Drops all workspaces; the next step rebuilds them. Results do not change.
  void forget_scratch();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace muslin
