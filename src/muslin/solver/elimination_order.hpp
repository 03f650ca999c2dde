// EliminationOrder stores the pairs of coupled vertices of a body, in the elimination order of the inner
// solver.
//
// Vertices are cut into slabs, eliminated in parallel: even slabs upwards, odd ones downwards, so that two of
// them meet without a gap (a twisted factorisation). Where an odd slab meets the one below, a thin layer is
// eliminated after both; where an even slab begins above an odd one, a thin layer is eliminated first. Within
// each of these tasks the level of a vertex is one more than the highest level of its earlier coupled
// vertices. Vertices of one level do not depend on each other: 16 of them make a group, one per vector lane.
//
// Positions number the vertices in this order, 16 for each group, some of them empty. In a lattice the
// neighbours of the lanes of a group lie at consecutive positions, with few breaks: a block of couplings
// needs two base positions and no index per coupling. The order depends on the pattern alone, so the bits are
// the same for any thread count.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "muslin/potential/spring_network.hpp"

namespace muslin {

class EliminationOrder {
 public:
  static constexpr int lanes = 16;

  /// Couplings of one kind between the vertices of a group and earlier ones, at most one per lane.
  struct Block {
    int group = 0;
    int first = 0, second = 0;  ///< lane l's earlier end is at position l + (l < cut ? first : second)
    std::uint8_t cut = 0;
    std::uint8_t kind = 0;
    std::uint16_t used = 0;  ///< bit l: lane l has a coupling
  };
  /// The couplings from their earlier ends: where bit l of used[i] is set, lane l of the group is coupled to
  /// position l + position[i] by lane l + shift[i] of block[i].
  struct Link {
    std::array<int, 2> position{}, block{};
    std::array<std::uint16_t, 2> used{};
    std::array<std::int8_t, 2> shift{};
  };
  struct Group {
    int block_begin = 0, block_end = 0;
    int link_begin = 0, link_end = 0;
  };
  /// Consecutive groups, eliminated in this order.
  struct Task {
    int group_begin = 0, group_end = 0;
  };

  /// `order`, if not null, receives 16 numbers for each block: the coupling of each lane (counted through
  /// `runs`), −1 for none.
  EliminationOrder(std::span<const CouplingRun> runs, int vertex_count,
                   std::vector<std::int64_t>* order = nullptr);

  int vertex_count() const { return static_cast<int>(position_.size()); }
  std::size_t position_count() const { return vertex_.size(); }
  std::size_t block_count() const { return blocks_.size(); }
  /// Returns −1 for an empty position.
  int vertex(std::size_t position) const { return vertex_[position]; }
  int position(std::size_t vertex) const { return position_[vertex]; }
  const std::vector<int>& vertices() const { return vertex_; }

  const std::vector<Group>& groups() const { return groups_; }
  const std::vector<Block>& blocks() const { return blocks_; }
  const std::vector<Link>& links() const { return links_; }
  const std::vector<Task>& tasks() const { return tasks_; }
  /// Phase p holds tasks phases()[p] … phases()[p+1] − 1, independent of each other.
  const std::vector<int>& phases() const { return phases_; }
  std::size_t bytes() const;

 private:
  struct Coupling {
    int vertex = 0;  // eliminated earlier
    int kind = 0;    // twice the owner's, plus one where it has the lower index
    std::int64_t index = 0;
  };
  /// Couplings of each vertex with earlier ones: begin[v] … begin[v+1] − 1.
  struct EarlierEnds {
    std::vector<std::int64_t> begin;
    std::vector<Coupling> couplings;
  };
  /// The vertices that each task eliminates, in order; by vertex its task and its rank there.
  struct Split {
    std::vector<std::vector<int>> members;
    std::vector<int> task, rank;
    std::array<int, 4> phase{};  // first task of each, and the number of tasks
    bool before(int u, int v) const;
  };
  Split split(std::span<const CouplingRun> runs) const;
  /// `by_count`: sorts the vertices of one level by having many couplings, then by index.
  void arrange(const EarlierEnds& earlier, const Split& split, bool by_count);
  void make_blocks(const EarlierEnds& earlier, std::vector<std::int64_t>* order);
  void make_links();

  std::vector<int> vertex_, position_;
  std::vector<Group> groups_;
  std::vector<Block> blocks_;
  std::vector<Link> links_;
  std::vector<Task> tasks_;
  std::vector<int> phases_;
};

}  // namespace muslin
