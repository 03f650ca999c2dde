#include <algorithm>
#include <array>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "muslin/component/body_maps.hpp"
#include "muslin/component/body_mesh.hpp"
#include "muslin/component/body_table.hpp"
#include "muslin/component/changing_terms.hpp"
#include "muslin/component/lattice/lattice_body.hpp"
#include "muslin/component/lattice/shared_voxels.hpp"
#include "muslin/component/solid.hpp"
#include "muslin/component/stability_bound.hpp"
#include "muslin/core/progress_part.hpp"
#include "muslin/energy/element_energy.hpp"
#include "muslin/energy/plastic_springs.hpp"
#include "muslin/energy/solid_laws.hpp"
#include "muslin/energy/spring_damping.hpp"
#include "muslin/energy/spring_energy.hpp"
#include "muslin/energy/volume_energy.hpp"
#include "muslin/field/signed_distance.hpp"
#include "muslin/geometry/thicken.hpp"
#include "muslin/material/keyed_material.hpp"
#include "muslin/material/material_table.hpp"
#include "muslin/potential/mass_damping.hpp"

namespace muslin {
namespace {

// Above this the run is long and takes several GiB; the user is warned.
constexpr std::size_t many_voxels = 2'000'000;

void add_lattice_terms(LatticeBody& body);

class LatticeBuilder {
 public:
  LatticeBuilder(const BodySettings& settings, const ComponentInputs& inputs)
      : settings_(settings), own_(settings.own.as<LatticeBodySettings>()), inputs_(inputs) {
    body_.settings = settings;
  }

  std::shared_ptr<Component> build() {
    read_body_mesh(settings_, inputs_, MeshUse::solid, body_);
    make_solid();
    at_place(settings_.place, inputs_.files.resolve(settings_.mesh).string(),
             [&] { fill(inputs_.progress); });
    vary_material();
    weigh(body_);
    add_lattice_terms(body_);
    return built_;
  }

 private:
  void say(const std::string& sentence) { warn_of_body(inputs_, settings_.name, sentence); }

  void make_solid() {
    using Inside = LatticeBodySettings::Inside;
    MeshKind kind = kind_of(body_.mesh, body_.report);
    if (kind == MeshKind::holed_solid && own_.thickness) kind = MeshKind::sheet;
    if (own_.inside != Inside::automatic)
      kind = own_.inside == Inside::filled ? MeshKind::solid : MeshKind::sheet;
    body_.sheet = kind == MeshKind::sheet;
    if (body_.sheet) {
      body_.thickness = own_.thickness.value_or(own_.lattice.width);
      body_.solid = thicken(body_.mesh, body_.thickness);
      if (!own_.thickness) {
        say(
            fmt::format("the mesh is a sheet; its thickness is taken as one voxel width, {} m; set "
                        "`thickness` to choose it, or `inside = \"filled\"` for a solid",
                        body_.thickness));
      }
      return;
    }
    if (own_.thickness) say("the mesh is filled, so `thickness` has no effect");
    if (kind == MeshKind::holed_solid) {
      say(fmt::format(
          "the mesh has {} open edges around small holes and is filled as a solid; set `inside = \"sheet\"` "
          "if it is meant as a shell",
          body_.report.open_edges));
    }
    body_.solid = body_.report.volume < 0 ? flipped(body_.mesh) : body_.mesh;
  }

  void fill(const Progress& progress) {
    progress.at(0.1, "distance field");
    if (own_.separate_parts) body_.separate = SeparateParts(body_.solid, own_.lattice);
    const Mesh solid = body_.separate.in_grid(body_.solid);
    const SignedDistance distance(solid);
    progress.at(0.2, "voxels");
    body_.lattice = build_lattice(solid, distance, own_.lattice, progress_part(progress, 0.2, 0.7));
    progress.at(0.7, "springs");
    const std::vector<double> fill = body_.lattice.fill;
    body_.lattice.fill = body_.voxel_shares();
    body_.springs = build_springs(body_.lattice, own_.bracing);
    body_.lattice.fill = fill;
    progress.at(0.8, "skin");
    body_.skin = body_.carry(body_.skin_mesh().positions);
    progress.at(0.9, "contour");
    const bool one_layer = body_.lattice.extent.minCoeff() == 1;
    body_.contour = build_contour(body_.lattice, solid, distance,
                                  one_layer ? ContourMethod::squares : ContourMethod::cubes);
    body_.lattice.slabs = body_.separate.slabs(body_.lattice);
    if (!body_.separate.empty())
      body_.contour.embedding.apply(rest_positions(), body_.contour.mesh.positions);
    body_.vertex_count = static_cast<int>(body_.lattice.vertex_count());
    count();
    advise();
  }

  std::vector<Vec3> rest_positions() const {
    std::vector<Vec3> vertices;
    vertices.reserve(body_.lattice.vertex_count());
    for (std::size_t v = 0; v < body_.lattice.vertex_count(); ++v)
      vertices.push_back(body_.lattice.rest_position(v));
    return vertices;
  }

  void count() {
    BodyStatistics& s = body_.statistics;
    s.vertices = static_cast<std::int64_t>(body_.lattice.vertex_count());
    s.voxels = static_cast<std::int64_t>(body_.lattice.voxel_count());
    s.tetrahedra = 6 * s.voxels;
    s.springs = body_.springs.count_by_kind;
    s.coverage = body_.lattice.coverage;
    s.contour_distance = body_.contour.distance;
  }

  void advise() {
    const double width = own_.lattice.width;
    if (body_.lattice.coverage < 1 - 1e-6) {
      say(
          fmt::format("{:.3g} % of its surface lies outside the voxels; use `voxels = \"cover\"` or a higher "
                      "`threshold`",
                      100 * (1 - body_.lattice.coverage)));
    }
    if (body_.contour.mesh.face_count() == 0)
      say("it is too small for its voxels to have a contour; use a smaller `voxel_width`");
    if (body_.sheet && body_.thickness > 4 * width) {
      say(
          fmt::format("the sheet is {:.3g} voxels thick; a larger `voxel_width` or a smaller `thickness` is "
                      "cheaper",
                      body_.thickness / width));
    }
    if (body_.lattice.voxel_count() > many_voxels) {
      say(fmt::format("{} voxels take long and several GiB of memory; a larger `voxel_width` takes less",
                      body_.lattice.voxel_count()));
    }
    if (own_.separate_parts) return;
    if (const auto shared = find_shared_voxels(body_.solid, body_.lattice)) {
      say(fmt::format(
          "{} parts of its mesh are apart but share voxels, so they move as one, such as those of vertices "
          "{} and {}, {:.2g} m apart; set `separate_parts = true` to keep them apart",
          shared->parts, shared->vertices[0] + 1, shared->vertices[1] + 1, shared->distance));
    }
  }

  void vary_material() {
    body_.maps = read_maps(settings_.material.variations, lattice_material_table(), inputs_.files, body_);
    const MappedNumber* damping = find_map(body_.maps, "stiffness_damping");
    if (damping != nullptr && settings_.material.has_springs())
      throw Error(ErrorKind::input, damping->variation.place,
                  "`stiffness_damping` of springs cannot vary by a map",
                  "give a number, which damps in proportion to the moduli, or a solid by `law`");
    body_.vertex_maps = over_points(body_.maps, body_.mesh, rest_positions());
    for (MappedNumber& map : read_maps(settings_.variations, body_table(), inputs_.files, body_))
      body_.maps.push_back(std::move(map));
  }

  const BodySettings& settings_;
  const LatticeBodySettings& own_;
  const ComponentInputs& inputs_;
  std::shared_ptr<LatticeBody> built_ = std::make_shared<LatticeBody>();
  LatticeBody& body_ = *built_;
};

class LatticeTerms {
 public:
  explicit LatticeTerms(LatticeBody& body) : settings_(body.settings), own_(body.own()), body_(body) {}

  void add_terms() {
    const Material& material = settings_.material;
    const std::array moduli = {material.edge_modulus, material.face_diagonal_modulus,
                               material.body_diagonal_modulus};
    Lattice lattice = body_.lattice;
    lattice.fill = body_.voxel_shares();
    std::vector<Vec3> rest(lattice.vertex_count());
    for (std::size_t v = 0; v < rest.size(); ++v) rest[v] = lattice.rest_position(v);
    StabilityBound bound(rest);
    std::shared_ptr<const Load> damping;
    if (const SolidLaw* law = find_solid_law(material.law)) {
      const auto pattern = tetrahedron_pattern(body_.lattice);
      const auto made = [&](const Lattice& weighted) {
        return law->make(weighted, SolidModuli{*material.youngs_modulus, material.poisson}, pattern);
      };
      const Lattice stiff = filled(lattice, "youngs_modulus");
      const auto solid = made(stiff);
      body_.potentials.push_back({"solid", EnergyRole::elastic, solid});
      bound.add(*solid, 4, greatest("stiffness_damping", material.stiffness_damping));
      const MappedNumber* damped = find_map(body_.maps, "stiffness_damping");
      const bool even = damped == nullptr || damped->variation.from == damped->variation.to;
      damping = std::make_shared<ElementDamping>(even ? solid : made(filled(stiff, "stiffness_damping")),
                                                 material.stiffness_damping);
    } else {
      const auto springs = std::make_shared<SpringEnergy>(body_.springs, body_.lattice.width, moduli,
                                                          varied(spring_weights()), body_.network);
      if (material.yield_strain) {
        body_.loads.push_back(
            {"springs", EnergyRole::elastic,
             std::make_shared<PlasticSprings>(
                 body_.name, body_.springs, body_.lattice.vertex_count(), body_.lattice.width, moduli,
                 varied(spring_weights()), StrainYield{*material.yield_strain, material.strain_hardening})});
      } else {
        body_.potentials.push_back({"springs", EnergyRole::elastic, springs});
      }
      bound.add(*springs, 2, material.stiffness_damping);
      damping = std::make_shared<SpringDamping>(springs, material.stiffness_damping);
    }
    if (material.volume_modulus > 0) {
      const auto volume =
          std::make_shared<VolumeEnergy>(filled(lattice, "volume_modulus"), material.volume_modulus);
      body_.potentials.push_back({"volume", EnergyRole::elastic, volume});
      bound.add(*volume, 4, 0);
    }
    const std::vector<double> masses = body_.masses();
    if (material.stiffness_damping > 0)
      body_.loads.push_back({"stiffness damping", EnergyRole::dissipation, damping});
    if (material.mass_damping != 0) {
      std::vector<double> damped = masses;
      if (const MappedNumber* map = find_map(body_.vertex_maps, "mass_damping"))
        for (std::size_t v = 0; v < damped.size(); ++v) damped[v] *= map->at(v) / material.mass_damping;
      body_.loads.push_back({"mass damping", EnergyRole::dissipation,
                             std::make_shared<MassDamping>(material.mass_damping, std::move(damped))});
    }
    bound.apply(masses, greatest("mass_damping", material.mass_damping), body_.statistics);
  }

  /// Returns #springs factors of the spring constants; empty if all are 1.
  std::vector<float> spring_weights() const {
    if (own_.boundary_springs == LatticeBodySettings::BoundarySprings::shared) return body_.springs.share;
    if (own_.mass == LatticeBodySettings::Mass::solid) return body_.springs.mean_fill;
    return {};
  }

 private:
  /// `weights` of springs times the mean of their mapped modulus at both ends, over the nominal one.
  std::vector<float> varied(std::vector<float> weights) const {
    constexpr std::array keys = {"edge_modulus", "face_diagonal_modulus", "body_diagonal_modulus"};
    if (body_.vertex_maps.empty()) return weights;
    if (weights.empty()) weights.assign(static_cast<std::size_t>(body_.springs.count), 1.0F);
    for (const SpringRun& run : body_.springs.runs) {
      const SpringKind kind = body_.springs.directions[static_cast<std::size_t>(run.direction)].kind;
      const MappedNumber* map = find_map(body_.vertex_maps, keys[static_cast<std::size_t>(kind)]);
      if (map == nullptr || map->variation.nominal() == 0) continue;
      for (int i = 0; i < run.length; ++i) {
        const double number = map->mean(std::array{run.a + i, run.b + i});
        weights[static_cast<std::size_t>(run.first + i)] *=
            static_cast<float>(number / map->variation.nominal());
      }
    }
    return weights;
  }
  /// `lattice` with its fill times the mapped number over the nominal one.
  Lattice filled(Lattice lattice, std::string_view key) const {
    const std::vector<double> factors = body_.voxel_factors(key);
    for (std::size_t c = 0; c < factors.size(); ++c) lattice.fill[c] *= factors[c];
    return lattice;
  }

  /// The greatest value of a number that may vary by a map.
  double greatest(std::string_view key, double number) const {
    const MappedNumber* map = find_map(body_.maps, key);
    return map != nullptr ? map->variation.greatest() : number;
  }

  const BodySettings& settings_;
  const LatticeBodySettings& own_;
  LatticeBody& body_;
};

void add_lattice_terms(LatticeBody& body) {
  const schema::Variations& variations = body.settings.material.variations;
  const std::vector<double> times = keyframe_times(variations);
  if (times.empty()) return LatticeTerms(body).add_terms();
  if (body.settings.material.has_springs())
    body.network =
        SpringEnergy(body.springs, body.lattice.width, {}, LatticeTerms(body).spring_weights()).network();
  // The terms belong to this body and live as long as it does.
  add_changing_terms(body, {times, [&variations](double time) { return keyed_numbers(variations, time); },
                            [&body](double time) {
                              const auto at_time = std::make_shared<LatticeBody>();
                              at_time->name = body.name;
                              at_time->statistics = body.statistics;
                              at_time->settings = body.settings;
                              at_time->settings.material = material_at(body.settings.material, time);
                              at_time->lattice = body.lattice;
                              at_time->springs = body.springs;
                              at_time->network = body.network;
                              at_time->maps = body.maps;
                              at_time->vertex_maps = body.vertex_maps;
                              LatticeTerms(*at_time).add_terms();
                              return at_time;
                            }});
}

}  // namespace

std::shared_ptr<Component> build_lattice_body(const BodySettings& settings, const ComponentInputs& inputs) {
  return LatticeBuilder(settings, inputs).build();
}

}  // namespace muslin
