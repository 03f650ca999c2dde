// Run directories: written, read, exported.
#include <exception>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <variant>

#include "bindings.hpp"
#include "callbacks.hpp"
#include "diagnostics.hpp"
#include "errors.hpp"
#include "json.hpp"
#include "paths.hpp"
#include "simulation_object.hpp"
#include <fmt/format.h>
#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

namespace nb = nanobind;
using namespace nb::literals;

namespace muslin::python {
namespace {

namespace fs = std::filesystem;
using RunReport = std::optional<nb::typed<nb::callable, nb::object(RunProgress)>>;

SurfaceKind surface_called(const std::string& name) {
  return static_cast<SurfaceKind>(choice(name, {"skin", "contour"}, "surface"));
}

/// run_scene marks a run `interrupted` only when it is asked to stop. So what a callback raises, Ctrl-C among
/// it, is kept, the run stopped, and then raised.
class Keeper {
 public:
  template <class Call>
  void keep(const Call& call) {
    if (kept_) return;
    try {
      call();
    } catch (...) {
      kept_ = std::current_exception();
    }
  }
  bool has() const { return kept_ != nullptr; }
  void raise() const {
    if (kept_) std::rethrow_exception(kept_);
  }

 private:
  std::exception_ptr kept_;
};

/// −1: the last.
int first_frame(std::optional<int> resume_from) {
  if (resume_from && *resume_from < 0)
    throw Error(ErrorKind::usage, "resume_from is below 0", "give the frame to resume from");
  return resume_from.value_or(-1);
}

RunResult run(const Scene& scene, const FilePath& directory, std::optional<int> frames, bool resume,
              std::optional<int> resume_from, bool keep_states, bool allow_tangled, const RunReport& progress,
              const Cancel& cancel) {
  if (frames && *frames < 0) throw Error(ErrorKind::usage, "frames is below 0", "give the last frame");
  RunOptions options;
  options.directory = directory;
  options.frames = frames.value_or(-1);
  options.resume = resume || resume_from;
  options.resume_from = first_frame(resume_from);
  options.keep_states = keep_states;
  options.allow_tangled = allow_tangled;
  Keeper keeper;
  if (progress) {
    options.report = [&](const RunProgress& now) {
      keeper.keep([&] {
        const nb::gil_scoped_acquire gil;
        (*progress)(now);
      });
    };
  }
  options.cancelled = [&] {
    bool stop = false;
    keeper.keep([&] { stop = is_cancelled(cancel); });
    return stop || keeper.has();
  };
  const nb::gil_scoped_release nogil;
  try {
    RunResult result = run_scene(scene, options);
    keeper.raise();
    return result;
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::interrupted) keeper.raise();
    throw;
  }
}

RunStatus status_called(const std::string& name) {
  const std::vector<std::string> names = {"running", "finished", "interrupted", "failed"};
  return static_cast<RunStatus>(choice(name, names, "status of a run"));
}

/// A writer that closes its run by how the `with` block ended.
class RunWriterObject {
 public:
  RunWriterObject(const FilePath& directory, SimulationObject& simulation, std::optional<int> frames,
                  bool resume, std::optional<int> resume_from, bool keep_states)
      : simulation_(simulation), frames_(frames.value_or(simulation.model()->scene.time.frames())) {
    if (frames_ < 0) throw Error(ErrorKind::usage, "frames is below 0", "give the last frame");
    {
      SimulationObject::Work work(simulation);
      const nb::gil_scoped_release nogil;
      writer_ = std::make_unique<RunWriter>(directory, work.simulation(), frames_, resume || resume_from,
                                            RunHistory{keep_states, first_frame(resume_from)});
    }
    if (writer_->resumed()) simulation.restored();
  }

  bool resumed() { return writer().resumed(); }
  std::vector<std::string> changes() { return writer().changes(); }
  void write_frame() {
    SimulationObject::Work work(simulation_);
    RunWriter& to = writer();
    const nb::gil_scoped_release nogil;
    to.write_frame();
  }
  void finish(const std::string& status, const std::string& reason) {
    SimulationObject::Work work(simulation_);
    writer().finish(status_called(status), reason);
    writer_.reset();
  }
  void exit(nb::handle exception) {
    if (!writer_) return;
    SimulationObject::Work work(simulation_);
    const std::unique_ptr<RunWriter> closing = std::move(writer_);
    const Simulation& simulation = work.simulation();
    const std::string after = fmt::format("stopped after frame {}", simulation.frame());
    if (exception.is_none()) {
      const bool done = simulation.frame() >= frames_;
      return closing->finish(done ? RunStatus::finished : RunStatus::interrupted, done ? "" : after);
    }
    const nb::module_ errors = nb::module_::import_("muslin.errors");
    const std::string text = nb::str(exception).c_str();
    if (nb::isinstance(exception, errors.attr("FileError"))) return closing->abandon(text);
    const bool stopped = nb::isinstance(exception, errors.attr("Interrupted")) ||
                         nb::isinstance(exception, nb::handle(PyExc_KeyboardInterrupt));
    closing->finish(stopped ? RunStatus::interrupted : RunStatus::failed, stopped ? after : text);
  }

 private:
  RunWriter& writer() {
    if (!writer_) throw Error(ErrorKind::usage, "the run is closed", "make a new RunWriter");
    return *writer_;
  }

  SimulationObject& simulation_;  // kept alive by the Python object
  int frames_;
  std::unique_ptr<RunWriter> writer_;
};

/// Indices that Python gives, checked.
class Bodies {
 public:
  Bodies(const RunReader& run, const std::optional<std::string>& body) : index_(find(run, body)) {}
  int index() const { return index_; }

 private:
  static int find(const RunReader& run, const std::optional<std::string>& body) {
    if (body) return static_cast<int>(choice(*body, run.bodies(), "body of the run"));
    int only = -1, soft = 0;
    for (int b = 0; b < static_cast<int>(run.bodies().size()); ++b) {
      if (run.is_collider(b)) continue;
      only = b;
      ++soft;
    }
    if (soft != 1)
      throw Error(ErrorKind::usage, "the run has several bodies", "name one of " + name_list(run.bodies()));
    return only;
  }
  int index_;
};

int frame_of(const RunReader& run, int frame) {
  const int at = frame < 0 ? frame + run.frame_count() : frame;
  if (at < 0 || at >= run.frame_count()) {
    throw Error(ErrorKind::usage, fmt::format("the run has no frame {}", frame),
                fmt::format("give a frame from 0 to {}", run.frame_count() - 1));
  }
  return at;
}

int lattice_body(const RunReader& run, const std::optional<std::string>& body) {
  const int index = Bodies(run, body).index();
  if (!run.has_cells(index)) throw Error(ErrorKind::usage, "the body has no lattice", "take its skin");
  return index;
}

void bind_writer(nb::module_& m) {
  nb::class_<RunWriterObject>(
      m, "RunWriter",
      "Writes a run directory from a simulation that the program advances itself:\n\n"
      "    with muslin.RunWriter(\"out\", simulation) as writer:\n"
      "        for frame in simulation:\n"
      "            writer.write_frame()\n\n"
      "The run is finished if it reached its last frame, interrupted or failed if the block\n"
      "was left earlier; then `resume=True` continues from its last checkpoint.")
      .def(
          nb::init<const FilePath&, SimulationObject&, std::optional<int>, bool, std::optional<int>, bool>(),
          "directory"_a, "simulation"_a, nb::kw_only(), "frames"_a = nb::none(), "resume"_a = false,
          "resume_from"_a = nb::none(), "keep_states"_a = false, nb::keep_alive<1, 3>(),
          "Begins a run at frame 0, in place of an earlier one in `directory`; with `resume` it restores "
          "the\n"
          "simulation from the newest checkpoint, if there is one. frames: the last frame, else the scene's.")
      .def_prop_ro("resumed", &RunWriterObject::resumed, "Whether it went on from a checkpoint.")
      .def_prop_ro("changes", &RunWriterObject::changes,
                   "Settings that differ from those of the run resumed.")
      .def("write_frame", &RunWriterObject::write_frame,
           "Adds the frame that the simulation has just finished.")
      .def("finish", &RunWriterObject::finish, "status"_a = "finished", "reason"_a = "",
           "Closes the run as \"finished\", \"interrupted\" or \"failed\".")
      .def(
          "__enter__", [](nb::handle self) { return nb::borrow(self); },
          nb::sig("def __enter__(self) -> RunWriter"))
      .def(
          "__exit__",
          [](RunWriterObject& self, nb::handle, nb::handle exception, nb::handle) { self.exit(exception); },
          nb::arg().none(), nb::arg().none(), nb::arg().none(),
          nb::sig(
              "def __exit__(self, type: type[BaseException] | None, value: BaseException | None, traceback: "
              "types.TracebackType | None, /) -> None"));
}

}  // namespace

void bind_run(nb::module_& m) {
  nb::class_<RunProgress>(m, "RunProgress", "How far a run is.")
      .def_ro("frame", &RunProgress::frame, "Frames finished.")
      .def_ro("total", &RunProgress::total, "The last frame of the run.")
      .def_ro("fraction", &RunProgress::fraction, "Of the whole run, or of the stage while building.")
      .def_ro("seconds_left", &RunProgress::seconds_left, "An estimate; NaN before there is one.")
      .def_ro("stage", &RunProgress::stage, "The current stage.");
  nb::class_<RunResult>(m, "RunResult", "The result of a run.")
      .def_ro("first_frame", &RunResult::first_frame, "0, or the frame that was resumed from.")
      .def_ro("last_frame", &RunResult::last_frame)
      .def_ro("changes", &RunResult::changes, "Settings changed since the run that was resumed.")
      .def_ro("warnings", &RunResult::warnings, "Of the model.")
      .def("__repr__", [](const RunResult& result) {
        return fmt::format(
            "<muslin.RunResult frames {} to {}{}>", result.first_frame, result.last_frame,
            result.warnings.empty() ? "" : fmt::format(", {} warnings", result.warnings.size()));
      });
  m.def(
      "run", &run, "scene"_a, "directory"_a, nb::kw_only(), "frames"_a = nb::none(), "resume"_a = false,
      "resume_from"_a = nb::none(), "keep_states"_a = false, "allow_tangled"_a = false,
      "progress"_a = nb::none(), "cancel"_a = nb::none(),
      "Runs a scene and writes its run directory, as `muslin run` does, to the same bytes. frames: the "
      "last frame,\n"
      "else the scene's. resume: continue from the last checkpoint, if there is one; resume_from: from that "
      "of this\n"
      "frame, which needs a run with keep_states. allow_tangled: start although surfaces cross, as "
      "Simulation "
      "has it; a\nrun that is resumed remembers. After Interrupted, KeyboardInterrupt, or an exception of "
      "a\n"
      "callback the run can be resumed.");
  bind_writer(m);

  using Name = std::optional<std::string>;
  nb::class_<RunReader>(m, "Run", "A run directory, finished or not, even while it is being written.")
      .def(
          "__init__", [](RunReader* self, const FilePath& directory) { new (self) RunReader(directory); },
          "directory"_a)
      .def_prop_ro("directory", [](const RunReader& run) { return run.directory(); })
      .def_prop_ro(
          "status", [](const RunReader& run) { return name_of(run.status()); },
          "\"running\" (also if it was killed), \"finished\", \"interrupted\" or \"failed\".")
      .def_prop_ro("title", [](const RunReader& run) { return run.title(); })
      .def_prop_ro(
          "scene", [](const RunReader& run) { return from_json(run.resolved_scene()); },
          "Every setting with its value.")
      .def_prop_ro("frame_rate", &RunReader::frame_rate, "[1/s]")
      .def_prop_ro("frame_count", &RunReader::frame_count,
                   "Complete frames when it was opened, with frame 0.")
      .def_prop_ro(
          "bodies", [](const RunReader& run) { return run.bodies(); },
          "Their names, those of colliders last.")
      .def_prop_ro("last_frame", &RunReader::last_frame, "That the run has or, unfinished, was to reach.")
      .def(
          "colour",
          [](const RunReader& run, const Name& body) {
            return to_array(run.colour(Bodies(run, body).index()));
          },
          "body"_a = nb::none(), "Of a body in pictures: red, green, blue from 0 to 1 (sRGB), shape (3,).")
      .def(
          "has_lattice",
          [](const RunReader& run, const Name& body) { return run.has_cells(Bodies(run, body).index()); },
          "body"_a = nb::none(), "Shells and colliders have none, and no contour.")
      .def(
          "is_collider",
          [](const RunReader& run, const Name& body) { return run.is_collider(Bodies(run, body).index()); },
          "body"_a)
      .def(
          "mesh",
          [](const RunReader& run, const Name& body, const std::string& surface) -> const Mesh& {
            return run.mesh(Bodies(run, body).index(), surface_called(surface));
          },
          "body"_a = nb::none(), nb::kw_only(), "surface"_a = "skin", nb::rv_policy::reference_internal,
          "The surface at rest: \"skin\", the original mesh, or \"contour\".")
      .def(
          "points",
          [](const RunReader& run, int frame, const Name& body, const std::string& surface) {
            return taken(
                run.points(Bodies(run, body).index(), surface_called(surface), frame_of(run, frame)));
          },
          "frame"_a, "body"_a = nb::none(), nb::kw_only(), "surface"_a = "skin",
          "Its vertices at a frame, (n, 3) [m]; negative frames count from the end.")
      .def(
          "velocities",
          [](const RunReader& run, int frame, const Name& body, const std::string& surface) {
            return taken(
                run.velocities(Bodies(run, body).index(), surface_called(surface), frame_of(run, frame)));
          },
          "frame"_a, "body"_a = nb::none(), nb::kw_only(), "surface"_a = "skin",
          "By central differences over the neighbouring frames, (n, 3) [m/s].")
      .def(
          "lattice_rest_positions",
          [](nb::pointer_and_handle<RunReader> run, const Name& body) {
            return view(run.p->cells(lattice_body(*run.p, body)).rest_positions, run.h);
          },
          "body"_a = nb::none(), "(V, 3) [m]")
      .def(
          "lattice_voxels",
          [](nb::pointer_and_handle<RunReader> run, const Name& body) {
            return view(run.p->cells(lattice_body(*run.p, body)).voxels, run.h);
          },
          "body"_a = nb::none(), "(C, 8) corners of each voxel.")
      .def(
          "lattice_points",
          [](const RunReader& run, int frame, const Name& body) {
            return taken(run.selectable_points(lattice_body(run, body), frame_of(run, frame)));
          },
          "frame"_a, "body"_a = nb::none(), "The lattice's vertices at a frame, (V, 3) [m].")
      .def(
          "lattice_velocities",
          [](const RunReader& run, int frame, const Name& body) {
            return taken(run.selectable_velocities(lattice_body(run, body), frame_of(run, frame)));
          },
          "frame"_a, "body"_a = nb::none(), "By central differences, (V, 3) [m/s].")
      .def_prop_ro(
          "diagnostics", [](const RunReader& run) { return columns_of(run.diagnostics()); },
          "The columns of diagnostics.csv as arrays, a row per frame.")
      .def("__repr__", [](const RunReader& run) {
        return fmt::format("<muslin.Run \"{}\": {}, {} frames>", run.title(), name_of(run.status()),
                           run.frame_count());
      });

  m.def(
      "export_run",
      [](const RunReader& run, const FilePath& file, const std::string& body, const std::string& surface,
         int smooth, int subdivide, const std::optional<FilePath>& carry, double thickness,
         const Report& progress, const Cancel& cancel) {
        const ExportOptions options{body,      surface_called(surface),    smooth,
                                    subdivide, carry.value_or(FilePath()), thickness};
        ExportReport report;
        {
          const nb::gil_scoped_release nogil;
          report = export_run(run, file, options, progress_of(progress, cancel));
        }
        nb::dict result;
        result["frames_drawn_in"] = report.frames_drawn_in;
        result["frames_crossing"] = report.frames_crossing;
        result["most_crossings"] = report.most_crossings;
        result["frame_of_most"] = report.frame_of_most;
        return result;
      },
      "run"_a, "file"_a, nb::kw_only(), "body"_a = "", "surface"_a = "skin", "smooth"_a = 0,
      "subdivide"_a = 0, "carry"_a = nb::none(), "thickness"_a = 0.0, "progress"_a = nb::none(),
      "cancel"_a = nb::none(),
      nb::sig(
          "def export_run(run: Run, file: str | os.PathLike[str], *, body: str = '', surface: str = 'skin', "
          "smooth: int = 0, subdivide: int = 0, carry: str | os.PathLike[str] | None = None, "
          "thickness: float = 0.0, progress: Callable[[float, str], None] | None = None, "
          "cancel: Callable[[], bool] | None = None) -> dict[str, int]"),
      "Writes a run for other programs, by the suffix: .pc2 .mdd .obj .ply .glb .gltf .usda .vtu.\n\n"
      "The surface is finished in this order: rounds of smoothing that does not shrink it, levels of\n"
      "subdivision, a finer mesh that it carries, a thickness [m]. Returns in how many frames the carried\n"
      "mesh was drawn in to avoid crossings, and in how many it crosses all the same.");
  m.def(
      "write_stages",
      [](const FilePath& directory, const Model& model, const Report& progress, const Cancel& cancel) {
        const nb::gil_scoped_release nogil;
        write_stages(directory, model, progress_of(progress, cancel));
      },
      "directory"_a, "model"_a, nb::kw_only(), "progress"_a = nb::none(), "cancel"_a = nb::none(),
      "Every stage between mesh and simulation as files, as `muslin build` does.");
}

}  // namespace muslin::python
