// WindingNumber computes the generalised winding number of a triangle soup: about 1 inside, about 0 outside,
// smooth across holes.
//
// Jacobson, Kavan, Sorkine-Hornung, Robust inside-outside segmentation using generalized winding numbers
// (2013); hierarchy and far field after Barill, Dickson, Schmidt, Levin, Jacobson, Fast winding numbers for
// soups and clouds (2018); solid angles after Van Oosterom, Strackee, The solid angle of a plane triangle
// (1983).
#pragma once

#include <array>
#include <span>
#include <vector>

#include "muslin/core/vectors.hpp"

namespace muslin {

/// Safe to call from several threads; the same bits for any thread count.
class WindingNumber {
 public:
  /// `triangles` (#T by 3) index `positions` (#V by 3). Orientation is taken as given: counter-clockwise
  /// seen from outside (see orientation.hpp).
  WindingNumber(ConstVectors positions, std::span<const Vec3i> triangles);

  /// Returns (1/4π) Σ solid angle of each triangle seen from `point`. Clusters farther away than twice their
  /// radius are evaluated by a Taylor series of second order (error below 1e-2).
  double operator()(const Vec3& point) const;

 private:
  struct Triangle {
    Vec3 a, b, c;
  };
  // A cluster of triangles for the far field: moments of its area vectors about `centre`, of which only the
  // symmetric parts that the series needs are kept.
  struct Node {
    Vec3 centre = Vec3::Zero();
    double squared_reach = 0;          // a point at this squared distance or farther sees the series
    Vec3 area = Vec3::Zero();          // ∫ n
    std::array<double, 6> first{};     // sym ∫ n⊗x: xx yy zz, 2xy 2yz 2zx
    Vec3 second_trace = Vec3::Zero();  // 2 ∫ (n·x) x + ∫ n |x|²
    std::array<double, 10> second{};   // sym ∫ n⊗x⊗x: xxx yyy zzz, 3xxy 3xxz 3yyx 3yyz 3zzx 3zzy, 6xyz
    int begin = 0, end = 0;            // its triangles
    int right = 0;                     // second child; the first follows this node; 0 for a leaf
  };
  struct Moments;

  Moments build(int node, int leaves, std::span<int> order, int begin, std::span<const Triangle> triangles);

  std::vector<Triangle> triangles_;  // in the order of the leaves
  std::vector<Node> nodes_;
};

/// Returns the solid angle of triangle abc seen from the origin, in (−2π, 2π); positive if the origin is on
/// its inner side.
double solid_angle(const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace muslin
