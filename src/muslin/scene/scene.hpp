// Scene holds the settings of a scene, checked and with defaults filled in. Settings store their place in the
// file for later error messages.
#pragma once

#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "muslin/api.hpp"
#include "muslin/component/body_settings.hpp"
#include "muslin/component/collider/collider_settings.hpp"
#include "muslin/component/component_source.hpp"
#include "muslin/component/selection.hpp"
#include "muslin/constraint/pin.hpp"
#include "muslin/core/error.hpp"
#include "muslin/core/vectors.hpp"
#include "muslin/force/keyed.hpp"
#include "muslin/geometry/mesh.hpp"
#include "muslin/io/mesh_file.hpp"
#include "muslin/scene/attachment.hpp"
#include "muslin/scene/contact_pair.hpp"
#include "muslin/scene/pressure.hpp"
#include "muslin/schema/own_settings.hpp"
#include "muslin/solver/solver.hpp"

namespace muslin {

struct MUSLIN_API TimeSettings {
  double duration = 2;                 ///< [s]
  double frame_rate = 24;              ///< [1/s]
  std::optional<int> steps_per_frame;  ///< none: adaptive

  int frames() const;  ///< last frame number; frame 0 is the start
  /// Returns the step for a fixed number per frame; the longest one otherwise [s].
  double step() const { return 1.0 / (frame_rate * steps_per_frame.value_or(1)); }
};

/// A run treats surfaces that cross or are closer than their thickness at its start in one of these ways.
enum class TangledStart {
  refuse,  ///< it does not start
  repair,  ///< it pulls them apart first; what still crosses then is left free until it parts
  ignore,  ///< they are left free until they part
};

struct ContactSettings {
  bool given = false;              ///< true if the scene has [contact]
  std::optional<double> distance;  ///< d̂ [m]; default: see build_contact.hpp
  double friction = 0.3;           ///< Coulomb's μ of bodies without their own
  schema::Variations variations;   ///< of `friction`, by keyframes
  TangledStart tangled = TangledStart::repair;
  std::vector<ContactPairSettings> pairs;  ///< of several that match, the last one in force holds
  Place place;
};

struct PinSettings {
  std::string name, body;
  Selection where;  ///< unused for a rigid body, which is held as a whole
  double from = 0, until = std::numeric_limits<double>::infinity();  ///< [s]
  std::optional<double> stiffness;  ///< of a soft pin, of all its springs together [N/m]
  std::optional<double> time;       ///< in place of the stiffness: time in which it pulls its body there [s]
  double damping = 0;               ///< of all its dashpots together [N·s/m]
  double weight = 1;                ///< of its springs and dashpots, 0 to 1
  schema::Variations variations;    ///< of `weight`
  Motion motion;
  std::optional<Vec3> pivot;  ///< of the motion [m]; default: the centre of the held vertices at rest
  std::string sequence;       ///< in place of the motion: path of a file of moving points; empty: none
  Place sequence_place;
  std::vector<std::string> ignore;  ///< bodies and colliders that the held vertices pass through
  Place place;

  bool is_soft() const { return stiffness || time; }
};

struct ForceSettings {
  std::string type = "gravity";  ///< its kind, one of those in scene/force_kinds.cpp
  std::string name;
  std::string body;                ///< empty: every body
  std::optional<Selection> where;  ///< point forces; none: the centre of mass of a rigid body
  /// gravity: acceleration [m/s²]; point: force on each selected vertex [N]; wind: velocity [m/s]
  Keyed value;
  double from = 0, until = std::numeric_limits<double>::infinity();  ///< [s]
  OwnSettings own;  ///< those of its kind: WindForceSettings, FieldForceSettings
  Place place;

  bool acts_on(const std::string& name_of_body) const { return body.empty() || body == name_of_body; }
};

struct ProbeSettings {
  std::string name, body;
  Vec3 at = Vec3::Zero();  ///< rest position [m]
  Place place;
};

struct Scene {
  std::string title;
  std::filesystem::path file;          ///< where it was read from
  std::string text;                    ///< the file as it was read
  std::vector<std::string> overrides;  ///< KEY=VALUE that replaced settings of the text
  std::string resolved;                ///< JSON: every setting with its value, defaults included
  std::vector<std::string> warnings;   ///< legal but probably unintended settings
  TimeSettings time;
  SolverSettings solver;
  std::vector<BodySettings> bodies;
  std::vector<ColliderSettings> colliders;
  ContactSettings contact;
  std::vector<PinSettings> pins;
  std::vector<ForceSettings> forces;
  std::vector<PressureSettings> pressures;
  std::vector<AttachmentSettings> attachments;
  std::vector<ProbeSettings> probes;
  /// Components that a program adds, built after those above. Pins, forces and probes may name them.
  std::vector<ComponentSource> components;
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
