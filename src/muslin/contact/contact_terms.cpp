#include "muslin/contact/contact_terms.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <unordered_map>
#include <utility>

#include "muslin/contact/contact_energy.hpp"
#include "muslin/contact/turning_plane.hpp"
#include "muslin/core/index.hpp"
#include "muslin/core/parallel.hpp"

namespace muslin {
namespace {

constexpr std::size_t term_grain = 1024, patch_grain = 128;
constexpr double rounding = 1e-9;
/// A round body meets the insides of faces and edges within this share of the range, and not at all where
/// they come nearer to it than their corners by less than the second share: then these are enough. One that
/// is smaller than faces, which come nearer by more than `round_most` ranges, is met by them as a point is.
constexpr double round_range = 0.5, round_sagitta = 0.25, round_most = 8;
/// Edges fade out towards their ends over this share of the range, where the vertex there is in range as
/// well, but of no more than this share of their length; and below this squared sine of their angle.
constexpr double end_ranges = 0.5, end_share = 0.05, parallel_share = 1e-3;

double smoothstep(double y) {
  const double c = std::clamp(y, 0.0, 1.0);
  return c * c * (3 - 2 * c);
}

/// The factor of two edges: 1 where both closest points are well inside, 0 at ends and where the edges are
/// parallel. An end that is the corner opposite to the other edge in its only triangle stays: no pair of that
/// vertex meets the edge, and nothing else keeps the triangle from being flattened.
double edge_factor(const ContactSurface& surface, const ContactPair& pair, const PairGeometry& at,
                   ConstVectors x) {
  const auto edge = [&](std::size_t i) {
    return Vec3(x[static_cast<std::size_t>(pair.points[i + 1])] -
                x[static_cast<std::size_t>(pair.points[i])]);
  };
  const Vec3 u = edge(0), v = edge(2);
  const double sine = u.cross(v).squaredNorm() / std::max(u.squaredNorm() * v.squaredNorm(), 1e-300);
  const double apart = std::min(1.0, sine / parallel_share);
  const auto inside = [&](double t, double squared_length, std::size_t first, int other) {
    const double width =
        std::min(end_share, end_ranges * pair.range / std::sqrt(std::max(squared_length, 1e-300)));
    const int lone = surface.lone_corner(other);
    const double begin = pair.points[first] == lone ? 1 : smoothstep(t / width);
    const double end = pair.points[first + 1] == lone ? 1 : smoothstep((1 - t) / width);
    return begin * end;
  };
  return inside(at.weights[1], u.squaredNorm(), 0, pair.second) *
         inside(-at.weights[3], v.squaredNorm(), 2, pair.first) * apart * (2 - apart);
}

PairGeometry of_difference(const Vec3& difference, const std::array<double, 4>& weights) {
  const double d = difference.norm();
  return {d > 0 ? Vec3(difference / d) : Vec3(Vec3::Zero()), d, weights};
}

/// The range of a pair's term; 0 where it has none.
double range_of(const ContactSurface& surface, const ContactPair& pair, ConstVectors x) {
  const bool faces = pair.kind == PairKind::vertex_triangle;
  if (pair.kind == PairKind::point_plane) return pair.range;
  const bool first = surface.is_round(pair.points[0]), second = surface.is_round(pair.points[3]);
  if (!(first || (second && !faces))) return pair.range;
  if (first && second) return pair.range;
  const std::size_t begin = faces ? 1 : first ? 2 : 0, end = faces || first ? 4 : 2;
  double longest = 0;
  for (std::size_t i = begin; i < end; ++i)
    for (std::size_t j = begin; j < i; ++j)
      longest = std::max(
          longest, (x[static_cast<std::size_t>(pair.points[i])] - x[static_cast<std::size_t>(pair.points[j])])
                       .squaredNorm());
  const double sagitta = longest / (8 * pair.thickness);
  if (!(sagitta < round_most * pair.range)) return pair.range;
  return sagitta < round_sagitta * pair.range ? 0 : round_range * pair.range;
}

double stiffness_of(const ContactSurface& surface, const ContactPair& pair, double dt) {
  const std::optional<double> ruled = pair.rule < 0 ? std::nullopt : surface.rules()[pair.rule].stiffness;
  return ruled ? *ruled
               : surface.stiffness(pair.points[0],
                                   pair.points[static_cast<std::size_t>(pair.point_count() - 1)], dt);
}

bool is_near(double gap, double range) { return gap > 0 && gap < PairDistances::ranges_known * range; }

/// The triangles of one body that one vertex is near to.
class Patch {
 public:
  explicit Patch(const PairDistances& distances)
      : surface_(distances.candidates().surface()),
        pairs_(distances.candidates().pairs()),
        distances_(distances) {}

  /// Sets the pairs of the vertex with the triangles, in the order of the triangles.
  void assign(std::span<const int> pairs, double dt) {
    if (!places_.empty())
      for (const int t : triangles_) places_[static_cast<std::size_t>(t)] = -1;
    indices_ = pairs;
    triangles_.resize(pairs.size());
    ranges_.resize(pairs.size());
    stiffnesses_.resize(pairs.size());
    if (is_large(pairs.size()) && places_.empty()) places_.assign(surface_.triangles().size(), -1);
    parallel_for(pairs.size(), patch_grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        triangles_[k] = pair(k).second;
        ranges_[k] = range_of(surface_, pair(k), distances_.points());
        stiffnesses_[k] = stiffness_of(surface_, pair(k), dt);
        if (!places_.empty()) places_[static_cast<std::size_t>(triangles_[k])] = static_cast<int>(k);
      }
    });
    vertex_ = pair(0).points[0];
    const auto range_is_less = [&](std::size_t k) { return ranges_[k] < pair(k).range; };
    corners_only_ = false;
    if (is_lone_point())
      for (std::size_t k = 0; k < size() && !corners_only_; ++k) corners_only_ = range_is_less(k);
  }

  std::size_t size() const { return triangles_.size(); }
  /// Large patches find triangles by a table, and are worth several threads each.
  static bool is_large(std::size_t size) { return size > 256; }

  /// Appends the terms of triangle k, and those of its edges and corners that no triangle before it has.
  void add_terms(std::size_t k, std::vector<ContactTerm>& out) const {
    const ContactPair& own = pair(k);
    if (ranges_[k] > 0) {
      out.push_back({ContactTerm::Kind::vertex_triangle, own.rule, own.points, -1, own.key(), own.thickness,
                     ranges_[k], stiffnesses_[k]});
    }
    const Vec3i &corners = surface_.triangles()[at(triangles_[k])],
                &edges = surface_.triangle_edges()[at(triangles_[k])];
    for (int i = 0; i < 3; ++i) {
      if (!is_again(edges, i) && edges[i] >= 0) add_edge(k, edges[i], out);
      if (!is_again(corners, i)) add_corner(k, corners[i], out);
    }
  }

 private:
  /// The triangles of the patch that share an edge or a corner: their count, the least of their numbers, and
  /// the greatest thickness. Features without double counting must be no thicker than their triangles.
  struct Feature {
    int triangles = 0;
    double thickness = std::numeric_limits<double>::infinity(), range = thickness, stiffness = thickness;
    double thickest = 0;
  };

  static bool is_again(const Vec3i& three, int i) {
    return (i > 0 && three[i] == three[0]) || (i == 2 && three[2] == three[1]);
  }
  const ContactPair& pair(std::size_t k) const { return pairs_[at(indices_[k])]; }

  /// Returns the place of a triangle in the patch; size() if it is not in it.
  std::size_t find(int triangle) const {
    if (is_large(size())) {
      const int place = places_[at(triangle)];
      return place < 0 ? size() : at(place);
    }
    const auto found = std::lower_bound(triangles_.begin(), triangles_.end(), triangle);
    return found != triangles_.end() && *found == triangle
               ? static_cast<std::size_t>(found - triangles_.begin())
               : size();
  }

  /// True if triangle k is the first of the patch among `triangles`, of which it is one.
  bool is_first(std::size_t k, std::span<const int> triangles) const {
    for (const int t : triangles)
      if (const std::size_t place = find(t); place < size()) return place == k;
    return false;
  }

  Feature feature(std::span<const int> triangles) const {
    Feature result;
    for (const int t : triangles) {
      const std::size_t k = find(t);
      if (k == size()) continue;
      ++result.triangles;
      result.thickness = std::min(result.thickness, pair(k).thickness);
      result.thickest = std::max(result.thickest, pair(k).thickness);
      result.range = std::min(result.range, ranges_[k]);
      result.stiffness = std::min(result.stiffness, stiffnesses_[k]);
    }
    return result;
  }

  void add_edge(std::size_t k, int edge, std::vector<ContactTerm>& out) const {
    const std::span<const int> triangles = surface_.triangles_at_edge(edge);
    if (!is_first(k, triangles)) return;
    const Feature e = feature(triangles);
    const ContactSurface::Edge& ends = surface_.edges()[at(edge)];
    add({ContactTerm::Kind::vertex_edge,
         pair(k).rule,
         {vertex_, ends[0], ends[1], -1},
         -1,
         0,
         e.thickness,
         e.range,
         (1 - e.triangles) * e.stiffness},
        out);
  }

  void add_corner(std::size_t k, int corner, std::vector<ContactTerm>& out) const {
    const std::span<const int> triangles = surface_.triangles_at_point(corner);
    if (!is_first(k, triangles)) return;
    const Feature c = feature(triangles);
    if (corners_only_) {
      // The search finds the centre of a sphere and corners only with the corners' triangles.
      const std::uint64_t key =
          ContactPair::key_of(PairKind::vertex_triangle, corner, surface_.round_triangle(vertex_));
      add({ContactTerm::Kind::vertex_vertex,
           pair(k).rule,
           {vertex_, corner, -1, -1},
           -1,
           key,
           c.thickest,
           pair(0).range,
           stiffnesses_[0]},
          out);
    }
    if (!(c.range > 0)) return;
    // Each triangle but the first at an edge adds one to Σ (n_e − 1).
    int coefficient = 1 - c.triangles;
    for (const int t : triangles) {
      const std::size_t place = find(t);
      if (place == size()) continue;
      const Vec3i& edges = surface_.triangle_edges()[at(t)];
      for (int i = 0; i < 3; ++i) {
        if (edges[i] < 0 || is_again(edges, i)) continue;
        const ContactSurface::Edge& ends = surface_.edges()[at(edges[i])];
        const bool meets = ends[0] == corner || ends[1] == corner;
        if (meets && !is_first(place, surface_.triangles_at_edge(edges[i]))) ++coefficient;
      }
    }
    add({ContactTerm::Kind::vertex_vertex,
         pair(k).rule,
         {vertex_, corner, -1, -1},
         -1,
         0,
         c.thickness,
         c.range,
         coefficient * c.stiffness},
        out);
  }

  void add(const ContactTerm& term, std::vector<ContactTerm>& out) const {
    if (term.stiffness == 0 || !(term.range > 0)) return;
    const double gap = term_geometry(surface_, term, distances_.points()).distance - term.thickness;
    if (is_near(gap, term.range)) out.push_back(term);
  }

  bool is_lone_point() const {
    if (!surface_.is_round(vertex_)) return false;
    const Vec3i& t = surface_.triangles()[at(surface_.round_triangle(vertex_))];
    return t[0] == t[1] && t[1] == t[2];
  }

  const ContactSurface& surface_;
  std::span<const ContactPair> pairs_;
  const PairDistances& distances_;
  std::span<const int> indices_;  ///< into pairs_
  std::vector<int> triangles_;
  std::vector<double> ranges_, stiffnesses_;
  std::vector<int> places_;  ///< by triangle; −1: none. Empty before the first large patch
  int vertex_ = 0;
  bool corners_only_ = false;  ///< a sphere that some of the triangles are too small to meet as faces
};

/// Appends the term of a pair of a point and a plane or of two edges.
void add_term(const PairDistances& distances, std::size_t i, double dt, std::vector<ContactTerm>& out) {
  const ContactSurface& surface = distances.candidates().surface();
  const ContactPair& pair = distances.candidates().pairs()[i];
  const double stiffness = stiffness_of(surface, pair, dt);
  if (pair.kind == PairKind::point_plane) {
    out.push_back({ContactTerm::Kind::point_plane, pair.rule, pair.points, pair.second, pair.key(),
                   pair.thickness, pair.range, stiffness});
    return;
  }
  const double factor = edge_factor(surface, pair, distances[i], distances.points());
  const double range = range_of(surface, pair, distances.points());
  if (factor > 0 && range > 0) {
    out.push_back({ContactTerm::Kind::edge_edge, pair.rule, pair.points, -1, pair.key(), pair.thickness,
                   range, factor * stiffness});
  }
}

/// Leaves out points without weight and names each point once.
MergedContact reduced(const ContactTerm& term, const PairGeometry& at) {
  MergedContact contact;
  contact.key = term.key;
  contact.rule = term.rule;
  contact.normal = at.normal;
  int count = 0;
  const auto take = [&](int from, int to) {
    const int begin = count;
    for (int i = from; i < to; ++i) {
      const auto k = static_cast<std::size_t>(i);
      if (term.points[k] < 0 || at.weights[k] == 0) continue;
      int place = begin;
      while (place < count && contact.points[static_cast<std::size_t>(place)] < term.points[k]) ++place;
      if (place < count && contact.points[static_cast<std::size_t>(place)] == term.points[k]) {
        contact.weights[static_cast<std::size_t>(place)] += at.weights[k];
        continue;
      }
      for (int j = count++; j > place; --j) {
        contact.points[static_cast<std::size_t>(j)] = contact.points[static_cast<std::size_t>(j - 1)];
        contact.weights[static_cast<std::size_t>(j)] = contact.weights[static_cast<std::size_t>(j - 1)];
      }
      contact.points[static_cast<std::size_t>(place)] = term.points[k];
      contact.weights[static_cast<std::size_t>(place)] = at.weights[k];
    }
  };
  take(0, term.first_size());
  contact.first_size = count;
  take(term.first_size(), 4);
  return contact;
}

/// Pairs of vertices and triangles in the order of their vertices, then of their triangles.
std::vector<int> by_features(std::span<const ContactPair> pairs, std::span<const int> found,
                             std::size_t point_count) {
  const auto pair_of = [&](int i) -> const ContactPair& { return pairs[static_cast<std::size_t>(i)]; };
  std::vector<std::size_t> begins(point_count + 1, 0);
  for (const int i : found) ++begins[static_cast<std::size_t>(pair_of(i).first) + 1];
  std::partial_sum(begins.begin(), begins.end(), begins.begin());
  std::vector<int> sorted(found.size());
  std::vector<std::size_t> next(begins.begin(), begins.end() - 1);
  for (const int i : found) sorted[next[static_cast<std::size_t>(pair_of(i).first)]++] = i;
  parallel_for(point_count, term_grain, [&](std::size_t first, std::size_t last) {
    for (std::size_t v = first; v < last; ++v) {
      std::sort(sorted.begin() + static_cast<std::ptrdiff_t>(begins[v]),
                sorted.begin() + static_cast<std::ptrdiff_t>(begins[v + 1]),
                [&](int i, int j) { return pair_of(i).second < pair_of(j).second; });
    }
  });
  return sorted;
}

/// Identifies a contact by the points that have weight in it.
struct TouchingPoints {
  int first_size;
  std::array<int, 4> points;
  bool operator==(const TouchingPoints&) const = default;
};
struct HashOfPoints {
  std::size_t operator()(const TouchingPoints& p) const {
    auto hash = static_cast<std::uint64_t>(p.first_size);
    for (const int point : p.points) hash = (hash ^ static_cast<std::uint32_t>(point)) * 0x9e3779b97f4a7c15;
    return hash ^ hash >> 32;
  }
};

/// The places of contacts in a list to which they are added one by one. Short lists are searched one by one,
/// long ones by a table: most vertices are near to a few features, a ball to thousands.
class Places {
 public:
  void clear() {
    keys_.clear();
    table_.clear();
  }
  /// The length of the list for a key that is not in it.
  std::size_t find(const TouchingPoints& key) const {
    if (table_.empty())
      return static_cast<std::size_t>(std::find(keys_.begin(), keys_.end(), key) - keys_.begin());
    const auto known = table_.find(key);
    return known == table_.end() ? keys_.size() : known->second;
  }
  void add(const TouchingPoints& key) {
    keys_.push_back(key);
    if (keys_.size() <= few) return;
    for (std::size_t i = table_.empty() ? 0 : keys_.size() - 1; i < keys_.size(); ++i)
      table_.emplace(keys_[i], i);
  }

 private:
  static constexpr std::size_t few = 24;
  std::vector<TouchingPoints> keys_;
  std::unordered_map<TouchingPoints, std::size_t, HashOfPoints> table_;
};

}  // namespace

PairGeometry term_geometry(const ContactSurface& surface, const ContactTerm& term, ConstVectors x) {
  const auto at = [&](std::size_t i) -> const Vec3& { return x[static_cast<std::size_t>(term.points[i])]; };
  switch (term.kind) {
    case ContactTerm::Kind::point_plane: {
      const ContactPlane& plane = surface.planes()[static_cast<std::size_t>(term.plane)];
      if (plane.turns()) {
        const OverPlane over = over_plane(std::array{at(0), at(1), at(2), at(3)});
        return {over.normal, over.distance, over.weights};
      }
      return {plane.normal, plane.normal.dot(at(0) - at(1)), {1, -1, 0, 0}};
    }
    case ContactTerm::Kind::vertex_triangle: {
      const ClosestPoints c = closest_vertex_triangle(at(0), at(1), at(2), at(3));
      return of_difference(c.difference, c.weights);
    }
    case ContactTerm::Kind::vertex_edge: {
      const double t = closest_on_segment(at(0), at(1), at(2));
      return of_difference(at(0) - at(1) - t * (at(2) - at(1)), {1, -(1 - t), -t, 0});
    }
    case ContactTerm::Kind::vertex_vertex:
      return of_difference(at(0) - at(1), {1, -1, 0, 0});
    case ContactTerm::Kind::edge_edge:
      break;
  }
  const ClosestPoints c = closest_edge_edge(at(0), at(1), at(2), at(3));
  return of_difference(c.difference, c.weights);
}

std::vector<ContactTerm> contact_terms(const PairDistances& distances, double dt) {
  const ContactSurface& surface = distances.candidates().surface();
  const std::span<const ContactPair> pairs = distances.candidates().pairs();
  const auto is_near_pair = [&](std::size_t i) {
    return distances.is_known(i) && is_near(distances[i].distance - pairs[i].thickness, pairs[i].range);
  };
  std::vector<ContactTerm> terms = parallel_collect<ContactTerm>(
      pairs.size(), term_grain, [&](std::size_t begin, std::size_t end, auto& out) {
        for (std::size_t i = begin; i < end; ++i) {
          if (pairs[i].kind != PairKind::vertex_triangle && is_near_pair(i)) add_term(distances, i, dt, out);
        }
      });
  const std::vector<int> found =
      parallel_collect<int>(pairs.size(), term_grain, [&](std::size_t begin, std::size_t end, auto& out) {
        for (std::size_t i = begin; i < end; ++i) {
          if (pairs[i].kind == PairKind::vertex_triangle && is_near_pair(i))
            out.push_back(static_cast<int>(i));
        }
      });
  const std::vector<int> of_vertices = by_features(pairs, found, distances.points().size());
  // A vertex meets the triangles of one body as one surface; another body is another contact.
  std::vector<std::size_t> begins;
  for (std::size_t k = 0; k < of_vertices.size(); ++k) {
    const auto meets = [&](std::size_t at) {
      const ContactPair& pair = pairs[static_cast<std::size_t>(of_vertices[at])];
      return std::pair(pair.first, surface.body_of(pair.points[3]));
    };
    if (k == 0 || meets(k) != meets(k - 1)) begins.push_back(k);
  }
  const std::size_t patches = begins.size();
  begins.push_back(of_vertices.size());
  const auto pairs_of = [&](std::size_t p) {
    return std::span(of_vertices).subspan(begins[p], begins[p + 1] - begins[p]);
  };
  const auto append = [&](const std::vector<ContactTerm>& more) {
    terms.insert(terms.end(), more.begin(), more.end());
  };
  append(
      parallel_collect<ContactTerm>(patches, patch_grain, [&](std::size_t begin, std::size_t end, auto& out) {
        Patch patch(distances);
        for (std::size_t p = begin; p < end; ++p) {
          if (Patch::is_large(pairs_of(p).size())) continue;
          patch.assign(pairs_of(p), dt);
          for (std::size_t k = 0; k < patch.size(); ++k) patch.add_terms(k, out);
        }
      }));
  Patch large(distances);
  for (std::size_t p = 0; p < patches; ++p) {
    if (!Patch::is_large(pairs_of(p).size())) continue;
    large.assign(pairs_of(p), dt);
    append(parallel_collect<ContactTerm>(large.size(), patch_grain,
                                         [&](std::size_t begin, std::size_t end, auto& out) {
      for (std::size_t k = begin; k < end; ++k) large.add_terms(k, out);
                                         }));
  }
  return terms;
}

std::vector<MergedContact> merged_contacts(const ContactSurface& surface, std::span<const ContactTerm> terms,
                                           ConstVectors x) {
  const std::vector<MergedContact> contacts = parallel_collect<MergedContact>(
      terms.size(), term_grain, [&](std::size_t begin, std::size_t end, auto& out) {
        for (std::size_t i = begin; i < end; ++i) {
          const PairGeometry at = term_geometry(surface, terms[i], x);
          const double gap = at.distance - terms[i].thickness;
          if (gap >= terms[i].range) continue;
          const Law law = contact_law(gap, terms[i].range);
          MergedContact contact = reduced(terms[i], at);
          contact.slope = terms[i].stiffness * law.slope;
          contact.curvature = terms[i].stiffness * law.curvature;
          contact.stiffness = terms[i].stiffness;
          contact.magnitude = std::abs(contact.slope);
          contact.distance = at.distance;
          out.push_back(contact);
        }
      });
  // Terms of one vertex against one body follow one another, and those against two have no closest points in
  // common.
  std::vector<MergedContact> merged;
  std::size_t first = 0;
  Places places;
  for (const MergedContact& contact : contacts) {
    if (!merged.empty() && merged.back().points[0] != contact.points[0]) {
      first = merged.size();
      places.clear();
    }
    const TouchingPoints points = {contact.first_size, contact.points};
    const std::size_t place = first + places.find(points);
    if (place == merged.size()) {
      merged.push_back(contact);
      places.add(points);
      continue;
    }
    MergedContact& same = merged[place];
    same.slope += contact.slope;
    same.curvature += contact.curvature;
    same.stiffness += contact.stiffness;
    same.magnitude += contact.magnitude;
    if (same.key == 0) {
      same.key = contact.key;
      same.rule = contact.rule;
    }
  }
  std::erase_if(merged, [](const MergedContact& contact) {
    return contact.stiffness == 0 && std::abs(contact.slope) <= rounding * contact.magnitude;
  });
  return merged;
}

}  // namespace muslin
