// Continues a simulation with a changed topology.
#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "muslin/component/kinds.hpp"
#include "muslin/contact/contact_model.hpp"
#include "muslin/contact/crossings.hpp"
#include "muslin/core/error.hpp"
#include "muslin/geometry/mesh.hpp"
#include "muslin/simulation/energy_account.hpp"
#include "muslin/simulation/simulation_impl.hpp"

namespace muslin {
namespace {

void require_origins(std::span<const int> origins, const Model& from, const Model& to) {
  require(origins.size() == to.vertex_count(), "a changed model has another number of vertices than origins",
          "give one origin for each vertex of the new model");
  for (const int origin : origins)
    require(origin >= 0 && static_cast<std::size_t>(origin) < from.vertex_count(),
            "a vertex of a changed model has an origin that does not exist",
            "give vertices of the model so far, counted from 0");
}

std::vector<Vec3> gathered(ConstVectors values, std::span<const int> origins) {
  std::vector<Vec3> result;
  if (values.empty()) return result;
  for (const int origin : origins) result.push_back(values[static_cast<std::size_t>(origin)]);
  return result;
}

/// Keeps the anchors of the pins: a vertex has the anchor of its origin. A pin that did not hold all of its
/// vertices records them again in the next step.
Holds gathered(const Holds& earlier, const Model& from, const Model& to, std::span<const int> origins) {
  Holds holds;
  if (earlier.holding.size() != from.pins.size() || from.pins.size() != to.pins.size()) return holds;
  std::size_t first = 0;
  for (std::size_t p = 0; p < to.pins.size(); ++p) {
    const std::vector<int>& known = from.pins[p].vertices;
    std::uint8_t holding = earlier.holding[p];
    for (const int vertex : to.pins[p].vertices) {
      const auto at = std::lower_bound(known.begin(), known.end(), origins[static_cast<std::size_t>(vertex)]);
      const bool is_known = at != known.end() && *at == origins[static_cast<std::size_t>(vertex)];
      if (!is_known) holding = 0;
      holds.anchors.push_back(is_known ? earlier.anchors[first + static_cast<std::size_t>(at - known.begin())]
                                       : Vec3::Zero());
    }
    holds.holding.push_back(holding);
    first += known.size();
  }
  return holds;
}

/// True if two triangles of the surface have a corner at one place, as on both sides of a cut.
bool share_a_corner(const ContactSurface& surface, ConstVectors points, const Crossing& crossing) {
  if (crossing.first_triangle < 0 || crossing.second_triangle < 0) return false;
  for (const int a : surface.triangles()[static_cast<std::size_t>(crossing.first_triangle)])
    for (const int b : surface.triangles()[static_cast<std::size_t>(crossing.second_triangle)])
      if (points[static_cast<std::size_t>(a)] == points[static_cast<std::size_t>(b)]) return true;
  return false;
}

/// Refuses crossings at x, except those of triangles that a cut has just separated.
void refuse_other_crossings(const ContactModel& contact, ConstVectors x, double time) {
  std::vector<Vec3> points(contact.surface->point_count());
  contact.map->apply(x, points);
  for (const Crossing& crossing : find_crossings(contact, x, time))
    if (!share_a_corner(*contact.surface, points, crossing)) refuse_crossings(contact, x, time);
}

/// Opens edges of a mesh of the scene, which becomes a mesh in memory that only this body uses, because other
/// bodies may have the same file.
std::vector<int> cut_mesh(Scene& scene, const std::string& body, std::string& path,
                          std::span<const std::array<int, 2>> edges) {
  MeshCut halves = cut(scene_mesh(scene, path).mesh, edges);
  path = fmt::format("{} ({}, cut {})", path, body, halves.mesh.version);
  scene.meshes[path] = std::make_shared<const Mesh>(std::move(halves.mesh));
  return std::move(halves.origins);
}

}  // namespace

void Simulation::change_model(std::shared_ptr<const Model> model, std::span<const int> origins) {
  Impl& impl = *impl_;
  require(model != nullptr, "a simulation needs a model", "give the one that build_model returns");
  require_origins(origins, *impl.model, *model);
  const auto energy = [&impl] {
    double sum =
        kinetic_energy(impl.model->masses, impl.state.motion.velocities) + impl.state.energy.contact_energy;
    for (const double stored : impl.state.energy.stored) sum += stored;
    return sum;
  };
  State motion = impl.state.motion;
  for (std::vector<Vec3>* values :
       {&motion.positions, &motion.velocities, &motion.previous_positions, &motion.previous_velocities})
    *values = gathered(*values, origins);
  motion.history = {};
  if (model->contact && !impl.options.allow_tangled)
    refuse_other_crossings(*model->contact, motion.positions, motion.time);
  const double before = energy();

  impl.state.holds = gathered(impl.state.holds, *impl.model, *model, origins);
  impl.state.pins = pin_keys(model->pins);
  impl.state.motion = std::move(motion);
  impl.state.contact = {};
  impl.state.energy.contact_energy = 0;
  impl.model = std::move(model);
  impl.loads = impl.model->loads;
  impl.scratch.forget();
  if (impl.model->contact) impl.touch(true);
  impl.measure_energy();
  impl.state.energy.work += energy() - before;
  if (impl.state.steps_done == 0) impl.describe_state(impl.state.diagnostics);
}

void Simulation::cut(const std::string& body, std::span<const std::array<int, 2>> edges) {
  Scene scene = model().scene;
  const auto settings = std::find_if(scene.bodies.begin(), scene.bodies.end(),
                                     [&](const BodySettings& b) { return b.name == body; });
  const Component& before = model().body(body);
  if (settings == scene.bodies.end() || kind_of(*settings).cut_meshes == nullptr)
    throw Error(ErrorKind::usage,
                fmt::format("\"{}\" is no shell of the scene, and only these can be cut", body),
                "give the name of a [[body]] that is a shell");
  if (before.source)
    throw Error(ErrorKind::usage,
                fmt::format("\"{}\" has other vertices than its file, which cannot be cut", body),
                "join vertices and delete loose ones in the modeller, and leave out `weld`");
  std::vector<int> cut_origins;
  for (std::string* path : kind_of(*settings).cut_meshes(*settings))
    cut_origins = cut_mesh(scene, body, *path, edges);

  auto next = std::make_shared<const Model>(build_model(scene));
  std::vector<int> origins;
  for (std::size_t b = 0; b < next->bodies.size(); ++b) {
    const Component& earlier = model().bodies[b];
    for (int v = 0; v < next->bodies[b].vertex_count; ++v)
      origins.push_back(earlier.first_vertex +
                        (&earlier == &before ? cut_origins[static_cast<std::size_t>(v)] : v));
  }
  change_model(std::move(next), origins);
}

}  // namespace muslin
