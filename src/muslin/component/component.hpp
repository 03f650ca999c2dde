// Component is the unit of which a model consists: a lattice, a shell, a rigid body, a kinematic mesh, or a
// component that a program adds. It provides its degrees of freedom and masses, potentials and loads, surface
// map, constraints and statistics. Contact, solver, cache and views use this interface only; none of them
// asks what kind a component is. CONTRIBUTING.md tells how to add a kind.
//
// Vertices are counted within the component, from 0, unless a comment says otherwise. A component is built
// once by its ComponentSource, and immutable and shared from then on.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "muslin/api.hpp"
#include "muslin/component/component_source.hpp"
#include "muslin/component/contact_part.hpp"
#include "muslin/component/mapped_number.hpp"
#include "muslin/component/selection.hpp"
#include "muslin/component/terms.hpp"
#include "muslin/constraint/prescribed.hpp"
#include "muslin/core/progress.hpp"
#include "muslin/core/vectors.hpp"
#include "muslin/geometry/inspect.hpp"
#include "muslin/geometry/mesh.hpp"
#include "muslin/io/mesh_file.hpp"
#include "muslin/lattice/embedding.hpp"
#include "muslin/potential/state.hpp"
#include "muslin/solver/solver.hpp"

namespace muslin {

struct BodyStatistics {
  std::int64_t vertices = 0, voxels = 0, tetrahedra = 0;
  std::array<std::int64_t, 3> springs{};   ///< by SpringKind: edge, face diagonal, body diagonal
  double mass = 0;                         ///< [kg]
  double coverage = 1;                     ///< share of the mesh's area inside kept voxels
  double contour_distance = 0;             ///< largest distance of the rest contour from the solid [m]
  std::int64_t triangles = 0, hinges = 0;  ///< of a shell's or collider's mesh
  /// A stable step of symplectic_euler at rest, with damping [s]; infinity without stiffness and damping.
  double stable_step = std::numeric_limits<double>::infinity();
  /// Without damping: at most 2/ω of the highest frequency [s].
  double undamped_step = std::numeric_limits<double>::infinity();
};

/// A point of a component.
struct AttachedPoint {
  Embedding point;      ///< one point
  std::string warning;  ///< if it is not at the requested place: a sentence without subject
};

/// Vertices that a force acts on.
struct LoadedVertices {
  std::vector<int> vertices;
  std::vector<double> shares;  ///< #vertices, of the force on each; empty: 1
};

/// Points besides the skin that a run caches in NAME.POINTS.pc2, and a file with their mesh.
struct CachedPoints {
  std::string name;       ///< such as "contour"
  std::string extension;  ///< of the file NAME.POINTS.EXTENSION: "obj", a surface, or "vtu", voxels
  std::function<void(const std::filesystem::path&)> write_rest;  ///< writes that file
  /// Maps the vertices to these points; null: the points are the vertices, and selections refer to them.
  const Embedding* embedding = nullptr;
};

/// Appearance of a component in views.
struct Appearance {
  std::optional<Vec3> colour = std::nullopt;  ///< sRGB 0…1; none: from the palette
  std::string shape = "";                     ///< of a collider, such as "plane"; empty: not a collider
  bool unbounded = false;                     ///< the mesh is a patch of an unbounded surface
};

class MUSLIN_API Component {
 public:
  std::string name;
  Mesh mesh;           ///< the user's mesh, placed in the world, of which `weld` has joined vertices
  MeshReport report;   ///< of mesh
  bool sheet = false;  ///< thin: the surface has two sides, no inside
  /// The mesh with the vertices of its file, where `mesh` has others, and how they belong to those of `mesh`.
  struct Source {
    Mesh mesh;
    std::vector<int> vertices;  ///< #V of the file: its vertex in Component::mesh; −1 if that was left out
    std::vector<int> origins;   ///< #V of Component::mesh: the first vertex of the file
  };
  std::optional<Source> source;
  Embedding skin;        ///< of skin_mesh().positions
  int first_vertex = 0;  ///< its vertices are first_vertex … first_vertex + vertex_count − 1 of the state
  int vertex_count = 0;
  BodyStatistics statistics;
  std::vector<VertexAttribute> attributes;  ///< numbers painted on `mesh`, which maps name
  std::vector<MappedNumber> maps;           ///< numbers that vary over the vertices of `mesh`
  /// Over its vertices; in output their names follow the component's. Potentials are added to the solver's
  /// list in this order.
  std::vector<PotentialTerm> potentials;
  std::vector<LoadTerm> loads;

  /// Returns the mesh that output shows: the skin's polygons, UVs and rest positions.
  const Mesh& skin_mesh() const { return source ? source->mesh : mesh; }

  Component() = default;
  Component(const Component&) = delete;
  Component& operator=(const Component&) = delete;
  virtual ~Component();

  /// Returns the name of its kind for listings and files; no decision depends on it.
  virtual std::string kind() const = 0;

  /// Adds the potentials and loads that depend on which vertices are held during the whole run (#vertices,
  /// not 0: held), and sets statistics.stable_step. Called once, before the component is shared. Default:
  /// nothing.
  virtual void add_terms(std::span<const std::uint8_t> held) { (void)held; }

  // Degrees of freedom.

  /// Returns the position of a vertex at the start [m].
  virtual Vec3 rest_position(std::size_t v) const = 0;
  /// Returns #vertices [kg]; 0 of prescribed vertices.
  virtual std::vector<double> masses() const = 0;
  /// Returns #vertices, at the start [m/s]. Default: at rest.
  virtual std::vector<Vec3> velocities() const;
  /// Returns the scripted motion of all of its vertices, with `first` 0; null if forces move it.
  virtual const Prescribed* motion() const { return nullptr; }
  bool is_prescribed() const { return motion() != nullptr; }
  /// False for a body that moves rigidly.
  virtual bool deforms() const { return true; }
  /// True if forces deform it.
  bool is_soft() const { return deforms() && !is_prescribed(); }
  /// Returns the typical distance of neighbouring vertices, for a rigid body those of its mesh [m].
  virtual double spacing() const = 0;
  /// Returns #vertices labels; vertices connected by terms have equal labels. Default: one part.
  virtual std::vector<int> parts() const;
  /// Returns the longest step for which single precision resolves its masses against its stiffness [s].
  virtual double longest_step() const;
  /// Changes anchor and prediction of its vertices for a step from `state`; `fixed`: #V of the model, 1 where
  /// a vertex is held. Default: no change.
  virtual void predict(Integrator integrator, const State& state, std::span<const std::uint8_t> fixed,
                       StepContext& context) const;
  /// Returns the largest ratio of an element's length at x to its length at rest; x are the positions of its
  /// vertices.
  virtual double max_stretch(ConstVectors x) const;
  /// Returns the largest stretch that it allows at a time [s], if there is one.
  virtual std::optional<double> stretch_limit(double at_time) const {
    (void)at_time;
    return std::nullopt;
  }

  // Selections and points.

  /// True if its vertices are those of its mesh, in their order: J = 1.
  virtual bool is_mesh() const { return true; }
  /// True if `where` selects among its vertices; otherwise it selects among those of its mesh, pins hold the
  /// component as a whole, and forces on points are shared by its vertices.
  virtual bool selects_vertices() const { return true; }
  virtual std::size_t selectable_count() const { return mesh.vertex_count(); }
  /// Returns the position at the start of point i of those that `where` selects among [m].
  virtual Vec3 selectable(std::size_t i) const { return mesh.positions[i]; }
  /// Returns #selectable flags, 1 for points that belong to the group of the mesh.
  virtual std::vector<std::uint8_t> in_group(const MeshGroup& group) const;
  /// Returns the vertices that a pin holds, ascending. Errors: as select_vertices.
  std::vector<int> held_vertices(const Selection& where, const std::string& what) const;
  /// Returns the vertices that a force on each selected point acts on, all in equal shares if `where` is
  /// absent. Errors: as select_vertices.
  LoadedVertices loaded_vertices(const std::optional<Selection>& where, const std::string& what) const;
  /// Returns the point of the component at or nearest to `at`. Default: the nearest point of its surface.
  virtual AttachedPoint attach(const Vec3& at) const;

  // Contact.

  /// Returns its surface; none if it touches nothing. Default: none.
  virtual std::optional<ContactPart> contact_part() const;

  // Files and views.

  /// Continue a hash with the data that a saved state must fit: first the shapes of all components, then
  /// their materials.
  virtual std::uint64_t shape_hash(std::uint64_t seed) const;
  virtual std::uint64_t material_hash(std::uint64_t seed) const { return seed; }
  virtual Appearance appearance() const { return {}; }
  bool is_collider() const { return !appearance().shape.empty(); }
  /// Returns the points that a run caches besides the skin.
  virtual std::vector<CachedPoints> cached_points() const { return {}; }
  /// Writes the stages between mesh and simulation into a folder. Default: NAME.skin.obj. Errors: file.
  virtual void write_stages(const std::filesystem::path& folder, const Progress& progress) const;
  /// Returns a JSON object for `muslin check --json` and stats.json.
  virtual std::string description_json() const;
  /// Returns the description as lines of text.
  virtual std::string description() const;

 protected:
  /// Continues a hash with the name, the vertex range and the number of springs.
  std::uint64_t range_hash(std::uint64_t seed, std::int64_t springs) const;
};

/// Returns the embedding whose points are the vertices: J = 1. Prepared for the transpose.
MUSLIN_API Embedding identity_embedding(std::size_t count);
/// Returns the embedding of the vertices of a file in those of the mesh; vertices that were left out stay.
Embedding embed_source(const Component::Source& source);

/// Fills in statistics.mass, the sum of masses() in their order.
MUSLIN_API void weigh(Component& component);

}  // namespace muslin
