// Names, lists and removes the files of a run.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace muslin {

struct BodyFiles {
  std::string skin_mesh, skin_cache, contour_mesh, contour_cache, lattice_mesh, lattice_cache;
};
/// Returns the names of a body's files. Errors: input, if the body's name cannot be part of a file name.
BodyFiles body_files(const std::string& body);

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

/// Removes incomplete files left by a process that was killed while writing. Errors: file.
void remove_unfinished_files(const std::filesystem::path& directory, const std::vector<std::string>& bodies);

/// Removes the files of an earlier run and no others. Errors: file.
void remove_run_files(const std::filesystem::path& directory);

}  // namespace muslin
