// Converts between the springs of a lattice and the elastic moduli of the solid it models.
//
// Every vertex of the lattice has a spring along each direction ±o, so a uniform strain moves all vertices
// uniformly and the solid's stiffness is the sum (Born and Huang 1954, §11)
//
//   C_ijkl = Σ over directions o of  m_o · o_i o_j o_k o_l / |o|²,
//
// m_o the spring's modulus (its constant over the voxel width). All moduli below hold for a large block with
// unstretched springs; docs/theory/lattice-moduli.md has closed forms, thin sheets, and limits.
#pragma once

#include <optional>

#include <Eigen/Core>

#include "muslin/core/vectors.hpp"
#include "muslin/lattice/springs.hpp"

namespace muslin {

/// A spring's constant is its modulus × voxel width [N/m²].
struct SpringModuli {
  double edge = 0;
  double face_diagonal = 0;
  double body_diagonal = 0;
};

/// Voigt's order xx, yy, zz, yz, xz, xy; shear strains are γ = 2ε.
using StiffnessMatrix = Eigen::Matrix<double, 6, 6>;

/// Returns C in σ = C ε of a block of lattice [N/m²]. Volume conservation adds its modulus to the bulk
/// modulus.
StiffnessMatrix lattice_stiffness(const SpringModuli& moduli, Bracing bracing, double volume_modulus = 0);

/// Moduli of a test specimen cut along the lattice's axes. The three axes are equivalent.
struct ElasticModuli {
  double youngs = 0;   ///< pulled along an axis [N/m²]
  double poisson = 0;  ///< contraction across over stretch along; 0 if nothing resists a pull
  double shear = 0;    ///< sheared in a plane of two axes [N/m²]
  double youngs_least = 0, youngs_greatest = 0;  ///< over all directions of pull [N/m²]
  double youngs_mean = 0;                        ///< of a polycrystal of such blocks (Hill 1952) [N/m²]
};
ElasticModuli elastic_moduli(const SpringModuli& moduli, Bracing bracing, double volume_modulus = 0);

/// Returns Young's modulus of a pull along the unit vector `direction` [N/m²].
double youngs_modulus(const StiffnessMatrix& stiffness, const Vec3& direction);

/// Returns the springs for which a block has this Young's and shear modulus along its axes [N/m²]; face and
/// body diagonals get the same modulus. Without a shear modulus it is 0.4 × Young's, which makes full bracing
/// isotropic with Poisson's ratio ¼; Poisson's ratio cannot be chosen independently (springs pull along their
/// length: C12 = C44, Cauchy's relation), except by a volume modulus. Errors: input, unless Young's modulus
/// is positive and the shear modulus ≥ 0 and below greatest_shear_ratio × Young's.
SpringModuli springs_for(double youngs, std::optional<double> shear, Bracing bracing);

/// Returns the bound below which springs_for can reach a ratio of shear to Young's modulus.
double greatest_shear_ratio(Bracing bracing);

}  // namespace muslin
