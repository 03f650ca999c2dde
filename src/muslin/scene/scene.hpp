// Scene holds the user's scene, checked and with defaults filled in. Settings store their place in the file
// for later error messages.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "muslin/api.hpp"
#include "muslin/constraint/pin.hpp"
#include "muslin/core/error.hpp"
#include "muslin/core/vectors.hpp"
#include "muslin/force/keyed.hpp"
#include "muslin/geometry/mesh.hpp"
#include "muslin/io/mesh_file.hpp"
#include "muslin/lattice/lattice.hpp"
#include "muslin/lattice/springs.hpp"
#include "muslin/material/material.hpp"
#include "muslin/solver/solver.hpp"

namespace muslin {

struct MUSLIN_API TimeSettings {
  double duration = 2;     ///< [s]
  double frame_rate = 24;  ///< [1/s]
  std::optional<int> steps_per_frame;  ///< none: adaptive

  int frames() const;  ///< last frame number; frame 0 is the start
  /// Returns the step for a fixed number per frame; the longest one otherwise [s].
  double step() const { return 1.0 / (frame_rate * steps_per_frame.value_or(1)); }
};

/// The degrees of freedom of a body.
enum class BodyModel {
  lattice,   ///< voxels filled into the mesh, with springs
  shell,     ///< the mesh itself, as thin cloth
  rigid,     ///< a collider: four points that carry it
  sequence,  ///< a collider whose vertices move along samples: the mesh itself
};

/// Selects the vertices of a body (of its lattice, or of its mesh if it is a shell) that satisfy every given
/// criterion. Coordinates are those of the world at rest, after the body has been placed.
struct Selection {
  struct BoxShape {
    Vec3 min, max;
  };
  struct SphereShape {
    Vec3 center;
    double radius;
  };
  /// |(x − point)·normal| ≤ distance
  struct PlaneShape {
    Vec3 point, normal;              ///< the normal has length 1
    std::optional<double> distance;  ///< [m]; default: half a voxel width (shell: half a mean edge), so that
                                     ///< one layer is always met
  };
  /// Within `distance` of the segment.
  struct LineShape {
    Vec3 a, b;
    std::optional<double> distance;  ///< [m]; default: ¾ of a voxel width or mean edge, so that a line in the
                                     ///< middle of a sheet of one voxel meets both of its sides
  };
  std::optional<std::string> group;  ///< the vertices that carry this group of the body's mesh
  std::optional<BoxShape> box;
  std::optional<SphereShape> sphere;
  std::optional<PlaneShape> plane;
  std::optional<LineShape> line;
  std::vector<Vec3> nearest;  ///< the vertex nearest to each point, and all that are as near
  Place place;
};

struct BodySettings {
  std::string name;
  std::string mesh;  ///< path as written; relative to the scene file
  Place mesh_place;
  BodyModel model = BodyModel::lattice;
  // For shells.
  std::optional<double> shell_thickness;  ///< as contact sees it [m]; default: see build_contact.hpp
  std::string rest_mesh;                  ///< path of the shape without stress; empty: `mesh`
  Place rest_mesh_place;
  std::optional<Vec3>
      warp;  ///< direction of the warp threads; default: along the texture's u, or the longest side
  std::optional<double> stretch_limit;  ///< of length to rest length in every direction; default: none
  // For lattices.
  std::optional<double> thickness;  ///< of an open mesh [m]; default: one voxel width
  LatticeSettings lattice;
  Bracing bracing = Bracing::kuhn;
  enum class Mass { solid, cells } mass = Mass::solid;
  enum class BoundarySprings { full, shared } boundary_springs = BoundarySprings::full;
  Material material;              ///< has the numbers of the model
  Vec3 translate = Vec3::Zero();  ///< [m]
  Vec3 rotate = Vec3::Zero();     ///< Euler angles about x, then y, then z [degrees]
  Vec3 scale = Vec3::Ones();
  Vec3 velocity = Vec3::Zero();    ///< initial [m/s]
  bool contact = true;             ///< touches other bodies, colliders and itself
  bool self_contact = true;        ///< touches itself
  std::optional<double> friction;  ///< Coulomb's μ; default: that of the scene
  std::optional<Vec3> colour;      ///< in pictures, sRGB 0…1; default: one of a palette
  Place place;
};

/// An obstacle for bodies, static or moving; with a density it is a rigid body itself.
struct ColliderSettings {
  enum class Shape { plane, sphere, capsule, box, mesh } shape = Shape::plane;
  std::string name;
  Vec3 center = Vec3::Zero();    ///< of a sphere or box; a point of a plane [m]
  double radius = 0;             ///< of a sphere or capsule [m]
  Vec3 normal = Vec3(0, 1, 0);   ///< of a plane, towards the free side, of length 1
  Vec3 size = Vec3::Ones();      ///< of a box [m]
  std::array<Vec3, 2> points{};  ///< the ends of a capsule's axis [m]
  std::string mesh;              ///< path as written; relative to the scene file
  Place mesh_place;
  Vec3 translate = Vec3::Zero();  ///< of a mesh [m]
  Vec3 rotate = Vec3::Zero();     ///< of a mesh, or of a box about its centre [degrees], as of a body
  Vec3 scale = Vec3::Ones();      ///< of a mesh
  Motion motion;                  ///< relative to the shape's placement
  std::optional<Vec3> pivot;      ///< of the motion [m]; default: the middle of the shape
  std::string sequence;           ///< path of the samples that a mesh follows; empty: none
  Place sequence_place;
  std::optional<double> frame_rate;  ///< of the samples, but of those of an .mdd [1/s]; default: the scene's
  std::optional<double> start;    ///< time of the first sample [s]; default: that of the file, or 0
  std::optional<double> density;  ///< [kg/m³]; if given, it moves dynamically
  Vec3 velocity = Vec3::Zero();   ///< initial, with a density [m/s]
  Vec3 angular_velocity = Vec3::Zero();  ///< initial, with a density, about its centre of mass [degrees/s]
  bool contact = true;
  std::optional<double> friction;  ///< Coulomb's μ; default: that of the scene
  std::optional<Vec3> colour;      ///< in pictures, sRGB 0…1; default: grey
  Place place;

  bool is_free() const { return density.has_value(); }
};

struct ContactSettings {
  bool given = false;              ///< true if the scene has the table
  std::optional<double> distance;  ///< d̂ [m]; default: see build_contact.hpp
  double friction = 0.3;           ///< Coulomb's μ of bodies without their own
  Place place;
};

struct PinSettings {
  std::string name, body;
  Selection where;  ///< unused for a rigid body, which is held as a whole
  double from = 0, until = std::numeric_limits<double>::infinity();  ///< [s]
  Motion motion;
  std::optional<Vec3> pivot;  ///< of the motion [m]; default: the centre of the held vertices at rest
  std::string sequence;       ///< in place of the motion: path of a file of moving points; empty: none
  Place sequence_place;
  Place place;
};

struct ForceSettings {
  enum class Type { gravity, point, wind } type = Type::gravity;
  std::string name;
  std::string body;                ///< empty: every body
  std::optional<Selection> where;  ///< point forces; none: the centre of mass of a rigid body
  Keyed value;  ///< gravity: acceleration [m/s²]; point: force on each selected vertex [N]; wind: velocity
                ///< [m/s]
  double from = 0, until = std::numeric_limits<double>::infinity();  ///< [s]
  double air_density = 1.2;                                          ///< wind [kg/m³]
  double drag = 1.17;                                                ///< wind, drag coefficient C_D
  double lift = 0.0;                                                 ///< wind, lift coefficient C_L ≤ C_D
  double gust = 0.0;         ///< wind, root mean square of each component of the turbulence [m/s]
  double gust_length = 1.0;  ///< wind, size of its largest eddies [m]
  std::int64_t seed = 1;     ///< wind, decides the turbulence
  Place place;
};

struct ProbeSettings {
  std::string name, body;
  Vec3 at = Vec3::Zero();  ///< rest position [m]
  Place place;
};

struct Scene {
  std::string title;
  std::filesystem::path file;         ///< where it was read from
  std::string text;                   ///< the file as it was read
  std::string resolved;               ///< JSON: every setting with its value, defaults included
  std::vector<std::string> warnings;  ///< legal but probably unintended settings
  TimeSettings time;
  SolverSettings solver;
  std::vector<BodySettings> bodies;
  std::vector<ColliderSettings> colliders;
  ContactSettings contact;
  std::vector<PinSettings> pins;
  std::vector<ForceSettings> forces;
  std::vector<ProbeSettings> probes;
  /// In-memory meshes, by their path in the scene: for programs that make their own. They take precedence
  /// over files of that path.
  std::map<std::string, std::shared_ptr<const Mesh>> meshes;
};

/// Returns a path as written in the scene, resolved against the scene file's folder.
MUSLIN_API std::filesystem::path resolve_path(const Scene& scene, const std::string& path);

/// Returns the mesh called `path` in the scene: one in memory, or that file. Errors: as read_mesh.
MUSLIN_API MeshFile scene_mesh(const Scene& scene, const std::string& path);

/// Reads and checks a scene file; `overrides` are KEY=VALUE as given to --set, e.g. "time.duration=2",
/// "body.flag.voxel_width=0.5", "body.0.voxel_width=0.5". Unknown keys are errors that name the nearest
/// known key. Errors: file; input with file, line, column.
MUSLIN_API Scene read_scene(const std::filesystem::path& file,
                            const std::vector<std::string>& overrides = {});
/// Parses a scene from a text; `file` is the name in messages, and paths are relative to it.
MUSLIN_API Scene parse_scene(const std::string& text, const std::filesystem::path& file,
                             const std::vector<std::string>& overrides = {});

}  // namespace muslin
