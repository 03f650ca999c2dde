// The energies and dampings of a shell.
#include <algorithm>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "muslin/component/changing_terms.hpp"
#include "muslin/component/shell/shell_body.hpp"
#include "muslin/component/stability_bound.hpp"
#include "muslin/energy/bending_friction.hpp"
#include "muslin/energy/element_energy.hpp"
#include "muslin/energy/keyed_stretch_limit.hpp"
#include "muslin/energy/measured_membrane.hpp"
#include "muslin/energy/membrane_energy.hpp"
#include "muslin/energy/plastic_bending.hpp"
#include "muslin/energy/plastic_membrane.hpp"
#include "muslin/energy/shell_bending.hpp"
#include "muslin/energy/stretch_limit.hpp"
#include "muslin/material/keyed_material.hpp"
#include "muslin/material/measured_sheet.hpp"
#include "muslin/potential/mass_damping.hpp"
#include "muslin/schema/over_time.hpp"

namespace muslin {
namespace {

class ShellTerms {
 public:
  explicit ShellTerms(ShellBody& body)
      : body_(body), material_(body.material()), stress_(stress_of(material_)), bound_(body.mesh.positions) {}

  void add(std::span<const std::uint8_t> held) {
    const ShellMaterial& m = material_;
    if (!body_.pattern) body_.pattern = block_pattern(body_.shell);
    const auto pattern = body_.pattern;
    const auto membrane = membrane_on(pattern, even);
    add_membrane(pattern, membrane);
    // The stable step is that of the stiffest state.
    if (body_.triangle_materials.empty()) {
      bound_.add(MembraneEnergy(body_.shell, {stress_.warp.greatest_slope(), stress_.weft.greatest_slope(),
                                              stress_.shear.greatest_slope(), m.poisson}),
                 3, m.stiffness_damping);
    } else {
      bound_.add(*membrane_on(nullptr, even), 3, greatest(&ShellMaterial::stiffness_damping));
    }
    // The limit has no stiffness at rest, so that the stable step does not know it.
    if (is_limited()) add_limit(pattern);
    const auto bending = bending_on(pattern, held, even);
    add_bending(bending, held);
    // Its blocks are those of half the stiffness that bounds it.
    bound_.add(*bending, 2 * 4, greatest(&ShellMaterial::bending_damping));
    if (has_bending_friction(m)) add_bending_friction(*bending, held);
    add_dampings(pattern, held, membrane, bending);
    const MappedNumber* map = find_map(body_.maps, "mass_damping");
    const double slowing =
        map != nullptr ? map->variation.greatest() : greatest(&ShellMaterial::mass_damping);
    bound_.apply(body_.masses(), slowing, body_.statistics);
  }

 private:
  using Pattern = std::shared_ptr<const SymmetricPattern>;
  static constexpr double unlimited = 10;  // a limit, without stiffness
  static constexpr auto even = [](const ShellMaterial&) { return 1.0; };

  /// The numbers of all triangles, or one for all.
  std::span<const ShellMaterial> materials() const {
    if (body_.triangle_materials.empty()) return {&material_, 1};
    return body_.triangle_materials;
  }

  /// The membrane, each triangle's stiffness times factor(material).
  template <class Factor>
  std::shared_ptr<const ElementEnergy> membrane_on(Pattern pattern, const Factor& factor) const {
    const ShellMaterial& m = material_;
    if (has_curves(m))
      return std::make_shared<MeasuredMembrane>(body_.shell, stress_, m.poisson, std::move(pattern),
                                                rigidity());
    if (body_.triangle_materials.empty())
      return std::make_shared<MembraneEnergy>(
          body_.shell, MembraneModuli{m.membrane_warp, m.membrane_weft, m.membrane_shear, m.poisson},
          std::move(pattern), rigidity());
    std::vector<MembraneModuli> moduli;
    std::vector<BucklingRigidity> rigidities;
    const bool buckles = body_.own().compression == Compression::buckling;
    for (const ShellMaterial& at : materials()) {
      const double f = factor(at);
      moduli.push_back({f * at.membrane_warp, f * at.membrane_weft, f * at.membrane_shear, at.poisson});
      if (buckles) rigidities.push_back({f * at.bending_warp, f * at.bending_weft});
    }
    return std::make_shared<MembraneEnergy>(body_.shell, moduli, std::move(pattern), rigidities);
  }
  void add_membrane(const Pattern& pattern, const std::shared_ptr<const ElementEnergy>& elastic) {
    const ShellMaterial& m = material_;
    if (!m.yield_strain) return add("membrane", elastic);
    body_.loads.push_back({"membrane", EnergyRole::elastic,
                           std::make_shared<PlasticMembrane>(
                               body_.name, body_.shell,
                               MembraneModuli{m.membrane_warp, m.membrane_weft, m.membrane_shear, m.poisson},
                               StrainYield{*m.yield_strain, m.strain_hardening}, pattern)});
  }
  bool is_limited() const {
    if (!body_.has_several_fabrics()) return body_.own().stretch_limit.has_value();
    return std::any_of(body_.triangle_materials.begin(), body_.triangle_materials.end(),
                       [](const ShellMaterial& at) { return at.stretch_limit.has_value(); });
  }
  void add_limit(const Pattern& pattern) {
    const ShellBodySettings& own = body_.own();
    const auto over_time = schema::over_time(own.variations, "stretch_limit", own.stretch_limit);
    const double largest = over_time ? over_time->greatest() : unlimited;
    const double strain = 0.5 * (largest * largest - 1);
    double stiffest = std::max(stress_.warp.slope(strain), stress_.weft.slope(strain));
    for (const ShellMaterial& at : body_.triangle_materials)
      stiffest = std::max({stiffest, at.membrane_warp, at.membrane_weft});
    const auto stiffness = [stiffest, mass = body_.statistics.mass, edge = body_.shell.mean_edge](double at) {
      return stretch_limit_stiffness(stiffest, mass, edge, at);
    };
    if (over_time && over_time->least() < largest)
      return body_.loads.push_back(
          {"stretch limit", EnergyRole::elastic,
           std::make_shared<KeyedStretchLimit>(body_.name, body_.shell, *over_time, stiffness, pattern)});
    if (!body_.has_several_fabrics() && find_map(body_.maps, "stretch_limit") == nullptr)
      return add("stretch limit",
                 std::make_shared<StretchLimitEnergy>(body_.shell, largest, stiffness(largest), pattern));
    std::vector<double> limits, stiffnesses;
    for (const ShellMaterial& at : materials()) {
      limits.push_back(at.stretch_limit.value_or(unlimited));
      stiffnesses.push_back(at.stretch_limit ? stiffness(*at.stretch_limit) : 0);
    }
    add("stretch limit", std::make_shared<StretchLimitEnergy>(body_.shell, limits, stiffnesses, pattern));
  }
  BucklingRigidity rigidity() const {
    if (body_.own().compression == Compression::elastic) return {};
    const SheetMoments moments = moments_of(material_);
    return {moments.warp.slope(0), moments.weft.slope(0)};
  }
  template <class Factor>
  std::shared_ptr<const ShellBending> bending_on(Pattern pattern, std::span<const std::uint8_t> held,
                                                 const Factor& factor) const {
    const ShellMaterial& m = material_;
    if (has_bending_curves(m)) {
      const SheetMoments moments = moments_of(m);
      return std::make_shared<ShellBending>(
          body_.shell, BendingCurves{moments.warp, moments.weft, m.bending_bias, m.poisson},
          std::move(pattern), held);
    }
    std::vector<BendingModuli> moduli;
    for (const ShellMaterial& at : materials()) {
      const double f = factor(at);
      moduli.push_back({f * at.bending_warp, f * at.bending_weft, f * at.bending_bias, at.poisson});
    }
    return std::make_shared<ShellBending>(body_.shell, moduli, std::move(pattern), held);
  }
  BendingModuli plate() const {
    const ShellMaterial& m = material_;
    return {m.bending_warp, m.bending_weft, m.bending_bias, m.poisson};
  }
  void add_bending(const std::shared_ptr<const ShellBending>& elastic, std::span<const std::uint8_t> held) {
    const ShellMaterial& m = material_;
    if (!m.yield_curvature) return add("bending", elastic);
    constexpr double never = std::numeric_limits<double>::infinity();
    const BendingYield yield{*m.yield_curvature, m.yield_hardening, m.yield_recovery.value_or(never)};
    body_.loads.push_back(
        {"bending", EnergyRole::elastic,
         std::make_shared<PlasticBending>(body_.name, body_.shell, plate(), yield, elastic, held)});
  }
  /// A damping that varies acts through elements of its own, whose stiffness is scaled by it.
  void add_dampings(const Pattern& pattern, std::span<const std::uint8_t> held,
                    std::shared_ptr<const ElementEnergy> membrane,
                    std::shared_ptr<const ElementEnergy> bending) {
    if (const double beta = nominal(&ShellMaterial::stiffness_damping); beta > 0) {
      if (varies(&ShellMaterial::stiffness_damping))
        membrane = membrane_on(pattern, [&](const ShellMaterial& at) { return at.stiffness_damping / beta; });
      add_damping("stiffness damping", std::make_shared<ElementDamping>(membrane, beta));
    }
    if (const double beta = nominal(&ShellMaterial::bending_damping); beta > 0) {
      if (varies(&ShellMaterial::bending_damping))
        bending =
            bending_on(pattern, held, [&](const ShellMaterial& at) { return at.bending_damping / beta; });
      add_damping("bending damping", std::make_shared<ElementDamping>(bending, beta));
    }
    add_mass_damping();
  }
  void add_mass_damping() {
    const double alpha = nominal(&ShellMaterial::mass_damping);
    if (alpha == 0) return;
    std::vector<double> masses = body_.has_several_fabrics() ? body_.mass_dampings() : body_.masses();
    if (body_.has_several_fabrics())
      for (double& mass : masses) mass /= alpha;
    if (const MappedNumber* map = find_map(body_.maps, "mass_damping"))
      for (std::size_t v = 0; v < masses.size(); ++v) masses[v] *= map->at(v) / alpha;
    add_damping("mass damping", std::make_shared<MassDamping>(alpha, std::move(masses)));
  }
  /// The number of the body's material, or the greatest one where that is 0.
  double nominal(double ShellMaterial::* number) const {
    return material_.*number > 0 ? material_.*number : greatest(number);
  }
  bool varies(double ShellMaterial::* number) const {
    const double one = nominal(number);
    return std::any_of(materials().begin(), materials().end(),
                       [&](const ShellMaterial& at) { return at.*number != one; });
  }
  /// The greatest value of a number that may vary by a map, or follow one that does.
  double greatest(double ShellMaterial::* number) const {
    double most = 0;
    for (const ShellMaterial& at : materials()) most = std::max(most, at.*number);
    return most;
  }
  void add_bending_friction(const ShellBending& bending, std::span<const std::uint8_t> held) {
    const ShellMaterial& m = material_;
    const BendingFrictionLimits limits{m.bending_friction_warp, m.bending_friction_weft,
                                       m.bending_friction_curvature};
    const auto friction =
        std::make_shared<BendingFriction>(body_.name, body_.shell, bending.angles(), limits, held);
    body_.loads.push_back({"bending friction", EnergyRole::elastic, friction});
    StepContext start;
    start.positions = body_.mesh.positions;
    bound_.add(*friction->potential(start), 2 * 4, 0);
  }
  void add(const char* name, std::shared_ptr<const Potential> potential) {
    body_.potentials.push_back({name, EnergyRole::elastic, std::move(potential)});
  }
  void add_damping(const char* name, std::shared_ptr<const Load> load) {
    body_.loads.push_back({name, EnergyRole::dissipation, std::move(load)});
  }

  ShellBody& body_;
  const ShellMaterial& material_;
  SheetStress stress_;
  StabilityBound bound_;
};

}  // namespace

void ShellBody::add_terms(std::span<const std::uint8_t> held) {
  schema::Variations variations = own().variations;
  schema::forget_variation(variations, "stretch_limit");  // a term of its own follows it
  for (const FabricInUse& fabric : fabrics)
    variations.insert(variations.end(), fabric.numbers().variations.begin(),
                      fabric.numbers().variations.end());
  const std::vector<double> times = keyframe_times(variations);
  if (times.empty()) return ShellTerms(*this).add(held);
  pattern = block_pattern(shell);
  // The terms belong to this body and live as long as it does.
  add_changing_terms(*this,
                     {times, [variations](double time) { return keyed_numbers(variations, time); },
                      [this, always_held = std::vector<std::uint8_t>(held.begin(), held.end())](double time) {
                        const auto at_time = std::make_shared<ShellBody>();
                        at_time->name = name;
                        at_time->mesh = mesh;
                        at_time->vertex_count = vertex_count;
                        at_time->statistics = statistics;
                        at_time->settings = settings;
                        at_time->shell = shell_at(time);
                        at_time->time = time;
                        at_time->woven_areas = woven_areas;
                        at_time->woven_vertex_areas = woven_vertex_areas;
                        at_time->maps = maps;
                        at_time->fabrics = fabrics;
                        for (FabricInUse& fabric : at_time->fabrics)
                          fabric.material.shell = muslin::material_at(fabric.numbers(), time);
                        at_time->settings.material = at_time->fabrics.front().material;
                        at_time->triangle_fabrics = triangle_fabrics;
                        if (!triangle_materials.empty())
                          at_time->triangle_materials = materials_of_triangles(time);
                        at_time->pattern = pattern;
                        ShellTerms(*at_time).add(always_held);
                        return at_time;
                      }});
}

}  // namespace muslin
