#include "muslin/cache/run_writer.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <optional>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "muslin/cache/contact_record.hpp"
#include "muslin/cache/directory_lock.hpp"
#include "muslin/cache/point_cache.hpp"
#include "muslin/cache/run_files.hpp"
#include "muslin/cache/selections.hpp"
#include "muslin/cache/tables.hpp"
#include "muslin/core/error.hpp"
#include "muslin/core/input_file.hpp"
#include "muslin/core/output_file.hpp"
#include "muslin/core/parallel.hpp"
#include "muslin/io/mesh_file.hpp"
#include "muslin/scene/describe.hpp"
#include "muslin/scene/scene_table.hpp"
#include "muslin/simulation/checkpoint.hpp"
#include "muslin/version.hpp"

namespace muslin {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

constexpr std::size_t small_state = std::size_t{64} << 20;  ///< bytes
constexpr std::chrono::seconds large_state_interval{10};
constexpr std::chrono::seconds sync_interval{5};
constexpr int run_format = 1;

Json parsed_scene(const Model& model) {
  const Json scene = Json::parse(model.scene.resolved, nullptr, false);
  return scene.is_discarded() ? Json() : scene;
}

std::string processor() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);)
    if (line.starts_with("model name") && line.find(": ") != std::string::npos)
      return line.substr(line.find(": ") + 2);
  return "unknown";
}

/// "/body/0/mesh" → "body.0.mesh".
std::string dotted(std::string pointer) {
  if (!pointer.empty()) pointer.erase(0, 1);
  std::replace(pointer.begin(), pointer.end(), '/', '.');
  return pointer;
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

std::string as_text(const std::vector<std::uint8_t>& bytes) { return {bytes.begin(), bytes.end()}; }

/// Reads run.json of a run to resume. Errors: file; input, if it is damaged.
Json read_summary(const fs::path& directory) {
  Json run = Json::parse(read_file(directory / "run.json"), nullptr, false);
  const auto has = [&](const char* key, bool (Json::*is)() const noexcept) {
    return run.contains(key) && (run[key].*is)();
  };
  if (!run.is_object() || !has("scene", &Json::is_object) || !has("frame_rate", &Json::is_number) ||
      !has("timings", &Json::is_object))
    throw Error(ErrorKind::input, {(directory / "run.json").string()}, "the summary of the run is damaged",
                "restart the run without --resume");
  return run;
}

PointsFiles files_of(const Component& body, const CachedPoints& points) {
  return points_files(body.name, points.name, points.extension);
}

/// Returns the names of all files of the component. Errors: input, if its name cannot be part of one.
std::vector<std::string> files_of(const Component& body) {
  const PointsFiles skin = skin_files(body.name);
  std::vector<std::string> files = {skin.mesh, skin.cache};
  for (const CachedPoints& points : body.cached_points()) {
    const PointsFiles own = files_of(body, points);
    files.insert(files.end(), {own.mesh, own.cache});
  }
  return files;
}

bool has_stretch_limit(const Model& model) {
  return std::any_of(model.bodies.begin(), model.bodies.end(),
                     [](const Component& body) { return body.stretch_limit(0).has_value(); });
}

/// The open caches of a component: its skin, and its other cached points in their order.
struct BodyCaches {
  Pc2Writer skin;
  std::vector<Pc2Writer> others;
};

}  // namespace

std::vector<std::string> changes_since(const fs::path& directory, const Model& model) {
  const Json run = read_summary(directory);
  if (run["frame_rate"] != model.scene.time.frame_rate) {
    throw Error(ErrorKind::input, {directory.string()}, "the frame rate is not that of the run to resume",
                "undo the change, or restart the run without --resume");
  }
  std::vector<std::string> changes, refused;
  for (const auto& step : Json::diff(run["scene"], parsed_scene(model))) {
    const std::string setting = dotted(step.value("path", ""));
    changes.push_back(setting);
    if (!schema::may_change_on_resume(scene_table(), setting)) refused.push_back(setting);
  }
  if (!refused.empty()) {
    throw Error(ErrorKind::input, {directory.string()},
                "the bodies are not those of the run to resume; changed: " + joined(refused),
                "undo the change, or restart the run without --resume");
  }
  return changes;
}

const char* name_of(RunStatus status) {
  switch (status) {
    case RunStatus::running:
      return "running";
    case RunStatus::finished:
      return "finished";
    case RunStatus::interrupted:
      return "interrupted";
    case RunStatus::failed:
      return "failed";
  }
  return "";
}

struct RunWriter::Impl {
  fs::path directory;
  Simulation& simulation;
  int total_frames;
  RunHistory history;
  DirectoryLock lock;
  std::vector<BodyCaches> caches;
  OutputFile diagnostics, probes;
  std::optional<OutputFile> stretches;  ///< only if a shell has, or in an earlier session had, a limit
  std::optional<OutputFile> pins, attachments;  ///< likewise, if the scene has some
  bool resumed = false;
  std::vector<std::string> changes;
  Json sessions = Json::array();
  int first_frame = 0;
  RunQuality quality;
  int durable_frame = -1;  ///< of the newest checkpoint known to be on the disk
  Clock::time_point begin = Clock::now(), last_checkpoint = begin, last_sync = begin;

  Impl(fs::path the_directory, Simulation& the_simulation, int frames, RunHistory the_history)
      : directory(std::move(the_directory)),
        simulation(the_simulation),
        total_frames(frames),
        history(the_history) {}

  const Model& model() const { return simulation.model(); }
  void claim();
  void start();
  std::vector<CheckpointFile> checkpoints_to_try() const;
  bool resume();
  void renew_diagnostics() const;
  void open_files(int frames);
  void append_points();
  void append_rows();
  void write_checkpoint(bool durable);
  void prune_checkpoints() const;
  void sync();
  void write_summary(RunStatus status, const std::string& reason) const;
};

void RunWriter::Impl::claim() {
  std::error_code code;
  if (fs::exists(directory, code) && !fs::is_directory(directory)) {
    throw Error(ErrorKind::file, {directory.string()}, "this is a file, not a directory",
                "choose another directory with -o");
  }
  make_directory(directory);
  if (!is_run(directory)) {
    for (const auto& entry : fs::directory_iterator(directory)) {
      // A process killed in its first moments leaves an empty checkpoint/ and nothing else.
      const std::string name = entry.path().filename().string();
      if (name == "checkpoint" || name == "run.json.part") continue;
      throw Error(ErrorKind::file, {directory.string()}, "the directory is not empty and holds no run",
                  "choose an empty or a new directory with -o");
    }
  }
  make_directory(directory / "checkpoint");
  lock = DirectoryLock(directory / "checkpoint", "lock");
}

void RunWriter::Impl::start() {
  if (is_run(directory)) remove_run_files(directory);
  write_summary(RunStatus::running, "");
  const Model& model = this->model();
  write_atomically(directory / "scene.toml", model.scene.text);
  write_atomically(directory / "stats.json", statistics_json(model));
  write_atomically(directory / "selections.json", selections_json(model));
  for (const Component& body : model.bodies) {
    write_mesh(directory / skin_files(body.name).mesh, body.skin_mesh());
    for (const CachedPoints& points : body.cached_points())
      points.write_rest(directory / files_of(body, points).mesh);
  }
  open_files(0);
  append_points();
  append_rows();
  sync();
  write_checkpoint(true);
}

/// Opens the caches and tables with their first `frames` frames kept; 0 begins them.
void RunWriter::Impl::open_files(int frames) {
  const auto mode = frames == 0 ? OutputFile::Mode::replace : OutputFile::Mode::resume;
  for (const Component& body : model().bodies) {
    const auto open = [&](const std::string& name, std::size_t points) {
      return Pc2Writer(directory / name, points, mode, frames);
    };
    caches.push_back({open(skin_files(body.name).cache, body.skin.size()), {}});
    for (const CachedPoints& points : body.cached_points()) {
      const std::size_t count =
          points.embedding ? points.embedding->size() : static_cast<std::size_t>(body.vertex_count);
      caches.back().others.push_back(open(files_of(body, points).cache, count));
    }
  }
  const auto table = [&](const char* name, std::string_view header, bool is_there) {
    const fs::path path = directory / name;
    if (frames == 0 || !is_there) {
      OutputFile file(path, OutputFile::Mode::replace);
      file.append(header);
      return file;
    }
    const std::size_t kept = table_length(read_file(path), frames - 1);
    if (kept == 0) {
      throw Error(ErrorKind::input, {path.string()}, "the table has lost its first line",
                  "restart the run, without --resume");
    }
    OutputFile file(path, OutputFile::Mode::resume);
    file.truncate(kept);
    return file;
  };
  diagnostics = table("diagnostics.csv", diagnostics_header, true);
  probes = table("probes.csv", probes_header, true);
  // Limits, pins and attachments may be new on resume.
  const auto table_if = [&](bool wanted, const char* name, std::string_view header) {
    std::error_code code;
    const bool is_there = fs::exists(directory / name, code);
    return is_there || wanted ? std::optional(table(name, header, is_there)) : std::nullopt;
  };
  stretches = table_if(has_stretch_limit(model()), "stretch.csv", stretch_header);
  pins = table_if(!model().pins.empty(), "pins.csv", pins_header);
  attachments = table_if(!model().attachments.empty(), "attachments.csv", attachments_header);
}

/// A table that an earlier version began gets the columns of this one, as it can have only one kind of rows.
void RunWriter::Impl::renew_diagnostics() const {
  const fs::path path = directory / "diagnostics.csv";
  if (read_file(path).starts_with(diagnostics_header)) return;
  std::string text(diagnostics_header);
  for (const Diagnostics& row : read_diagnostics(path)) text += diagnostics_row(row);
  write_atomically(path, text);
}

/// Those a resume may begin from, the best first.
std::vector<CheckpointFile> RunWriter::Impl::checkpoints_to_try() const {
  std::vector<CheckpointFile> all = list_checkpoints(directory);
  if (history.resume_from < 0) return all;
  for (const CheckpointFile& file : all)
    if (file.frame == history.resume_from && file.steps == 0) return {file};
  std::string frames;
  for (const CheckpointFile& file : all)
    if (file.steps == 0 && frames.size() < 60)
      frames += (frames.empty() ? "" : ", ") + std::to_string(file.frame);
  throw Error(ErrorKind::input, {directory.string()},
              fmt::format("there is no state of frame {} to resume from", history.resume_from),
              frames.empty()
                  ? "restart the run"
                  : fmt::format("there are those of frames {}; a run with --keep-states keeps all", frames));
}

bool RunWriter::Impl::resume() {
  if (!is_run(directory) && history.resume_from < 0) return false;
  const std::vector<CheckpointFile> checkpoints = checkpoints_to_try();
  if (checkpoints.empty()) return false;
  changes = changes_since(directory, model());
  const Json run = read_summary(directory);
  std::optional<Error> trouble;
  for (const CheckpointFile& file : checkpoints) {
    try {
      const std::string content = read_file(file.path);
      simulation.restore({content.begin(), content.end()});
      renew_diagnostics();
      open_files(file.frame + 1);
      quality = {};
      for (const Diagnostics& row : read_diagnostics(directory / "diagnostics.csv")) quality.add(row);
      if (stretches)
        for (const LimitedStretch& row : read_stretches(directory / "stretch.csv")) quality.add(row);
      first_frame = file.frame;
      sessions = run["timings"].value("sessions", Json());
      if (!sessions.is_array()) sessions = Json::array();
      return true;
    } catch (const Error& error) {
      // The newest checkpoint may be damaged by a power cut; the one before it serves as well.
      caches.clear();
      const Place place = error.place().file.empty() ? Place{file.path.string()} : error.place();
      trouble = Error(error.kind(), place, error.problem(), error.remedy());
    }
  }
  throw *trouble;
}

void RunWriter::Impl::append_points() {
  const Model& model = this->model();
  std::vector<Vec3> points;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Component& body = model.bodies[b];
    const ConstVectors q = model.of(body, simulation.state().positions);
    points.resize(body.skin.size());
    body.skin.apply(q, points);
    caches[b].skin.append(points);
    auto cache = caches[b].others.begin();
    for (const CachedPoints& others : body.cached_points()) {
      if (others.embedding) {
        points.resize(others.embedding->size());
        others.embedding->apply(q, points);
        cache->append(points);
      } else {
        cache->append(q);
      }
      ++cache;
    }
  }
}

void RunWriter::Impl::append_rows() {
  diagnostics.append(diagnostics_row(simulation.diagnostics()));
  probes.append(probe_rows(simulation));
  quality.add(simulation.diagnostics());
  if (pins) pins->append(pin_rows(simulation));
  if (attachments) attachments->append(attachment_rows(simulation));
  if (!stretches) return;
  for (const LimitedStretch& row : limited_stretches(model(), simulation.state(), simulation.frame())) {
    stretches->append(stretch_row(row));
    quality.add(row);
  }
}

void RunWriter::Impl::sync() {
  for (BodyCaches& cache : caches) {
    cache.skin.sync();
    for (Pc2Writer& others : cache.others) others.sync();
  }
  diagnostics.sync();
  probes.sync();
  if (stretches) stretches->sync();
  if (pins) pins->sync();
  if (attachments) attachments->sync();
  last_sync = Clock::now();
}

void RunWriter::Impl::write_checkpoint(bool durable) {
  const fs::path path =
      directory / "checkpoint" / checkpoint_name(simulation.frame(), simulation.steps_done());
  write_atomically(path, as_text(simulation.checkpoint()), durable);
  if (durable && simulation.steps_done() == 0) durable_frame = simulation.frame();
  prune_checkpoints();
  last_checkpoint = Clock::now();
}

/// Keeps the last two finished frames (or all, if asked to), the newest state that is surely on the disk, and
/// a state inside a frame only while it is the newest.
void RunWriter::Impl::prune_checkpoints() const {
  int kept = 0;
  for (const CheckpointFile& file : list_checkpoints(directory)) {
    const bool newest = file.frame == simulation.frame() && file.steps == simulation.steps_done();
    const bool finished_frame = file.steps == 0 && file.frame <= simulation.frame();
    if (newest || (finished_frame && (history.keep_states || kept < 2 || file.frame == durable_frame))) {
      if (finished_frame) ++kept;
      continue;
    }
    std::error_code ignored;
    fs::remove(file.path, ignored);
  }
}

void RunWriter::Impl::write_summary(RunStatus status, const std::string& reason) const {
  const Model& model = this->model();
  Json run;
  run["muslin"] = {{"version", version()}, {"format", run_format}};
  run["title"] = model.scene.title;
  run["status"] = name_of(status);
  if (!reason.empty()) run["reason"] = reason;
  run["frames"] = total_frames;
  run["frame_rate"] = model.scene.time.frame_rate;
  run["bodies"] = Json::array();
  for (const Component& body : model.bodies) {
    const PointsFiles skin = skin_files(body.name);
    Json entry = {
        {"name", body.name}, {"model", body.kind()}, {"skin", {{"mesh", skin.mesh}, {"cache", skin.cache}}}};
    if (body.is_collider()) entry["shape"] = body.appearance().shape;
    for (const CachedPoints& points : body.cached_points()) {
      const PointsFiles names = files_of(body, points);
      entry[points.name] = {{"mesh", names.mesh}, {"cache", names.cache}};
      if (!points.embedding) entry["vertices"] = points.name;
    }
    run["bodies"].push_back(entry);
  }
  std::vector<std::string> warnings = model.warnings;
  const Untangled& repair = simulation.untangled();
  if (repair.needed()) {
    warnings.push_back(describe(repair));
    run["tangled_start"] = {{"crossings", repair.crossings},
                            {"wrong_side", repair.lost},
                            {"too_close", repair.close},
                            {"left", repair.left},
                            {"wrong_side_left", repair.lost_left},
                            {"depth", repair.depth},
                            {"moved", repair.moved},
                            {"steps", repair.steps}};
  }
  for (std::string& warning : warnings_of(quality)) warnings.push_back(std::move(warning));
  run["warnings"] = warnings;
  if (simulation.options().allow_tangled) run["allow_tangled"] = true;
  run["contact"] = model.contact ? contact_record_json(*model.contact) : Json();
  run["scene"] = parsed_scene(model);
  if (!model.scene.file.empty())  // that of a program may have none
    run["scene_file"] = fs::absolute(model.scene.file).lexically_normal().string();
  run["machine"] = {{"processor", processor()},
                    {"cores", std::thread::hardware_concurrency()},
                    {"threads", thread_count()},
                    {"compiler", __VERSION__}};
  run["convergence"] = {{"steps", quality.steps},
                        {"converged_steps", quality.converged_steps},
                        {"worst_error", quality.worst_error},
                        {"frames_missed", quality.frames_missed}};
  run["energy"] = {{"material_work", simulation.diagnostics().material_work}};
  run["held_back"] = {{"frames", quality.frames_held_back},
                      {"most", quality.max_held_back},
                      {"farthest", quality.farthest_behind}};
  run["crossings"] = {{"at_end", quality.crossings_at_end}, {"frames", quality.frames_crossing}};
  run["overstretched"] = Json::array();
  for (const RunQuality::Overstretched& shell : quality.overstretched) {
    run["overstretched"].push_back(
        {{"body", shell.body}, {"frames", shell.frames}, {"stretch", shell.stretch}, {"limit", shell.limit}});
  }
  run["pins"] = Json::array();
  for (const Pin& pin : model.pins)
    run["pins"].push_back({{"name", pin.name}, {"largest_force", simulation.pin_force(pin.name).most}});
  run["attachments"] = Json::array();
  for (const Attached& attached : model.attachments)
    run["attachments"].push_back({{"name", attached.name},
                                  {"joints", attached.places.size()},
                                  {"holding", simulation.attachment_force(attached.name).holding}});
  Json all = sessions;
  all.push_back({{"from_frame", first_frame},
                 {"to_frame", simulation.frame()},
                 {"wall_s", std::chrono::duration<double>(Clock::now() - begin).count()},
                 {"changed", changes}});
  run["timings"] = {{"sessions", all}};
  write_atomically(directory / "run.json", run.dump(2) + "\n");
}

RunWriter::RunWriter(fs::path directory, Simulation& simulation, int total_frames, bool resume,
                     RunHistory history)
    : impl_(std::make_unique<Impl>(std::move(directory), simulation, total_frames, history)) {
  std::vector<std::string> files;
  for (const Component& body : simulation.model().bodies)
    for (std::string& file : files_of(body)) files.push_back(std::move(file));
  impl_->claim();
  remove_unfinished_files(impl_->directory, files);
  impl_->resumed = resume && impl_->resume();
  if (!impl_->resumed) {
    impl_->start();
    return;
  }
  write_atomically(impl_->directory / "scene.toml", simulation.model().scene.text);
  write_atomically(impl_->directory / "selections.json", selections_json(simulation.model()));
  impl_->prune_checkpoints();
  impl_->write_summary(RunStatus::running, "");
}

RunWriter::~RunWriter() = default;

bool RunWriter::resumed() const { return impl_->resumed; }
const std::vector<std::string>& RunWriter::changes() const { return impl_->changes; }

const RunQuality& RunWriter::quality() const { return impl_->quality; }

void RunWriter::write_frame() {
  Impl& parts = *impl_;
  parts.append_points();
  parts.append_rows();
  const auto now = Clock::now();
  const bool durable = now - parts.last_sync >= sync_interval;
  const std::size_t state_bytes = 4 * sizeof(Vec3) * parts.model().vertex_count();
  const bool seldom = state_bytes > small_state && !parts.history.keep_states;
  if (seldom && now - parts.last_checkpoint < large_state_interval) return;
  if (durable) parts.sync();
  parts.write_checkpoint(durable);
}

void RunWriter::finish(RunStatus status, const std::string& reason) {
  impl_->sync();
  impl_->write_checkpoint(true);
  impl_->write_summary(status, reason);
}

void RunWriter::abandon(const std::string& reason) {
  try {
    impl_->write_summary(RunStatus::failed, reason);
  } catch (const Error&) {  // NOLINT(bugprone-empty-catch)
    // A full disk refuses this as well; the caller reports what filled it.
  }
}

}  // namespace muslin
