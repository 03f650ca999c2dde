// Tangle is what has to be pulled apart at one position of all surfaces: crossings, points on the wrong side,
// places closer than the thickness.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <vector>

#include "muslin/contact/contact_candidates.hpp"
#include "muslin/contact/contact_model.hpp"
#include "muslin/core/vectors.hpp"
#include "muslin/untangle/separation.hpp"
#include "muslin/untangle/surface_pieces.hpp"

namespace muslin {

struct Tangle {
  std::vector<std::array<int, 2>> crossing;  ///< pairs of triangles, ascending
  std::vector<int> lost;                     ///< #P, the piece on whose wrong side a point is, −1: none
  std::size_t lost_count = 0;                ///< points on a wrong side
  std::size_t close_count = 0;               ///< pairs of features closer than their thickness
  double depth = 0;                          ///< of the deepest point [m]
  std::vector<Separation> separations;       ///< what would resolve all this

  bool empty() const { return crossing.empty() && lost_count == 0 && close_count == 0; }
  std::size_t size() const { return crossing.size() + lost_count + close_count; }
};

/// Finds tangles. Which side is right is decided, in this order, by solids (nothing belongs inside them), by
/// layers, by the lesser area of what would have to move, and where contours cut nothing off by the way in
/// which they become shorter (Volino and Magnenat-Thalmann, Resolving surface collisions through intersection
/// contour minimization, 2006).
class TangleFinder {
 public:
  explicit TangleFinder(std::shared_ptr<const ContactModel> model);
  /// q is #V by 3 [m]; `dt` the step in which separations act [s].
  Tangle find(ConstVectors q, double dt);
  const SurfacePieces& pieces() const { return pieces_; }

 private:
  class Search;

  std::shared_ptr<const ContactModel> model_;
  SurfacePieces pieces_;
  ContactCandidates candidates_;
  std::map<std::pair<int, int>, int> decided_;  // sides, by pieces
};

}  // namespace muslin
