// Wind applies air drag and lift to the faces of a surface carried by the vertices.
//
// Per triangle with area A, unit normal n and velocity v of the air relative to it:
//
//   drag  ½ C_D ρ v² A |n·v̂| v̂              along the relative wind, on the projected area A |n·v̂|
//   lift  ½ C_L ρ v² A (n·v̂) (n − (n·v̂) v̂)  across it, in the plane of v and n
//
// n enters twice, so its sign does not matter. The lift direction is left unnormalised: the lift of a plate
// is proportional to sin α cos α and vanishes at normal incidence. A porous sheet has both times 1 −
// porosity.
//
// The force is semi-implicit: n, A, |n·v| and |v| are taken at the start of the step, v at its end. It is
// then −∂W/∂x of a convex quadratic, so any step length and any wind speed is stable. docs/theory/wind.md.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "muslin/force/field.hpp"
#include "muslin/force/keyed.hpp"
#include "muslin/lattice/embedding.hpp"
#include "muslin/potential/potential.hpp"

namespace muslin {

struct WindSettings {
  Keyed velocity{{{0, Vec3::Zero()}}};  ///< mean velocity of the air [m/s]
  Window window;                        ///< when it acts; outside there is no air resistance
  KeyedNumber air_density = 1.2;        ///< ρ [kg/m³] ≥ 0
  KeyedNumber drag = 1.17;              ///< C_D ≥ 0; 1.17: a square plate, broadside
  /// C_L, 0 … C_D at every key of the two, as more would pull a face against the wind; between keys C_D where
  /// it would exceed that.
  KeyedNumber lift = 0;
  /// true: an open sheet, each face counts, whichever side faces the wind. false: a closed solid with outward
  /// faces; only those that face the wind count, and C_D refers to the frontal area as in handbooks.
  bool two_sided = true;
  KeyedNumber gust = 0;    ///< root mean square of each component of the turbulence [m/s] ≥ 0
  double gust_length = 1;  ///< size of its largest eddies [m] > 0
  std::uint64_t seed = 1;  ///< decides the turbulence
  double porosity = 0;     ///< open share of the surface, 0 … 1
  std::vector<Field> fields;  ///< of velocities that add to the air [m/s]
};

class Wind : public Load {
 public:
  /// Blows on `triangles` (#T, indices of the embedding's points) carried by `vertex_count` vertices.
  /// Errors: usage, if a setting is out of its range or not finite.
  Wind(WindSettings settings, Embedding skin, std::vector<Vec3i> triangles, std::size_t vertex_count);
  std::unique_ptr<Potential> potential(const StepContext& step) const override;

  struct Faces;

 private:
  WindSettings settings_;
  std::shared_ptr<const Faces> faces_;
};

}  // namespace muslin
