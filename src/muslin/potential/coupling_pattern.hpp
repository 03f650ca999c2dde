// Which vertices of a body are coupled in pairs, in the order in which the inner solver walks them.
//
// A lattice's couplings come in runs a+i — b+i of constant b − a, so that they need no index arrays. Vertices
// are cut into slabs, one task each, and slabs into blocks that fit the first-level cache. A task writes to
// the vertices of its own slab only: a coupling between two slabs is computed by both. All sizes depend on
// the pattern alone, hence the same bits for any thread count.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace muslin {

/// Couplings of vertices a + i and b + i, 0 ≤ i < length. `axis` is the lattice axis (0 x, 1 y, 2 z) that
/// they run along if chains of them are stiff lines of the body, −1 otherwise.
struct CouplingRun {
  int kind = 0;  ///< the owner's own number
  int axis = -1;
  int a = 0, b = 0, length = 0;
};

/// Part of a run with a in one block and b in one slab. Its coefficients are slots slot … slot + length − 1.
struct CouplingPiece {
  int kind = 0;
  int axis = -1;
  int a = 0, b = 0, length = 0;  ///< a < b
  std::int64_t slot = 0;
  int index = 0;  ///< of the piece
};

/// A stretch of vertices whose predecessors (or successors) along an axis are consecutive too, or that have
/// none (other = −1).
struct LineSegment {
  int vertex = 0, other = -1, length = 0;
  int piece = -1;          ///< of the couplings between the two
  int offset = 0;          ///< of the first coupling in its piece
  std::int64_t pivot = 0;  ///< place of the first vertex in the order of the groups
};

/// The lines along one axis, in groups of neighbouring lines.
struct LinePattern {
  struct Group {
    int forward_begin = 0, forward_end = 0;    ///< segments in ascending order, with their predecessors
    int backward_begin = 0, backward_end = 0;  ///< segments in descending order, with their successors
  };
  std::vector<Group> groups;
  std::vector<LineSegment> forward, backward;
  std::vector<int> tasks;  ///< task t solves groups tasks[t] … tasks[t+1] − 1
};

class CouplingPattern {
 public:
  struct Block {
    int begin = 0, end = 0;                    ///< vertices
    int start_begin = 0, start_end = 0;        ///< vertices first touched by this block
    int own_begin = 0, own_end = 0;            ///< pieces with both ends in the slab
    int leaving_begin = 0, leaving_end = 0;    ///< pieces with only a in the slab
    int entering_begin = 0, entering_end = 0;  ///< entries of entering(), b in this block's slab
  };
  struct Slab {
    int block_begin = 0, block_end = 0;
  };
  struct Chain {
    int vertex = 0, length = 0;
  };
  static constexpr int block_size = 1024;  // vertices
  static constexpr int lanes = 16;         // chains solved side by side

  CouplingPattern(std::vector<CouplingRun> runs, int vertex_count);

  int vertex_count() const { return vertex_count_; }
  std::int64_t slot_count() const { return slot_count_; }
  const std::vector<CouplingPiece>& pieces() const { return pieces_; }
  const std::vector<Block>& blocks() const { return blocks_; }
  const std::vector<Slab>& slabs() const { return slabs_; }
  const std::vector<int>& entering() const { return entering_; }
  /// Pieces of each slab by the slab of a: slab s has first_piece()[s] … first_piece()[s+1] − 1.
  const std::vector<int>& first_piece() const { return first_piece_; }

  /// Chains of consecutive vertices (b = a + 1) along axis 0, every vertex in one; longest first, bundle by
  /// bundle of `lanes`.
  const std::vector<Chain>& chains() const { return chains_; }
  /// The couplings of axis-0 chains: piece and offset of that between v and v + 1, −1 where there is none.
  struct Link {
    int piece = -1, offset = 0;
  };
  const std::vector<Link>& chain_links() const { return chain_links_; }
  /// Lines along axes 1 and 2.
  const LinePattern& lines(int axis) const { return lines_[axis - 1]; }
  std::size_t bytes() const;

 private:
  void cut(const std::vector<CouplingRun>& runs);
  void find_chains();
  void find_lines(int axis);

  int vertex_count_;
  std::int64_t slot_count_ = 0;
  std::vector<CouplingPiece> pieces_;
  std::vector<Block> blocks_;
  std::vector<Slab> slabs_;
  std::vector<int> entering_, first_piece_;
  std::vector<Chain> chains_;
  std::vector<Link> chain_links_;
  LinePattern lines_[2];
};

}  // namespace muslin
