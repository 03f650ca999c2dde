#include "muslin/cache/run_reader.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include <nlohmann/json.hpp>

#include "muslin/cache/run_files.hpp"
#include "muslin/cache/tables.hpp"
#include "muslin/core/error.hpp"
#include "muslin/core/input_file.hpp"
#include "muslin/io/mesh_file.hpp"
#include "muslin/io/vtk_file.hpp"
#include "muslin/scene/colours.hpp"

namespace muslin {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Points over time.
struct Track {
  Pc2Reader cache;
  std::vector<Vec3f> at(int frame) const { return cache.read(frame); }
  std::vector<Vec3f> velocities(int frame, int frames, double frame_rate) const {
    const int before = std::max(0, frame - 1), after = std::min(frames - 1, frame + 1);
    std::vector<Vec3f> result = at(after);
    if (before == after) {
      std::fill(result.begin(), result.end(), Vec3f::Zero());
      return result;
    }
    const std::vector<Vec3f> earlier = at(before);
    const auto scale = static_cast<float>(frame_rate / (after - before));
    for (std::size_t i = 0; i < result.size(); ++i) result[i] = scale * (result[i] - earlier[i]);
    return result;
  }
};

struct BodyTracks {
  Track skin;
  Mesh skin_mesh;
  bool collider = false, plane = false;
  std::optional<Track> contour, vertices;  ///< where the component caches them
  Mesh contour_mesh;
  RunReader::Cells cells;  ///< of the vertices

  const Track& selectable() const { return vertices ? *vertices : skin; }
};

bool is_text(const Json& object, const char* key) { return object.contains(key) && object[key].is_string(); }

bool describes_run(const Json& run) {
  return run.is_object() && run.contains("muslin") && is_text(run, "title") && is_text(run, "status") &&
         run.contains("frame_rate") && run["frame_rate"].is_number() && run["frame_rate"] > 0.0 &&
         run.contains("bodies") && run["bodies"].is_array() && !run["bodies"].empty() &&
         std::all_of(run["bodies"].begin(), run["bodies"].end(),
                     [](const Json& body) { return body.is_object() && is_text(body, "name"); });
}

}  // namespace

const char* name_of(SurfaceKind surface) { return surface == SurfaceKind::skin ? "skin" : "contour"; }

struct RunReader::Impl {
  fs::path directory;
  Json run;
  std::string title;
  std::vector<std::string> names;
  std::vector<BodyTracks> bodies;
  std::vector<Diagnostics> diagnostics;
  Selections selections;
  int frames = 0;
  double frame_rate = 24;

  const BodyTracks& body(int index) const {
    if (index < 0 || static_cast<std::size_t>(index) >= bodies.size())
      throw Error(ErrorKind::usage, {directory.string()},
                  "the run has no body of index " + std::to_string(index),
                  "it has " + std::to_string(bodies.size()) + ", counted from 0");
    return bodies[static_cast<std::size_t>(index)];
  }
  void require_frame(int frame) const {
    if (frame < 0 || frame >= frames)
      throw Error(ErrorKind::usage, {directory.string()}, "the run has no frame " + std::to_string(frame),
                  "its frames are 0 to " + std::to_string(frames - 1));
  }
  const Track& track(int index, SurfaceKind surface) const {
    require(index, surface);
    return surface == SurfaceKind::skin ? body(index).skin : *body(index).contour;
  }
  void require(int index, SurfaceKind surface) const {
    if (surface == SurfaceKind::skin || body(index).contour) return;
    throw Error(
        ErrorKind::usage, {directory.string()},
        "the body \"" + names[static_cast<std::size_t>(index)] + "\" has no contour: it is no lattice",
        "take its skin");
  }
};

RunReader::RunReader(fs::path directory) : impl_(std::make_unique<Impl>()) {
  Impl& impl = *impl_;
  impl.directory = std::move(directory);
  const fs::path summary = impl.directory / "run.json";
  if (!fs::exists(summary)) {
    throw Error(ErrorKind::file, {impl.directory.string()}, "there is no run here (no run.json)",
                "name the directory that `muslin run` wrote");
  }
  impl.run = Json::parse(read_file(summary), nullptr, false);
  if (!describes_run(impl.run)) {
    throw Error(ErrorKind::input, {summary.string()}, "this does not describe a run of muslin",
                "run the scene again");
  }
  impl.title = impl.run["title"];
  impl.frame_rate = impl.run["frame_rate"];
  impl.diagnostics = read_diagnostics(impl.directory / "diagnostics.csv");
  std::size_t frames = impl.diagnostics.size();
  for (const Json& body : impl.run["bodies"]) {
    impl.names.push_back(body["name"]);
    const BodyFiles files = listed_files(body);
    const PointsFiles& skin = files.points.front();
    BodyTracks tracks{.skin = {Pc2Reader(impl.directory / skin.cache)},
                      .skin_mesh = read_mesh(impl.directory / skin.mesh).mesh,
                      .collider = body.contains("shape"),
                      .plane = body.value("shape", Json()) == "plane",
                      .contour = {},
                      .vertices = {},
                      .contour_mesh = {},
                      .cells = {}};
    const auto fit = [&](const Track& points, std::size_t count, const std::string& file) {
      if (points.cache.points() != count) {
        throw Error(ErrorKind::input, {(impl.directory / file).string()},
                    "the cache has another number of points than its mesh", "run the scene again");
      }
      frames = std::min(frames, static_cast<std::size_t>(points.cache.samples()));
    };
    fit(tracks.skin, tracks.skin_mesh.vertex_count(), skin.cache);
    for (const PointsFiles& points : files.points) {
      const auto track = [&] { return Track{Pc2Reader(impl.directory / points.cache)}; };
      if (points.name == name_of(SurfaceKind::contour)) {
        tracks.contour = track();
        // A body much smaller than a voxel has no contour.
        if (tracks.contour->cache.points() > 0)
          tracks.contour_mesh = read_mesh(impl.directory / points.mesh).mesh;
        fit(*tracks.contour, tracks.contour_mesh.vertex_count(), points.cache);
      } else if (points.name == files.vertices) {
        tracks.vertices = track();
        if (!points.mesh.ends_with(".vtu")) continue;
        VtkVoxels voxels = read_voxels(impl.directory / points.mesh);
        tracks.cells = {std::move(voxels.points), std::move(voxels.voxels)};
        fit(*tracks.vertices, tracks.cells.rest_positions.size(), points.cache);
      }
    }
    impl.bodies.push_back(std::move(tracks));
  }
  std::vector<std::size_t> points, skins;
  for (const BodyTracks& body : impl.bodies) {
    points.push_back(body.selectable().cache.points());
    skins.push_back(body.skin.cache.points());
  }
  impl.selections = read_selections(impl.directory / "selections.json", impl.names, points, skins);
  impl.diagnostics.resize(frames);
  impl.frames = static_cast<int>(frames);
}

RunReader::~RunReader() = default;
RunReader::RunReader(RunReader&&) noexcept = default;
RunReader& RunReader::operator=(RunReader&&) noexcept = default;

const fs::path& RunReader::directory() const { return impl_->directory; }
const std::string& RunReader::title() const { return impl_->title; }
std::string RunReader::resolved_scene() const { return impl_->run.value("scene", Json()).dump(); }
double RunReader::frame_rate() const { return impl_->frame_rate; }
int RunReader::frame_count() const { return impl_->frames; }
int RunReader::last_frame() const {
  const Json last = impl_->run.value("frames", Json());
  return std::max(impl_->frames - 1, last.is_number_integer() ? last.get<int>() : 0);
}
const std::vector<std::string>& RunReader::bodies() const { return impl_->names; }
const std::vector<Diagnostics>& RunReader::diagnostics() const { return impl_->diagnostics; }
const Selections& RunReader::selections() const { return impl_->selections; }

std::vector<int> RunReader::holding(const std::string& attachment) const {
  const std::filesystem::path path = impl_->directory / "attachments.csv";
  std::vector<int> holding;
  if (std::filesystem::exists(path)) holding = read_holding(path, attachment);
  holding.resize(static_cast<std::size_t>(impl_->frames), -1);
  return holding;
}

Vec3 RunReader::colour(int body) const {
  const auto b = static_cast<std::size_t>(body);
  const Json scene = impl_->run.value("scene", Json());
  if (!scene.is_object()) return palette_colour(b);
  const bool collider = impl_->body(body).collider;
  Json own;
  for (const Json& settings : scene.value(collider ? "collider" : "body", Json::array()))
    if (settings.is_object() && settings.value("name", Json()) == Json(impl_->names[b]))
      own = settings.value("colour", Json());
  const auto is_number = [](const Json& value) { return value.is_number(); };
  if (!own.is_array() || own.size() != 3 || !std::all_of(own.begin(), own.end(), is_number))
    return collider ? collider_colour() : palette_colour(b);
  return {own[0].get<double>(), own[1].get<double>(), own[2].get<double>()};
}

RunStatus RunReader::status() const {
  const std::string status = impl_->run.value("status", "");
  for (RunStatus known : {RunStatus::finished, RunStatus::interrupted, RunStatus::failed})
    if (status == name_of(known)) return known;
  return RunStatus::running;
}

int RunReader::find_body(const std::string& name) const {
  const auto& names = impl_->names;
  const auto& bodies = impl_->bodies;
  const auto is_soft = [](const BodyTracks& body) { return !body.collider; };
  const auto soft = std::find_if(bodies.begin(), bodies.end(), is_soft);
  if (name.empty() && std::count_if(bodies.begin(), bodies.end(), is_soft) == 1)
    return static_cast<int>(soft - bodies.begin());
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<int>(found - names.begin());
  std::string known;
  for (const std::string& each : names) known += (known.empty() ? "" : ", ") + each;
  throw Error(ErrorKind::usage, {impl_->directory.string()},
              name.empty() ? "the run has several bodies" : "the run has no body \"" + name + "\"",
              "choose one with --body: " + known);
}

bool RunReader::is_collider(int body) const { return impl_->body(body).collider; }
bool RunReader::is_plane(int body) const { return impl_->body(body).plane; }
bool RunReader::has(int body, SurfaceKind surface) const {
  return surface == SurfaceKind::skin || impl_->body(body).contour.has_value();
}
const Mesh& RunReader::mesh(int body, SurfaceKind surface) const {
  impl_->require(body, surface);
  return surface == SurfaceKind::skin ? impl_->body(body).skin_mesh : impl_->body(body).contour_mesh;
}
std::vector<Vec3f> RunReader::points(int body, SurfaceKind surface, int frame) const {
  impl_->require_frame(frame);
  return impl_->track(body, surface).at(frame);
}
std::vector<Vec3f> RunReader::velocities(int body, SurfaceKind surface, int frame) const {
  impl_->require_frame(frame);
  return impl_->track(body, surface).velocities(frame, impl_->frames, impl_->frame_rate);
}
std::size_t RunReader::selectable_count(int body) const {
  return impl_->body(body).selectable().cache.points();
}
std::vector<Vec3f> RunReader::selectable_points(int body, int frame) const {
  impl_->require_frame(frame);
  return impl_->body(body).selectable().at(frame);
}
std::vector<Vec3f> RunReader::selectable_velocities(int body, int frame) const {
  impl_->require_frame(frame);
  return impl_->body(body).selectable().velocities(frame, impl_->frames, impl_->frame_rate);
}
bool RunReader::has_cells(int body) const { return !impl_->body(body).cells.voxels.empty(); }
const RunReader::Cells& RunReader::cells(int body) const { return impl_->body(body).cells; }

}  // namespace muslin
