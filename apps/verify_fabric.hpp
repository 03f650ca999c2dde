// Provides the meshes, bodies and tolerances of the cases that validate fabrics on any triangulation.
#pragma once

#include <functional>
#include <initializer_list>
#include <string>
#include <vector>

#include "verify_case.hpp"
#include "verify_experiment.hpp"

namespace muslin::app {

/// A triangulation of a strip and its resolution. `kind` is one of: right (squares cut along one diagonal),
/// crossed (along both), equilateral, delaunay (of points moved at random).
struct FabricMesh {
  std::string kind;
  int cells;  ///< along the strip

  /// The name of a quantity on this mesh, such as "crossed 40: energy".
  std::string label(const std::string& quantity) const;
  /// The relative accuracy of an element of second order: 1 % with 40 cells, 2 % on irregular meshes, times
  /// (40/cells)².
  double tolerance() const;
  /// A comparison by this tolerance, or by a share of it where the test is more accurate.
  Comparison compare(const std::string& quantity, double reference, double measured, double share = 1) const;
};

/// Four triangulations at each of these resolutions.
std::vector<FabricMesh> fabric_meshes(std::initializer_list<int> cells);

/// A sheet from x = 0 to 1 and y = 0 to `width` in the plane z = 0 [m], a file of an experiment. `clamped`
/// adds a row of cells before x = 0.
class FabricSheet {
 public:
  FabricSheet(const Experiment& experiment, const FabricMesh& mesh, double width, bool clamped);

  /// Mean position of the vertices that rest at these points [m].
  Vec3 mean(const Simulation& simulation, const std::vector<Vec3>& points) const;
  /// The number of a vertex that rests at this point.
  std::size_t vertex(const Vec3& point) const;

  Mesh mesh;
};

/// The strip of a FabricSheet, moved by `shape` of its points at rest; points that coincide become one.
Mesh bent_strip(const FabricMesh& of, double width, bool clamped,
                const std::function<Vec3(const Vec3&)>& shape);

/// A body "sheet.obj" of 0.2 kg/m² with warp along x. Isotropic: its bending rigidity [N m] and membrane
/// stiffness [N/m] belong to a sheet of this thickness [m]. More keys of the body may follow.
std::string fabric_body(double rigidity, double poisson, double thickness);

/// Pins the vertices of a box between two corners, in the plane z = 0 [m].
std::string fabric_pin(double x0, double y0, double x1, double y1, const std::string& keyframes = "");

/// A body of a sheet as above, made of a solid of this Young's modulus [Pa].
std::string shell_body(double youngs, double poisson, double thickness);

/// A force [N] on the vertex nearest to a point [m].
std::string point_force(const Vec3& at, const Vec3& force);

/// A probe of this name.
std::string probe(const std::string& name, const Vec3& at);

/// Static equilibrium by a few steps of this length [s]: long against the periods of the shell, and short
/// enough that loads do not carry it far where nothing but inertia or a rod resists.
std::string slow_steps(double step);

/// The tolerance of a mesh whose cells go around a circle, of which half counts, by symmetry.
double tolerance_around(const FabricMesh& of);

inline constexpr double fabric_density = 0.2;     ///< [kg/m²]
inline constexpr double fabric_width = 0.25;      ///< of strips, over their length
inline constexpr double fabric_thickness = 0.01;  ///< over their length: K L²/D = 1.2e5

}  // namespace muslin::app
