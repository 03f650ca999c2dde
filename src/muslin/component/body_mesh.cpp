#include "muslin/component/body_mesh.hpp"

#include <array>
#include <utility>

#include <fmt/format.h>

#include "muslin/component/placement.hpp"
#include "muslin/core/hash.hpp"

namespace muslin {

Error placed_in(const Place& place, const std::string& file, const Error& error) {
  std::string where = file;
  if (error.place().line > 0) where += fmt::format(":{}", error.place().line);
  if (error.place().line > 0 && error.place().column > 0) where += fmt::format(":{}", error.place().column);
  return {error.kind(), place, where + ": " + error.problem(), error.remedy()};
}

void warn_of_body(const ComponentInputs& inputs, const std::string& body, const std::string& sentence) {
  inputs.warnings.push_back(fmt::format("body {}: {}", body, sentence));
}

std::vector<MeshGroup> read_body_mesh(const BodySettings& settings, const ComponentInputs& inputs,
                                      Component& component) {
  component.name = settings.name;
  inputs.progress.at(0.0, "mesh");
  const std::string file = inputs.files.resolve(settings.mesh).string();
  return at_place(settings.mesh_place, file, [&] {
    MeshFile read = inputs.files.mesh(settings.mesh);
    if (!read.note.empty()) warn_of_body(inputs, settings.name, read.note);
    component.mesh = std::move(read.mesh);
    component.attributes = std::move(read.attributes);
    const auto place = placement(settings.translate, settings.rotate, settings.scale);
    for (Vec3& x : component.mesh.positions) x = place * x;
    require_usable(component.mesh, file);
    component.report = inspect(component.mesh);
    for (const std::string& warning : component.report.warnings) warn_of_body(inputs, settings.name, warning);
    return std::move(read.materials);
  });
}

std::uint64_t material_hash(const Material& m, double own, std::uint64_t seed) {
  const std::array numbers = {m.density, own};
  return hash_bytes(m.law.data(), m.law.size(), hash_bytes(numbers.data(), sizeof numbers, seed));
}

}  // namespace muslin
