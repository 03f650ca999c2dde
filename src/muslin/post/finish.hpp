// Prepares the surface of a simulated body for rendering: smooth, subdivide, carry a finer mesh, thicken.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "muslin/core/vectors.hpp"
#include "muslin/geometry/mesh.hpp"
#include "muslin/post/carried_mesh.hpp"

namespace muslin {

/// Applied in the order of the members.
struct FinishOptions {
  int smooth = 0;     ///< rounds of smoothing, 0 to 1000
  int subdivide = 0;  ///< levels of subdivision, 0 to 8
  std::optional<Mesh> carried =
      std::nullopt;      ///< a mesh that the surface carries, modelled on the surface at rest
  double thickness = 0;  ///< of the solid made of the surface [m]; 0: it stays a surface

  bool changes_nothing() const { return smooth == 0 && subdivide == 0 && !carried && thickness == 0; }
};

class Finish {
 public:
  /// Errors: usage, if an option is out of its range, and those of Subdivision and CarriedMesh.
  Finish(const Mesh& rest, FinishOptions options);
  ~Finish();
  Finish(Finish&&) noexcept;
  Finish& operator=(Finish&&) noexcept;

  const Mesh& mesh() const;  ///< the finished surface at rest
  /// Returns the points of mesh() for these positions of the surface, and the crossings of the carried mesh.
  Carried points(ConstVectors positions, const Obstacles& obstacles = {}) const;

 private:
  struct Stages;
  std::unique_ptr<Stages> stages_;
};

}  // namespace muslin
