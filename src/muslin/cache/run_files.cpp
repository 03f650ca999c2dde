#include "muslin/cache/run_files.hpp"

#include <algorithm>
#include <charconv>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "muslin/core/error.hpp"
#include "muslin/core/input_file.hpp"

namespace muslin {

namespace fs = std::filesystem;

BodyFiles body_files(const std::string& body) {
  if (body.empty() || body.front() == '.' || body.find_first_of("/\\\n\r\t\"") != std::string::npos ||
      body.size() > 200) {
    throw Error(ErrorKind::input, "the body \"" + body + "\" cannot name files",
                "give it a name of letters, digits, dashes");
  }
  return {body + ".skin.obj",    body + ".skin.pc2",    body + ".contour.obj",
          body + ".contour.pc2", body + ".lattice.vtu", body + ".lattice.pc2"};
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
  static const std::vector<std::string> names = {"scene.toml", "diagnostics.csv", "probes.csv", "stretch.csv",
                                                 "stats.json", "selections.json", "run.json"};
  return names;
}

std::vector<std::string> names_of(const std::string& body) {
  const BodyFiles files = body_files(body);
  return {files.skin_mesh,     files.skin_cache,   files.contour_mesh,
          files.contour_cache, files.lattice_mesh, files.lattice_cache};
}

/// Returns the names that run.json lists for a body, of files beside it that begin with its name.
std::vector<std::string> listed_names(const nlohmann::json& body) {
  const std::string name = body.value("name", "");
  std::vector<std::string> names = names_of(name);
  for (const nlohmann::json& entry : body) {
    for (const char* key : {"mesh", "cache"}) {
      const auto at = entry.is_object() ? entry.find(key) : entry.end();
      if (at == entry.end() || !at->is_string()) continue;
      const std::string file = at->get<std::string>();
      if (file.starts_with(name + ".") && file.find_first_of("/\\") == std::string::npos)
        names.push_back(file);
    }
  }
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
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

void remove_unfinished_files(const fs::path& directory, const std::vector<std::string>& bodies) {
  std::vector<std::string> owned = own_names();
  for (const std::string& body : bodies)
    for (const std::string& name : names_of(body)) owned.push_back(name);
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
  const auto json = nlohmann::json::parse(read_file(directory / "run.json"), nullptr, false);
  for (const auto& body : json.value("bodies", nlohmann::json::array()))
    for (const std::string& name : listed_names(body)) doomed.push_back(directory / name);
  for (const CheckpointFile& file : list_checkpoints(directory)) doomed.push_back(file.path);
  // run.json is removed last: until then the directory is recognised as a run and can be cleaned again.
  for (const std::string& name : own_names()) doomed.push_back(directory / name);
  for (const fs::path& path : doomed) remove_file(path);
}

}  // namespace muslin
