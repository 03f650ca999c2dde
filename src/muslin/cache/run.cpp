#include "muslin/cache/run.hpp"

#include <chrono>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "muslin/cache/run_files.hpp"
#include "muslin/cache/run_quality.hpp"
#include "muslin/cache/run_writer.hpp"
#include "muslin/core/error.hpp"
#include "muslin/scene/model.hpp"
#include "muslin/simulation/simulation.hpp"

namespace muslin {
namespace {

/// Returns the time left at the mean pace of this session's frames.
class Pace {
 public:
  explicit Pace(double from) : from_(from) {}
  double seconds_left(double frames_done, int total) const {
    const double done = frames_done - from_;
    if (done <= 0) return std::numeric_limits<double>::quiet_NaN();
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begin_;
    return spent.count() / done * (total - frames_done);
  }

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  double from_;
};

}  // namespace

RunResult run_scene(const std::filesystem::path& file, const RunOptions& options) {
  return run_scene(read_scene(file, options.overrides), options);
}

RunResult run_scene(const Scene& scene, const RunOptions& options) {
  const int total = options.frames >= 0 ? options.frames : scene.time.frames();
  RunProgress now;
  now.total = total;
  now.seconds_left = std::numeric_limits<double>::quiet_NaN();
  Progress building;
  building.cancelled = options.cancelled;
  building.report = [&](double fraction, std::string_view stage) {
    now.fraction = fraction;
    now.stage = stage;
    if (options.report) options.report(now);
  };
  const auto model = std::make_shared<const Model>(build_model(scene, building));
  // Checked before the start: other bodies may cross where those of the run did not.
  if (options.resume && is_run(options.directory) && !list_checkpoints(options.directory).empty())
    changes_since(options.directory, *model);
  const bool tangled = options.allow_tangled || (options.resume && is_tangled_run(options.directory));
  const bool resumes = options.resume && !list_checkpoints(options.directory).empty();
  Simulation simulation(model, {.allow_tangled = tangled, .resumes = resumes}, building);
  RunWriter writer(options.directory, simulation, total, options.resume,
                   {options.keep_states, options.resume_from});

  RunResult result;
  result.first_frame = simulation.frame();
  result.changes = writer.changes();
  result.warnings = model->warnings;
  if (simulation.untangled().needed()) result.warnings.push_back(describe(simulation.untangled()));
  const Pace pace(simulation.state().time * scene.time.frame_rate);
  Progress stepping;
  stepping.cancelled = options.cancelled;
  stepping.report = [&](double fraction, std::string_view stage) {
    const double frames = simulation.frame() + fraction;
    now.frame = simulation.frame();
    now.fraction = total > 0 ? std::min(1.0, frames / total) : 1.0;
    now.seconds_left = pace.seconds_left(frames, total);
    now.stage = stage;
    if (options.report) options.report(now);
  };
  try {
    while (simulation.frame() < total) {
      simulation.advance(stepping);
      writer.write_frame();
    }
    stepping.report(0, "simulation");
    writer.finish(RunStatus::finished);
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::interrupted) {
      writer.finish(RunStatus::interrupted,
                    fmt::format("stopped by the user after frame {}", simulation.frame()));
      throw Error(ErrorKind::interrupted, {options.directory.string()},
                  fmt::format("stopped after frame {} of {}", simulation.frame(), total),
                  "continue with --resume");
    }
    if (error.kind() == ErrorKind::file) {
      writer.abandon(error.what());
      throw Error(ErrorKind::file, error.place(), error.problem(),
                  error.remedy() + ", then continue with --resume");
    }
    writer.finish(RunStatus::failed, error.what());
    throw;
  }
  result.last_frame = simulation.frame();
  for (const std::string& warning : warnings_of(writer.quality())) result.warnings.push_back(warning);
  return result;
}

}  // namespace muslin
