#include "muslin/energy/spring_slabs.hpp"

#include <tuple>

namespace muslin {
namespace {

constexpr int largest_slab_count = 64;
constexpr int smallest_slab = 2048;  // vertices
constexpr int reaches_per_slab = 4;  // springs between slabs are computed twice: keep them few

}  // namespace

SpringSlabs::SpringSlabs(const std::vector<CouplingRun>& runs, int vertex_count) {
  int reach = 0;
  for (const CouplingRun& run : runs) reach = std::max(reach, run.b - run.a);
  int slab_size = std::max({smallest_slab, vertex_count / largest_slab_count, reaches_per_slab * reach});
  slab_size = (slab_size + block_size - 1) / block_size * block_size;

  std::int64_t slot = 0;
  for (const CouplingRun& run : runs) {
    for (int i = 0; i < run.length;) {
      const int a = run.a + i, b = run.b + i;
      const int end = std::min(
          {run.length, (a / block_size + 1) * block_size - run.a, (b / slab_size + 1) * slab_size - run.b});
      SpringPiece part{run.kind, a, b, end - i, slot + i, Ends::both};
      if (a / slab_size != b / slab_size) {
        part.ends = Ends::b;
        pieces_.push_back(part);
        part.ends = Ends::a;
      }
      pieces_.push_back(part);
      i = end;
    }
    slot += run.length;
  }
  const auto block_of = [](const SpringPiece& p) { return (p.ends == Ends::b ? p.b : p.a) / block_size; };
  std::sort(pieces_.begin(), pieces_.end(), [&](const SpringPiece& p, const SpringPiece& q) {
    return std::tuple(block_of(p), p.ends, p.direction, p.a) <
           std::tuple(block_of(q), q.ends, q.direction, q.a);
  });

  std::size_t at = 0;
  for (int begin = 0; begin < vertex_count; begin += slab_size) {
    Slab slab;
    slab.begin = slab.read_begin = begin;
    slab.end = slab.read_end = std::min(begin + slab_size, vertex_count);
    slab.block_begin = blocks_.size();
    for (int v = begin; v < slab.end; v += block_size) {
      Block block;
      block.begin = v;
      block.end = block.read_end = block.written_end = std::min(v + block_size, slab.end);
      block.piece_begin = at;
      for (; at < pieces_.size() && block_of(pieces_[at]) == v / block_size; ++at) {
        const SpringPiece& piece = pieces_[at];
        const int end = piece.b + piece.length;
        slab.read_begin = std::min(slab.read_begin, piece.a);
        block.read_end = std::max(block.read_end, end);
        if (piece.ends != Ends::a) block.written_end = std::max(block.written_end, end);
      }
      block.piece_end = at;
      slab.read_end = std::max(slab.read_end, block.read_end);
      blocks_.push_back(block);
    }
    slab.block_end = blocks_.size();
    slabs_.push_back(slab);
  }
}

}  // namespace muslin
