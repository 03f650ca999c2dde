#include "muslin/shell/shell.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include <Eigen/LU>
#include <fmt/format.h>

#include "muslin/core/error.hpp"
#include "muslin/core/index.hpp"
#include "muslin/core/parallel.hpp"
#include "muslin/shell/triangle_corners.hpp"

namespace muslin {
namespace {

// A triangle this flat (twice its area over its longest edge squared) has no bending direction.
constexpr double flattest = 1e-9;
// Below this length of its projection a unit vector defines no direction on a face.
constexpr double shortest_projection = 1e-3;

class ShellBuilder {
 public:
  ShellBuilder(const Mesh& mesh, const RestShape& rest, const Weave& weave)
      : mesh_(mesh), rest_(rest), weave_(weave) {
    require(rest.corners.size() == mesh.face_vertices.size(),
            "a rest shape has another number of corners than its mesh", "give one position for each");
  }

  Shell build() {
    Triangulation cut = triangulate(mesh_);
    corners_ = triangle_corners(mesh_, cut);
    at_rest_ = rest_.triangles(corners_);
    shell_.triangles = std::move(cut.triangles);
    shell_.faces = std::move(cut.faces);
    shell_.vertex_areas.assign(mesh_.vertex_count(), 0.0);
    find_warps();
    for (std::size_t t = 0; t < shell_.triangles.size(); ++t) add_triangle(t);
    for (std::size_t v = 0; v < shell_.vertex_areas.size(); ++v) {
      if (shell_.vertex_areas[v] > 0) continue;
      throw Error(ErrorKind::input,
                  fmt::format("vertex {} belongs to no polygon, so as part of a shell it has no mass", v + 1),
                  "delete loose vertices in the modeller");
    }
    add_hinges();
    return std::move(shell_);
  }

 private:
  /// The place at rest of a corner, 0 to 2, of a triangle.
  const Vec3& rest(std::size_t t, int corner) const { return rest_.positions[at(at_rest_[t][corner])]; }

  void find_warps() {
    std::vector<std::uint8_t> known(shell_.triangles.size(), 0);
    std::vector<std::size_t> reached;
    warps_.resize(shell_.triangles.size());
    for (std::size_t t = 0; t < shell_.triangles.size(); ++t) {
      require_area(t);
      const std::optional<Vec3> warp = warp_of(t);
      if (!warp) continue;
      warps_[t] = *warp;
      known[t] = 1;
      reached.push_back(t);
    }
    if (reached.size() == shell_.triangles.size()) return;
    if (reached.empty())
      throw Error(ErrorKind::input,
                  "no polygon has texture coordinates with an area, so the threads have no direction",
                  "unwrap the mesh, or give `warp` a direction");
    continue_warps(known, std::move(reached));
  }

  /// Threads of triangles without a texture continue those of their neighbours, the nearest first; those of a
  /// piece without any run along the longest side of the whole.
  void continue_warps(std::vector<std::uint8_t>& known, std::vector<std::size_t> reached) {
    std::vector<std::vector<std::pair<EdgeUse, EdgeUse>>> sides(shell_.triangles.size());
    for_each_edge(triangle_sides(shell_.triangles), [&](std::span<const EdgeUse> edge) {
      for (const EdgeUse& from : edge)
        for (const EdgeUse& to : edge)
          if (from.face != to.face) sides[static_cast<std::size_t>(from.face)].emplace_back(from, to);
    });
    std::size_t i = 0;
    const auto spread = [&] {
      for (; i < reached.size(); ++i) {
        for (const auto& [from, to] : sides[reached[i]]) {
          const auto next = static_cast<std::size_t>(to.face);
          if (known[next] != 0) continue;
          known[next] = 1;
          warps_[next] = unfolded(from, to);
          reached.push_back(next);
        }
      }
    };
    spread();
    const Vec3 along = rest_.longest_side();
    for (std::size_t t = 0; t < known.size(); ++t) {
      if (known[t] != 0) continue;
      known[t] = 1;
      warps_[t] = in_plane(along, normal_of(static_cast<int>(t)));
      reached.push_back(t);
      spread();
    }
  }

  /// Returns the warp of one triangle in another, unfolded about their edge into one plane.
  Vec3 unfolded(const EdgeUse& from, const EdgeUse& to) const {
    const Vec3 along = direction_of(from), onward = direction_of(to);
    const Vec3& warp = warps_[at(from.face)];
    const double side = from.ascends == to.ascends ? -1 : 1;  // −1: it faces the other way
    return warp.dot(along) * onward +
           side * warp.dot(normal_of(from.face).cross(along)) * normal_of(to.face).cross(onward);
  }

  /// Returns the direction of an edge at rest in one of its triangles, from the lower vertex to the higher.
  Vec3 direction_of(const EdgeUse& use) const {
    const int c = use.corner % 3;  // triangles have three corners each
    const Vec3 edge = rest(at(use.face), (c + 1) % 3) - rest(at(use.face), c);
    return (use.ascends ? edge : Vec3(-edge)).normalized();
  }

  Vec3 normal_of(int triangle) const {
    const auto t = at(triangle);
    return (rest(t, 1) - rest(t, 0)).cross(rest(t, 2) - rest(t, 0)).normalized();
  }

  void require_area(std::size_t t) const {
    const Vec3i& v = shell_.triangles[t];
    const Vec3 e1 = rest(t, 1) - rest(t, 0), e2 = rest(t, 2) - rest(t, 0);
    const Vec3 twice = e1.cross(e2);
    const double longest = std::max({e1.squaredNorm(), e2.squaredNorm(), (e2 - e1).squaredNorm()});
    if (!(twice.norm() > flattest * longest)) {
      throw Error(ErrorKind::input,
                  fmt::format("polygon {} has a triangle without area (vertices {}, {}, {})",
                              shell_.faces[t] + 1, v[0] + 1, v[1] + 1, v[2] + 1),
                  "merge or dissolve degenerate polygons in the modeller");
    }
  }

  void add_triangle(std::size_t t) {
    const Vec3i& v = shell_.triangles[t];
    const Vec3 e1 = rest(t, 1) - rest(t, 0), e2 = rest(t, 2) - rest(t, 0);
    const Vec3 twice = e1.cross(e2);
    const Vec3 normal = twice.normalized();
    const Vec3& warp = warps_[t];
    const Vec3 weft = normal.cross(warp);
    Mat2 edges;
    edges << warp.dot(e1), warp.dot(e2), weft.dot(e1), weft.dot(e2);
    const double area = twice.norm() / 2;
    shell_.inverses.push_back(edges.inverse());
    shell_.areas.push_back(area);
    shell_.area += area;
    for (int c = 0; c < 3; ++c) shell_.vertex_areas[at(v[c])] += area / 3;
  }

  /// None: the triangle has no texture.
  std::optional<Vec3> warp_of(std::size_t t) {
    const Vec3 e1 = rest(t, 1) - rest(t, 0), e2 = rest(t, 2) - rest(t, 0);
    const Vec3 normal = e1.cross(e2).normalized();
    if (!weave_.warp) return warp_from_texture(t, e1, e2, normal);
    if (is_across(*weave_.warp, normal)) ++shell_.odd_faces;
    return in_plane(*weave_.warp, normal);
  }

  static Vec3 projected(const Vec3& v, const Vec3& normal) { return v - v.dot(normal) * normal; }
  static bool is_across(const Vec3& v, const Vec3& normal) {
    return projected(v, normal).norm() < shortest_projection * v.norm();
  }
  /// Returns the direction of v in the plane; that of another axis if v stands across it.
  static Vec3 in_plane(const Vec3& v, const Vec3& normal) {
    if (!is_across(v, normal)) return projected(v, normal).normalized();
    int axis;
    normal.cwiseAbs().minCoeff(&axis);
    return (Vec3::Unit(axis) - normal[axis] * normal).normalized();
  }

  /// Returns the direction of steepest u in the triangle: with the texture's edges U (columns) and those of
  /// the triangle E, ∂x/∂u = E U⁻¹ (1, 0).
  std::optional<Vec3> warp_from_texture(std::size_t t, const Vec3& e1, const Vec3& e2,
                                        const Vec3& normal) const {
    const std::optional<TextureTriangle> texture = texture_of(mesh_, corners_[t]);
    if (!texture || !texture->has_area()) return std::nullopt;
    const auto& uv = texture->uv;
    const Vec3 along = (e1 * (uv[2] - uv[0]).y() - e2 * (uv[1] - uv[0]).y()) / texture->twice_area();
    return (along - along.dot(normal) * normal).normalized();
  }

  void add_hinges() {
    std::size_t edges = 0;
    for_each_edge(triangle_sides(shell_.triangles), [&](std::span<const EdgeUse> edge) {
      ++edges;
      const int c = edge[0].corner % 3;  // triangles have three corners each
      shell_.mean_edge += (rest(at(edge[0].face), (c + 1) % 3) - rest(at(edge[0].face), c)).norm();
      for (const EdgeUse& further : edge.subspan(1)) add_hinge(edge[0], further);
    });
    shell_.mean_edge /= static_cast<double>(edges);
  }

  void add_hinge(const EdgeUse& first, const EdgeUse& second) {
    const auto t1 = at(first.face), t2 = at(second.face);
    const Vec3i& v = shell_.triangles[t1];
    const int c1 = first.corner % 3, c2 = second.corner % 3;
    Hinge hinge;
    hinge.vertices = {v[c1], v[(c1 + 1) % 3], v[(c1 + 2) % 3], shell_.triangles[t2][(c2 + 2) % 3]};
    if (hinge.vertices[2] == hinge.vertices[3]) {
      throw Error(ErrorKind::input,
                  fmt::format("polygons {} and {} both have the triangle of vertices {}, {}, {}",
                              shell_.faces[t1] + 1, shell_.faces[t2] + 1, v[0] + 1, v[1] + 1, v[2] + 1),
                  "delete double polygons in the modeller");
    }
    const bool along = first.ascends == second.ascends;  // both triangles run along the edge alike
    const std::array ends1 = {rest(t1, c1), rest(t1, (c1 + 1) % 3)};
    const std::array ends2 = {rest(t2, along ? c2 : (c2 + 1) % 3), rest(t2, along ? (c2 + 1) % 3 : c2)};
    const Vec3 edge1 = ends1[1] - ends1[0], edge2 = ends2[1] - ends2[0];
    const double length1 = edge1.norm(), length2 = edge2.norm();
    hinge.length = (length1 + length2) / 2;
    hinge.area = shell_.areas[t1] + shell_.areas[t2];
    const bool seam = ends1 != ends2;
    if (seam) ++shell_.seam_hinges;
    if (!seam && !rest_.unfolded)
      hinge.angle = hinge_angle(ends1[0], ends1[1], rest(t1, (c1 + 2) % 3), rest(t2, (c2 + 2) % 3));
    // The bending direction is across the edge: cos² of its angle with warp is sin² of that of the edge.
    const double share1 = 1 - std::pow(edge1.dot(warps_[t1]) / length1, 2),
                 share2 = 1 - std::pow(edge2.dot(warps_[t2]) / length2, 2);
    hinge.warp_share =
        std::clamp((share1 * shell_.areas[t1] + share2 * shell_.areas[t2]) / hinge.area, 0.0, 1.0);
    shell_.hinges.push_back(hinge);
  }

  const Mesh& mesh_;
  const RestShape& rest_;
  const Weave& weave_;
  Shell shell_;
  std::vector<Vec3i> corners_;  // #T, of the mesh's polygons
  std::vector<Vec3i> at_rest_;  // #T, positions of the rest shape
  std::vector<Vec3> warps_;     // #T
};

/// Returns the square of the largest singular value of F.
double square_of_stretch(const Vec3i& corners, const Mat2& d, ConstVectors x) {
  const Vec3& x0 = x[static_cast<std::size_t>(corners[0])];
  const Vec3 e1 = x[static_cast<std::size_t>(corners[1])] - x0;
  const Vec3 e2 = x[static_cast<std::size_t>(corners[2])] - x0;
  const Vec3 a = e1 * d(0, 0) + e2 * d(1, 0), b = e1 * d(0, 1) + e2 * d(1, 1);
  const double half = 0.5 * (a.squaredNorm() - b.squaredNorm()), shear = a.dot(b);
  return 0.5 * (a.squaredNorm() + b.squaredNorm()) + std::sqrt(half * half + shear * shear);
}

}  // namespace

Shell build_shell(const Mesh& mesh, const RestShape& rest, const Weave& weave) {
  return ShellBuilder(mesh, rest, weave).build();
}

Shell build_shell(const Mesh& mesh, ConstVectors rest_positions, const Weave& weave) {
  const RestShape rest = rest_of_vertices(mesh, rest_positions);
  if (weave.warp || !mesh.corner_uvs.empty()) return build_shell(mesh, rest, weave);
  return build_shell(mesh, rest, {rest.longest_side()});
}

double hinge_angle(const Vec3& x0, const Vec3& x1, const Vec3& x2, const Vec3& x3) {
  const Vec3 e = x1 - x0;
  const Vec3 n1 = e.cross(x2 - x0), n2 = (x3 - x0).cross(e);
  return std::atan2(n1.cross(n2).dot(e.normalized()), n1.dot(n2));
}

double largest_stretch(const Vec3i& corners, const Mat2& inverse, ConstVectors x) {
  return std::sqrt(square_of_stretch(corners, inverse, x));
}

double max_stretch(const Shell& shell, ConstVectors x) {
  struct Largest {
    double square = 0;
    Largest operator+(const Largest& other) const { return {std::max(square, other.square)}; }
  };
  constexpr std::size_t grain = 4096;
  const Largest largest =
      parallel_sum(shell.triangles.size(), grain, Largest{}, [&](std::size_t begin, std::size_t end) {
        Largest block;
        for (std::size_t t = begin; t < end; ++t)
          block.square = std::max(block.square, square_of_stretch(shell.triangles[t], shell.inverses[t], x));
        return block;
      });
  return std::sqrt(largest.square);
}

}  // namespace muslin
