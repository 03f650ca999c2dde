#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>

#include "muslin/energy/affine_body.hpp"
#include "muslin/energy/hinge_bending.hpp"
#include "muslin/energy/membrane_energy.hpp"
#include "muslin/energy/neo_hookean_energy.hpp"
#include "muslin/energy/spring_damping.hpp"
#include "muslin/energy/spring_energy.hpp"
#include "muslin/energy/stretch_limit.hpp"
#include "muslin/energy/volume_energy.hpp"
#include "muslin/potential/mass_damping.hpp"
#include "muslin/potential/restricted.hpp"
#include "muslin/potential/stopping_time.hpp"
#include "muslin/scene/build_body.hpp"
#include "muslin/scene/build_loads.hpp"

namespace muslin {
namespace {

/// The largest eigenvalue of blocks[v] / masses[v] over all vertices [1/s²].
double largest_ratio(const std::vector<Mat3>& blocks, std::span<const double> masses) {
  double largest = 0;
  for (std::size_t v = 0; v < blocks.size(); ++v) {
    Eigen::SelfAdjointEigenSolver<Mat3> solver;
    solver.computeDirect(blocks[v], Eigen::EigenvaluesOnly);
    largest = std::max(largest, solver.eigenvalues().maxCoeff() / masses[v]);
  }
  return largest;
}

/// Elastic and damping terms of one body, in the vertices of the model.
class BodyMaterial {
 public:
  BodyMaterial(Model& model, std::size_t index)
      : model_(model), body_(model.bodies[index]), settings_(model.scene.bodies[index]) {}

  void build() {
    if (body_.is_shell()) {
      build_shell_energies();
    } else {
      build_lattice_energies();
    }
    const double ratio = stiffness_.empty() ? 0 : largest_ratio(stiffness_, body_masses());
    body_.statistics.stable_step = ratio > 0 ? 2 / std::sqrt(ratio) : std::numeric_limits<double>::infinity();
  }

 private:
  void build_lattice_energies() {
    const Material& material = settings_.material;
    const std::array moduli = {material.edge_modulus, material.face_diagonal_modulus,
                               material.body_diagonal_modulus};
    // A solid needs no springs.
    if (material.young_modulus == 0 || *std::max_element(moduli.begin(), moduli.end()) > 0) {
      const auto springs = std::make_shared<SpringEnergy>(body_.springs, body_.lattice.width, moduli,
                                                          spring_weights(body_, settings_));
      add("springs", springs);
      add_stiffness(*springs, 2);
      if (material.stiffness_damping > 0)
        add("stiffness damping", std::make_shared<SpringDamping>(springs, material.stiffness_damping));
    }
    if (material.volume_modulus > 0) {
      const auto volume = std::make_shared<VolumeEnergy>(with_shares(), material.volume_modulus);
      add("volume", volume);
      add_stiffness(*volume, 4);
    }
    if (material.young_modulus > 0) {
      const auto solid = std::make_shared<NeoHookeanEnergy>(
          with_shares(), SolidModuli{material.young_modulus, material.poisson},
          tetrahedron_pattern(body_.lattice));
      add("solid", solid);
      add_stiffness(*solid, 4);
      if (material.stiffness_damping > 0)
        add("solid damping", std::make_shared<ElementDamping>(solid, material.stiffness_damping));
    }
    add_mass_damping(material.mass_damping);
  }

  void build_shell_energies() {
    const ShellMaterial& m = *settings_.material.shell;
    const auto pattern = block_pattern(body_.shell);
    const auto membrane = std::make_shared<MembraneEnergy>(
        body_.shell, MembraneModuli{m.membrane_warp, m.membrane_weft, m.membrane_shear, m.poisson}, pattern);
    add("membrane", membrane);
    add_stiffness(*membrane, 3);
    if (settings_.stretch_limit) add_stretch_limit(*settings_.stretch_limit, pattern);
    const auto bending = std::make_shared<HingeBending>(
        body_.shell, BendingModuli{m.bending_warp, m.bending_weft, m.bending_bias}, pattern);
    add("bending", bending);
    add_stiffness(*bending, 4);
    if (m.stiffness_damping > 0)
      add("stiffness damping", std::make_shared<ElementDamping>(membrane, m.stiffness_damping));
    if (m.bending_damping > 0)
      add("bending damping", std::make_shared<ElementDamping>(bending, m.bending_damping));
    add_mass_damping(m.mass_damping);
  }

  /// Without stiffness at rest, so that the stable step does not know it.
  void add_stretch_limit(double limit, const std::shared_ptr<const SymmetricPattern>& pattern) {
    const ShellMaterial& m = *settings_.material.shell;
    const double stiffness = stretch_limit_stiffness(std::max(m.membrane_warp, m.membrane_weft),
                                                     body_.statistics.mass, body_.shell.mean_edge, limit);
    add("stretch limit", std::make_shared<StretchLimitEnergy>(body_.shell, limit, stiffness, pattern));
  }

  void add_mass_damping(double alpha) {
    if (alpha == 0) return;
    const auto masses = body_masses();
    add("mass damping",
        std::make_shared<MassDamping>(alpha, std::vector<double>(masses.begin(), masses.end())));
  }

  std::span<const double> body_masses() const { return std::span(model_.masses).subspan(first(), count()); }
  std::size_t first() const { return static_cast<std::size_t>(body_.first_vertex); }
  std::size_t count() const { return static_cast<std::size_t>(body_.vertex_count); }
  bool alone() const { return count() == model_.vertex_count(); }

  Lattice with_shares() const {
    Lattice lattice = body_.lattice;
    lattice.fill = voxel_shares(body_, settings_);
    return lattice;
  }

  void add(const std::string& name, std::shared_ptr<const Potential> potential) {
    if (!alone()) potential = std::make_shared<RestrictedPotential>(potential, first(), count());
    model_.potentials.push_back({body_.name + ": " + name, EnergyRole::elastic, std::move(potential)});
  }
  void add(const std::string& name, std::shared_ptr<const Load> load) {
    if (!alone()) load = std::make_shared<RestrictedLoad>(load, first(), count());
    model_.loads.push_back({body_.name + ": " + name, EnergyRole::dissipation, std::move(load)});
  }

  /// An element over n vertices stores ½ k (Σ aᵢ·dᵢ)² ≤ ½ k n Σ (aᵢ·dᵢ)²: its Hessian is at most n times
  /// its diagonal blocks. So ω² ≤ n λ(block)/m, and symplectic Euler is stable below 2/ω.
  void add_stiffness(const Potential& potential, double vertices_of_element) {
    std::vector<Mat3> blocks(count(), Mat3::Zero());
    const ConstVectors rest = ConstVectors(model_.rest_positions).subspan(first(), count());
    potential.add_diagonal_blocks(rest, blocks);
    if (stiffness_.empty()) stiffness_.assign(count(), Mat3::Zero());
    for (std::size_t v = 0; v < blocks.size(); ++v) stiffness_[v] += vertices_of_element * blocks[v];
  }

  Model& model_;
  Body& body_;
  const BodySettings& settings_;
  std::vector<Mat3> stiffness_;
};

/// In units of mass/stopping_time²: a body that is accelerated by g through a point of its surface is dented
/// there by about 5 g stopping_time²/1000, 1 µm. The same in steps of any length: stiffness that grew while a
/// body is dented would add energy.
constexpr double rigidity = 1000;

void add_rigidity(Model& model, const Body& body) {
  const double stiffness = rigidity * body.statistics.mass / (stopping_time * stopping_time);
  model.potentials.push_back({body.name + ": rigidity", EnergyRole::elastic,
                              std::make_shared<RestrictedPotential>(
                                  std::make_shared<AffineBodyEnergy>(body.frame.radii, stiffness),
                                  static_cast<std::size_t>(body.first_vertex),
                                  static_cast<std::size_t>(body.vertex_count))});
}

}  // namespace

void build_materials(Model& model) {
  for (std::size_t b = 0; b < model.scene.bodies.size(); ++b) BodyMaterial(model, b).build();
  for (const Body& body : model.bodies)
    if (body.is_rigid() && !body.prescribed) add_rigidity(model, body);
}

}  // namespace muslin
