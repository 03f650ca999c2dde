#include "muslin/lattice/lattice_moduli.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/QR>
#include <fmt/format.h>

#include "muslin/core/error.hpp"

namespace muslin {

namespace {

using Vec6 = Eigen::Matrix<double, 6, 1>;

/// Returns the Voigt vector of the symmetric matrix u uᵀ, off-diagonal entries once.
Vec6 voigt_square(const Vec3& u) {
  Vec6 result;
  result << u.x() * u.x(), u.y() * u.y(), u.z() * u.z(), u.y() * u.z(), u.x() * u.z(), u.x() * u.y();
  return result;
}

/// The strain under a unit stress, 0 where the lattice does not resist at all.
struct Response {
  Vec6 strain = Vec6::Zero();
  double stiffness = 0;  ///< stress over its own strain [N/m²]
};

/// Computes strains for many stresses on one lattice, whose stiffness may be singular.
class Specimen {
 public:
  explicit Specimen(const StiffnessMatrix& stiffness) : stiffness_(stiffness), solver_(stiffness) {}

  Response under(const Vec6& stress) const {
    const Vec6 strain = solver_.solve(stress);
    if (!((stiffness_ * strain - stress).norm() <= 1e-9 * stress.norm())) return {};
    return {strain, 1 / stress.dot(strain)};
  }
  Response pulled(const Vec3& direction) const { return under(voigt_square(direction)); }
  Response sheared() const { return under(Vec6::Unit(3)); }

 private:
  StiffnessMatrix stiffness_;
  Eigen::CompleteOrthogonalDecomposition<StiffnessMatrix> solver_;
};

/// Computes Voigt's and Reuss's averages of bulk and shear modulus, then their mean (Hill).
double hill_youngs_modulus(const StiffnessMatrix& c) {
  const auto sums = [](const StiffnessMatrix& a) {
    return std::array{a(0, 0) + a(1, 1) + a(2, 2), a(0, 1) + a(1, 2) + a(0, 2), a(3, 3) + a(4, 4) + a(5, 5)};
  };
  const auto [axial, across, shear] = sums(c);
  double bulk = (axial + 2 * across) / 9;
  double rigidity = (axial - across + 3 * shear) / 15;
  const Eigen::FullPivHouseholderQR<StiffnessMatrix> solver(c);
  double bulk_reuss = 0;
  double rigidity_reuss = 0;
  if (solver.isInvertible()) {
    const auto [s_axial, s_across, s_shear] = sums(solver.inverse());
    bulk_reuss = 1 / (s_axial + 2 * s_across);
    rigidity_reuss = 15 / (4 * (s_axial - s_across) + 3 * s_shear);
  }
  bulk = 0.5 * (bulk + bulk_reuss);
  rigidity = 0.5 * (rigidity + rigidity_reuss);
  return bulk > 0 ? 9 * bulk * rigidity / (3 * bulk + rigidity) : 0;
}

/// Returns springs of edge modulus 1 − s and diagonals s: from no diagonals (s = 0) to diagonals only (s =
/// 1).
SpringModuli mixture(double s) { return {1 - s, s, s}; }

}  // namespace

StiffnessMatrix lattice_stiffness(const SpringModuli& moduli, Bracing bracing, double volume_modulus) {
  const std::array<double, 3> modulus = {moduli.edge, moduli.face_diagonal, moduli.body_diagonal};
  StiffnessMatrix stiffness = StiffnessMatrix::Zero();
  stiffness.topLeftCorner<3, 3>().setConstant(volume_modulus);
  for (const SpringDirection& direction : spring_directions(bracing)) {
    const Vec3 o = direction.offset.cast<double>();
    const Vec6 v = voigt_square(o);
    stiffness += modulus[static_cast<std::size_t>(direction.kind)] / o.squaredNorm() * v * v.transpose();
  }
  return stiffness;
}

double youngs_modulus(const StiffnessMatrix& stiffness, const Vec3& direction) {
  return Specimen(stiffness).pulled(direction).stiffness;
}

ElasticModuli elastic_moduli(const SpringModuli& moduli, Bracing bracing, double volume_modulus) {
  const StiffnessMatrix stiffness = lattice_stiffness(moduli, bracing, volume_modulus);
  const Specimen specimen(stiffness);
  const Response pull = specimen.pulled(Vec3::UnitX());
  ElasticModuli result;
  result.youngs = pull.stiffness;
  result.poisson = pull.stiffness > 0 ? -pull.strain[1] / pull.strain[0] : 0;
  result.shear = specimen.sheared().stiffness;
  result.youngs_mean = hill_youngs_modulus(stiffness);

  // The extremes of a smooth function on a half sphere, by a grid of 2° that contains the axes and the
  // diagonals of faces; those of the body are added.
  result.youngs_least = result.youngs_greatest = result.youngs;
  const auto visit = [&](const Vec3& direction) {
    const double e = specimen.pulled(direction.normalized()).stiffness;
    result.youngs_least = std::min(result.youngs_least, e);
    result.youngs_greatest = std::max(result.youngs_greatest, e);
  };
  constexpr int steps = 45;
  constexpr double angle = 3.14159265358979323846 / 2 / steps;
  for (int i = 0; i <= steps; ++i) {
    for (int j = 0; j < 4 * steps; ++j) {
      visit(Vec3(std::sin(i * angle) * std::cos(j * angle), std::sin(i * angle) * std::sin(j * angle),
                 std::cos(i * angle)));
    }
  }
  for (const Vec3& diagonal : {Vec3(1, 1, 1), Vec3(-1, 1, 1), Vec3(1, -1, 1), Vec3(1, 1, -1)})
    visit(diagonal);
  return result;
}

double greatest_shear_ratio(Bracing bracing) {
  // The limit of shear over Young's modulus as diagonals outgrow edges without bound. Full bracing: with
  // d the modulus of the diagonals, C11 = 10/3 d and C12 = C44 = 7/3 d, so E = C11 − 2 C12²/(C11+C12)
  // = 24/17 d and G = 7/3 d. Kuhn bracing: diagonals alone collapse; edges then carry both E and G, 3/2 each.
  return bracing == Bracing::full ? 119.0 / 72.0 : 1.0;
}

SpringModuli springs_for(double youngs, std::optional<double> shear, Bracing bracing) {
  if (!std::isfinite(youngs) || youngs <= 0) {
    throw Error(ErrorKind::input, fmt::format("a Young's modulus of {} N/m2", youngs),
                "give a positive number");
  }
  const double target = shear.value_or(0.4 * youngs) / youngs;
  const double greatest = greatest_shear_ratio(bracing);
  // Within a millionth of the limit the edges would be that much softer than the diagonals.
  if (!(target >= 0 && target <= (1 - 1e-6) * greatest)) {
    throw Error(ErrorKind::input,
                fmt::format("a shear modulus of {} N/m2 beside a Young's modulus of {} N/m2", *shear, youngs),
                fmt::format("springs reach 0 to {:.4g} N/m2 with {} bracing", greatest * youngs,
                            bracing == Bracing::full ? "full" : "kuhn"));
  }
  const auto axis = [&](const SpringModuli& moduli) {
    const Specimen specimen(lattice_stiffness(moduli, bracing));
    return std::array{specimen.pulled(Vec3::UnitX()).stiffness, specimen.sheared().stiffness};
  };
  // Shear over Young's modulus grows with the share of the diagonals: bisect.
  double low = 0;
  double high = 1;
  for (int i = 0; i < 100 && target > 0; ++i) {
    const double middle = 0.5 * (low + high);
    const auto [e, g] = axis(mixture(middle));
    (g < target * e ? low : high) = middle;
  }
  const SpringModuli unit = mixture(0.5 * (low + (target > 0 ? high : 0)));
  const double scale = youngs / axis(unit)[0];
  return {scale * unit.edge, scale * unit.face_diagonal, scale * unit.body_diagonal};
}

}  // namespace muslin
