// SimulatedBody gives access to one component of a running simulation: its motion, its stretch, and forces
// and energies that a program adds.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "muslin/api.hpp"
#include "muslin/core/vectors.hpp"
#include "muslin/force/force_function.hpp"
#include "muslin/potential/potential.hpp"
#include "muslin/scene/model.hpp"

namespace muslin {

class Simulation;

/// A reference, valid until the simulation is destroyed or moved.
class MUSLIN_API SimulatedBody {
 public:
  const std::string& name() const { return body_->name; }
  /// Return its vertices, #V by 3, [m] and [m/s]: the nodes of a lattice, the vertices of a shell's or a
  /// moving collider's mesh, the four corners of a rigid body's frame. Valid until the simulation advances.
  ConstVectors positions() const;
  ConstVectors velocities() const;
  /// Returns the positions of the vertices of its mesh, in their order, #P by 3 [m].
  std::vector<Vec3> points() const;
  /// Returns the largest ratio of length to rest length, of an edge or of a triangle in any direction.
  double stretch() const;

  /// Adds a force on each of its vertices, computed by a ForceFunction whose spans are those of this body.
  /// Its work is in the energy balance. Not part of checkpoints: add it again before restore().
  void add_force(const std::string& name, ForceFunction::Function force);
  /// Adds an energy of its vertices, which the solver treats implicitly, like built-in ones; `role` is its
  /// role in the balance. Not part of checkpoints. Errors: usage, if it is null.
  void add_potential(const std::string& name, EnergyRole role, std::shared_ptr<const Potential> potential);

 private:
  friend class Simulation;
  SimulatedBody(Simulation& simulation, const Component& body) : simulation_(&simulation), body_(&body) {}

  Simulation* simulation_;
  const Component* body_;
};

}  // namespace muslin
