// The façade of a run: a model and its state, advanced frame by frame.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "muslin/api.hpp"
#include "muslin/core/progress.hpp"
#include "muslin/core/vectors.hpp"
#include "muslin/potential/state.hpp"
#include "muslin/scene/model.hpp"
#include "muslin/simulation/diagnostics.hpp"
#include "muslin/simulation/simulated_body.hpp"
#include "muslin/solver/solver.hpp"

namespace muslin {

struct SimulationOptions {
  /// Start although surfaces cross: these are left free of each other until they part.
  bool allow_tangled = false;
};

class MUSLIN_API Simulation {
 public:
  /// Errors: input, if surfaces cross at the start and may not; usage, if symplectic_euler meets contact.
  explicit Simulation(std::shared_ptr<const Model> model, const SimulationOptions& options = {});
  ~Simulation();
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;

  const Model& model() const;
  std::shared_ptr<const Model> shared_model() const;  ///< the same; changes with cut and change_model
  const SimulationOptions& options() const;
  const State& state() const;              ///< how all bodies are and move
  int frame() const;                       ///< the last finished frame
  int steps_done() const;                  ///< steps of the frame in work; 0 unless it was interrupted
  const Diagnostics& diagnostics() const;  ///< of the last finished frame
  std::size_t tangled() const;             ///< pairs of triangles that cross still, where that is allowed
  RunCosts costs() const;
  /// Returns the body or collider of that name. Errors: usage, with the nearest name.
  SimulatedBody body(const std::string& name);
  /// Returns where the probe of that name is [m]. Errors: usage, with the nearest name.
  Vec3 probe(const std::string& name) const;

  /// Advances to the end of the next frame. A step that fails is halved, up to 8 times; if that fails too,
  /// throws Error(solver) with frame, time, place and what to change, and the state is that of the last good
  /// step. Polls progress.cancelled before each step; after Error(interrupted), or whatever else a load or a
  /// callback throws, the next call goes on from the last whole step.
  void advance(const Progress& progress = {});
  /// One step of that, which finishes the frame if it is the frame's last.
  void step();

  /// Loads besides those of the model, in the energy balance by their role. They may depend on what changes
  /// outside, so they are no part of checkpoints: add them again before restore(). Errors: usage, if it is
  /// null.
  void add_load(LoadTerm load);

  /// Puts all vertices (#V by 3 [m]) somewhere else, as one would by hand: velocities stay, BDF2 starts anew,
  /// pins that hold take hold where their vertices are now and move on from there, and the change of energy
  /// counts as work. Colliders that move as they are told stay. Contact forgets what stuck. Errors: usage,
  /// for another count or for numbers that are not finite or beyond 1.5e11 m; input, if surfaces would cross.
  void set_positions(ConstVectors positions);
  /// The same for velocities (#V by 3 [m/s]). Errors: usage, for another count or numbers not finite.
  void set_velocities(ConstVectors velocities);

  /// Opens edges of a shell, given by pairs of vertices of its mesh counted from 0, and goes on with what
  /// became of it: cut() in muslin/topology says where vertices part and how new ones are numbered. Vertices
  /// keep their motion, pins what they hold; the energy of hinges that are gone counts as work. Contact
  /// forgets what stuck, and lets both sides of the cut pass until they have parted. Forces and energies that
  /// a program added are dropped with what loads remember, and references to bodies and the model are no
  /// longer valid. A checkpoint made from now on belongs to model(). Errors: usage, for a body that is no
  /// shell or a pair that is no edge; input, where a pin or contact cannot go on.
  void cut(const std::string& body, std::span<const std::array<int, 2>> edges);
  /// Goes on with any other model, whose vertex v continues vertex origins[v] of the model so far. The
  /// change of energy counts as work. Errors: usage, for another number of origins or one out of range;
  /// input, if surfaces would cross.
  void change_model(std::shared_ptr<const Model> model, std::span<const int> origins);

  /// The complete state as bytes, and back: a run continued from it gives the same bits as one that never
  /// stopped. Only the bodies must be the same; pins, loads, duration and solver settings may have changed
  /// (pins that are new take hold of their vertices where they are). restore throws Error(input) if the
  /// bytes are damaged, of other bodies, or inside a frame that now has another number of steps.
  std::vector<std::uint8_t> checkpoint() const;
  void restore(const std::vector<std::uint8_t>& bytes);

  /// Drops every workspace: the next step makes them again. Results do not change.
  void forget_scratch();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace muslin
