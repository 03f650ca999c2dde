// Names, lists and removes the files of a run.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace muslin {

/// The files of points of a body over time: BODY.NAME.EXTENSION connects them, BODY.NAME.pc2 has their
/// positions.
struct PointsFiles {
  std::string name;  ///< such as "skin"
  std::string mesh, cache;
};
/// Returns these names. Errors: input, if the name of the body cannot be part of a file name.
PointsFiles points_files(const std::string& body, const std::string& name, const std::string& extension);
inline PointsFiles skin_files(const std::string& body) { return points_files(body, "skin", "obj"); }

/// The files of a body, in runs of all versions.
struct BodyFiles {
  std::vector<PointsFiles> points;  ///< those of the skin first
  std::string vertices;  ///< the name of those that are the body's vertices; empty: none or the skin's
};
/// Reads an entry of `bodies` in run.json, an object with a `name`. Errors: as points_files.
BodyFiles listed_files(const nlohmann::ordered_json& body);

/// A checkpoint on the disk: `checkpoint/000012.state` after frame 12, `000012+03.state` three steps later.
struct CheckpointFile {
  int frame = 0;
  int steps = 0;
  std::filesystem::path path;
};
std::string checkpoint_name(int frame, int steps);
/// Returns the checkpoints of a run, newest first.
std::vector<CheckpointFile> list_checkpoints(const std::filesystem::path& run);

/// True if the directory holds a run of muslin (finished or not).
bool is_run(const std::filesystem::path& directory);
/// True if it holds a run that was started with crossing surfaces, according to run.json.
bool is_tangled_run(const std::filesystem::path& directory);

/// Removes incomplete files left by a process that was killed while writing: those of every run, and those in
/// `files`. Errors: file.
void remove_unfinished_files(const std::filesystem::path& directory, const std::vector<std::string>& files);

/// Removes the files of an earlier run and no others. Errors: file.
void remove_run_files(const std::filesystem::path& directory);

}  // namespace muslin
