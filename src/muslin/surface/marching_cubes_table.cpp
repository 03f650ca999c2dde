#include "muslin/surface/marching_cubes_table.hpp"

namespace muslin {
namespace {

using Triangle = std::array<CubePoint, 3>;

/// True if the edges lie in one face of the cube.
bool share_face(int a, int b) {
  const CubeEdge ea = cube_edge(a), eb = cube_edge(b);
  for (int axis = 0; axis < 3; ++axis) {
    if (axis == ea.axis || axis == eb.axis) continue;
    if ((ea.low >> axis & 1) == (eb.low >> axis & 1)) return true;
  }
  return false;
}

/// A fan from the corner whose diagonals stay off the cube's faces: there the neighbour could have the same.
void add_fan(const std::vector<int>& loop, std::vector<Triangle>& triangles) {
  const std::size_t n = loop.size();
  std::size_t best = 0, fewest = n;
  for (std::size_t apex = 0; apex < n; ++apex) {
    std::size_t in_faces = 0;
    for (std::size_t d = 2; d + 1 < n; ++d) in_faces += share_face(loop[apex], loop[(apex + d) % n]);
    if (in_faces < fewest) fewest = in_faces, best = apex;
  }
  for (std::size_t d = 1; d + 1 < n; ++d) {
    triangles.push_back({static_cast<CubePoint>(loop[best]), static_cast<CubePoint>(loop[(best + d) % n]),
                         static_cast<CubePoint>(loop[(best + d + 1) % n])});
  }
}

CubeCase make_case(int inside) {
  CubeCase result;
  std::array<int, 12> next;
  next.fill(-1);
  for (int face = 0; face < 6; ++face) {
    const std::array<int, 4> corners = face_corners(face);
    int mask = 0;
    for (int i = 0; i < 4; ++i) mask |= (inside >> corners[i] & 1) << i;
    for (const std::vector<int>& run : inside_runs(mask)) {
      std::vector<int> points;
      for (const int at : run) {
        const int corner = corners[at / 2];
        points.push_back(at % 2 == 0 ? 12 + corner : edge_between(corner, corners[(at / 2 + 1) % 4]));
      }
      for (std::size_t p = 1; p + 1 < points.size(); ++p) {
        result.caps[face].push_back({static_cast<CubePoint>(points[0]), static_cast<CubePoint>(points[p]),
                                     static_cast<CubePoint>(points[p + 1])});
      }
      // The cap runs from its last crossing to its first, so the surface runs the other way.
      if (mask != 15) next[points.front()] = points.back();
    }
  }
  for (int start = 0; start < 12; ++start) {
    std::vector<int> loop;
    for (int at = start; next[at] >= 0;) {
      loop.push_back(at);
      const int following = next[at];
      next[at] = -1;
      at = following;
    }
    if (!loop.empty()) add_fan(loop, result.surface);
  }
  return result;
}

}  // namespace

CubeEdge cube_edge(int edge) {
  const int axis = edge / 4, n = edge % 4;
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  const int low = (n & 1) << u | (n >> 1) << v;
  return {low, low | 1 << axis, axis};
}

int edge_between(int corner, int other) {
  const int low = corner & other, bit = corner ^ other;
  const int axis = bit >> 1;  // 1, 2, 4 → 0, 1, 2
  return 4 * axis + (low >> (axis + 1) % 3 & 1) + 2 * (low >> (axis + 2) % 3 & 1);
}

std::array<int, 4> face_corners(int face) {
  const int axis = face / 2, side = face % 2;
  const int u = 1 << (axis + 1) % 3, v = 1 << (axis + 2) % 3, base = side << axis;
  if (side == 1) return {base, base | u, base | u | v, base | v};
  return {base, base | v, base | u | v, base | u};
}

std::vector<std::vector<int>> inside_runs(int inside_of_four) {
  if (inside_of_four == 15) return {{0, 2, 4, 6}};
  std::vector<std::vector<int>> runs;
  for (int first = 0; first < 4; ++first) {
    const int before = (first + 3) % 4;
    if (!(inside_of_four >> first & 1) || (inside_of_four >> before & 1)) continue;
    std::vector<int> run = {2 * before + 1};
    int at = first;
    for (; inside_of_four >> at & 1; at = (at + 1) % 4) run.push_back(2 * at);
    run.push_back(2 * ((at + 3) % 4) + 1);
    runs.push_back(run);
  }
  return runs;
}

const std::array<CubeCase, 256>& marching_cubes_table() {
  static const std::array<CubeCase, 256> table = [] {
    std::array<CubeCase, 256> cases;
    for (int inside = 0; inside < 256; ++inside) cases[inside] = make_case(inside);
    return cases;
  }();
  return table;
}

}  // namespace muslin
