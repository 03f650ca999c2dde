// Linearization is the Hessian of an incremental potential at one x in float, for the inner solver.
//
//   H = diag(identity) + couplings + K,   K = block matrices + the loose rest,
//
// where the loose rest consists of relative stiffnesses, coupled forms, rank-one terms and general
// potentials.
//
// It is the HessianSink to which potentials add themselves (Potential::linearize): springs become couplings,
// pair blocks matrices, contacts relative stiffness; general potentials are multiplied in double.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "muslin/core/buffer.hpp"
#include "muslin/core/vectors.hpp"
#include "muslin/potential/hessian_sink.hpp"
#include "muslin/potential/spring_network.hpp"
#include "muslin/solver/coupled_forms.hpp"
#include "muslin/solver/full_couplings.hpp"
#include "muslin/solver/relative_stiffness.hpp"
#include "muslin/solver/spring_hessian.hpp"
#include "muslin/solver/symmetric_matrix.hpp"

namespace muslin {

class Linearization : public HessianSink {
 public:
  /// Resets to H = M; potentials are multiplied by `scale`.
  void reset(std::span<const double> masses, std::span<const std::uint8_t> fixed, double scale);

  std::size_t size() const { return identity_.size(); }
  double scale() const override { return scale_; }
  std::span<const double> masses() const override { return masses_; }
  std::span<const std::uint8_t> fixed() const override { return fixed_; }

  void set_springs(const std::shared_ptr<const SpringNetwork>& network, std::span<const CentralSpring> kinds,
                   ConstVectors x, std::size_t first) override;
  void add_dashpots(const std::shared_ptr<const SpringNetwork>& network, std::span<const CentralSpring> kinds,
                    ConstVectors x, std::size_t first) override;
  PairBlocks pair_blocks(const std::shared_ptr<const SymmetricPattern>& pattern, std::size_t first) override {
    return matrix(pattern, first).blocks();
  }
  PairBlocks pair_blocks_to_set(const std::shared_ptr<const SymmetricPattern>& pattern, std::size_t first,
                                bool& fresh) override;
  void stand_in(const std::shared_ptr<const SymmetricPattern>& pattern,
                const std::shared_ptr<const SpringNetwork>& network, std::span<const CentralSpring> kinds,
                ConstVectors x, std::size_t first) override;
  RelativeTerms relative_terms(std::size_t first, std::size_t count, std::size_t terms,
                               std::size_t weights) override;
  Float4* coupled_forms(const std::shared_ptr<const FormCoupling>& coupling, std::size_t first,
                        double factor) override;
  std::span<float> identity(std::size_t first, std::size_t count) override {
    return {identity_.data() + first, count};
  }
  void add_rank_one(RankOneTerm term, std::size_t first) override;
  void add_general(const Potential& potential, std::size_t first, ConstVectors x) override;

  /// Returns the couplings of this pattern on vertices first, first + 1, …; zero at the first request. A
  /// vertex has couplings of one pattern only.
  SpringHessian& couplings(const std::shared_ptr<const EliminationOrder>& pattern, std::size_t first);
  /// Returns the matrix of this pattern on vertices first, first + 1, …; at the first request zero, or
  /// undefined if it need not be.
  SymmetricMatrix& matrix(const std::shared_ptr<const SymmetricPattern>& pattern, std::size_t first,
                          bool zero = true);

  /// Call when all potentials have been added.
  void finish();

  /// Leaves out the negative eigenvalues of the couplings; springs replace the full couplings for which they
  /// stand in.
  void project();

  /// Returns scratch memory for the solver, valid until the next call or until a potential is added.
  std::span<float> workspace(std::size_t count) {
    if (workspace_.size() < count) workspace_.resize(count);
    return {workspace_.data(), count};
  }

  /// Returns the couplings of all vertices in ascending order, empty ones for vertices without any.
  std::span<const SpringHessian* const> sets() const { return sets_; }
  /// Computes the springs that stand in for full couplings; sets() contains them only from then on.
  void fill_stand_ins();
  /// Returns the full couplings for which the springs of a set stand in, null if there are none.
  const FullCouplings* full(const SpringHessian& set) const;
  /// Returns the block matrices except those for which springs stand in.
  std::span<const SymmetricMatrix* const> matrices() const { return matrices_; }
  bool has_springs() const;
  const float* identity() const { return identity_.data(); }

  /// True if K is not zero.
  bool has_remainder() const {
    return !matrices_.empty() || !generals_.empty() || relative_count_ > 0 || forms_count_ > 0 ||
           !rank_ones_.empty();
  }
  /// Diagonal blocks of K without the coupled forms, with the identity positive definite: xx, xy, xz of
  /// `upper` and yy, yz, zz of `lower`, #V by 3. Relative stiffnesses are scaled down where masses would be
  /// lost to rounding.
  const FloatVectors& remainder_upper() const { return upper_; }
  const FloatVectors& remainder_lower() const { return lower_; }
  /// Returns the largest ratio of the trace of a relative stiffness's diagonal block to the vertex's entry of
  /// `identity`.
  double stiffest_relative() const { return stiffest_relative_; }
  /// y += K p, three floats and a zero per vertex; returns pᵀK p.
  double add_remainder_product(const Float4* p, Float4* y);

  std::size_t bytes() const;

 private:
  struct General {
    const Potential* potential;
    std::size_t first;
    ConstVectors x;
  };
  /// A network in the order of elimination.
  struct Arranged {
    std::shared_ptr<const SpringNetwork> network;
    std::shared_ptr<const EliminationOrder> pattern;
    std::vector<float> weights;  // 16 each block; empty: all 1
  };
  struct RankOne {
    RankOneTerm term;
    std::size_t first;
  };
  /// Springs in place of a matrix.
  struct StandIn {
    std::shared_ptr<const SymmetricPattern> pattern;
    std::shared_ptr<const SpringNetwork> network;
    std::vector<int> slots;            // as of FullCouplings::set
    std::vector<CentralSpring> kinds;  // at this x; empty if not used
    ConstVectors x;
    std::size_t first = 0;
    FullCouplings full;
    SpringHessian* springs = nullptr;  // replaced by `full` while that is in use
    bool filled = false;               // `springs` are computed
    bool in_use = true;                // `full` is
  };
  void put_stand_ins();
  const Arranged& arranged(const std::shared_ptr<const SpringNetwork>& network);
  void cover_gap(std::size_t begin, std::size_t end);
  void find_remainder_diagonal();

  std::span<const double> masses_;
  std::span<const std::uint8_t> fixed_;
  double scale_ = 1;
  Buffer<float> identity_, workspace_;
  std::vector<std::unique_ptr<SpringHessian>> storage_;  // reused from step to step
  std::vector<const SpringHessian*> sets_;               // of this x
  std::vector<std::unique_ptr<SymmetricMatrix>> matrix_storage_;
  std::vector<const SymmetricMatrix*> matrices_;
  std::vector<const SymmetricMatrix*> stood_for_;    // of this x
  std::vector<std::unique_ptr<StandIn>> stand_ins_;  // reused from step to step
  std::vector<General> generals_;
  std::vector<RankOne> rank_ones_;
  std::vector<std::unique_ptr<Arranged>> networks_;            // reused from step to step
  std::vector<std::unique_ptr<RelativeStiffness>> relatives_;  // reused from step to step
  std::size_t relative_count_ = 0;                             // of this x
  std::vector<std::unique_ptr<CoupledForms>> forms_;           // reused from step to step
  std::size_t forms_count_ = 0;                                // of this x
  FloatVectors upper_, lower_;
  double stiffest_relative_ = 0;
  std::vector<Vec3> p_, y_;  // for products in double
  std::vector<Mat3> blocks_;
};

}  // namespace muslin
