#include "muslin/untangle/crossed_regions.hpp"

#include <algorithm>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "muslin/core/disjoint_sets.hpp"
#include "muslin/core/index.hpp"
#include "muslin/core/parallel.hpp"
#include "muslin/geometry/closest_point.hpp"

namespace muslin {
namespace {

constexpr std::size_t region_grain = 64;
/// Rings of triangles around those that a contour passes, to which points behind it may be nearest.
constexpr int rings = 2;

/// Share of the contours' corners by which a region is on one side.
constexpr double clear_share = 0.6;

using Pair = std::pair<int, int>;  // a piece, and the piece that cuts it

/// The regions into which one piece cuts another.
struct Regions {
  struct Region {
    std::vector<int> points;
    double area = 0;              // [m²]
    double side = 0;              // > 0: before the cutting surface, by its normals at the contours
    std::vector<int> piercings;   // of edges on its border
    std::vector<int> neighbours;  // regions
    bool wrong = false;
  };
  std::vector<Region> all;

  /// True if a region lies on both sides.
  static bool is_mixed(const Region& r) {
    return std::abs(r.side) < clear_share * static_cast<double>(r.piercings.size());
  }
  bool divided() const { return all.size() > 1; }
  double area_before(int side) const {
    double sum = 0;
    if (!divided()) return sum;
    for (const Region& r : all)
      if (r.side * side > 0) sum += r.area;
    return sum;
  }
  void mark(int side) {
    if (!divided()) return;
    for (Region& r : all) r.wrong = r.side * side > 0;
  }
};

class CrossedRegions {
 public:
  CrossedRegions(const ContactSurface& surface, const SurfacePieces& pieces, ConstVectors x,
                 std::span<const Piercing> piercings, Layerings& known)
      : surface_(surface),
        pieces_(pieces),
        x_(x),
        piercings_(piercings),
        known_(known),
        wrong_(surface.point_count(), 0) {
    for (std::size_t i = 0; i < piercings.size(); ++i) {
      const int cut = piece_of_edge(piercings[i].edge), by = pieces.of_triangle(piercings[i].triangle);
      if (pieces.is_solid(cut) || pieces.is_solid(by)) continue;
      by_pair_[{cut, by}].push_back(static_cast<int>(i));
    }
  }

  std::vector<LostPoint> find() {
    for (const auto& [pair, sides] : known_) decided_.insert(pair);
    for (const auto& [pair, list] : by_pair_) {
      Regions regions = divide(pair, list);
      if (pair.first != pair.second && layering(pair).layers) split_mixed(regions);
      regions_.emplace(pair, std::move(regions));
    }
    for (auto& [pair, regions] : regions_) {
      if (pair.first == pair.second) {
        mark_within(regions);
      } else if (pair.first < pair.second || !regions_.contains({pair.second, pair.first})) {
        mark_between(pair);
      }
    }
    for (const auto& [pair, regions] : regions_)
      for (const Regions::Region& region : regions.all)
        if (region.wrong)
          for (const int p : region.points) wrong_[at(p)] = 1;
    std::vector<LostPoint> lost;
    for (const auto& [pair, regions] : regions_)
      for (const Regions::Region& region : regions.all)
        if (region.wrong) add_ways_back(pair.second, region, lost);
    return lost;
  }

 private:
  int piece_of_edge(int edge) const { return pieces_.of_point(surface_.edges()[at(edge)][0]); }
  Vec3 normal(int triangle) const {
    const Vec3i& t = surface_.triangles()[at(triangle)];
    return (x_[at(t[1])] - x_[at(t[0])]).cross(x_[at(t[2])] - x_[at(t[0])]);
  }

  /// Divides a piece along the edges that are pierced an odd number of times.
  Regions divide(const Pair& pair, std::span<const int> list) const {
    std::map<int, int> count;  // by edge
    for (const int i : list) ++count[piercings_[at(i)].edge];
    DisjointSets sets(surface_.point_count());
    for (const int t : pieces_.triangles(pair.first)) {
      for (int i = 0; i < 3; ++i) {
        const int e = surface_.triangle_edges()[at(t)][i];
        const auto found = e < 0 ? count.end() : count.find(e);
        const Vec3i& corners = surface_.triangles()[at(t)];
        if (found == count.end() || found->second % 2 == 0) sets.join(corners[i], corners[(i + 1) % 3]);
      }
    }
    Regions regions;
    std::map<int, int> of_root;
    for (const int p : pieces_.points(pair.first)) {
      const auto [place, is_new] = of_root.try_emplace(sets.find(p), static_cast<int>(regions.all.size()));
      if (is_new) regions.all.emplace_back();
      Regions::Region& region = regions.all[at(place->second)];
      region.points.push_back(p);
      region.area += pieces_.area(p);
    }
    for (const int i : list) {
      const Piercing& piercing = piercings_[at(i)];
      if (count[piercing.edge] % 2 == 0) continue;
      const ContactSurface::Edge& e = surface_.edges()[at(piercing.edge)];
      const Vec3 n = normal(piercing.triangle);
      const std::array<int, 2> ends = {of_root.at(sets.find(e[0])), of_root.at(sets.find(e[1]))};
      for (int k = 0; k < 2; ++k) {
        Regions::Region& region = regions.all[at(ends[at(k)])];
        region.side += n.dot(x_[at(e[at(k)])] - piercing.at) > 0 ? 1 : -1;
        region.piercings.push_back(i);
        region.neighbours.push_back(ends[at(1 - k)]);
      }
    }
    return regions;
  }

  Vec3 normal_of_edge(int edge) const {
    Vec3 sum = Vec3::Zero();
    for (const int t : surface_.triangles_at_edge(edge)) sum += normal(t);
    return sum.normalized();
  }
  /// Splits regions of a layer that lie on both sides, since the other layer ends: points belong to the side
  /// of the nearest corner of a contour, in edges.
  void split_mixed(Regions& regions) const {
    std::vector<Regions::Region> all;
    for (Regions::Region& region : regions.all) {
      if (region.piercings.empty() || !Regions::is_mixed(region)) {
        all.push_back(std::move(region));
        continue;
      }
      std::map<int, int> side;  // by point; 0: not known
      for (const int p : region.points) side[p] = 0;
      std::deque<int> next;
      std::array<Regions::Region, 2> halves;
      for (const int i : region.piercings) {
        const Piercing& piercing = piercings_[at(i)];
        for (const int end : surface_.edges()[at(piercing.edge)]) {
          const auto found = side.find(end);
          if (found == side.end()) continue;
          const bool before = normal(piercing.triangle).dot(x_[at(end)] - piercing.at) > 0;
          halves[before ? 0 : 1].piercings.push_back(i);
          halves[before ? 0 : 1].side += before ? 1 : -1;
          if (found->second != 0) continue;
          found->second = before ? 1 : -1;
          next.push_back(end);
        }
      }
      while (!next.empty()) {
        const int p = next.front();
        next.pop_front();
        for (const int t : surface_.triangles_at_point(p)) {
          for (int k = 0; k < 3; ++k) {
            const auto found = side.find(surface_.triangles()[at(t)][k]);
            if (found == side.end() || found->second != 0) continue;
            found->second = side.at(p);
            next.push_back(found->first);
          }
        }
      }
      for (const auto& [p, s] : side) {
        Regions::Region& half = halves[s >= 0 ? 0 : 1];
        half.points.push_back(p);
        half.area += pieces_.area(p);
      }
      for (Regions::Region& half : halves)
        if (!half.points.empty()) all.push_back(std::move(half));
    }
    regions.all = std::move(all);
  }

  /// Marks the regions that an odd number of contours separates from the largest one.
  static void mark_within(Regions& regions) {
    if (!regions.divided()) return;
    const auto largest =
        std::max_element(regions.all.begin(), regions.all.end(),
                         [](const Regions::Region& a, const Regions::Region& b) { return a.area < b.area; });
    std::vector<int> contours(regions.all.size(), -1);
    std::deque<int> next = {static_cast<int>(largest - regions.all.begin())};
    contours[at(next.front())] = 0;
    while (!next.empty()) {
      const int r = next.front();
      next.pop_front();
      for (const int n : regions.all[at(r)].neighbours) {
        if (contours[at(n)] >= 0) continue;
        contours[at(n)] = contours[at(r)] + 1;
        next.push_back(n);
      }
    }
    for (std::size_t r = 0; r < regions.all.size(); ++r) regions.all[r].wrong = contours[r] % 2 == 1;
  }

  /// Marks the regions of two pieces that cut each other, such that no place is wrong for both.
  void mark_between(const Pair& pair) {
    const Pair ordered = std::minmax(pair.first, pair.second), back = {ordered.second, ordered.first};
    Regions empty;
    Regions& first = regions_.contains(ordered) ? regions_.at(ordered) : empty;
    Regions& second = regions_.contains(back) ? regions_.at(back) : empty;
    Layering& sides = known_.at(ordered);
    if (!decided_.contains(ordered) && !by_layer(ordered) &&
        first.area_before(sides.wrong_of_first) + second.area_before(sides.wrong_of_second) >
            first.area_before(-sides.wrong_of_first) + second.area_before(-sides.wrong_of_second)) {
      sides.wrong_of_first = -sides.wrong_of_first;
      sides.wrong_of_second = -sides.wrong_of_second;
    }
    first.mark(sides.wrong_of_first);
    second.mark(sides.wrong_of_second);
  }

  /// Returns the wrong side of the first of two pieces by the layers of their bodies; 0: they do not tell.
  int by_layer(const Pair& pair) const {
    const auto layer = [&](int piece) { return surface_.bodies()[at(pieces_.body(piece))].layer; };
    const std::optional<int> a = layer(pair.first), b = layer(pair.second);
    return !a || !b || *a == *b ? 0 : *a > *b ? -1 : 1;
  }

  /// Returns how two pieces lie to each other; which side is wrong may be turned by mark_between.
  const Layering& layering(const Pair& pair) {
    const Pair ordered = std::minmax(pair.first, pair.second), back = {ordered.second, ordered.first};
    const auto found = known_.find(ordered);
    if (found != known_.end()) return found->second;
    double along = 0;  // sum of cosines
    double aligned = 0, count = 0;
    for (const Pair& p : {ordered, back}) {
      const auto list = by_pair_.find(p);
      if (list == by_pair_.end()) continue;
      for (const int i : list->second) {
        const double cosine =
            normal_of_edge(piercings_[at(i)].edge).dot(normal(piercings_[at(i)].triangle).normalized());
        along += cosine;
        aligned += std::abs(cosine);
        ++count;
      }
    }
    Layering sides;
    sides.layers = aligned > layered * count;
    const int wrong = by_layer(ordered);
    if (wrong != 0) {
      sides.wrong_of_first = wrong;
      sides.wrong_of_second = -wrong;
    } else {
      sides.wrong_of_second = along >= 0 ? -1 : 1;
    }
    return known_.emplace(ordered, sides).first->second;
  }

  /// Returns the triangles of piece `by` near the contours of a region and behind them.
  std::vector<int> triangles_around(int by, const Regions::Region& region) const {
    std::vector<std::uint8_t> own(surface_.point_count(), 0);
    for (const int p : region.points) own[at(p)] = 1;
    const auto is_own = [&](int t) {
      const Vec3i& c = surface_.triangles()[at(t)];
      return own[at(c[0])] != 0 || own[at(c[1])] != 0 || own[at(c[2])] != 0;
    };
    std::map<int, int> ring;  // by triangle
    std::deque<int> next;
    const auto add = [&](int t, int distance) {
      if (pieces_.of_triangle(t) != by || is_own(t) || distance > rings) return;
      const auto [place, is_new] = ring.try_emplace(t, distance);
      if (!is_new && place->second <= distance) return;
      place->second = distance;
      next.push_back(t);
    };
    for (const int i : region.piercings) add(piercings_[at(i)].triangle, 0);
    for (const Piercing& p : piercings_) {
      if (!is_own(p.triangle)) continue;
      for (const int t : surface_.triangles_at_edge(p.edge)) add(t, 0);
    }
    while (!next.empty()) {
      const int t = next.front();
      next.pop_front();
      const int distance = ring.at(t);
      const Vec3i& corners = surface_.triangles()[at(t)];
      for (int k = 0; k < 3; ++k)
        for (const int n : surface_.triangles_at_point(corners[k]))
          add(n, wrong_[at(corners[k])] != 0 ? distance : distance + 1);
    }
    std::vector<int> all;
    all.reserve(ring.size());
    for (const auto& [t, distance] : ring) all.push_back(t);
    return all;
  }

  /// True if a place on a triangle is on the border of its surface: what is nearest to it is beside it.
  bool is_on_border(int triangle, const Vec3& weights) const {
    for (int i = 0; i < 3; ++i) {
      const int e = surface_.triangle_edges()[at(triangle)][i];
      if (e >= 0 && weights[(i + 2) % 3] <= 0 && surface_.triangles_at_edge(e).size() == 1) return true;
    }
    return false;
  }

  void add_ways_back(int by, const Regions::Region& region, std::vector<LostPoint>& lost) const {
    const std::vector<int> around = triangles_around(by, region);
    if (around.empty() || region.side == 0) return;
    std::vector<Vec3i> triangles;
    triangles.reserve(around.size());
    for (const int t : around) triangles.push_back(surface_.triangles()[at(t)]);
    const ClosestPointQuery nearest(x_, triangles);
    const double side = region.side > 0 ? 1 : -1;
    const std::vector<LostPoint> found =
        parallel_collect<LostPoint>(region.points.size(), region_grain,
                                    [&](std::size_t begin, std::size_t end, std::vector<LostPoint>& out) {
                                      for (std::size_t i = begin; i < end; ++i) {
                                        const int p = region.points[i];
                                        const ClosestPoint near = nearest(x_[at(p)]);
                                        const int t = around[at(near.triangle)];
                                        const Vec3 n = normal(t);
                                        if (!(n.norm() > 0)) continue;
                                        const Vec3 back = -side * n.normalized();
                                        const double depth = back.dot(near.point - x_[at(p)]);
                                        if (depth < 0 || is_on_border(t, near.barycentric)) continue;
                                        out.push_back({p, by, t, near.barycentric, back, depth});
                                      }
                                    });
    lost.insert(lost.end(), found.begin(), found.end());
  }

  const ContactSurface& surface_;
  const SurfacePieces& pieces_;
  ConstVectors x_;
  std::span<const Piercing> piercings_;
  Layerings& known_;
  std::set<Pair> decided_;                    // before this call
  std::map<Pair, std::vector<int>> by_pair_;  // piercings
  std::map<Pair, Regions> regions_;
  std::vector<std::uint8_t> wrong_;  // #P
};

}  // namespace

std::vector<LostPoint> find_crossed_regions(const ContactSurface& surface, const SurfacePieces& pieces,
                                            ConstVectors x, std::span<const Piercing> piercings,
                                            Layerings& known) {
  return CrossedRegions(surface, pieces, x, piercings, known).find();
}

}  // namespace muslin
