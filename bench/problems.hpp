// The bodies that speeds are measured on: the thesis's flag at several resolutions, and a cube.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "support/lattice_box.hpp"
#include "textbook.hpp"

#include "muslin/energy/spring_energy.hpp"
#include "muslin/solver/solver.hpp"

namespace muslin::bench {

/// One body at the beginning of one step. Springs of 20000/100/100 N/m² × voxel width and 10 kg/m³ at every
/// resolution, so that a finer lattice is the same body cut finer: k dt²/m grows with 1/width².
struct Problem {
  std::string name;
  double dt = 0;
  Lattice lattice;
  Springs lattice_springs;
  std::vector<double> masses;
  std::vector<std::uint8_t> fixed;
  std::shared_ptr<const SpringEnergy> springs;
  std::shared_ptr<const Potential> gravity;
  std::vector<Vec3> rest_positions;
  bool coarse_space = true;  ///< whether steps may use it
  State state;

  StepProblem step_problem() const {
    return {masses,  {springs.get(), gravity.get()},
            fixed,   state.positions,
            nullptr, coarse_space ? ConstVectors(rest_positions) : ConstVectors()};
  }
  TextbookProblem textbook() const;
  /// Largest k dt² / m of an edge inside the body.
  double stiffness_number() const;
  /// Share of the edges that are shorter than at rest: what buckles.
  double compressed_share() const;
};

enum class Start {
  rest,  ///< hanging from two corners of the top
  /// Likewise, but every vertex flies towards the middle of the top at 10 /s times its distance: faster than
  /// waves of compression run, so that the body folds in many places.
  flung,
};

/// How the state before the measured step is reached: from rest, flung, or from that of another case (`from`;
/// interpolated if that is coarser), by `steps` steps of `dt`.
struct ProblemSettings {
  std::string name;
  Vec3i extent;
  double width = 1;  ///< [m]
  double dt = 1.0 / 240;
  Start start = Start::rest;
  int steps = 20;
  std::string from = {};
  bool only_system = false;  ///< whole steps are not measured
};

/// All cases, in the order in which they are measured.
const std::vector<ProblemSettings>& cases();
const ProblemSettings& case_named(const std::string& name);

/// States are kept in MUSLIN_BENCH_STATES from one run of the program to the next.
Problem make_problem(const ProblemSettings& settings);

}  // namespace muslin::bench
