// Builds the springs of a lattice, by direction, and its tetrahedra.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "muslin/api.hpp"
#include "muslin/lattice/lattice.hpp"

namespace muslin {

enum class Bracing {
  kuhn,  ///< the edges of the six tetrahedra: 19 springs in a lone voxel, 7 directions
  full,  ///< both diagonals of each face and all four of the body: 28 springs in a lone voxel, 13 directions
};
enum class SpringKind : std::uint8_t { edge, face_diagonal, body_diagonal };

/// Integer offsets b − a of the directions. The first seven are those of the Kuhn split: the offsets
/// {0,1}³ without 0, so that the body diagonal runs along (1,1,1).
struct SpringDirection {
  Vec3i offset;
  SpringKind kind;
};
MUSLIN_API std::vector<SpringDirection> spring_directions(Bracing bracing);

/// Springs of one direction along one contiguous piece of a row: spring i joins vertex a + i to b + i, for
/// 0 ≤ i < length, and has index first + i. Traversing a lattice needs no index arrays.
struct SpringRun {
  int direction = 0;  ///< index into spring_directions()
  int a = 0;
  int b = 0;
  int length = 0;
  std::int64_t first = 0;
};

struct Springs {
  Bracing bracing = Bracing::kuhn;
  std::vector<SpringDirection> directions;
  std::vector<SpringRun> runs;  ///< by direction, then by a
  std::int64_t count = 0;
  std::array<std::int64_t, 3> count_by_kind{};  ///< indexed by SpringKind
  /// Per spring: number of kept voxels around it over the number of a spring inside a solid (4 for an edge,
  /// 2 for a face diagonal, 1 for a body diagonal), each voxel weighted by its fill.
  std::vector<float> share;
  /// Per spring: mean fill of the kept voxels around it.
  std::vector<float> mean_fill;
};
MUSLIN_API Springs build_springs(const Lattice& lattice, Bracing bracing);

/// Returns six positively oriented tetrahedra per voxel (Kuhn / Freudenthal), sharing the voxel's (1,1,1)
/// diagonal; faces of neighbouring voxels match. Shape 6·#C.
MUSLIN_API std::vector<std::array<int, 4>> build_tetrahedra(const Lattice& lattice);

}  // namespace muslin
