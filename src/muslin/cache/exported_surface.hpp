// ExportedSurface yields a surface of a run frame by frame, finished as the export asks for.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "muslin/cache/export.hpp"
#include "muslin/cache/run_reader.hpp"
#include "muslin/post/finish.hpp"

namespace muslin {

/// Returns the points in double.
std::vector<Vec3> widened(const std::vector<Vec3f>& points);

class ExportedSurface {
 public:
  /// Errors: usage, for a body or surface that the run does not have, or if it cannot be finished; those of
  /// read_mesh for the mesh to carry.
  ExportedSurface(const RunReader& run, int body, const ExportOptions& options);

  const std::string& name() const;  ///< of the body
  const Mesh& mesh() const;         ///< at rest
  std::vector<Vec3f> points(int frame);
  /// Central differences over the neighbouring frames, one-sided at the ends [m/s].
  std::vector<Vec3f> velocities(int frame);
  /// The crossings of the mesh that the surface carries, in the frames that were asked for.
  const ExportReport& report() const { return report_; }

 private:
  const std::vector<Vec3f>& finished(int frame);
  Obstacles obstacles(int frame) const;

  const RunReader& run_;
  int body_;
  SurfaceKind surface_;
  std::optional<Finish> finish_;
  bool guarded_ = false;  ///< the carried mesh must not cross other surfaces
  ExportReport report_;
  int last_reported_ = -1;
  std::map<int, std::vector<Vec3f>> recent_;  ///< by frame; velocities read every frame three times
};

}  // namespace muslin
