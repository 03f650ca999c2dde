#include "muslin/geometry/inspect.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>

#include <fmt/format.h>
#include <tbb/parallel_sort.h>

#include "muslin/core/error.hpp"
#include "muslin/core/parallel.hpp"
#include "muslin/geometry/weld.hpp"

namespace muslin {
namespace {

constexpr std::size_t report_grain = 16384;

std::string counted(std::size_t count, const char* one, const char* many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

struct Fault {
  std::string problem, remedy;
};

// Returns a fault that makes the arrays unusable; without one every index and number is valid.
std::optional<Fault> broken_arrays(const Mesh& mesh) {
  const auto damaged = [](std::string problem) {
    return Fault{std::move(problem), "the file is damaged: export it again"};
  };
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    if (!mesh.positions[v].allFinite())
      return damaged("vertex " + std::to_string(v + 1) + " has a coordinate that is not a number");
    if (mesh.positions[v].cwiseAbs().maxCoeff() > largest_coordinate)
      return Fault{"vertex " + std::to_string(v + 1) + " has a coordinate beyond 1e9 m",
                   "coordinates are metres: scale the mesh down or export it again"};
  }
  const std::size_t corners = mesh.face_vertices.size();
  if (mesh.face_offsets.empty()
          ? corners != 0
          : mesh.face_offsets.front() != 0 || static_cast<std::size_t>(mesh.face_offsets.back()) != corners)
    return damaged("the face offsets do not fit the list of corners");
  for (std::size_t f = 0; f < mesh.face_count(); ++f)
    if (mesh.face_offsets[f + 1] - mesh.face_offsets[f] < 3)
      return damaged("face " + std::to_string(f + 1) + " has fewer than three corners");
  for (std::size_t f = 0; f < mesh.face_count(); ++f)
    for (const int v : mesh.face(f))
      if (v < 0 || static_cast<std::size_t>(v) >= mesh.positions.size())
        return damaged("face " + std::to_string(f + 1) + " uses vertex " +
                       std::to_string(std::int64_t{v} + 1) + ", but there are " +
                       std::to_string(mesh.positions.size()));
  if (!mesh.corner_uvs.empty() && mesh.corner_uvs.size() != corners)
    return damaged("the texture indices do not fit the list of corners");
  for (const int uv : mesh.corner_uvs)
    if (uv < -1 || uv >= static_cast<std::int64_t>(mesh.uvs.size()))
      return damaged("a corner uses texture coordinate " + std::to_string(std::int64_t{uv} + 1) +
                     ", but there are " + std::to_string(mesh.uvs.size()));
  for (const Vec2& uv : mesh.uvs)
    if (!uv.allFinite()) return damaged("a texture coordinate is not a number");
  for (const MeshGroup& group : mesh.groups) {
    for (const int f : group.faces)
      if (f < 0 || static_cast<std::size_t>(f) >= mesh.face_count())
        return damaged("group " + group.name + " names a face that does not exist");
    for (const int v : group.vertices)
      if (v < 0 || static_cast<std::size_t>(v) >= mesh.positions.size())
        return damaged("group " + group.name + " names a vertex that does not exist");
  }
  return std::nullopt;
}

// Each edge of each face as one number: the lower vertex, the higher, and its direction.
void count_edges(const Mesh& mesh, MeshReport& report) {
  std::vector<std::uint64_t> edges(mesh.face_vertices.size());
  parallel_for(mesh.face_count(), report_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) {
      const auto face = mesh.face(f);
      for (std::size_t c = 0; c < face.size(); ++c) {
        const auto from = static_cast<std::uint64_t>(face[c]),
                   to = static_cast<std::uint64_t>(face[c + 1 < face.size() ? c + 1 : 0]);
        edges[static_cast<std::size_t>(mesh.face_offsets[f]) + c] =
            std::min(from, to) << 32 | std::max(from, to) << 1 | (from > to ? 1 : 0);
      }
    }
  });
  tbb::parallel_sort(edges.begin(), edges.end());
  for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
    while (end < edges.size() && edges[end] >> 1 == edges[begin] >> 1) ++end;
    const bool point = edges[begin] >> 32 == (edges[begin] >> 1 & 0x7fffffff);
    if (point) continue;
    report.open_edges += end - begin == 1;
    report.non_manifold_edges += end - begin > 2;
    report.flipped_edges += end - begin == 2 && edges[begin] == edges[begin + 1];
  }
}

void count_components(const Mesh& mesh, MeshReport& report) {
  std::vector<int> parent(mesh.positions.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int v) {
    while (parent[static_cast<std::size_t>(v)] != v) {
      int& up = parent[static_cast<std::size_t>(v)];
      up = parent[static_cast<std::size_t>(up)];
      v = up;
    }
    return v;
  };
  std::vector<char> used(mesh.positions.size());
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    int first = root(mesh.face(f)[0]);
    for (const int v : mesh.face(f)) {
      used[static_cast<std::size_t>(v)] = 1;
      const int other = root(v);
      parent[static_cast<std::size_t>(std::max(first, other))] = std::min(first, other);
      first = std::min(first, other);
    }
  }
  for (std::size_t v = 0; v < parent.size(); ++v) {
    report.unused_vertices += !used[v];
    report.components += used[v] && parent[v] == static_cast<int>(v);
  }
}

// Two faces are equal if they have the same vertices, in any order.
void count_duplicates(const Mesh& mesh, MeshReport& report) {
  std::vector<int> sorted = mesh.face_vertices;
  std::vector<int> order(mesh.face_count());
  std::iota(order.begin(), order.end(), 0);
  const auto begin = [&](int f) { return sorted.begin() + mesh.face_offsets[static_cast<std::size_t>(f)]; };
  const auto end = [&](int f) { return sorted.begin() + mesh.face_offsets[static_cast<std::size_t>(f) + 1]; };
  parallel_for(order.size(), report_grain, [&](std::size_t first, std::size_t last) {
    for (std::size_t f = first; f < last; ++f)
      std::sort(begin(static_cast<int>(f)), end(static_cast<int>(f)));
  });
  tbb::parallel_sort(order.begin(), order.end(), [&](int f, int g) {
    return std::lexicographical_compare(begin(f), end(f), begin(g), end(g));
  });
  for (std::size_t i = 1; i < order.size(); ++i)
    report.duplicate_faces +=
        std::equal(begin(order[i - 1]), end(order[i - 1]), begin(order[i]), end(order[i]));
}

void measure(const Mesh& mesh, const Triangulation& cut, MeshReport& report) {
  const Vec3 center = report.bounds.center();
  const Vec2 sums =
      parallel_sum(cut.triangles.size(), report_grain, Vec2(0, 0), [&](std::size_t begin, std::size_t end) {
        Vec2 sum(0, 0);
        for (std::size_t t = begin; t < end; ++t) {
          const Vec3 a = mesh.positions[static_cast<std::size_t>(cut.triangles[t][0])] - center,
                     b = mesh.positions[static_cast<std::size_t>(cut.triangles[t][1])] - center,
                     c = mesh.positions[static_cast<std::size_t>(cut.triangles[t][2])] - center;
          sum += Vec2((b - a).cross(c - a).norm() / 2, a.dot(b.cross(c)) / 6);
        }
        return sum;
      });
  report.area = sums[0];
  report.volume = sums[1];
  report.degenerate_faces =
      parallel_sum(mesh.face_count(), report_grain, std::size_t{0}, [&](std::size_t begin, std::size_t end) {
        std::size_t degenerate = 0;
        for (std::size_t f = begin; f < end; ++f) {
          const auto face = mesh.face(f);
          double longest = 0;
          for (std::size_t c = 0; c < face.size(); ++c)
            longest = std::max(longest, (mesh.positions[static_cast<std::size_t>(face[c])] -
                                         mesh.positions[static_cast<std::size_t>(face[0])])
                                            .squaredNorm());
          degenerate += !(newell_normal(mesh.positions, face).norm() > 1e-12 * longest);
        }
        return degenerate;
      });
}

/// A tolerance of one digit that joins vertices at this distance.
double joining(double distance, double size) {
  const double least = std::max(1.5 * distance, 1e-6 * size);
  const double digit = std::pow(10, std::floor(std::log10(least)));
  return std::ceil(least / digit) * digit;
}

void warn(MeshReport& report, bool cloth) {
  const auto say = [&](std::string sentence) { report.warnings.push_back(std::move(sentence)); };
  const double size = report.bounds.sizes().maxCoeff();
  if (size > largest_mesh || size < 1e-3)
    say(fmt::format("The mesh is {:.3g} m across; if its file is in other units than metres, scale it.",
                    size));
  if (report.degenerate_faces > 0)
    say(counted(report.degenerate_faces, "face has", "faces have") +
        " no area; they are kept but carry nothing: dissolve degenerate faces in the modeller.");
  if (report.duplicate_faces > 0)
    say(counted(report.duplicate_faces, "face repeats", "faces repeat") +
        " the vertices of another; remove doubled faces.");
  if (report.non_manifold_edges > 0 && !cloth)
    say(counted(report.non_manifold_edges, "edge is", "edges are") +
        " shared by three or more faces; inside and outside are guessed there: split or remove the extra "
        "faces.");
  if (report.flipped_edges > 0)
    say("Faces disagree about their front side along " + counted(report.flipped_edges, "edge", "edges") +
        "; recalculate the normals.");
  if (report.closed && report.flipped_edges == 0 && report.non_manifold_edges == 0 && report.volume < 0)
    say("The faces of the closed mesh point inward; flip the normals.");
  if (report.near_border_vertices > 1)
    say(fmt::format(
        "{} vertices on borders lie within {:.2g} m of others but are not joined, so that the borders "
        "come apart ({}); `weld = {:.1g}` joins them.",
        report.near_border_vertices, report.near_border_distance,
        counted(report.components, "piece", "pieces"), joining(report.near_border_distance, size)));
  if (report.unused_vertices > 0)
    say(counted(report.unused_vertices, "vertex belongs", "vertices belong") +
        " to no face; they are kept but not simulated: delete loose vertices.");
}

MeshReport report_of(const Mesh& mesh, bool cloth) {
  MeshReport report;
  report.vertices = mesh.vertex_count();
  report.faces = mesh.face_count();
  if (const auto fault = broken_arrays(mesh)) {
    report.warnings.push_back("Unusable: " + fault->problem + "; " + fault->remedy + ".");
    return report;
  }
  report.bounds = mesh.bounds();
  if (report.faces == 0) {
    report.warnings.push_back("Unusable: there are no faces; export the mesh with its faces.");
    return report;
  }
  const Triangulation cut = triangulate(mesh);
  report.triangles = cut.triangles.size();
  count_edges(mesh, report);
  count_components(mesh, report);
  count_duplicates(mesh, report);
  measure(mesh, cut, report);
  report.closed = report.open_edges == 0;
  const NearBorders near = near_borders(mesh);
  report.near_border_vertices = near.vertices;
  report.near_border_distance = near.distance;
  int thinnest = 0;
  if (report.bounds.sizes().minCoeff(&thinnest) <= 1e-9 * report.bounds.diagonal().norm())
    report.flat_axis = thinnest;
  warn(report, cloth);
  return report;
}

}  // namespace

MeshReport inspect(const Mesh& mesh) { return report_of(mesh, false); }

MeshReport inspect_cloth(const Mesh& mesh) { return report_of(mesh, true); }

void require_usable(const Mesh& mesh, const std::string& file) {
  const auto refuse = [&](const std::string& problem, const std::string& remedy) {
    throw Error(ErrorKind::input, Place{file}, problem, remedy);
  };
  if (mesh.positions.empty()) refuse("the mesh has no vertices", "export a polygon mesh");
  if (const auto fault = broken_arrays(mesh)) refuse(fault->problem, fault->remedy);
  if (mesh.face_count() == 0)
    refuse("the mesh has no faces", "export a polygon mesh, not only points or curves");
  const Vec3 size = mesh.bounds().sizes();
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const double area2 = newell_normal(mesh.positions, mesh.face(f)).norm();
    if (area2 > 1e-14 * size.squaredNorm() / static_cast<double>(mesh.face_count())) return;
  }
  refuse("all faces have no area",
         "the mesh is collapsed to a line or point: check its scale and export it again");
}

}  // namespace muslin
