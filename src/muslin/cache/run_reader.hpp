// RunReader reads a run directory for pictures, exports and views.
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "muslin/api.hpp"
#include "muslin/cache/point_cache.hpp"
#include "muslin/cache/run_writer.hpp"
#include "muslin/cache/selections.hpp"
#include "muslin/geometry/mesh.hpp"
#include "muslin/simulation/simulation.hpp"

namespace muslin {

/// The surface of a body that is shown.
enum class SurfaceKind {
  skin,     ///< the original mesh, carried by the lattice
  contour,  ///< marching squares or cubes on the deformed lattice
};
MUSLIN_API const char* name_of(SurfaceKind surface);

/// Reads a run, finished or not, even while it is being written. Frames 0 … frame_count() − 1 are complete in
/// all files; the count is determined when the reader is constructed. Bodies are numbered as in bodies().
/// Functions that take a body or frame throw Error(usage) if it does not exist.
class MUSLIN_API RunReader {
 public:
  /// Errors: file, if there is no run; input, if it is damaged.
  explicit RunReader(std::filesystem::path directory);
  ~RunReader();
  RunReader(RunReader&&) noexcept;
  RunReader& operator=(RunReader&&) noexcept;

  const std::filesystem::path& directory() const;
  RunStatus status() const;  ///< `running` also for a run that was killed
  const std::string& title() const;
  std::string resolved_scene() const;  ///< JSON, as Scene::resolved
  double frame_rate() const;           ///< [1/s]
  int frame_count() const;
  int last_frame() const;  ///< of the run, or the planned one if unfinished
  const std::vector<std::string>& bodies() const;
  /// Returns the index of a body by name; an empty name means the only one that is not a collider.
  /// Error(usage) naming the bodies there are.
  int find_body(const std::string& name) const;

  /// Returns the colour in pictures, sRGB 0…1: the scene's, or else one from a palette; colliders are grey by
  /// default.
  Vec3 colour(int body) const;

  bool is_collider(int body) const;
  /// True for an unbounded collider, of which a patch is shown.
  bool is_plane(int body) const;
  /// True if the run has this surface of the body. Every body has a skin.
  bool has(int body, SurfaceKind surface) const;

  /// Returns the surface at rest as it was written: polygons, UVs, groups. Errors: usage, for the contour of
  /// a body without one.
  const Mesh& mesh(int body, SurfaceKind surface) const;
  /// Returns the vertices of that surface at a frame, in the same order [m].
  std::vector<Vec3f> points(int body, SurfaceKind surface, int frame) const;
  /// Returns their velocities by central differences over the neighbouring frames, one-sided at the ends
  /// [m/s].
  std::vector<Vec3f> velocities(int body, SurfaceKind surface, int frame) const;

  /// The points that selections refer to: the vertices of the body if they are cached, those of its skin
  /// otherwise.
  std::size_t selectable_count(int body) const;
  std::vector<Vec3f> selectable_points(int body, int frame) const;
  std::vector<Vec3f> selectable_velocities(int body, int frame) const;

  /// Voxels between the vertices of a body: rest positions [m], and corners in the order of Lattice.
  struct Cells {
    std::vector<Vec3> rest_positions;
    std::vector<std::array<int, 8>> voxels;
  };
  bool has_cells(int body) const;
  const Cells& cells(int body) const;  ///< empty if it has none

  /// Returns the vertices of the pins and point forces, and the cords, since the run was last started or
  /// resumed.
  const Selections& selections() const;
  /// Returns for each frame how many joints of an attachment hold; −1 where the run does not tell.
  std::vector<int> holding(const std::string& attachment) const;

  /// Rows of diagnostics.csv, frames 0 … frame_count() − 1.
  const std::vector<Diagnostics>& diagnostics() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace muslin
