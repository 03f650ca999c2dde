#include "muslin/component/shell/shell_body.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "muslin/component/body_maps.hpp"
#include "muslin/component/body_mesh.hpp"
#include "muslin/component/description.hpp"
#include "muslin/core/counted.hpp"
#include "muslin/core/disjoint_sets.hpp"
#include "muslin/core/error.hpp"
#include "muslin/core/hash.hpp"
#include "muslin/core/index.hpp"
#include "muslin/geometry/edge_length.hpp"
#include "muslin/io/mesh_file.hpp"
#include "muslin/io/vtk_file.hpp"
#include "muslin/material/keyed_material.hpp"
#include "muslin/material/measured_sheet.hpp"
#include "muslin/material/varied_material.hpp"
#include "muslin/schema/over_time.hpp"
#include "muslin/shell/rest_scale.hpp"

namespace muslin {
namespace {

constexpr double thin = 5e-4, thin_share = 0.1;  // default thickness: [m], of the mean edge

/// Returns the triangles with the direction of their warp.
VtkGrid triangles(const Shell& shell, const Mesh& mesh) {
  VtkGrid grid;
  grid.points = flat(ConstVectors(mesh.positions));
  std::vector<double> warps;
  for (std::size_t t = 0; t < shell.triangles.size(); ++t) {
    const Vec3i& v = shell.triangles[t];
    const std::array<std::int64_t, 3> corners = {v[0], v[1], v[2]};
    grid.add_cell(VtkCell::triangle, corners.data(), 3);
    const auto x = [&](int c) { return mesh.positions[static_cast<std::size_t>(v[c])]; };
    const Mat2& inverse = shell.inverses[t];
    const Vec3 warp = (x(1) - x(0)) * inverse(0, 0) + (x(2) - x(0)) * inverse(1, 0);
    warps.insert(warps.end(), warp.data(), warp.data() + 3);
  }
  grid.cell_data.push_back({"warp", 3, std::move(warps)});
  grid.cell_data.push_back({"rest_area", 1, shell.areas});
  return grid;
}

nlohmann::ordered_json fabrics_json(const ShellBody& body) {
  const std::vector<double> areas = body.fabric_areas(), masses = body.fabric_masses();
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (std::size_t f = 0; f < body.fabrics.size(); ++f)
    list.push_back({{"name", body.fabrics[f].name},
                    {"material", body.fabrics[f].material.name},
                    {"area", areas[f]},
                    {"mass", masses[f]}});
  return list;
}

bool rest_differs(const ShellBodySettings& own) {
  return own.rest == RestSource::uv || !own.rest_mesh.empty();
}

}  // namespace

const ShellMaterial& ShellBody::material() const {
  if (!settings.material.shell)
    throw Error(ErrorKind::usage, "the material of a shell has no numbers of shells", "set its `shell`");
  return *settings.material.shell;
}

std::vector<ShellMaterial> ShellBody::materials_of_triangles(double time) const {
  std::vector<std::vector<double>> numbers;
  numbers.reserve(fabrics.size());
  for (const FabricInUse& fabric : fabrics) numbers.push_back(numbers_at(fabric.numbers().variations, time));
  std::vector<ShellMaterial> materials;
  materials.reserve(shell.triangles.size());
  for (std::size_t t = 0; t < shell.triangles.size(); ++t) {
    const std::size_t f = at(triangle_fabrics[t]);
    for (const MappedNumber& map : fabrics[f].maps) numbers[f][map.index] = map.mean(shell.triangles[t]);
    materials.push_back(with_numbers(fabrics[f].numbers(), numbers[f]));
  }
  return materials;
}

std::optional<double> ShellBody::stretch_limit(double at_time) const {
  if (const auto limit = schema::over_time(own().variations, "stretch_limit", own().stretch_limit))
    return limit->at(at_time);
  if (!has_several_fabrics()) return std::nullopt;
  double largest = 0;
  for (const ShellMaterial& at : triangle_materials) {
    if (!at.stretch_limit) return std::nullopt;
    largest = std::max(largest, *at.stretch_limit);
  }
  return largest;
}

TrustedEdge ShellBody::shortest_trusted_edge() const {
  TrustedEdge shortest = trusted_edge(material(), own().compression);
  for (const FabricInUse& fabric : fabrics) {
    const TrustedEdge edge = trusted_edge(fabric.numbers(), own().compression);
    if (edge.length() < shortest.length()) shortest = edge;
  }
  return shortest;
}

Vec2 ShellBody::rest_scale(std::span<const int> vertices, double at_time) const {
  const ShellBodySettings& o = own();
  const auto scale = [&](const char* key, double number) {
    const MappedNumber* map = find_map(maps, key);
    return map != nullptr ? map->mean(vertices) : number;
  };
  const Vec2 whole(scale("rest_scale_warp", o.rest_scale_warp),
                   scale("rest_scale_weft", o.rest_scale_weft.value_or(o.rest_scale_warp)));
  const schema::Variation* keyed = schema::find_variation(o.variations, "rest_scale_share");
  const double share = keyed != nullptr ? value_at(keyed->keyframes, at_time) : o.rest_scale_share;
  return share == 1 ? whole : Vec2(Vec2::Ones() + share * (whole - Vec2::Ones()));
}

Shell ShellBody::shell_at(double at_time) const {
  Shell result = shell;
  scale_rest(result, [&](std::span<const int> vertices) -> Vec2 {
    return rest_scale(vertices, at_time).cwiseQuotient(rest_scale(vertices, time));
  });
  return result;
}

template <class Visit>
void ShellBody::for_each_share(const Visit& visit) const {
  std::vector<const MappedNumber*> densities;
  densities.reserve(fabrics.size());
  for (const FabricInUse& fabric : fabrics) densities.push_back(find_map(fabric.maps, "areal_density"));
  for (std::size_t t = 0; t < shell.triangles.size(); ++t) {
    const std::size_t f = at(triangle_fabrics[t]);
    for (const int v : shell.triangles[t]) {
      const double density =
          densities[f] != nullptr ? densities[f]->at(at(v)) : fabrics[f].numbers().areal_density;
      visit(t, at(v), density * woven_areas[t] / 3);
    }
  }
}

std::vector<double> ShellBody::fabric_masses() const {
  std::vector<double> masses(fabrics.size(), 0.0);
  for_each_share([&](std::size_t t, std::size_t, double share) { masses[at(triangle_fabrics[t])] += share; });
  return masses;
}

std::vector<double> ShellBody::fabric_areas() const {
  std::vector<double> areas(fabrics.size(), 0.0);
  for (std::size_t t = 0; t < shell.areas.size(); ++t) areas[at(triangle_fabrics[t])] += woven_areas[t];
  return areas;
}

std::vector<double> ShellBody::mass_dampings() const {
  std::vector<double> dampings(mesh.vertex_count(), 0.0);
  for_each_share([&](std::size_t t, std::size_t v, double share) {
    dampings[v] += share * material_at(t).mass_damping;
  });
  return dampings;
}

std::vector<double> ShellBody::masses() const {
  if (has_several_fabrics()) {
    std::vector<double> masses(mesh.vertex_count(), 0.0);
    for_each_share([&](std::size_t, std::size_t v, double share) { masses[v] += share; });
    return masses;
  }
  std::vector<double> masses = woven_vertex_areas;
  const MappedNumber* mapped = find_map(maps, "areal_density");
  for (std::size_t v = 0; v < masses.size(); ++v)
    masses[v] *= mapped != nullptr ? mapped->at(v) : material().areal_density;
  return masses;
}

std::vector<Vec3> ShellBody::velocities() const {
  return std::vector<Vec3>(mesh.vertex_count(), settings.velocity);
}

std::vector<int> ShellBody::parts() const {
  DisjointSets parts(mesh.vertex_count());
  for (const Vec3i& t : shell.triangles) {
    parts.join(t[0], t[1]);
    parts.join(t[1], t[2]);
  }
  return parts.find_all();
}

double ShellBody::mean_modulus() const {
  const auto modulus = [](const ShellMaterial& material) {
    const SheetStress stress = stress_of(material);
    return std::sqrt(stress.warp.slope(0) * stress.weft.slope(0));
  };
  if (!has_several_fabrics()) return modulus(material());
  const std::vector<double> areas = fabric_areas();
  double sum = 0;
  for (std::size_t f = 0; f < fabrics.size(); ++f) sum += areas[f] * modulus(fabrics[f].numbers());
  return sum / std::accumulate(areas.begin(), areas.end(), 0.0);
}

std::vector<KeyedNumber> ShellBody::frictions() const {
  const MappedNumber* map = find_map(maps, "friction");
  const bool varies = map != nullptr || std::any_of(fabrics.begin(), fabrics.end(), [](const FabricInUse& f) {
                        return f.friction.has_value();
                      });
  if (!varies) return {};
  const std::vector<double> numbers =
      map != nullptr ? map->numbers() : std::vector<double>(mesh.vertex_count(), -1.0);
  std::vector<KeyedNumber> frictions(numbers.begin(), numbers.end());
  std::vector<std::optional<KeyedNumber>> of_fabrics;
  of_fabrics.reserve(fabrics.size());
  for (const FabricInUse& fabric : fabrics)
    of_fabrics.push_back(schema::over_time(fabric.variations, "friction", fabric.friction));
  std::vector<int> last(mesh.vertex_count(), -1);
  for (std::size_t t = 0; t < shell.triangles.size(); ++t) {
    const int fabric = triangle_fabrics[t];
    const FabricInUse& of = fabrics[at(fabric)];
    if (!of.friction) continue;
    const MappedNumber* own_map = find_map(maps, of.name + ".friction");
    for (const int v : shell.triangles[t]) {
      if (fabric < last[at(v)]) continue;
      last[at(v)] = fabric;
      frictions[at(v)] = own_map != nullptr ? own_map->at(at(v)) : *of_fabrics[at(fabric)];
    }
  }
  return frictions;
}

std::optional<ContactPart> ShellBody::contact_part() const {
  if (!settings.contact) return std::nullopt;
  const Triangulation cut = triangulate(mesh);
  ContactPart part;
  part.edge = mean_edge(mesh.positions, cut.triangles);
  part.size = mesh.bounds().sizes().maxCoeff();
  part.body.self_contact = settings.self_contact;
  part.body.friction = schema::over_time(settings.variations, "friction", settings.friction);
  part.varying.friction = frictions();
  part.body.layer = settings.layer;
  part.body.radius = own().thickness.value_or(std::min(thin, thin_share * part.edge)) / 2;
  if (const MappedNumber* map = find_map(maps, "thickness")) {
    part.varying.radius = map->numbers();
    for (double& radius : part.varying.radius) radius /= 2;
    part.body.radius = *std::max_element(part.varying.radius.begin(), part.varying.radius.end());
  }
  part.body.stiffness = contact_stiffness_share * mean_modulus();
  // A body without stretch resistance still needs contact to carry its weight.
  if (!(part.body.stiffness > 0)) part.body.mass = statistics.mass / vertex_count;
  part.add_mesh(mesh, cut, source ? identity_embedding(mesh.vertex_count()) : skin);
  return part;
}

std::uint64_t ShellBody::shape_hash(std::uint64_t seed) const {
  std::uint64_t hash = range_hash(seed, 0);
  hash = hash_bytes(shell.triangles.data(), shell.triangles.size() * sizeof(Vec3i), hash);
  hash = hash_bytes(shell.inverses.data(), shell.inverses.size() * sizeof(Mat2), hash);
  return hash_bytes(shell.hinges.data(), shell.hinges.size() * sizeof(Hinge), hash);
}

std::uint64_t ShellBody::material_hash(std::uint64_t seed) const {
  const ShellMaterial& m = material();
  const std::array numbers = {m.areal_density, static_cast<double>(own().compression)};
  std::uint64_t hash =
      hash_bytes(numbers.data(), sizeof numbers, muslin::material_hash(settings.material, 0, seed));
  if (has_bending_friction(m)) {
    const std::array friction = {m.bending_friction_warp, m.bending_friction_weft,
                                 m.bending_friction_curvature};
    hash = hash_bytes(friction.data(), sizeof friction, hash);
  }
  if (m.yield_curvature) {
    const std::array yield = {*m.yield_curvature, m.yield_hardening, m.yield_recovery.value_or(0)};
    hash = hash_bytes(yield.data(), sizeof yield, hash);
  }
  if (m.yield_strain) {
    const std::array yield = {*m.yield_strain, m.strain_hardening};
    hash = hash_bytes(yield.data(), sizeof yield, hash);
  }
  if (has_several_fabrics()) {
    for (const FabricInUse& fabric : fabrics)
      hash = hash_bytes(&fabric.numbers().areal_density, sizeof(double), hash);
    hash = hash_bytes(triangle_fabrics.data(), triangle_fabrics.size() * sizeof(int), hash);
  }
  return maps_hash(maps, hash);
}

void ShellBody::write_stages(const std::filesystem::path& folder, const Progress& /*progress*/) const {
  write_vtu(folder / (name + ".shell.vtu"), triangles(shell, mesh));
  write_mesh(folder / (name + ".skin.obj"), skin_mesh());
}

std::string ShellBody::description_json() const {
  const BodyStatistics& s = statistics;
  nlohmann::ordered_json json;
  json["name"] = name;
  json["mesh"] = settings.mesh;
  json["model"] = kind();
  json["triangles"] = s.triangles;
  json["pieces"] = report.components;
  json["hinges"] = s.hinges;
  json["area"] = shell.area;
  json["mean_edge"] = shell.mean_edge;
  json["trusted_edge"] = shortest_trusted_edge().length();
  if (rest_differs(own())) {
    json["rest"] = {{"of", own().rest == RestSource::uv ? "uv" : "rest_mesh"},
                    {"seam_hinges", shell.seam_hinges},
                    {"start_stretch", muslin::max_stretch(shell, mesh.positions)}};
    if (own().rest == RestSource::uv) json["rest"]["uv_scale"] = uv_scale;
  }
  if (const auto limit = stretch_limit(0)) json["stretch_limit"] = *limit;
  json["warp"] = own().warp ? "given" : mesh.corner_uvs.empty() ? "longest side" : "texture";
  json["material"] = settings.material.name;
  if (has_several_fabrics()) json["fabrics"] = fabrics_json(*this);
  append_counts(json, s);
  append_stable_step(json, s);
  return to_line(json);
}

std::string ShellBody::description() const {
  const BodyStatistics& s = statistics;
  std::string text =
      fmt::format("body {}: {} ({}, shell)\n", name, settings.mesh, counted(mesh.face_count(), "polygon"));
  text += fmt::format("  shell       {} vertices, {} triangles, {} hinges, edges of {:.4g} m on average\n",
                      s.vertices, s.triangles, s.hinges, shell.mean_edge);
  if (source)
    text +=
        fmt::format("  file        {} vertices, joined or loose ones included\n", source->vertices.size());
  if (report.components > 1) text += fmt::format("  pieces      {} that are not joined\n", report.components);
  if (rest_differs(own())) {
    text += own().rest == RestSource::uv
                ? fmt::format("  rest        the texture, {:.4g} m per unit", uv_scale)
                : fmt::format("  rest        {}", own().rest_mesh);
    text += fmt::format(", {}; stretched to {:.4g} at the start\n",
                        counted(shell.seam_hinges, "hinge on seams", "hinges on seams"),
                        muslin::max_stretch(shell, mesh.positions));
  }
  for (std::size_t f = 0; f < fabrics.size(); ++f) text += description_of(f);
  if (const double edge = shortest_trusted_edge().length(); edge > 0)
    text += fmt::format("  drape       as the fabric's with edges of up to {:.2g} m\n", edge);
  if (const auto limit = stretch_limit(0))
    text += fmt::format("  limit       stretched to {:.4g} of its length at most\n", *limit);
  return text;
}

std::string ShellBody::description_of(std::size_t fabric) const {
  const FabricInUse& of = fabrics[fabric];
  const ShellMaterial& m = of.numbers();
  const SheetStress stress = stress_of(m);
  const SheetMoments moments = moments_of(m);
  std::string text;
  double mass = statistics.mass;
  if (has_several_fabrics()) {
    text = fmt::format("  fabric      {}\n", of.name);
    mass = fabric_masses()[fabric];
  }
  text += fmt::format("  mass        {:.6g} kg of {}, {:.4g} kg/m² on {:.6g} m²\n", mass, of.material.name,
                      m.areal_density, fabric_areas()[fabric]);
  text += fmt::format(
      "  stiffness   warp {:.4g}, weft {:.4g}, shear {:.4g} N/m; bending {:.3g}, {:.3g}, bias "
      "{:.3g} N·m\n",
      stress.warp.slope(0), stress.weft.slope(0), stress.shear.slope(0), moments.warp.slope(0),
      moments.weft.slope(0), m.bending_bias);
  if (has_curves(m))
    text += fmt::format("  curves      at most warp {:.4g}, weft {:.4g}, shear {:.4g} N/m\n",
                        stress.warp.greatest_slope(), stress.weft.greatest_slope(),
                        stress.shear.greatest_slope());
  if (has_bending_curves(m))
    text += fmt::format("  curves      bending at least warp {:.3g}, weft {:.3g} N·m\n",
                        moments.warp.least_slope(), moments.weft.least_slope());
  if (has_bending_friction(m))
    text += fmt::format("  friction    of bending, up to warp {:.3g}, weft {:.3g} N within {:.3g}/m\n",
                        m.bending_friction_warp, m.bending_friction_weft, m.bending_friction_curvature);
  if (m.yield_curvature)
    text += fmt::format(
        "  yield       where warp bends by more than {:.3g}/m, then with {:.3g} of its stiffness\n",
        *m.yield_curvature, m.yield_hardening);
  if (m.yield_strain)
    text += fmt::format(
        "  yield       where threads stretch by more than {:.3g}, then with {:.3g} of their stiffness\n",
        *m.yield_strain, m.strain_hardening);
  return text;
}

const ShellBody* as_shell(const Component& component) { return dynamic_cast<const ShellBody*>(&component); }

}  // namespace muslin
