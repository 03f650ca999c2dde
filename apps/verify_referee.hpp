// Referee counts crossings independently of the contact code: the meshes of all bodies by the exact test,
// balls, capsules and planes by their formulas.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "muslin/hosts.hpp"

namespace muslin::app {

class Referee {
 public:
  /// Colliders and bodies with `contact = false` are left out.
  explicit Referee(std::shared_ptr<const Model> model);

  /// Counts pairs of triangles that meet, and triangles that reach into a ball or capsule or beneath a plane,
  /// at q (#V by 3, [m]). Static and kinematic colliders may cross one another, bodies with `self_contact =
  /// false` themselves.
  std::size_t crossings(ConstVectors q) const;

 private:
  /// A point of a rigid body.
  struct Anchor {
    std::size_t first = 0;  ///< of the four vertices
    std::array<double, 4> weights{};
    Vec3 at(ConstVectors q) const;
  };
  struct Round {
    std::size_t body = 0;
    Anchor a, b;  ///< the same for a ball
    double radius = 0;
  };
  struct Half {
    std::size_t body = 0;
    Anchor point, above;  ///< above by the normal
  };
  bool may_touch(std::size_t body_a, std::size_t body_b) const;

  std::shared_ptr<const Model> model_;
  // Bodies with a mesh in contact; then an axis for each round one.
  std::vector<bool> touches_itself_;  // by body
  std::vector<std::size_t> meshes_;
  std::vector<Vec3i> triangles_;
  std::vector<std::size_t> body_of_triangle_;
  std::vector<std::size_t> body_of_point_;
  std::vector<Round> rounds_;
  std::vector<Half> halves_;
};

}  // namespace muslin::app
