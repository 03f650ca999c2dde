#include "muslin/energy/spring_couplings.hpp"

#include <algorithm>
#include <cmath>

#include "muslin/core/parallel.hpp"
#include "muslin/core/vector_code.hpp"
#include "muslin/energy/spring_kernels.hpp"

namespace muslin {
namespace {

constexpr int lanes = CouplingPattern::lanes;
constexpr std::size_t batch = 32;    // blocks computed together
constexpr std::size_t grain = 1024;  // blocks
constexpr float shortest = static_cast<float>(shortest_spring);

/// x in the order of the pattern, 0 where a position is empty.
Columns arrange(const CouplingPattern& pattern, ConstVectors x, Linearization& into) {
  const std::size_t size = pattern.position_count();
  auto* const to = reinterpret_cast<double*>(into.workspace(2 * 3 * size).data());
  const int* const vertices = pattern.vertices().data();
  constexpr std::size_t ahead = 64;
  parallel_for(size, 8192, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      // The order of the pattern jumps from row to row, which processors do not foresee.
      const int v = vertices[i], next = vertices[std::min(i + ahead, end - 1)];
      if (next >= 0) __builtin_prefetch(x.data() + next);
      const Vec3 at = v < 0 ? Vec3(Vec3::Zero()) : x[static_cast<std::size_t>(v)];
      to[i] = at.x(), to[size + i] = at.y(), to[2 * size + i] = at.z();
    }
  });
  return {to, to + size, to + 2 * size};
}

/// Differences between the ends of the couplings of `count` blocks.
MUSLIN_VECTOR_CODE void edge_vectors(const CouplingPattern::Block* blocks, std::size_t count,
                                     const double* __restrict x, float* __restrict z) {
  for (std::size_t b = 0; b < count; ++b) {
    const CouplingPattern::Block& block = blocks[b];
    const double* const later = x + lanes * static_cast<std::ptrdiff_t>(block.group);
    const double *const first = x + block.first, *const second = x + block.second;
    if (block.cut == 0) {
      for (int l = 0; l < lanes; ++l) z[l] = static_cast<float>(later[l] - second[l]);
    } else {
      for (int l = 0; l < lanes; ++l)
        z[l] = static_cast<float>(later[l] - (l < block.cut ? first[l] : second[l]));
    }
    z += lanes;
  }
}

struct Batch {
  alignas(64) float weight[batch * lanes];
  alignas(64) float zx[batch * lanes], zy[batch * lanes], zz[batch * lanes];
  alignas(64) float sx[batch * lanes], sy[batch * lanes], sz[batch * lanes], t[batch * lanes];
};

/// z in zx, zy, zz; s and t receive the couplings.
MUSLIN_VECTOR_CODE void spring_couplings(const CouplingPattern::Block* blocks, std::size_t count,
                                         const BlockSprings::Type* types, Batch& batch) {
  for (std::size_t b = 0; b < count; ++b) {
    const float k = types[blocks[b].kind].k, rest = types[blocks[b].kind].rest, least = shortest * rest;
    for (std::size_t i = b * lanes; i < (b + 1) * lanes; ++i) {
      const float zx = batch.zx[i], zy = batch.zy[i], zz = batch.zz[i];
      const float length = std::sqrt(zx * zx + zy * zy + zz * zz);
      const float k_i = k * batch.weight[i];
      const float per_length = 1.0F / length;
      const float ratio = length > least ? rest * per_length : 0.0F;
      const float scaled = std::sqrt(k_i * ratio) * per_length;
      const float scale = length > least ? scaled : 0.0F;
      batch.sx[i] = scale * zx, batch.sy[i] = scale * zy, batch.sz[i] = scale * zz;
      batch.t[i] = k_i * (1.0F - ratio);
    }
  }
}

MUSLIN_VECTOR_CODE void dashpot_couplings(const CouplingPattern::Block* blocks, std::size_t count,
                                          const BlockSprings::Type* types, Batch& batch) {
  for (std::size_t b = 0; b < count; ++b) {
    const float k = types[blocks[b].kind].k;
    for (std::size_t i = b * lanes; i < (b + 1) * lanes; ++i) {
      const float zx = batch.zx[i], zy = batch.zy[i], zz = batch.zz[i];
      const float sx = batch.sx[i], sy = batch.sy[i], sz = batch.sz[i];
      const float square = sx * sx + sy * sy + sz * sz;
      const bool along_s = square > 0.0F;
      const float base = along_s ? square : zx * zx + zy * zy + zz * zz;
      const float grown = std::sqrt((square + k * batch.weight[i]) / base);
      const float scale = base > 0.0F ? grown : 0.0F;
      batch.sx[i] = scale * (along_s ? sx : zx);
      batch.sy[i] = scale * (along_s ? sy : zy);
      batch.sz[i] = scale * (along_s ? sz : zz);
    }
  }
}

/// body(first block, count, batch) for all blocks, with z and the weights in the batch.
template <class Body>
void for_each_batch(const BlockSprings& springs, ConstVectors x, Linearization& into, const Body& body) {
  const CouplingPattern& pattern = *springs.pattern;
  const Columns at = arrange(pattern, x, into);
  parallel_for(pattern.block_count(), grain, [&](std::size_t begin, std::size_t end) {
    Batch buffers;
    for (std::size_t block = begin; block < end; block += batch) {
      const std::size_t count = std::min(batch, end - block);
      const CouplingPattern::Block* const blocks = pattern.blocks().data() + block;
      for (std::size_t b = 0; b < count; ++b) {
        for (std::size_t l = 0; l < lanes; ++l) {
          const bool used = (blocks[b].used >> l & 1) != 0;
          buffers.weight[b * lanes + l] = !used ? 0.0F
                                          : springs.weights == nullptr
                                              ? 1.0F
                                              : springs.weights[(block + b) * lanes + l];
        }
      }
      edge_vectors(blocks, count, at.x, buffers.zx);
      edge_vectors(blocks, count, at.y, buffers.zy);
      edge_vectors(blocks, count, at.z, buffers.zz);
      body(block, count, buffers);
    }
  });
}

}  // namespace

void set_spring_couplings(const BlockSprings& springs, ConstVectors x, std::size_t first,
                          Linearization& into) {
  Couplings& couplings = into.couplings(springs.pattern, first);
  for_each_batch(springs, x, into, [&](std::size_t block, std::size_t count, Batch& b) {
    spring_couplings(springs.pattern->blocks().data() + block, count, springs.types.data(), b);
    couplings.store(block, count, b.sx, b.sy, b.sz, b.t);
  });
}

void add_dashpot_couplings(const BlockSprings& dashpots, ConstVectors x, std::size_t first,
                           Linearization& into) {
  Couplings& couplings = into.couplings(dashpots.pattern, first);
  for_each_batch(dashpots, x, into, [&](std::size_t block, std::size_t count, Batch& b) {
    couplings.load(block, count, b.sx, b.sy, b.sz, b.t);
    dashpot_couplings(dashpots.pattern->blocks().data() + block, count, dashpots.types.data(), b);
    couplings.store(block, count, b.sx, b.sy, b.sz, b.t);
  });
}

}  // namespace muslin
