// The energies and dampings of a shell.
#include <algorithm>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "muslin/component/changing_terms.hpp"
#include "muslin/component/shell/shell_body.hpp"
#include "muslin/energy/bending_friction.hpp"
#include "muslin/energy/element_energy.hpp"
#include "muslin/energy/measured_membrane.hpp"
#include "muslin/energy/membrane_energy.hpp"
#include "muslin/energy/plastic_bending.hpp"
#include "muslin/energy/shell_bending.hpp"
#include "muslin/energy/stretch_limit.hpp"
#include "muslin/material/keyed_material.hpp"
#include "muslin/material/measured_sheet.hpp"
#include "muslin/potential/mass_damping.hpp"

namespace muslin {
namespace {

class ShellTerms {
 public:
  explicit ShellTerms(ShellBody& body)
      : body_(body), material_(body.material()), stress_(stress_of(material_)) {}

  void add(std::span<const std::uint8_t> held) {
    const ShellMaterial& m = material_;
    if (!body_.pattern) body_.pattern = block_pattern(body_.shell);
    const auto pattern = body_.pattern;
    const auto membrane = membrane_on(pattern);
    add("membrane", membrane);
    // The stable step is that of the stiffest state.
    add_blocks(MembraneEnergy(body_.shell, {stress_.warp.greatest_slope(), stress_.weft.greatest_slope(),
                                            stress_.shear.greatest_slope(), m.poisson}),
               3);
    // The limit has no stiffness at rest, so that the stable step does not know it.
    if (body_.own().stretch_limit) {
      const double limit = *body_.own().stretch_limit;
      const double strain = 0.5 * (limit * limit - 1);
      const double stiffness =
          stretch_limit_stiffness(std::max(stress_.warp.slope(strain), stress_.weft.slope(strain)),
                                  body_.statistics.mass, body_.shell.mean_edge, limit);
      add("stretch limit", std::make_shared<StretchLimitEnergy>(body_.shell, limit, stiffness, pattern));
    }
    const auto bending = bending_on(pattern, held);
    add_bending(bending, held);
    add_blocks(*bending, 2 * 4);  // blocks of half the stiffness that bounds it
    if (has_bending_friction(m)) add_bending_friction(*bending, held);
    if (m.stiffness_damping > 0)
      add_damping("stiffness damping", std::make_shared<ElementDamping>(membrane, m.stiffness_damping));
    if (m.bending_damping > 0)
      add_damping("bending damping", std::make_shared<ElementDamping>(bending, m.bending_damping));
    const std::vector<double> masses = body_.masses();
    if (m.mass_damping != 0)
      add_damping("mass damping", std::make_shared<MassDamping>(m.mass_damping, masses));
    body_.statistics.stable_step = stable_step(blocks_, masses);
  }

 private:
  std::shared_ptr<const ElementEnergy> membrane_on(std::shared_ptr<const SymmetricPattern> pattern) const {
    const ShellMaterial& m = material_;
    if (has_curves(m))
      return std::make_shared<MeasuredMembrane>(body_.shell, stress_, m.poisson, std::move(pattern),
                                                rigidity());
    return std::make_shared<MembraneEnergy>(
        body_.shell, MembraneModuli{m.membrane_warp, m.membrane_weft, m.membrane_shear, m.poisson},
        std::move(pattern), rigidity());
  }
  BucklingRigidity rigidity() const {
    if (body_.own().compression == Compression::elastic) return {};
    const SheetMoments moments = moments_of(material_);
    return {moments.warp.slope(0), moments.weft.slope(0)};
  }
  std::shared_ptr<const ShellBending> bending_on(std::shared_ptr<const SymmetricPattern> pattern,
                                                 std::span<const std::uint8_t> held) const {
    const ShellMaterial& m = material_;
    if (has_bending_curves(m)) {
      const SheetMoments moments = moments_of(m);
      return std::make_shared<ShellBending>(
          body_.shell, BendingCurves{moments.warp, moments.weft, m.bending_bias, m.poisson},
          std::move(pattern), held);
    }
    return std::make_shared<ShellBending>(body_.shell, plate(), std::move(pattern), held);
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
  void add_bending_friction(const ShellBending& bending, std::span<const std::uint8_t> held) {
    const ShellMaterial& m = material_;
    const BendingFrictionLimits limits{m.bending_friction_warp, m.bending_friction_weft,
                                       m.bending_friction_curvature};
    const auto friction =
        std::make_shared<BendingFriction>(body_.name, body_.shell, bending.angles(), limits, held);
    body_.loads.push_back({"bending friction", EnergyRole::elastic, friction});
    StepContext start;
    start.positions = body_.mesh.positions;
    add_blocks(*friction->potential(start), 2 * 4);
  }
  void add(const char* name, std::shared_ptr<const Potential> potential) {
    body_.potentials.push_back({name, EnergyRole::elastic, std::move(potential)});
  }
  void add_damping(const char* name, std::shared_ptr<const Load> load) {
    body_.loads.push_back({name, EnergyRole::dissipation, std::move(load)});
  }
  void add_blocks(const Potential& potential, double vertices_of_element) {
    std::vector<Mat3> blocks(body_.mesh.vertex_count(), Mat3::Zero());
    potential.add_diagonal_blocks(body_.mesh.positions, blocks);
    if (blocks_.empty()) blocks_.assign(blocks.size(), Mat3::Zero());
    for (std::size_t v = 0; v < blocks.size(); ++v) blocks_[v] += vertices_of_element * blocks[v];
  }

  ShellBody& body_;
  const ShellMaterial& material_;
  SheetStress stress_;
  std::vector<Mat3> blocks_;
};

}  // namespace

void ShellBody::add_terms(std::span<const std::uint8_t> held) {
  const schema::Variations& variations = material().variations;
  const std::vector<double> times = keyframe_times(variations);
  if (times.empty()) return ShellTerms(*this).add(held);
  pattern = block_pattern(shell);
  // The terms belong to this body and live as long as it does.
  add_changing_terms(*this,
                     {times, [&variations](double time) { return keyed_numbers(variations, time); },
                      [this, always_held = std::vector<std::uint8_t>(held.begin(), held.end())](double time) {
                        const auto at_time = std::make_shared<ShellBody>();
                        at_time->name = name;
                        at_time->mesh = mesh;
                        at_time->vertex_count = vertex_count;
                        at_time->statistics = statistics;
                        at_time->settings = settings;
                        at_time->settings.material.shell = material_at(material(), time);
                        at_time->shell = shell;
                        at_time->pattern = pattern;
                        ShellTerms(*at_time).add(always_held);
                        return at_time;
                      }});
}

}  // namespace muslin
