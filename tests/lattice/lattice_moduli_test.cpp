// The moduli computed from spring directions are those that a block of actual springs shows when it is
// loaded: each test below builds the springs one by one, solves for equilibrium, and measures.
#include "muslin/lattice/lattice_moduli.hpp"

#include <cmath>
#include <functional>

#include "support/potential_battery.hpp"
#include <gtest/gtest.h>

#include "muslin/core/error.hpp"

namespace muslin {
namespace {

enum class Border {
  full,      ///< springs on the surface count in full
  shared,    ///< every voxel brings its share of the springs on its border, as inside a large body
  periodic,  ///< there is no surface: the block repeats itself
};

/// A block of n voxels of width 1 with springs of given moduli.
class Block {
 public:
  Block(const Vec3i& n, const SpringModuli& moduli, Bracing bracing, Border border)
      : n_(n), size_(border == Border::periodic ? n : Vec3i(n + Vec3i::Ones())) {
    const double modulus[3] = {moduli.edge, moduli.face_diagonal, moduli.body_diagonal};
    for (const SpringDirection& d : spring_directions(bracing)) {
      for (int i = 0; i < size_.x(); ++i) {
        for (int j = 0; j < size_.y(); ++j) {
          for (int k = 0; k < size_.z(); ++k) {
            const Vec3i a(i, j, k);
            Vec3i b = a + d.offset;
            for (int axis = 0; axis < 3 && border == Border::periodic; ++axis)
              b[axis] = (b[axis] + n[axis]) % n[axis];
            if ((b.array() < 0).any() || (b.array() >= size_.array()).any()) continue;
            double share = 1;
            for (int axis = 0; axis < 3; ++axis) {
              if (border == Border::shared && d.offset[axis] == 0 && (a[axis] == 0 || a[axis] == n[axis]))
                share /= 2;
            }
            const Vec3 o = d.offset.cast<double>();
            springs_.push_back(
                {index(a), index(b), o, o.normalized(), share * modulus[static_cast<std::size_t>(d.kind)]});
          }
        }
      }
    }
  }

  std::size_t size() const { return static_cast<std::size_t>(size_.prod()); }
  std::size_t index(const Vec3i& p) const {
    return static_cast<std::size_t>(p.x() + size_.x() * (p.y() + size_.y() * p.z()));
  }
  void for_each(const std::function<void(const Vec3i&, std::size_t)>& f) const {
    for (int k = 0; k < size_.z(); ++k)
      for (int j = 0; j < size_.y(); ++j)
        for (int i = 0; i < size_.x(); ++i) f(Vec3i(i, j, k), index(Vec3i(i, j, k)));
  }

  /// Displacements in equilibrium: free[v][c] = 0 keeps u[v][c] as given. Conjugate gradients.
  std::vector<Vec3> solve(std::vector<Vec3> u, const std::vector<Vec3>& force,
                          const std::vector<Vec3>& free) const {
    std::vector<Vec3> r = product(u);
    for (std::size_t v = 0; v < size(); ++v) r[v] = (force[v] - r[v]).cwiseProduct(free[v]);
    std::vector<Vec3> p = r;
    double rr = dot(r, r);
    const double target = 1e-20 * (rr + 1e-300);
    for (int i = 0; i < 5000 && rr > target; ++i) {
      std::vector<Vec3> kp = product(p);
      for (std::size_t v = 0; v < size(); ++v) kp[v] = kp[v].cwiseProduct(free[v]);
      const double alpha = rr / dot(p, kp);
      for (std::size_t v = 0; v < size(); ++v) u[v] += alpha * p[v], r[v] -= alpha * kp[v];
      const double next = dot(r, r);
      for (std::size_t v = 0; v < size(); ++v) p[v] = r[v] + next / rr * p[v];
      rr = next;
    }
    EXPECT_LE(rr, target) << "conjugate gradients did not converge";
    return u;
  }

  double energy(const std::vector<Vec3>& u) const { return 0.5 * dot(u, product(u)); }

  /// The mean strain of the block under an even stress on its surface, all else free.
  Mat3 strain_under(const Mat3& stress) const {
    std::vector<Vec3> force(size(), Vec3::Zero());
    for_each([&](const Vec3i& p, std::size_t v) {
      for (int axis = 0; axis < 3; ++axis) {
        if (p[axis] != 0 && p[axis] != n_[axis]) continue;
        double area = 1;
        for (int other = 0; other < 3; ++other)
          if (other != axis && (p[other] == 0 || p[other] == n_[other])) area /= 2;
        force[v] += (p[axis] == 0 ? -area : area) * stress.col(axis);
      }
    });
    const std::vector<Vec3> u =
        solve(std::vector<Vec3>(size(), Vec3::Zero()), force, std::vector<Vec3>(size(), Vec3::Ones()));
    // Least squares fit of u = G x over the block, centred.
    Mat3 ux = Mat3::Zero();
    Mat3 xx = Mat3::Zero();
    for_each([&](const Vec3i& p, std::size_t v) {
      const Vec3 x = p.cast<double>() - 0.5 * n_.cast<double>();
      ux += u[v] * x.transpose();
      xx += x * x.transpose();
    });
    const Mat3 g = ux * xx.inverse();
    return 0.5 * (g + g.transpose());
  }

  /// The mean stress of the periodic block under a mean strain, once the vertices have found equilibrium.
  Mat3 stress_under(const Mat3& strain) const {
    std::vector<Vec3> force(size(), Vec3::Zero());
    for (const Spring& s : springs_) {
      const Vec3 f = s.constant * s.direction.dot(strain * s.offset) * s.direction;
      force[s.a] += f;
      force[s.b] -= f;
    }
    const std::vector<Vec3> u =
        solve(test::random_vectors(size(), 0.1, 1), force, std::vector<Vec3>(size(), Vec3::Ones()));
    Mat3 stress = Mat3::Zero();
    for (const Spring& s : springs_) {
      const double stretch = s.direction.dot(strain * s.offset + u[s.b] - u[s.a]);
      stress += s.constant * stretch * s.direction * s.offset.transpose();
    }
    return stress / n_.prod();
  }

 private:
  struct Spring {
    std::size_t a, b;
    Vec3 offset, direction;
    double constant;
  };
  std::vector<Vec3> product(const std::vector<Vec3>& u) const {
    std::vector<Vec3> y(u.size(), Vec3::Zero());
    for (const Spring& s : springs_) {
      const Vec3 f = s.constant * s.direction.dot(u[s.b] - u[s.a]) * s.direction;
      y[s.a] -= f;
      y[s.b] += f;
    }
    return y;
  }
  static double dot(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    double sum = 0;
    for (std::size_t v = 0; v < a.size(); ++v) sum += a[v].dot(b[v]);
    return sum;
  }

  Vec3i n_;
  Vec3i size_;  ///< vertices along x, y, z
  std::vector<Spring> springs_;
};

struct Case {
  SpringModuli moduli;
  Bracing bracing;
};
const std::vector<Case> cases = {
    {{20000, 100, 100}, Bracing::kuhn}, {{20000, 100, 100}, Bracing::full}, {{1, 1, 0}, Bracing::full},
    {{1, 0, 0.375}, Bracing::full},     {{3, 1, 2}, Bracing::full},         {{3, 1, 2}, Bracing::kuhn},
    {{1, 0.4, 0.1}, Bracing::kuhn},
};

TEST(LatticeModuli, AgreeWithAPulledBlockOfSprings) {
  for (const Case& c : cases) {
    const ElasticModuli moduli = elastic_moduli(c.moduli, c.bracing);
    const Block block(Vec3i(4, 3, 3), c.moduli, c.bracing, Border::shared);
    // Kuhn bracing shears when pulled, and then the edges of so small a block give a little.
    const double tolerance = c.bracing == Bracing::full ? 1e-6 : 5e-3;
    for (int axis = 0; axis < 3; ++axis) {
      const int next = (axis + 1) % 3;
      Mat3 stress = Mat3::Zero();
      stress(axis, axis) = 1;
      const Mat3 pulled = block.strain_under(stress);
      EXPECT_NEAR(1 / pulled(axis, axis) / moduli.youngs, 1, tolerance);
      EXPECT_NEAR(-pulled(next, next) / pulled(axis, axis), moduli.poisson, tolerance);
    }
  }
}

TEST(LatticeModuli, AgreeWithAStrainedPeriodicBlockOfSprings) {
  const int voigt[6][2] = {{0, 0}, {1, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}};
  for (const Case& c : cases) {
    const Block block(Vec3i(3, 4, 3), c.moduli, c.bracing, Border::periodic);
    StiffnessMatrix measured;
    for (int column = 0; column < 6; ++column) {
      Mat3 strain = Mat3::Zero();  // ε = ½ on both sides of the diagonal: γ = 1
      strain(voigt[column][0], voigt[column][1]) += 0.5;
      strain(voigt[column][1], voigt[column][0]) += 0.5;
      const Mat3 stress = block.stress_under(strain);
      for (int row = 0; row < 6; ++row) measured(row, column) = stress(voigt[row][0], voigt[row][1]);
    }
    EXPECT_LT((measured - lattice_stiffness(c.moduli, c.bracing)).norm(), 1e-6 * measured.norm());
    const StiffnessMatrix compliance = measured.inverse();
    EXPECT_NEAR(1 / compliance(3, 3) / elastic_moduli(c.moduli, c.bracing).shear, 1, 1e-5);
    const Vec3 d = Vec3(1, 2, -2) / 3;
    Eigen::Matrix<double, 6, 1> pull;
    for (int i = 0; i < 6; ++i) pull[i] = d[voigt[i][0]] * d[voigt[i][1]];
    EXPECT_NEAR(pull.dot(compliance * pull) * youngs_modulus(measured, d), 1, 1e-5);
  }
}

TEST(LatticeModuli, FullBracingHasTheClosedForms) {
  const double k1 = 3, k2 = 0.7, k3 = 1.9;
  const StiffnessMatrix c = lattice_stiffness({k1, k2, k3}, Bracing::full);
  const double c11 = k1 + 2 * k2 + 4 * k3 / 3;
  const double c12 = k2 + 4 * k3 / 3;
  StiffnessMatrix expected = StiffnessMatrix::Zero();
  expected.topLeftCorner<3, 3>().setConstant(c12);
  expected.diagonal() << c11, c11, c11, c12, c12, c12;
  EXPECT_LT((c - expected).norm(), 1e-14);
  const ElasticModuli moduli = elastic_moduli({k1, k2, k3}, Bracing::full);
  EXPECT_NEAR(moduli.youngs, c11 - 2 * c12 * c12 / (c11 + c12), 1e-12);
  EXPECT_NEAR(moduli.poisson, c12 / (c11 + c12), 1e-12);
  EXPECT_NEAR(moduli.shear, c12, 1e-12);
}

TEST(LatticeModuli, KuhnBracingHasTheClosedForms) {
  const double k1 = 3, k2 = 0.7, k3 = 1.9;
  const double a = k2 / 2 + k3 / 3, b = k3 / 3;
  StiffnessMatrix expected;
  expected << k1 + 2 * a - b, a, a, b, a, a,  //
      a, k1 + 2 * a - b, a, a, b, a,          //
      a, a, k1 + 2 * a - b, a, a, b,          //
      b, a, a, a, b, b,                       //
      a, b, a, b, a, b,                       //
      a, a, b, b, b, a;
  EXPECT_LT((lattice_stiffness({k1, k2, k3}, Bracing::kuhn) - expected).norm(), 1e-14);
}

TEST(LatticeModuli, IsotropicExactlyWhenEdgesBalanceDiagonals) {
  const ElasticModuli even = elastic_moduli({0.7 + 8 * 0.3 / 3, 0.7, 0.3}, Bracing::full);
  EXPECT_NEAR(even.poisson, 0.25, 1e-12);
  EXPECT_NEAR(even.youngs, 2.5 * even.shear, 1e-12);
  EXPECT_NEAR(even.youngs_greatest / even.youngs_least, 1, 1e-12);
  EXPECT_NEAR(even.youngs_mean / even.youngs, 1, 1e-12);
  const ElasticModuli flag = elastic_moduli({20000, 100, 100}, Bracing::full);
  EXPECT_GT(flag.youngs_greatest / flag.youngs_least, 20);
}

TEST(LatticeModuli, VolumeConservationRaisesTheBulkModulusOnly) {
  const SpringModuli springs = springs_for(1000, std::nullopt, Bracing::full);  // G = 400, K = 2000/3
  const ElasticModuli moduli = elastic_moduli(springs, Bracing::full, 5000);
  const double bulk = 2000.0 / 3 + 5000;
  EXPECT_NEAR(moduli.shear, 400, 1e-6);
  EXPECT_NEAR(moduli.youngs, 9 * bulk * 400 / (3 * bulk + 400), 1e-6);
  EXPECT_NEAR(moduli.poisson, (3 * bulk - 800) / (6 * bulk + 800), 1e-9);
}

TEST(LatticeModuli, EdgesResistTensionButNotShear) {
  for (const Bracing bracing : {Bracing::kuhn, Bracing::full}) {
    const ElasticModuli moduli = elastic_moduli({5, 0, 0}, bracing);
    EXPECT_NEAR(moduli.youngs, 5, 1e-12);
    EXPECT_EQ(moduli.shear, 0);
    EXPECT_EQ(moduli.youngs_least, 0);
    EXPECT_NEAR(moduli.poisson, 0, 1e-12);
  }
}

TEST(LatticeModuli, SpringsForReachesTheRequestedModuli) {
  for (const Bracing bracing : {Bracing::kuhn, Bracing::full}) {
    for (const double youngs : {1.0, 2e11}) {
      for (const double ratio : {0.0, 1e-4, 0.05, 0.4, 0.9}) {
        const SpringModuli springs = springs_for(youngs, ratio * youngs, bracing);
        const ElasticModuli moduli = elastic_moduli(springs, bracing);
        EXPECT_NEAR(moduli.youngs / youngs, 1, 1e-9);
        EXPECT_NEAR(moduli.shear / youngs, ratio, 1e-9);
        EXPECT_GE(springs.edge, 0);
        EXPECT_GE(springs.face_diagonal, 0);
        EXPECT_EQ(springs.face_diagonal, springs.body_diagonal);
      }
    }
  }
  const SpringModuli isotropic = springs_for(1000, std::nullopt, Bracing::full);
  EXPECT_NEAR(isotropic.edge, isotropic.face_diagonal + 8 * isotropic.body_diagonal / 3, 1e-9);
}

TEST(LatticeModuli, SpringsForRejectsUnreachableModuli) {
  const auto message = [](double youngs, std::optional<double> shear, Bracing bracing) -> std::string {
    try {
      springs_for(youngs, shear, bracing);
    } catch (const Error& e) {
      EXPECT_EQ(e.kind(), ErrorKind::input);
      return e.what();
    }
    return "accepted";
  };
  EXPECT_NE(message(1000, 1000, Bracing::kuhn).find("0 to 1000 N/m2 with kuhn"), std::string::npos);
  EXPECT_NE(message(1000, 1700, Bracing::full).find("0 to 1653 N/m2 with full"), std::string::npos);
  EXPECT_NE(message(1000, -1, Bracing::full).find("-1 N/m2"), std::string::npos);
  for (const double bad : {0.0, -5.0, std::nan(""), static_cast<double>(INFINITY)})
    EXPECT_NE(message(bad, std::nullopt, Bracing::full).find("positive"), std::string::npos);
  EXPECT_NE(message(1, std::nan(""), Bracing::full).find("shear modulus of nan"), std::string::npos);
}

TEST(ThinSheets, BoundarySpringsCountedInFullAreTooStiffInStretch) {
  const SpringModuli springs{1, 1, 0};  // isotropic
  const double youngs = elastic_moduli(springs, Bracing::full).youngs;
  const auto stretch = [&](Border border) {
    // A wide sheet one voxel thick, held across (plane strain), pulled along x by its ends.
    const Vec3i n(4, 4, 1);
    const Block block(n, springs, Bracing::full, border);
    std::vector<Vec3> u(block.size(), Vec3::Zero()), free(block.size(), Vec3(0, 0, 1));
    block.for_each([&](const Vec3i& p, std::size_t v) { u[v].x() = p.x(); });
    const double energy = block.energy(block.solve(u, std::vector<Vec3>(block.size(), Vec3::Zero()), free));
    return energy / (0.5 * n.prod());
  };
  const double sheet = youngs / (1 - 0.25 * 0.25);
  EXPECT_NEAR(stretch(Border::shared) / sheet, 1, 1e-6);
  // 1.75 for an endless sheet; the outer edges of this one count twice as well.
  EXPECT_GT(stretch(Border::full) / sheet, 1.7);
}

TEST(ThinSheets, BendingOfSharedLayersApproachesThePlate) {
  const SpringModuli springs{1, 1, 0};  // isotropic
  const double youngs = elastic_moduli(springs, Bracing::full).youngs;
  for (const int layers : {1, 2, 4}) {
    // Ends turned about y by ±angle/2, held across (plane strain): a plate bent evenly to curvature
    // angle / length.
    const Vec3i n(6, 1, layers);
    const Block block(n, springs, Bracing::full, Border::shared);
    std::vector<Vec3> u(block.size(), Vec3::Zero()), free(block.size(), Vec3(1, 0, 1));
    block.for_each([&](const Vec3i& p, std::size_t v) {
      const double z = p.z() - 0.5 * layers;
      const double x = p.x() - 0.5 * n.x();
      u[v] = Vec3(-x * z, 0, 0.5 * x * x);
      if (p.x() == 0 || p.x() == n.x()) free[v].x() = 0;
      if (p.x() == 0 && p.z() == 0) free[v].z() = 0;
    });
    const double energy = block.energy(block.solve(u, std::vector<Vec3>(block.size(), Vec3::Zero()), free));
    const double rigidity = energy / (0.5 * n.x() * n.y());
    const double plate = youngs * std::pow(layers, 3) / (12 * (1 - 0.25 * 0.25));
    EXPECT_NEAR(rigidity / plate, 1 + 5 / (4.0 * layers * layers), 0.02) << layers;
  }
}

}  // namespace
}  // namespace muslin
