// Computes the signed distance of any triangle mesh, exact to rounding, and samples it on a regular grid.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "muslin/api.hpp"
#include "muslin/core/progress.hpp"
#include "muslin/core/vectors.hpp"
#include "muslin/geometry/mesh.hpp"

namespace muslin {

/// Nearest point of the surface.
struct SurfacePoint {
  double distance;  ///< [m]; infinity if beyond the search distance
  int triangle;     ///< index into triangulate(mesh).triangles; −1 if beyond the search distance
};

/// Distance to the surface, negative inside. The magnitude is the exact distance to the nearest triangle
/// (1e-6 relative or better); the sign is that of the generalised winding number, inside where it exceeds one
/// half (Barill et al. 2018), which also works for meshes with holes and triangle soups.
class MUSLIN_API SignedDistance {
 public:
  /// The solid is the volume enclosed by the faces, for any orientation (see orientation.hpp). Meant for
  /// meshes that pass require_usable (inspect.hpp). Errors: input, if there are no faces.
  explicit SignedDistance(const Mesh& mesh);
  ~SignedDistance();
  SignedDistance(SignedDistance&&) noexcept;
  SignedDistance& operator=(SignedDistance&&) noexcept;

  double operator()(const Vec3& point) const;
  /// Returns the unsigned distance to the surface.
  double distance(const Vec3& point) const;
  bool inside(const Vec3& point) const;
  /// Returns the unsigned distance, searching up to `max_distance`. A `hint`, the triangle nearest to a point
  /// close by, only makes it faster.
  SurfacePoint nearest(const Vec3& point, double max_distance, int hint = -1) const;
  /// True if each edge is traversed equally often in both directions: then the sign changes at the surface
  /// only.
  bool watertight() const;
  const Box& bounds() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// A regular grid of sample points: sample (i,j,k) lies at origin + width·(i,j,k); i runs fastest.
struct Grid {
  Vec3 origin = Vec3::Zero();
  double width = 1;
  Vec3i samples = Vec3i::Zero();

  std::size_t size() const {
    return static_cast<std::size_t>(samples.x()) * static_cast<std::size_t>(samples.y()) *
           static_cast<std::size_t>(samples.z());
  }
  std::size_t index(int i, int j, int k) const {
    return static_cast<std::size_t>(i) +
           static_cast<std::size_t>(samples.x()) *
               (static_cast<std::size_t>(j) +
                static_cast<std::size_t>(samples.y()) * static_cast<std::size_t>(k));
  }
  Vec3 position(int i, int j, int k) const { return origin + width * Vec3(i, j, k); }
};

/// Samples of the signed distance. With a finite band, samples farther than `band` from the surface hold
/// ±band with the right sign.
struct DistanceField {
  Grid grid;
  double band = 0;            ///< [m]; infinity for a full field
  std::vector<float> values;  ///< grid.size(), i fastest [m]
};

/// Samples the whole grid, in parallel; the same bits for any thread count. Where the mesh is watertight the
/// sign is computed only near the surface and propagated from there: it cannot change between two neighbours
/// whose distances add up to more than the width. `band` ≥ 0 [m], infinity for all samples. Errors: usage, if
/// the grid or the band is invalid; interrupted.
MUSLIN_API DistanceField sample_field(const SignedDistance& distance, const Grid& grid, double band,
                                      const Progress& progress = {});

}  // namespace muslin
