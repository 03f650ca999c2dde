#include <string>

#include "muslin/core/error.hpp"
#include "muslin/core/parallel.hpp"
#include "muslin/surface/marching.hpp"
#include "muslin/surface/marching_cubes_table.hpp"

namespace muslin {
namespace {

constexpr std::size_t square_grain = 1024;

/// The plane of a flat lattice. (u, v, thin) is a right-handed system of axes.
struct Plane {
  int thin = 2, u = 0, v = 1;
  double low = 0, middle = 0, high = 0;  ///< extent of the solid along the thin axis [m]
};

Plane plane_of(const Lattice& lattice, const Box& bounds) {
  Plane plane;
  for (int axis = 0; axis < 3; ++axis) {
    const int best = lattice.extent[plane.thin], extent = lattice.extent[axis];
    if (extent < best || (extent == best && bounds.sizes()[axis] < bounds.sizes()[plane.thin]))
      plane.thin = axis;
  }
  plane.u = (plane.thin + 1) % 3;
  plane.v = (plane.thin + 2) % 3;
  plane.low = bounds.min()[plane.thin];
  plane.high = bounds.max()[plane.thin];
  plane.middle = 0.5 * (plane.low + plane.high);
  if (lattice.extent[plane.thin] != 1) {
    throw Error(ErrorKind::input,
                "marching squares need a lattice one voxel thick, this one has " +
                    std::to_string(lattice.extent[plane.thin]),
                "use marching cubes, or a voxel width not below the thickness");
  }
  return plane;
}

/// A side of a square's inside part: from one point to the next, the names as for cubes with axis 0 for u and
/// 1 for v, without the layer. `side` is the square's side it lies in, −1 if it cuts through the square.
struct OutlineSide {
  std::uint64_t from = 0;
  int side = -1;
};

class Squares {
 public:
  Squares(const Lattice& lattice, const SignedDistance& distance)
      : lattice_(lattice), distance_(distance), plane_(plane_of(lattice, distance.bounds())) {
    values_.assign(lattice.vertex_count(), 0);
    inside_.assign(lattice.vertex_count(), 0);
    parallel_for(values_.size(), 64, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) {
        if (lattice_.vertices[v][plane_.thin] != 0) continue;
        values_[v] = distance_(in_plane(static_cast<int>(v)));
        inside_[v] = values_[v] <= inside_tolerance * lattice_.width;
      }
    });
  }

  MarchedSurface march() const {
    std::vector<std::vector<NamedTriangle>> blocks((lattice_.voxel_count() + square_grain - 1) /
                                                   square_grain);
    parallel_for(lattice_.voxel_count(), square_grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v)
        march_voxel(static_cast<int>(v), blocks[begin / square_grain]);
    });
    MarchedSurface surface;
    const std::vector<std::uint64_t> names = number_vertices(blocks, surface.triangles);
    surface.positions.resize(names.size());
    surface.embedding.vertices.resize(names.size());
    surface.embedding.weights.resize(names.size());
    parallel_for(names.size(), 128, [&](std::size_t begin, std::size_t end) {
      for (std::size_t n = begin; n < end; ++n) place(names[n], surface, n);
    });
    return surface;
  }

 private:
  Vec3 in_plane(int column) const {
    Vec3 position = lattice_.rest_position(column);
    position[plane_.thin] = plane_.middle;
    return position;
  }

  int corner(int n) const {
    const int u = n == 1 || n == 2, v = n >= 2;
    return u << plane_.u | v << plane_.v;
  }

  bool open(const Vec3i& voxel, int side) const {
    constexpr int du[] = {0, 1, 0, -1}, dv[] = {-1, 0, 1, 0};
    Vec3i beside = voxel;
    beside[plane_.u] += du[side];
    beside[plane_.v] += dv[side];
    return lattice_.find_voxel(beside) < 0;
  }

  void march_voxel(int voxel, std::vector<NamedTriangle>& out) const {
    const auto& vertices = lattice_.voxel_vertices[voxel];
    std::array<std::uint64_t, 4> columns;
    int mask = 0;
    for (int n = 0; n < 4; ++n) {
      const int column = vertices[corner(n)];
      columns[n] = static_cast<std::uint64_t>(column);
      mask |= inside_[column] << n;
    }
    for (const std::vector<int>& run : inside_runs(mask)) {
      std::vector<OutlineSide> outline;
      for (const int at : run) {
        const int n = at / 2, next = (n + 1) % 4;
        if (at % 2 == 0) {
          outline.push_back({4 * columns[n] + 3, n});
        } else {
          // Sides 0 and 1 run up an axis, 2 and 3 down; 0 and 2 along u.
          outline.push_back({4 * columns[n < 2 ? n : next] + static_cast<std::uint64_t>(n % 2), n});
        }
      }
      if (mask != 15) outline.back().side = -1;
      extrude(voxel, outline, out);
    }
  }

  void extrude(int voxel, const std::vector<OutlineSide>& outline, std::vector<NamedTriangle>& out) const {
    const auto add = [&](std::uint64_t a, std::uint64_t b, std::uint64_t c, int part) {
      out.push_back({{a, b, c}, std::int64_t{8} * voxel + part});
    };
    const auto bottom = [](const OutlineSide& s) { return 2 * s.from; };
    const auto top = [](const OutlineSide& s) { return 2 * s.from + 1; };
    const std::size_t n = outline.size();
    for (std::size_t p = 1; p + 1 < n; ++p) {
      add(top(outline[0]), top(outline[p]), top(outline[p + 1]), 0);
      add(bottom(outline[0]), bottom(outline[p + 1]), bottom(outline[p]), 1);
    }
    for (std::size_t p = 0; p < n; ++p) {
      const OutlineSide &a = outline[p], &b = outline[(p + 1) % n];
      if (a.side >= 0 && !open(lattice_.voxels[voxel], a.side)) continue;
      const int part = a.side >= 0 ? 2 + a.side : 6;
      add(bottom(a), bottom(b), top(b), part);
      add(bottom(a), top(b), top(a), part);
    }
  }

  void place(std::uint64_t name, MarchedSurface& surface, std::size_t at) const {
    const double height = name % 2 == 0 ? plane_.low : plane_.high;
    const int column = static_cast<int>(name / 8), kind = static_cast<int>(name / 2 % 4);
    int from = column, to = column;
    double t = 0;
    if (kind != 3) {
      to = lattice_.find_vertex(lattice_.vertices[column] + Vec3i::Unit(kind == 0 ? plane_.u : plane_.v));
      if (!inside_[from]) std::swap(from, to);
      // Inside a thin solid the distance is a poor guide to the outline, so this may need many steps.
      t = crossing(distance_, in_plane(from), in_plane(to), values_[from], values_[to], 60, 1e-9);
    }
    const double s = (height - lattice_.rest_position(column)[plane_.thin]) / lattice_.width;
    const Vec3i up = Vec3i::Unit(plane_.thin);
    const int from_top = lattice_.find_vertex(lattice_.vertices[from] + up);
    const int to_top = lattice_.find_vertex(lattice_.vertices[to] + up);
    surface.embedding.vertices[at] = {from, to, from_top, to_top, from, from, from, from};
    surface.embedding.weights[at] = {(1 - t) * (1 - s), t * (1 - s), (1 - t) * s, t * s, 0, 0, 0, 0};
    surface.positions[at] = (1 - t) * in_plane(from) + t * in_plane(to);
    surface.positions[at][plane_.thin] = height;
  }

  const Lattice& lattice_;
  const SignedDistance& distance_;
  Plane plane_;
  std::vector<double> values_;  ///< #V signed distance in the middle of the columns that start at a vertex
  std::vector<char> inside_;    ///< #V
};

}  // namespace

MarchedSurface march_squares(const Lattice& lattice, const SignedDistance& distance) {
  return Squares(lattice, distance).march();
}

}  // namespace muslin
