// Tangle is what has to be pulled apart at one position of all surfaces: crossings, points on the wrong side,
// places closer than the thickness.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "muslin/contact/contact_candidates.hpp"
#include "muslin/contact/contact_exemptions.hpp"
#include "muslin/contact/contact_model.hpp"
#include "muslin/core/vectors.hpp"
#include "muslin/untangle/crossed_regions.hpp"
#include "muslin/untangle/lost_point.hpp"
#include "muslin/untangle/separation.hpp"
#include "muslin/untangle/surface_pieces.hpp"

namespace muslin {

struct Tangle {
  std::vector<std::array<int, 2>> crossing;  ///< pairs of triangles, ascending
  FreeParts free;                            ///< what contact has to leave to the separations
  std::vector<LostPoint> wrong;              ///< the points on a wrong side, each once
  std::size_t close_count = 0;  ///< pairs of features closer than their thickness, or than the repair leaves
  double depth = 0;             ///< of the deepest point [m]
  std::vector<Separation> separations;  ///< what would resolve all this

  bool empty() const { return crossing.empty() && wrong.empty() && close_count == 0; }
  std::size_t size() const { return crossing.size() + wrong.size() + close_count; }
};

/// Further means of a repair whose steps did not help.
struct Persistence {
  double firmness = 1;    ///< of separations, over the stiffness of contact
  bool flattens = false;  ///< true if all folds of a surface through itself are flattened
};

/// Finds the tangles of one repair. Two pieces of which the right sides are known, a solid and what is around
/// it or layers, are free of contact once they are tangled, and separations keep them apart by those sides
/// until they have a gap in which contact is calm; other tangles leave contact on where nothing crosses.
/// Which side is right is decided, in this order, by solids (nothing belongs inside them), by layers, by the
/// lesser area of what would have to move, and where contours cut nothing off by the way in which they become
/// shorter (Volino and Magnenat-Thalmann, Resolving surface collisions through intersection contour
/// minimization, 2006).
class TangleFinder {
 public:
  explicit TangleFinder(std::shared_ptr<const ContactModel> model);
  /// q is #V by 3 [m]; `dt` the step in which separations act [s].
  Tangle find(ConstVectors q, double dt, const Persistence& persistence = {});

  const SurfacePieces& pieces() const { return pieces_; }

 private:
  class Search;

  std::shared_ptr<const ContactModel> model_;
  SurfacePieces pieces_;
  ContactCandidates candidates_;
  Layerings layerings_;
  std::set<std::pair<int, int>> sided_;  // pairs of pieces that separations alone keep apart, smaller first
};

/// Points of one body that are on the wrong side of another one, or of itself.
struct WrongSide {
  int body = 0, other = 0;  ///< of the surface
  std::size_t points = 0;
  double depth = 0;  ///< of the deepest [m]
};

/// Returns what is on a wrong side at q (#V by 3, [m]), by bodies: also what lies wholly inside a solid and
/// crosses nothing.
std::vector<WrongSide> find_wrong_sides(const std::shared_ptr<const ContactModel>& model, ConstVectors q);

/// Returns one line, such as: 120 points of "shirt" are inside "body", up to 2.1 mm deep.
std::string describe(const ContactModel& model, const WrongSide& side);

}  // namespace muslin
