// The signed distance of any triangle mesh, exact to rounding, and its samples on a regular grid.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "muslin/core/progress.hpp"
#include "muslin/core/vectors.hpp"
#include "muslin/geometry/mesh.hpp"

namespace muslin {

/// Distance to the surface, negative inside. The magnitude is the exact distance to the nearest triangle
/// (1e-6 relative or better); the sign is that of the generalised winding number, inside where it exceeds
/// one half (Barill et al. 2018), so that holes and soup have an inside too.
class SignedDistance {
 public:
  /// `mesh` must have an area; the solid is what its faces enclose.
  explicit SignedDistance(const Mesh& mesh);
  ~SignedDistance();
  SignedDistance(SignedDistance&&) noexcept;
  SignedDistance& operator=(SignedDistance&&) noexcept;

  double operator()(const Vec3& point) const;
  /// Unsigned distance to the surface.
  double distance(const Vec3& point) const;
  bool inside(const Vec3& point) const;
  const Box& bounds() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
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

DistanceField sample_field(const SignedDistance& distance, const Grid& grid, double band,
                           const Progress& progress = {});

}  // namespace muslin
