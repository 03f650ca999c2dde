#include "muslin/component/body_mesh.hpp"

#include <array>
#include <utility>

#include <fmt/format.h>

#include "muslin/component/placement.hpp"
#include "muslin/core/counted.hpp"
#include "muslin/core/hash.hpp"
#include "muslin/geometry/weld.hpp"

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

namespace {

/// Exchanges the mesh for one with fewer vertices, and keeps the source with its vertices moved to those.
void reduce(const BodySettings& settings, const ComponentInputs& inputs, MeshUse use, Component& component) {
  const std::size_t before = component.mesh.vertex_count(), loose = component.report.unused_vertices;
  ReducedMesh reduced =
      settings.weld ? weld(component.mesh, *settings.weld) : without_loose_vertices(component.mesh);
  const std::size_t joined = before - loose - reduced.mesh.vertex_count();
  if (settings.weld && joined == 0)
    warn_of_body(inputs, settings.name, fmt::format("`weld` = {} m joins no vertices", *settings.weld));
  if (joined == 0 && loose == 0) return;
  for (std::size_t v = 0; v < before; ++v)
    if (reduced.vertices[v] >= 0)
      component.mesh.positions[v] = reduced.mesh.positions[static_cast<std::size_t>(reduced.vertices[v])];
  component.source = {std::move(component.mesh), std::move(reduced.vertices), std::move(reduced.origins)};
  component.mesh = std::move(reduced.mesh);
  component.report = use == MeshUse::cloth ? inspect_cloth(component.mesh) : inspect(component.mesh);
}

}  // namespace

void read_body_mesh(const BodySettings& settings, const ComponentInputs& inputs, MeshUse use,
                    Component& component) {
  component.name = settings.name;
  inputs.progress.at(0.0, "mesh");
  const std::string file = inputs.files.resolve(settings.mesh).string();
  at_place(settings.mesh_place, file, [&] {
    MeshFile read = inputs.files.mesh(settings.mesh);
    if (!read.note.empty()) warn_of_body(inputs, settings.name, read.note);
    component.mesh = std::move(read.mesh);
    component.attributes = std::move(read.attributes);
    const auto place = placement(settings.translate, settings.rotate, settings.scale);
    for (Vec3& x : component.mesh.positions) x = place * x;
    require_usable(component.mesh, file);
    component.report = use == MeshUse::cloth ? inspect_cloth(component.mesh) : inspect(component.mesh);
    const bool drops = use == MeshUse::cloth && component.report.unused_vertices > 0;
    if (drops)
      warn_of_body(
          inputs, settings.name,
          fmt::format("{} to no polygon and {}; delete loose vertices",
                      counted(component.report.unused_vertices, "vertex belongs", "vertices belong"),
                      component.report.unused_vertices == 1 ? "stays where it is" : "stay where they are"));
    if (drops || settings.weld) reduce(settings, inputs, use, component);
    for (const std::string& warning : component.report.warnings) warn_of_body(inputs, settings.name, warning);
  });
}

std::uint64_t material_hash(const Material& m, double own, std::uint64_t seed) {
  const std::array numbers = {m.density, own};
  return hash_bytes(m.law.data(), m.law.size(), hash_bytes(numbers.data(), sizeof numbers, seed));
}

}  // namespace muslin
