// RunWriter writes a run directory, including the checkpoints for resuming. docs/guide/run-directory.md lists
// the files.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "muslin/api.hpp"
#include "muslin/cache/run_quality.hpp"
#include "muslin/simulation/simulation.hpp"

namespace muslin {

enum class RunStatus { running, finished, interrupted, failed };
MUSLIN_API const char* name_of(RunStatus status);

/// Checkpoints to keep and the frame to resume from.
struct RunHistory {
  bool keep_states = false;  ///< keep the checkpoint of every frame
  int resume_from = -1;      ///< resume from this frame and discard later ones; −1: the newest
};

/// Returns the settings of the run in `directory` that differ from the model's scene, e.g. "time.duration".
/// Errors: input, naming them, if they are incompatible with the frames already written; file.
MUSLIN_API std::vector<std::string> changes_since(const std::filesystem::path& directory, const Model& model);

/// Writes a run. A lock in `checkpoint/` admits one process at a time.
///
/// A frame goes to the disk in this order: points, rows, checkpoint. If the process is killed at any moment,
/// the newest checkpoint therefore has all its frames, and later data is discarded on resume. A checkpoint is
/// written after every frame; states beyond 64 MiB at least every 10 s instead. The content is forced to the
/// disk every 5 s and at the end. The last two checkpoints are kept; with `keep_states` one of every frame,
/// whatever its size.
class MUSLIN_API RunWriter {
 public:
  /// Begins a run at the simulation's frame 0, or with `resume` restores the simulation from the newest
  /// checkpoint, or that of `history.resume_from`, and continues from there; without a checkpoint it starts
  /// from frame 0. An earlier run in `directory` is replaced; only files of muslin are removed. Errors: file,
  /// if the directory cannot be created or written, contains anything other than a run, or is being written
  /// by another process; input, if the run to resume has other bodies (the message names the change) or no
  /// state of frame `history.resume_from`.
  RunWriter(std::filesystem::path directory, Simulation& simulation, int total_frames, bool resume,
            RunHistory history = {});
  /// Leaves the status `running`, as a killed process does, unless finish() was called.
  ~RunWriter();

  bool resumed() const;
  /// Returns the settings that differ from those of the resumed run, e.g. "time.duration".
  const std::vector<std::string>& changes() const;
  /// Adds the frame that the simulation has just finished.
  void write_frame();
  /// Returns the quality of all frames of the run so far.
  const RunQuality& quality() const;
  /// Writes a checkpoint of the step reached, flushes everything, sets the status. `reason` states why a run
  /// failed or stopped.
  void finish(RunStatus status, const std::string& reason = "");
  /// Marks the run failed after Error(file), as far as the disk allows; the last checkpoint stays the one to
  /// resume from.
  void abandon(const std::string& reason);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace muslin
