// Solids of Neo-Hookean tetrahedra in equilibrium, against closed forms, at three resolutions: bars pulled
// with free sides, simple shear, a bar that hangs under its weight.
#include <cmath>
#include <vector>

#include "support/lattice_box.hpp"
#include "support/potential_battery.hpp"
#include <Eigen/Cholesky>
#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "muslin/energy/neo_hookean_energy.hpp"

namespace muslin {
namespace {

constexpr SolidModuli rubber{2e5, 0.35};
const NeoHookeanLaw::Constants law = NeoHookeanLaw::constants(rubber.youngs_modulus, rubber.poisson);

/// A bar of 1 × `slender` × 1 (times 0.1 m), `across` voxels wide, some of whose coordinates are held.
class Bar {
 public:
  explicit Bar(int across, int slender) : lattice_(test::box_lattice({across, across * slender, across})) {
    lattice_.width = 0.1 / across;
    length = 0.1 * slender;
    energy_ = std::make_unique<NeoHookeanEnergy>(lattice_, rubber);
    for (std::size_t v = 0; v < lattice_.vertex_count(); ++v) rest.push_back(lattice_.rest_position(v));
    x = rest;
    loads.assign(x.size(), Vec3::Zero());
    held_.assign(x.size(), {false, false, false});
  }

  bool on(std::size_t v, int axis, double where) const { return std::abs(rest[v][axis] - where) < 1e-9; }
  void hold(std::size_t v, int axis, double value) {
    held_[v][static_cast<std::size_t>(axis)] = true;
    x[v][axis] = value;
  }
  /// Newton's method with the exact Hessian, or the projected one where that is not positive.
  void settle() {
    std::vector<Eigen::Index> index(3 * x.size(), -1);
    Eigen::Index n = 0;
    for (std::size_t i = 0; i < index.size(); ++i)
      if (!held_[i / 3][i % 3]) index[i] = n++;
    for (int iteration = 0; iteration < 60; ++iteration) {
      const Eigen::VectorXd g = residual(index, n);
      if (g.norm() < 1e-11 * rubber.youngs_modulus * 0.01) return;
      Eigen::MatrixXd h = hessian(Stiffness::exact, index, n);
      Eigen::LLT<Eigen::MatrixXd> llt(h);
      if (llt.info() != Eigen::Success) llt.compute(hessian(Stiffness::projected, index, n));
      const Eigen::VectorXd s = llt.solve(-g);
      for (std::size_t i = 0; i < index.size(); ++i)
        if (index[i] >= 0) x[i / 3][static_cast<Eigen::Index>(i % 3)] += s[index[i]];
    }
    ADD_FAILURE() << "no equilibrium";
  }
  /// The force that holds the vertices of a plane, along an axis.
  double reaction(int plane, double where, int along) const {
    double sum = 0;
    const std::vector<Vec3> g = test::gradient(*energy_, x);
    for (std::size_t v = 0; v < x.size(); ++v)
      if (on(v, plane, where)) sum += g[v][along];
    return sum;
  }
  double energy() const { return energy_->value(x); }
  const Lattice& lattice() const { return lattice_; }

  double length;
  std::vector<Vec3> rest, x, loads;

 private:
  Eigen::VectorXd residual(const std::vector<Eigen::Index>& index, Eigen::Index n) const {
    const std::vector<Vec3> g = test::gradient(*energy_, x);
    Eigen::VectorXd r(n);
    for (std::size_t i = 0; i < index.size(); ++i) {
      const auto axis = static_cast<Eigen::Index>(i % 3);
      if (index[i] >= 0) r[index[i]] = g[i / 3][axis] - loads[i / 3][axis];
    }
    return r;
  }
  Eigen::MatrixXd hessian(Stiffness kind, const std::vector<Eigen::Index>& index, Eigen::Index n) const {
    Eigen::MatrixXd h = Eigen::MatrixXd::Zero(n, n);
    for (std::size_t i = 0; i < index.size(); ++i) {
      if (index[i] < 0) continue;
      std::vector<Vec3> unit(x.size(), Vec3::Zero()), column = unit;
      unit[i / 3][static_cast<Eigen::Index>(i % 3)] = 1;
      energy_->add_stiffness_product(kind, x, unit, column);
      for (std::size_t j = 0; j < index.size(); ++j)
        if (index[j] >= 0) h(index[j], index[i]) = column[j / 3][static_cast<Eigen::Index>(j % 3)];
    }
    return h;
  }

  Lattice lattice_;
  std::unique_ptr<NeoHookeanEnergy> energy_;
  std::vector<std::array<bool, 3>> held_;
};

/// A bar pulled to `stretch` along y between plates on which it slides, on rollers at two sides.
Bar pulled(int across, double stretch) {
  Bar bar(across, 2);
  constexpr int pulls = 8;
  for (int pull = 1; pull <= pulls; ++pull) {
    for (std::size_t v = 0; v < bar.rest.size(); ++v) {
      for (const int axis : {0, 2})
        if (bar.on(v, axis, 0)) bar.hold(v, axis, 0);
      if (bar.on(v, 1, 0)) bar.hold(v, 1, 0);
      if (bar.on(v, 1, bar.length)) bar.hold(v, 1, (1 + (stretch - 1) * pull / pulls) * bar.length);
    }
    bar.settle();
  }
  return bar;
}

TEST(SolidBar, PulledWithFreeSidesHasYoungsModulusAndPoissonsRatio) {
  const double stretch = 1 + 1e-5;
  for (const int across : {1, 2, 4}) {
    const Bar bar = pulled(across, stretch);
    const double stress = bar.reaction(1, bar.length, 1) / 0.01;
    EXPECT_NEAR(stress / (stretch - 1) / rubber.youngs_modulus, 1, 1e-4) << across;
    const double across_strain = bar.x.back().x() / 0.1 - 1;
    EXPECT_NEAR(-across_strain / (stretch - 1), rubber.poisson, 1e-4) << across;
  }
}

TEST(SolidBar, LargeStretchFollowsTheCurveOfTheLaw) {
  // Free sides t: 2 a'(I_C) + f'(J) s = 0 with I_C = s² + 2 t² and J = s t²; the pull is 2 a' s + f' t².
  for (const int across : {1, 2}) {
    for (const double s : {0.5, 0.8, 1.5, 2.5}) {
      const Bar bar = pulled(across, s);
      const auto slack = [&](double t) {
        return NeoHookeanLaw::shear(law, s * s + 2 * t * t) + NeoHookeanLaw::slope(law, s * t * t) * s;
      };
      double low = 0.3, high = 2;  // grows with t
      for (int i = 0; i < 100; ++i) (slack((low + high) / 2) < 0 ? low : high) = (low + high) / 2;
      const double side = (low + high) / 2;
      const double pull = NeoHookeanLaw::shear(law, s * s + 2 * side * side) * s +
                          NeoHookeanLaw::slope(law, s * side * side) * side * side;
      EXPECT_NEAR(bar.reaction(1, bar.length, 1) / 0.01, pull, 1e-7 * rubber.youngs_modulus) << s;
      for (std::size_t v = 0; v < bar.x.size(); ++v)
        EXPECT_LE((bar.x[v] - Vec3(side, s, side).cwiseProduct(bar.rest[v])).norm(), 1e-8) << s;
    }
  }
}

TEST(SolidBar, SimpleShearHasTheShearModulus) {
  for (const int across : {2, 3, 4}) {
    for (const double shear : {1e-4, 0.5}) {
      Bar bar(across, 1);
      for (std::size_t v = 0; v < bar.rest.size(); ++v) {
        const bool border = (bar.rest[v].array() < 1e-9).any() || (bar.rest[v].array() > 0.1 - 1e-9).any();
        if (!border) continue;
        bar.hold(v, 0, bar.rest[v].x() + shear * bar.rest[v].y());
        for (const int axis : {1, 2}) bar.hold(v, axis, bar.rest[v][axis]);
      }
      bar.settle();
      // J = 1 and I_C = 3 + γ²: ½ G γ² for small γ, and the law's energy for all.
      const double density = bar.energy() / 1e-3;
      EXPECT_NEAR(density / NeoHookeanLaw::energy(law, 3 + shear * shear, 1), 1, 1e-6);
      const double modulus = rubber.youngs_modulus / (2 * (1 + rubber.poisson));
      if (shear < 0.01) {
        EXPECT_NEAR(density / (0.5 * modulus * shear * shear), 1, 1e-6);
      }
      for (std::size_t v = 0; v < bar.x.size(); ++v)
        EXPECT_LE((bar.x[v] - bar.rest[v] - Vec3(shear * bar.rest[v].y(), 0, 0)).norm(), 1e-10);
    }
  }
}

TEST(SolidBar, HangingBarHasTheClosedFormElongation) {
  // The middle of the lower end sinks by ρ g L²/(2E), where the upper end slides on its plate.
  const double weight_density = 200;  // ρ g [N/m³]: strains of 2e-4
  for (const int across : {1, 2, 3}) {
    Bar bar(across, 4);
    const double h = bar.lattice().width;
    for (const auto& corners : bar.lattice().voxel_vertices)
      for (const int v : corners)
        bar.loads[static_cast<std::size_t>(v)] -= weight_density * h * h * h / 8 * Vec3::UnitY();
    for (std::size_t v = 0; v < bar.rest.size(); ++v) {
      if (!bar.on(v, 1, bar.length)) continue;
      bar.hold(v, 1, bar.length);
      if (bar.on(v, 0, 0)) bar.hold(v, 0, 0);
      if (bar.on(v, 2, 0)) bar.hold(v, 2, 0);
    }
    bar.settle();
    double sunk = 0;
    int count = 0;
    for (std::size_t v = 0; v < bar.rest.size(); ++v)
      if (bar.on(v, 1, 0)) sunk -= bar.x[v].y(), ++count;
    const double exact = weight_density * bar.length * bar.length / (2 * rubber.youngs_modulus);
    const double error = std::abs(sunk / count / exact - 1);
    EXPECT_LT(error, across == 1 ? 0.01 : 0.002) << across;
  }
}

}  // namespace
}  // namespace muslin
