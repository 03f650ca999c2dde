#include "muslin/cache/run_files.hpp"

#include <algorithm>
#include <charconv>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "muslin/core/error.hpp"
#include "muslin/core/input_file.hpp"

namespace muslin {

namespace fs = std::filesystem;

PointsFiles points_files(const std::string& body, const std::string& name, const std::string& extension) {
  if (body.empty() || body.front() == '.' || body.find_first_of("/\\\n\r\t\"") != std::string::npos ||
      body.size() > 200) {
    throw Error(ErrorKind::input, "the body \"" + body + "\" cannot name files",
                "give it a name of letters, digits, dashes");
  }
  return {name, fmt::format("{}.{}.{}", body, name, extension), fmt::format("{}.{}.pc2", body, name)};
}

BodyFiles listed_files(const nlohmann::ordered_json& body) {
  const std::string name = body.value("name", "");
  BodyFiles files{{skin_files(name)}, ""};
  // The first runs had lattices only, and did not list their files.
  if (!body.contains("model"))
    files.points.insert(files.points.end(),
                        {points_files(name, "contour", "obj"), points_files(name, "lattice", "vtu")});
  const auto file_in = [&](const nlohmann::ordered_json& entry, const char* key) -> std::string {
    const auto at = entry.find(key);
    const std::string file = at != entry.end() && at->is_string() ? at->get<std::string>() : "";
    const bool is_own = file.starts_with(name + ".") && file.find_first_of("/\\") == std::string::npos;
    return is_own ? file : "";
  };
  for (const auto& [points, entry] : body.items()) {
    const auto is_known = [&](const PointsFiles& each) { return each.name == points; };
    if (!entry.is_object() || std::any_of(files.points.begin(), files.points.end(), is_known)) continue;
    const PointsFiles listed = {points, file_in(entry, "mesh"), file_in(entry, "cache")};
    if (!listed.mesh.empty() && !listed.cache.empty()) files.points.push_back(listed);
  }
  const auto vertices = body.find("vertices");
  if (vertices != body.end() && vertices->is_string()) files.vertices = *vertices;
  // Earlier runs did not say that the vertices of a lattice are cached.
  const auto is_lattice = [](const PointsFiles& each) { return each.name == "lattice"; };
  if (files.vertices.empty() && std::any_of(files.points.begin(), files.points.end(), is_lattice))
    files.vertices = "lattice";
  return files;
}

std::string checkpoint_name(int frame, int steps) {
  return steps == 0 ? fmt::format("{:06}.state", frame) : fmt::format("{:06}+{:04}.state", frame, steps);
}

std::vector<CheckpointFile> list_checkpoints(const fs::path& run) {
  std::vector<CheckpointFile> found;
  std::error_code code;
  for (const auto& entry : fs::directory_iterator(run / "checkpoint", code)) {
    const std::string name = entry.path().filename().string();
    CheckpointFile file;
    file.path = entry.path();
    const char* end = name.data() + name.size();
    const auto frame = std::from_chars(name.data(), end, file.frame);
    if (frame.ec != std::errc{}) continue;
    if (frame.ptr != end && *frame.ptr == '+') std::from_chars(frame.ptr + 1, end, file.steps);
    if (name == checkpoint_name(file.frame, file.steps)) found.push_back(file);
  }
  std::sort(found.begin(), found.end(), [](const CheckpointFile& a, const CheckpointFile& b) {
    return std::pair(a.frame, a.steps) > std::pair(b.frame, b.steps);
  });
  return found;
}

namespace {

/// Returns run.json of a run; null if there is none.
nlohmann::json summary(const fs::path& directory) {
  std::error_code code;
  if (!fs::is_regular_file(directory / "run.json", code)) return nullptr;
  nlohmann::json json = nlohmann::json::parse(read_file(directory / "run.json"), nullptr, false);
  return json.is_object() && json.contains("muslin") ? json : nullptr;
}

}  // namespace

bool is_run(const fs::path& directory) { return !summary(directory).is_null(); }

bool is_tangled_run(const fs::path& directory) {
  const nlohmann::json run = summary(directory);
  const auto at = run.is_null() ? run.end() : run.find("allow_tangled");
  return at != run.end() && at->is_boolean() && at->get<bool>();
}

namespace {

const std::vector<std::string>& own_names() {
  static const std::vector<std::string> names = {
      "scene.toml", "diagnostics.csv", "probes.csv",  "pins.csv",        "attachments.csv", "stretch.csv",
      "stats.json", "report.html",     "report.json", "selections.json", "run.json"};
  return names;
}

void remove_file(const fs::path& path) {
  std::error_code code;
  fs::remove(path, code);
  if (code) {
    throw Error(ErrorKind::file, {path.string()}, "cannot remove the earlier run: " + code.message(),
                "choose another directory with -o");
  }
}

}  // namespace

void remove_unfinished_files(const fs::path& directory, const std::vector<std::string>& files) {
  std::vector<std::string> owned = own_names();
  owned.insert(owned.end(), files.begin(), files.end());
  std::vector<fs::path> doomed;
  std::error_code code;
  for (const auto& entry : fs::directory_iterator(directory / "checkpoint", code))
    if (entry.path().extension() == ".part") doomed.push_back(entry.path());
  // Files are written as NAME.part or NAME.part-… and renamed.
  for (const auto& entry : fs::directory_iterator(directory, code)) {
    const std::string name = entry.path().filename().string();
    const auto unfinished = [&name](const std::string& whole) { return name.starts_with(whole + ".part"); };
    if (std::any_of(owned.begin(), owned.end(), unfinished)) doomed.push_back(entry.path());
  }
  for (const fs::path& path : doomed) remove_file(path);
}

void remove_run_files(const fs::path& directory) {
  std::vector<fs::path> doomed;
  const auto json = nlohmann::ordered_json::parse(read_file(directory / "run.json"), nullptr, false);
  for (const auto& body : json.value("bodies", nlohmann::ordered_json::array()))
    for (const PointsFiles& points : listed_files(body).points)
      doomed.insert(doomed.end(), {directory / points.mesh, directory / points.cache});
  for (const CheckpointFile& file : list_checkpoints(directory)) doomed.push_back(file.path);
  // run.json is removed last: until then the directory is recognised as a run and can be cleaned again.
  for (const std::string& name : own_names()) doomed.push_back(directory / name);
  for (const fs::path& path : doomed) remove_file(path);
}

}  // namespace muslin
