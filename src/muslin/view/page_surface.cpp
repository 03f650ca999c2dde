#include "muslin/view/page_surface.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <tuple>

#include "muslin/render/render_mesh.hpp"
#include "muslin/render/scene_view.hpp"
#include "muslin/surface/edge_stretch.hpp"

namespace muslin {

PageSurface page_surface(const Mesh& mesh) {
  // Same pattern as in the ray-traced pictures.
  const Surface surface = make_surface(mesh, fabric_look(Vec3::Zero()));
  const SmoothingGroups groups =
      smoothing_groups(surface.triangles, surface.rest_positions, surface.crease_angle);
  PageSurface page;
  page.normal_count = groups.count;
  std::map<std::tuple<int, int, double, double>, std::uint32_t> known;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    for (int corner = 0; corner < 3; ++corner) {
      const int point = surface.triangles[t][corner], normal = groups.corners[t][corner];
      const Vec2 place = surface.pattern_positions.empty()
                             ? Vec2(Vec2::Zero())
                             : surface.pattern_positions[3 * t + static_cast<std::size_t>(corner)];
      const auto [drawn, added] = known.try_emplace({point, normal, place.x(), place.y()},
                                                    static_cast<std::uint32_t>(page.points.size()));
      if (added) {
        page.points.push_back(static_cast<std::uint32_t>(point));
        page.normals.push_back(static_cast<std::uint32_t>(normal));
        page.pattern.push_back(static_cast<float>(place.x()));
        page.pattern.push_back(static_cast<float>(place.y()));
      }
      page.triangles.push_back(drawn->second);
    }
  }
  const EdgeStretch stretch(mesh);
  for (const EdgeStretch::Edge& edge : stretch.edges()) {
    for (const int end : edge.ends) page.ends.push_back(static_cast<std::uint32_t>(end));
    page.rest_lengths.push_back(static_cast<float>(edge.rest_length));
  }
  return page;
}

CellsOutside outside_of(const RunReader::Cells& cells) {
  // Corner c lies at (c & 1, c >> 1 & 1, c >> 2 & 1); faces count around their outward normal.
  constexpr std::array<std::array<int, 4>, 6> faces = {
      {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
  struct Face {
    std::array<int, 4> key, corners;
  };
  std::vector<Face> all;
  for (const auto& voxel : cells.voxels)
    for (const auto& face : faces) {
      Face entry;
      for (std::size_t i = 0; i < 4; ++i) entry.corners[i] = voxel[static_cast<std::size_t>(face[i])];
      entry.key = entry.corners;
      std::sort(entry.key.begin(), entry.key.end());
      all.push_back(entry);
    }
  std::sort(all.begin(), all.end(), [](const Face& a, const Face& b) { return a.key < b.key; });
  CellsOutside outside;
  outside.mesh.face_offsets = {0};
  std::vector<int> number(cells.rest_positions.size(), -1);
  std::vector<const Face*> kept;
  for (std::size_t f = 0; f < all.size(); ++f) {
    const bool shared =
        (f > 0 && all[f - 1].key == all[f].key) || (f + 1 < all.size() && all[f + 1].key == all[f].key);
    if (shared) continue;
    kept.push_back(&all[f]);
    for (const int vertex : all[f].corners) number[static_cast<std::size_t>(vertex)] = 0;
  }
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] < 0) continue;
    number[v] = static_cast<int>(outside.vertices.size());
    outside.vertices.push_back(static_cast<int>(v));
    outside.mesh.positions.push_back(cells.rest_positions[v]);
  }
  for (const Face* face : kept) {
    std::array<int, 4> corners;
    for (std::size_t i = 0; i < 4; ++i) corners[i] = number[static_cast<std::size_t>(face->corners[i])];
    outside.mesh.add_face(corners);
  }
  return outside;
}

}  // namespace muslin
