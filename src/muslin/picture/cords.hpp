// Cords draws the cords and rods of a run's attachments.
#pragma once

#include <vector>

#include "muslin/cache/run_reader.hpp"
#include "muslin/core/vectors.hpp"
#include "muslin/render/scene_view.hpp"

namespace muslin {

/// Tubes from end to end, in one surface. A slack cord sags as a parabola of its length. A cord is drawn
/// while its attachment acts and a joint of it holds.
class Cords {
 public:
  /// `radius`: of the tubes [m].
  Cords(const RunReader& run, double radius);

  Surface surface() const;
  /// Returns the vertices of the surface at a frame [m]. The tube of a cord that is not drawn has no extent.
  std::vector<Vec3> points(int frame) const;

 private:
  struct Drawn {
    Cord cord;
    double length = 0;         ///< [m]
    std::vector<int> holding;  ///< by frame
  };
  bool acts(const Drawn& drawn, int frame) const;

  const RunReader& run_;
  double radius_;
  std::vector<Drawn> cords_;
};

}  // namespace muslin
