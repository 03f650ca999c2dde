// Threads of a sheet resist compression only up to the load at which the cells of the mesh buckle.
//
// A mesh with edges h cannot show folds shorter than 2 h. Fabric of the rigidity D buckles into such folds
// under π² D/h² [N/m] (Euler), so that this is the largest compression the mesh has to carry. With C the
// moduli of the threads, e = (E_uu, E_vv) their strains, n the loads of both and w ≥ 0 the strains that folds
// take up, the energy of threads per area is the relaxed one (Pipkin, The relaxed energy density for
// isotropic elastic membranes, 1986, where n = 0),
//
//   ψ(e) = min_w  ½ (e + w)·C (e + w) + n·w,
//
// convex in e with continuous stresses s = C (e + w) ≥ −n. A share of the elastic energy is left beside it.
// As h → 0 the loads grow without bound, and the energy becomes the elastic one. docs/theory/shells.md.
#pragma once

#include <limits>
#include <numbers>

#include "muslin/core/vector_code.hpp"

namespace muslin {

/// Bending rigidities of a sheet [N·m] along its threads; infinite: its compression is elastic.
struct BucklingRigidity {
  double warp = std::numeric_limits<double>::infinity();
  double weft = std::numeric_limits<double>::infinity();
};

/// The constants of two families of threads of a triangle.
struct Threads {
  double c11, c12, c22;         ///< C: positive semidefinite [N/m]
  double load_warp, load_weft;  ///< n times the triangle's area [N·m]
};

/// Returns n times the area A of a triangle [N·m]. It is half of a square of edges h, h² = 2 A: n = π² D/(2
/// A).
inline double buckling_load(double rigidity) { return std::numbers::pi * std::numbers::pi / 2 * rigidity; }

/// The energy of two families of threads per area, and its derivatives by their strains e.
struct ThreadState {
  double twice_energy;   ///< 2 ψ [N/m]
  double uu, vv;         ///< ∂ψ/∂e [N/m]
  double c11, c12, c22;  ///< ∂²ψ/∂e² [N/m]
};

/// Share of the elastic energy that buckled threads keep, so that the stiffness stays positive.
constexpr double elastic_share = 0.005;

MUSLIN_INLINE ThreadState state_of(const Threads& t, double area, double e1, double e2) {
  const double n1 = t.load_warp / area, n2 = t.load_weft / area;
  // Elastic.
  const double s1 = t.c11 * e1 + t.c12 * e2, s2 = t.c12 * e1 + t.c22 * e2;
  const double twice = t.c11 * (e1 * e1) + 2 * t.c12 * (e1 * e2) + t.c22 * (e2 * e2);
  const bool low1 = s1 < -n1, low2 = s2 < -n2, buckled = low1 || low2;
  // The other family's strain and stress if only one buckles: (e + w) of the buckled one follows from s = −n.
  const double first = (-n1 - t.c12 * e2) / (t.c11 > 0 ? t.c11 : 1);
  const double second = (-n2 - t.c12 * e1) / (t.c22 > 0 ? t.c22 : 1);
  const double s2_beside = t.c12 * first + t.c22 * e2, s1_beside = t.c11 * e1 + t.c12 * second;
  const bool only1 = low1 && s2_beside >= -n2, only2 = !only1 && low2 && s1_beside >= -n1;
  const double determinant = t.c11 * t.c22 - t.c12 * t.c12, over = determinant > 0 ? determinant : 1;
  const double f1 = only1 ? first : only2 ? e1 : (t.c12 * n2 - t.c22 * n1) / over;
  const double f2 = only1 ? e2 : only2 ? second : (t.c12 * n1 - t.c11 * n2) / over;
  const double r1 = only2 ? s1_beside : -n1, r2 = only1 ? s2_beside : -n2;
  const double narrowed1 = t.c11 - t.c12 * t.c12 / (t.c22 > 0 ? t.c22 : 1);
  const double narrowed2 = t.c22 - t.c12 * t.c12 / (t.c11 > 0 ? t.c11 : 1);
  const double relaxed = (r1 * f1 + r2 * f2) + 2 * (n1 * (f1 - e1) + n2 * (f2 - e2));

  const auto mixed = [buckled](double soft, double elastic) {
    return buckled ? soft + elastic_share * (elastic - soft) : elastic;
  };
  return {mixed(relaxed, twice), mixed(r1, s1),
          mixed(r2, s2),         mixed(only2 ? narrowed1 : 0, t.c11),
          mixed(0, t.c12),       mixed(only1 ? narrowed2 : 0, t.c22)};
}

}  // namespace muslin
