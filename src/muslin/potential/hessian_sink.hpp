// HessianSink receives the Hessians of potentials, element by element, for the linear systems of a step. It
// owns the storage; a potential asks once for a view of the storage of a pattern and adds its blocks there,
// from several threads if it wants.
//
// Vertices are those of all bodies: `first` is the vertex that a potential counts as its vertex 0. The
// potential multiplies all values by `scale()` before it adds them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "muslin/core/float4.hpp"
#include "muslin/core/vectors.hpp"

namespace muslin {

class Potential;
class SymmetricPattern;
struct FormCoupling;
struct SpringNetwork;
struct CentralSpring;

/// The blocks of a SymmetricPattern: three columns of four floats each, the fourth 0. Different blocks may be
/// written by different threads.
struct PairBlocks {
  Float4* columns = nullptr;
  Float4* block(int index) const { return columns + 3 * static_cast<std::size_t>(index); }
};

/// Terms Aᵀ (a n nᵀ + b (I − n nᵀ)) A with A p = Σ wᵢ pᵢ: stiffness against relative motion.
struct RelativeTerms {
  struct Weight {
    int vertex = 0;  ///< of the body
    float weight = 0;
  };
  struct Term {
    Float4 normal;
    float difference, tangential;  ///< a − b and b
    int begin, end;                ///< weights
  };
  Term* terms = nullptr;
  Weight* weights = nullptr;

  /// Sets term t, whose weights are number `begin` and following: normal n of length 1, normal_stiffness = a
  /// ≥ 0 and tangential = b ≥ 0, already scaled; each vertex once. Several threads may set terms.
  void set(std::size_t t, std::size_t begin, const Vec3& normal, double normal_stiffness, double tangential,
           std::span<const Weight> of_term) const {
    std::copy(of_term.begin(), of_term.end(), weights + begin);
    terms[t] = {Float4{static_cast<float>(normal.x()), static_cast<float>(normal.y()),
                       static_cast<float>(normal.z()), 0},
                static_cast<float>(normal_stiffness - tangential), static_cast<float>(tangential),
                static_cast<int>(begin), static_cast<int>(begin + of_term.size())};
  }
};

/// factor · g gᵀ with g = Σ gᵢ over a list of vertices: one stiff combination of many vertices, such as the
/// volume of a body.
struct RankOneTerm {
  double factor = 0;  ///< ≥ 0, already scaled
  std::vector<int> vertices;
  std::vector<Vec3> gradients;  ///< #vertices, gᵢ
};

class HessianSink {
 public:
  virtual ~HessianSink() = default;

  /// The factor of the Hessians in the system: dt² [s²].
  virtual double scale() const = 0;
  /// Returns the masses of all vertices, #V [kg]; those of held vertices are not 0 either.
  virtual std::span<const double> masses() const = 0;
  virtual std::span<const std::uint8_t> fixed() const = 0;

  /// Sets the Hessian of springs ½ k (|z| − r)² at x, the body's positions. A vertex has springs of one
  /// network only. `kinds` by CouplingRun::kind, k already scaled.
  virtual void set_springs(const std::shared_ptr<const SpringNetwork>& network,
                           std::span<const CentralSpring> kinds, ConstVectors x, std::size_t first) = 0;
  /// Adds dashpots k n nᵀ along springs already set. n is parallel to those springs; x counts where a spring
  /// has no direction.
  virtual void add_dashpots(const std::shared_ptr<const SpringNetwork>& network,
                            std::span<const CentralSpring> kinds, ConstVectors x, std::size_t first) = 0;

  /// Returns the blocks of a pattern, to which potentials add; all zero at the first request. The sum must be
  /// symmetric and, with the masses, positive definite.
  virtual PairBlocks pair_blocks(const std::shared_ptr<const SymmetricPattern>& pattern,
                                 std::size_t first) = 0;

  /// Returns the blocks of a pattern like pair_blocks, without setting them to zero. At the first request,
  /// `fresh`, the potential sets every block except the diagonal ones, which stand_in makes; at later ones it
  /// adds.
  virtual PairBlocks pair_blocks_to_set(const std::shared_ptr<const SymmetricPattern>& pattern,
                                        std::size_t first, bool& fresh) = 0;

  /// Makes the blocks of a pattern couplings between the ends of springs, which the linear solver handles
  /// like springs. The network has a spring for every pair of the pattern. Every row of the blocks sums to
  /// zero, so the diagonal ones need not be set. Springs of these `kinds`, k n nᵀ along the directions at x,
  /// replace the blocks on the coarse grid, and everywhere if the blocks are found to be indefinite; hence
  /// the blocks may be a true Hessian. Several calls for one pattern add their springs.
  virtual void stand_in(const std::shared_ptr<const SymmetricPattern>& pattern,
                        const std::shared_ptr<const SpringNetwork>& network,
                        std::span<const CentralSpring> kinds, ConstVectors x, std::size_t first) = 0;

  /// Returns `terms` new terms with `weights` weights in all between `count` vertices, each of which is to be
  /// set. Held vertices are left out by the potential.
  virtual RelativeTerms relative_terms(std::size_t first, std::size_t count, std::size_t terms,
                                       std::size_t weights) = 0;

  /// Adds factor · Σ c_ef gₑ g_fᵀ with the coefficients c of `coupling`, which may be indefinite as long as
  /// the sum is not. Returns g, four vectors and a zero each a form, to be set.
  virtual Float4* coupled_forms(const std::shared_ptr<const FormCoupling>& coupling, std::size_t first,
                                double factor) = 0;

  /// Returns the multiples of the identity on `count` vertices, to which potentials add.
  virtual std::span<float> identity(std::size_t first, std::size_t count) = 0;

  virtual void add_rank_one(RankOneTerm term, std::size_t first) = 0;

  /// Adds a potential by its product in double and its diagonal blocks: the last resort, as every iteration
  /// of the linear solver computes from x, which is kept by reference.
  virtual void add_general(const Potential& potential, std::size_t first, ConstVectors x) = 0;
};

}  // namespace muslin
