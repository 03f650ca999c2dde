// Runs a scene from its file to its run directory, as `muslin run` does.
#pragma once

#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "muslin/api.hpp"
#include "muslin/scene/scene.hpp"

namespace muslin {

struct RunProgress {
  int frame = 0;            ///< frames finished
  int total = 0;            ///< last frame of the run
  double fraction = 0;      ///< of the whole run, or of the stage while building
  double seconds_left = 0;  ///< estimate from the frames so far; NaN before there is one
  std::string stage;        ///< current stage: "distance field", "simulation", …
};

struct RunOptions {
  std::filesystem::path directory;     ///< output directory of the run
  std::vector<std::string> overrides;  ///< KEY=VALUE, as read_scene takes them
  int frames = -1;                     ///< last frame; −1: that of the scene
  bool resume = false;                 ///< continue from the last checkpoint, if any
  int resume_from = -1;                ///< with `resume`: continue from this frame; −1: the last
  /// Start although surfaces cross; these are not in contact until they part. The setting is stored in the
  /// run and applies on resume.
  bool allow_tangled = false;
  bool keep_states = false;  ///< keep the checkpoint of every frame, so that any can be resumed from
  /// Called after each stage, step and frame, in the calling thread.
  std::function<void(const RunProgress&)> report;
  /// Polled before each step. When true: a checkpoint is written, the run is marked `interrupted`, and
  /// run_scene throws Error(interrupted).
  std::function<bool()> cancelled;
};

struct RunResult {
  int first_frame = 0;                ///< 0, or the frame that was resumed from
  int last_frame = 0;                 ///< the last one written
  std::vector<std::string> changes;   ///< settings changed since the run that was resumed
  std::vector<std::string> warnings;  ///< of the model and of the run's quality
};

/// Errors: as read_scene, build_model, RunWriter and Simulation::advance throw them. After Error(solver) the
/// run is marked `failed`, holds the frames up to there and a checkpoint of the last good step.
MUSLIN_API RunResult run_scene(const std::filesystem::path& scene, const RunOptions& options);
/// Runs a scene that has been read; `options.overrides` are not applied again.
MUSLIN_API RunResult run_scene(const Scene& scene, const RunOptions& options);

}  // namespace muslin
