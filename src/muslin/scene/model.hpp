// Model holds all data that is constant during a run: bodies with their lattices or shells, masses,
// potentials, loads, pins, probes. Built once from a Scene; shared read-only by the simulation and its
// writers.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "muslin/api.hpp"
#include "muslin/constraint/pin.hpp"
#include "muslin/constraint/prescribed.hpp"
#include "muslin/core/progress.hpp"
#include "muslin/geometry/affine_frame.hpp"
#include "muslin/geometry/inspect.hpp"
#include "muslin/geometry/mesh.hpp"
#include "muslin/lattice/embedding.hpp"
#include "muslin/lattice/lattice.hpp"
#include "muslin/lattice/springs.hpp"
#include "muslin/potential/potential.hpp"
#include "muslin/scene/scene.hpp"
#include "muslin/shell/shell.hpp"
#include "muslin/surface/contour.hpp"

namespace muslin {

struct ContactModel;

struct BodyStatistics {
  std::int64_t vertices = 0, voxels = 0, tetrahedra = 0;
  std::array<std::int64_t, 3> springs{};   ///< by SpringKind: edge, face diagonal, body diagonal
  double mass = 0;                         ///< [kg]
  double coverage = 1;                     ///< share of the mesh's area inside kept voxels
  double contour_distance = 0;             ///< largest distance of the rest contour from the solid [m]
  std::int64_t triangles = 0, hinges = 0;  ///< of a shell
  double stable_step = 0;  ///< largest stable step of symplectic_euler at rest [s]; infinity without springs
};

/// A body of any model. Only a lattice has solid, lattice, springs and contour. The vertices of a shell or a
/// sequence are those of the mesh, in the same order, and so is its skin; those of a rigid body are the four
/// corners of its frame.
struct Body {
  std::string name;
  BodyModel model = BodyModel::lattice;
  Mesh mesh;  ///< the user's mesh, placed in the world; the skin's polygons, UVs and rest positions
  Mesh
      solid;  ///< a solid filled with voxels: the mesh itself, faces outward, or the sheet with its thickness
  MeshReport report;  ///< of mesh
  bool sheet =
      false;  ///< thin: a shell, or a mesh that is open or encloses nothing and was given a thickness
  double thickness = 0;  ///< of a sheet of voxels [m]
  Lattice lattice;
  Springs springs;
  Shell shell;
  AffineFrame frame;        ///< of a rigid body, at the start
  bool prescribed = false;  ///< kinematic: prescribed motion, no mass
  double mean_edge = 0;     ///< of a collider's mesh [m]
  Embedding skin;           ///< of mesh.positions
  Contour contour;
  int first_vertex =
      0;  ///< the body's vertices are first_vertex … first_vertex + vertex_count − 1 of the state
  int vertex_count = 0;
  BodyStatistics statistics;

  bool has_lattice() const { return model == BodyModel::lattice; }
  bool is_shell() const { return model == BodyModel::shell; }
  bool is_rigid() const { return model == BodyModel::rigid; }
  bool is_soft() const { return has_lattice() || is_shell(); }
  /// Returns the start position of the vertex, counted within the body [m].
  Vec3 rest_position(std::size_t v) const {
    return has_lattice() ? lattice.rest_position(v) : is_rigid() ? frame.corners()[v] : mesh.positions[v];
  }
  /// Returns the typical distance of neighbouring vertices: the voxel width, or the mean edge of the mesh
  /// [m].
  double spacing() const { return has_lattice() ? lattice.width : is_shell() ? shell.mean_edge : mean_edge; }
};

/// Role of a potential in the energy balance.
enum class EnergyRole {
  elastic,      ///< stored in the material
  potential,    ///< stored in a fixed field (gravity)
  work,         ///< done on the bodies from outside (point forces, wind)
  dissipation,  ///< lost (damping)
};

struct PotentialTerm {
  std::string name;
  EnergyRole role = EnergyRole::elastic;
  std::shared_ptr<const Potential> potential;  ///< over all vertices of the model
};
struct LoadTerm {
  std::string name;
  EnergyRole role = EnergyRole::work;
  std::shared_ptr<const Load> load;  ///< over all vertices of the model
};

struct Probe {
  std::string name;
  int body = 0;
  Embedding point;  ///< one point, indices local to the body
};

struct MUSLIN_API Model {
  Scene scene;
  std::vector<Body> bodies;          ///< those of the scene in its order, then its colliders in theirs
  std::vector<Vec3> rest_positions;  ///< #V by 3, all bodies one after the other, at the start [m]
  std::vector<Vec3> velocities;      ///< #V by 3, at the start [m/s]; empty: at rest
  std::vector<double> masses;        ///< #V [kg]; 0 of prescribed vertices
  std::vector<PotentialTerm> potentials;
  std::vector<LoadTerm> loads;
  std::vector<Pin> pins;
  std::vector<Prescribed> prescribed;
  std::vector<Probe> probes;
  std::shared_ptr<const ContactModel> contact;  ///< null if nothing can touch
  std::vector<std::string> warnings;            ///< for the user, before a run

  std::size_t vertex_count() const { return rest_positions.size(); }
  /// Return the body, collider or probe of that name. Errors: usage, with the nearest name.
  const Body& body(std::string_view name) const;
  const Probe& probe(std::string_view name) const;
  /// Returns the body of a vertex of the model. Errors: usage, if there is no such vertex.
  const Body& body_of(std::size_t vertex) const;
  /// Returns the body of a collider, counted among the colliders of the scene.
  const Body& collider(std::size_t index) const { return bodies[scene.bodies.size() + index]; }
  ConstVectors of(const Body& body, ConstVectors all) const {
    return all.subspan(static_cast<std::size_t>(body.first_vertex),
                       static_cast<std::size_t>(body.vertex_count));
  }
};

/// Reads the meshes and builds everything. Errors: input or file, with the place in the scene.
MUSLIN_API Model build_model(const Scene& scene, const Progress& progress = {});

}  // namespace muslin
