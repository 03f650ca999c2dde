#include "muslin/potential/coupling_pattern.hpp"

#include <algorithm>
#include <cassert>
#include <cstdlib>
#include <numeric>

namespace muslin {
namespace {

constexpr int largest_slab_count = 64;
constexpr int smallest_slab = 2048;   // vertices
constexpr int reaches_per_slab = 4;   // a coupling between slabs is computed twice: keep them few
constexpr int lines_per_group = 128;  // the same vector lanes at every step along the lines
constexpr int vertices_per_task = 4096;

}  // namespace

CouplingPattern::CouplingPattern(std::vector<CouplingRun> runs, int vertex_count)
    : vertex_count_(vertex_count) {
  for (CouplingRun& run : runs) {
    assert(run.a != run.b);
    if (run.b < run.a) std::swap(run.a, run.b);
  }
  cut(runs);
  find_chains();
  find_lines(1);
  find_lines(2);
}

void CouplingPattern::cut(const std::vector<CouplingRun>& runs) {
  int reach = 0;
  for (const CouplingRun& run : runs) reach = std::max(reach, run.b - run.a);
  int slab_size = std::max({smallest_slab, vertex_count_ / largest_slab_count, reaches_per_slab * reach});
  slab_size = (slab_size + block_size - 1) / block_size * block_size;

  for (const CouplingRun& run : runs) {
    for (int i = 0; i < run.length;) {
      const int a = run.a + i, b = run.b + i;
      const int end = std::min(
          {run.length, (a / block_size + 1) * block_size - run.a, (b / slab_size + 1) * slab_size - run.b});
      pieces_.push_back({run.kind, run.axis, a, b, end - i, 0, 0});
      i = end;
    }
  }
  const auto leaves = [&](const CouplingPiece& p) { return p.a / slab_size != p.b / slab_size; };
  std::stable_sort(pieces_.begin(), pieces_.end(), [&](const CouplingPiece& p, const CouplingPiece& q) {
    const int block_p = p.a / block_size, block_q = q.a / block_size;
    if (block_p != block_q) return block_p < block_q;
    if (leaves(p) != leaves(q)) return leaves(q);
    return p.kind < q.kind;
  });
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    pieces_[i].index = static_cast<int>(i);
    pieces_[i].slot = slot_count_;
    slot_count_ += pieces_[i].length;
  }

  for (const CouplingPiece& piece : pieces_)
    if (leaves(piece)) entering_.push_back(piece.index);
  std::stable_sort(entering_.begin(), entering_.end(), [&](int p, int q) {
    return pieces_[static_cast<std::size_t>(p)].b / block_size <
           pieces_[static_cast<std::size_t>(q)].b / block_size;
  });

  std::size_t at = 0, entered = 0;
  for (int begin = 0; begin < vertex_count_; begin += slab_size) {
    Slab slab{static_cast<int>(blocks_.size()), 0};
    const int slab_end = std::min(begin + slab_size, vertex_count_);
    first_piece_.push_back(static_cast<int>(at));
    int started = begin;
    for (int v = begin; v < slab_end; v += block_size) {
      Block block;
      block.begin = v;
      block.end = std::min(v + block_size, slab_end);
      int touched = block.end;
      block.own_begin = static_cast<int>(at);
      for (; at < pieces_.size() && pieces_[at].a < block.end && !leaves(pieces_[at]); ++at)
        touched = std::max(touched, pieces_[at].b + pieces_[at].length);
      block.own_end = block.leaving_begin = static_cast<int>(at);
      while (at < pieces_.size() && pieces_[at].a < block.end) ++at;
      block.leaving_end = static_cast<int>(at);
      block.entering_begin = static_cast<int>(entered);
      for (; entered < entering_.size(); ++entered) {
        const CouplingPiece& piece = pieces_[static_cast<std::size_t>(entering_[entered])];
        if (piece.b >= block.end) break;
        touched = std::max(touched, piece.b + piece.length);
      }
      block.entering_end = static_cast<int>(entered);
      block.start_begin = started;
      block.start_end = started = std::max(started, std::min(touched, slab_end));
      blocks_.push_back(block);
    }
    slab.block_end = static_cast<int>(blocks_.size());
    slabs_.push_back(slab);
  }
  first_piece_.push_back(static_cast<int>(at));
}

void CouplingPattern::find_chains() {
  chain_links_.resize(static_cast<std::size_t>(vertex_count_));
  for (const CouplingPiece& piece : pieces_) {
    if (piece.axis != 0 || piece.b != piece.a + 1) continue;
    for (int i = 0; i < piece.length; ++i)
      chain_links_[static_cast<std::size_t>(piece.a + i)] = {piece.index, i};
  }
  for (int v = 0; v < vertex_count_;) {
    int end = v + 1;
    while (chain_links_[static_cast<std::size_t>(end - 1)].piece >= 0) ++end;
    chains_.push_back({v, end - v});
    v = end;
  }
  // Chains of one bundle run side by side: alike in length, neighbours where possible.
  std::stable_sort(chains_.begin(), chains_.end(),
                   [](const Chain& p, const Chain& q) { return p.length > q.length; });
}

void CouplingPattern::find_lines(int axis) {
  LinePattern& lines = lines_[axis - 1];
  const auto count = static_cast<std::size_t>(vertex_count_);
  struct Neighbour {
    int vertex = -1, piece = -1, offset = 0;
  };
  std::vector<Neighbour> before(count), after(count);
  for (const CouplingPiece& piece : pieces_) {
    if (piece.axis != axis) continue;
    for (int i = 0; i < piece.length; ++i) {
      before[static_cast<std::size_t>(piece.b + i)] = {piece.a + i, piece.index, i};
      after[static_cast<std::size_t>(piece.a + i)] = {piece.b + i, piece.index, i};
    }
  }

  // A line belongs to the group of the line beside it, as long as that is not full.
  std::vector<int> group(count), size;
  for (std::size_t v = 0; v < count; ++v) {
    if (before[v].vertex >= 0) {
      group[v] = group[static_cast<std::size_t>(before[v].vertex)];
      continue;
    }
    const int beside = v > 0 ? group[v - 1] : -1;
    const bool grows = v > 0 && before[v - 1].vertex >= 0;  // the row is longer than the one before it
    if (beside >= 0 && size[static_cast<std::size_t>(beside)] < (grows ? 2 : 1) * lines_per_group) {
      group[v] = beside;
      ++size[static_cast<std::size_t>(beside)];
    } else {
      group[v] = static_cast<int>(size.size());
      size.push_back(1);
    }
  }
  std::vector<int> order(count);
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int p, int q) {
    return group[static_cast<std::size_t>(p)] < group[static_cast<std::size_t>(q)];
  });

  // Consecutive in vertex, in neighbour and in the piece between.
  const auto segments = [&](std::vector<LineSegment>& out, const std::vector<Neighbour>& neighbour,
                            std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const int v = order[i];
      const Neighbour& n = neighbour[static_cast<std::size_t>(v)];
      if (i > begin) {
        LineSegment& last = out.back();
        const bool next = v == last.vertex + last.length;
        const bool alike = n.piece == last.piece && (n.piece < 0 || n.offset == last.offset + last.length);
        // Vertices of one segment are solved side by side: none may be another's neighbour.
        const bool apart = n.piece < 0 || last.length < std::abs(last.vertex - last.other);
        if (next && alike && apart) {
          ++last.length;
          continue;
        }
      }
      out.push_back({v, n.vertex, 1, n.piece, n.offset, static_cast<std::int64_t>(i)});
    }
  };
  for (std::size_t begin = 0; begin < count;) {
    const int g = group[static_cast<std::size_t>(order[begin])];
    std::size_t end = begin;
    while (end < count && group[static_cast<std::size_t>(order[end])] == g) ++end;
    LinePattern::Group out;
    out.forward_begin = static_cast<int>(lines.forward.size());
    segments(lines.forward, before, begin, end);
    out.forward_end = static_cast<int>(lines.forward.size());
    out.backward_begin = static_cast<int>(lines.backward.size());
    segments(lines.backward, after, begin, end);
    out.backward_end = static_cast<int>(lines.backward.size());
    std::reverse(lines.backward.begin() + out.backward_begin, lines.backward.begin() + out.backward_end);
    if (lines.tasks.empty() || static_cast<int>(begin) - lines.tasks.back() >= vertices_per_task)
      lines.tasks.push_back(static_cast<int>(begin));
    lines.groups.push_back(out);
    begin = end;
  }
  // tasks holds first vertices so far: turn them into groups.
  std::vector<int> first_group;
  std::size_t at = 0, g = 0;
  for (const LinePattern::Group& each : lines.groups) {
    if (first_group.size() < lines.tasks.size() && static_cast<int>(at) == lines.tasks[first_group.size()])
      first_group.push_back(static_cast<int>(g));
    for (int s = each.forward_begin; s < each.forward_end; ++s)
      at += static_cast<std::size_t>(lines.forward[static_cast<std::size_t>(s)].length);
    ++g;
  }
  first_group.push_back(static_cast<int>(lines.groups.size()));
  lines.tasks = std::move(first_group);
}

std::size_t CouplingPattern::bytes() const {
  std::size_t bytes = pieces_.size() * sizeof(CouplingPiece) + blocks_.size() * sizeof(Block) +
                      chains_.size() * sizeof(Chain) + chain_links_.size() * sizeof(Link);
  for (const LinePattern& lines : lines_)
    bytes += (lines.forward.size() + lines.backward.size()) * sizeof(LineSegment);
  return bytes;
}

}  // namespace muslin
