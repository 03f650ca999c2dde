#include "muslin/cache/stages.hpp"

#include "muslin/cache/run_files.hpp"
#include "muslin/core/output_file.hpp"
#include "muslin/scene/describe.hpp"

namespace muslin {
void write_stages(const std::filesystem::path& directory, const Model& model, const Progress& progress) {
  make_directory(directory);
  for (const Component& body : model.bodies) {
    skin_files(body.name);  // rejects invalid file names
    body.write_stages(directory, progress);
  }
  write_atomically(directory / "stats.json", statistics_json(model));
}

}  // namespace muslin
