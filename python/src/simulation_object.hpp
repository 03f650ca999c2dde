// A simulation as Python sees it: with forces that are Python callables, snapshots of its state as arrays,
// and a guard against use from two threads at once.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "arrays.hpp"

#include "muslin/hosts.hpp"

namespace muslin::python {

class SimulationObject {
 public:
  SimulationObject(std::shared_ptr<const Model> model, const SimulationOptions& options)
      : model_(std::move(model)), simulation_(model_, options), history_{simulation_.diagnostics()} {}

  /// Marks the simulation as being worked on by this thread. Made and destroyed with the GIL held, which may
  /// be given up in between. Errors: usage, if it is being worked on already.
  class Work {
   public:
    explicit Work(SimulationObject& object);
    ~Work() { object_.worker_ = {}; }
    Work(const Work&) = delete;
    Work& operator=(const Work&) = delete;
    Simulation& simulation() { return object_.simulation_; }

   private:
    SimulationObject& object_;
  };

  /// For reading. Errors: usage, if another thread is working on it.
  const Simulation& simulation() const;
  const std::shared_ptr<const Model>& model() const { return model_; }

  void advance(const Progress& progress);
  void step();
  void restore(const std::vector<std::uint8_t>& bytes);
  /// True if the model is no longer that of its scene.
  bool is_cut() const { return cut_; }
  /// The simulation was restored from outside.
  void restored();
  void set_positions(nb::handle positions);
  void set_velocities(nb::handle velocities);
  /// Forces in Python are forgotten.
  void cut(const std::string& body, const std::vector<std::array<int, 2>>& edges);
  /// `function` is called as F(x, v, t) with the vertices of one body, or of all.
  void add_force(nb::object function, const std::string& name, const std::optional<std::string>& body);

  /// Read-only arrays of this moment, made once for each state; they never change.
  nb::object positions();
  nb::object velocities();
  /// A row per frame since the start, or since the state that was restored.
  const std::vector<Diagnostics>& history() const { return history_; }

  /// For Python's search for cycles: a force often refers to its simulation.
  const std::vector<nb::object>& forces() const { return forces_; }
  void forget_forces();

 private:
  void changed();
  void call_force(std::size_t index, const std::string& what, double time, ConstVectors x, ConstVectors v,
                  Vectors f) const;
  nb::object snapshot(nb::object& kept, const std::vector<Vec3>& vectors) const;

  std::shared_ptr<const Model> model_;
  Simulation simulation_;
  std::vector<Diagnostics> history_;
  std::vector<nb::object> forces_;
  bool cut_ = false;
  nb::object positions_, velocities_;
  std::thread::id worker_;
};

/// The body of the model of this name, or the only one that is no collider. Errors: usage.
const Component& find_body(const Model& model, const std::optional<std::string>& name);

}  // namespace muslin::python
