#include "muslin/contact/contact_terms.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "muslin/contact/contact_energy.hpp"
#include "muslin/contact/turning_plane.hpp"
#include "muslin/core/parallel.hpp"

namespace muslin {
namespace {

constexpr std::size_t grain = 1024, surface_grain = 128;
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
      longest = std::max(longest, (x[static_cast<std::size_t>(pair.points[i])] -
                                   x[static_cast<std::size_t>(pair.points[j])]).squaredNorm());
  const double sagitta = longest / (8 * pair.thickness);
  if (!(sagitta < round_most * pair.range)) return pair.range;
  return sagitta < round_sagitta * pair.range ? 0 : round_range * pair.range;
}

bool is_near(double gap, double range) { return gap > 0 && gap < PairDistances::ranges_known * range; }

/// The places of keys in a list to which they are added one by one. Short lists are searched key by key, long
/// ones by a table: most vertices are near to a few features, a ball to thousands.
template <class Key, class Hash>
class Places {
 public:
  void clear() {
    keys_.clear();
    table_.clear();
  }
  /// The length of the list for a key that is not in it.
  std::size_t find(const Key& key) const {
    if (table_.empty())
      return static_cast<std::size_t>(std::find(keys_.begin(), keys_.end(), key) - keys_.begin());
    const auto known = table_.find(key);
    return known == table_.end() ? keys_.size() : known->second;
  }
  void add(const Key& key) {
    keys_.push_back(key);
    if (keys_.size() <= few) return;
    for (std::size_t i = table_.empty() ? 0 : keys_.size() - 1; i < keys_.size(); ++i) table_.emplace(keys_[i], i);
  }

 private:
  static constexpr std::size_t few = 24;
  std::vector<Key> keys_;
  std::unordered_map<Key, std::size_t, Hash> table_;
};

/// The terms of one vertex against the triangles of `pairs`.
class VertexTerms {
 public:
  VertexTerms(const PairDistances& distances, double dt, std::vector<ContactTerm>& out)
      : surface_(distances.candidates().surface()), distances_(distances), dt_(dt), out_(out) {}

  void add(std::span<const int> pairs) {
    edges_.clear();
    corners_.clear();
    const std::span<const ContactPair> all = distances_.candidates().pairs();
    bool reduced = false;
    for (const int i : pairs) {
      const ContactPair& pair = all[static_cast<std::size_t>(i)];
      const auto t = static_cast<std::size_t>(pair.second);
      const Vec3i &corners = surface_.triangles()[t], &edges = surface_.triangle_edges()[t];
      for (int k = 0; k < 3; ++k) {
        const bool corner_again =
            (k > 0 && corners[k] == corners[0]) || (k == 2 && corners[2] == corners[1]);
        if (!corner_again) note(corners_, corners[k], pair);
        const bool edge_again = (k > 0 && edges[k] == edges[0]) || (k == 2 && edges[2] == edges[1]);
        if (edges[k] >= 0 && !edge_again) note(edges_, edges[k], pair);
      }
      const double range = range_of(surface_, pair, distances_.points());
      reduced |= range < pair.range;
      if (range > 0) {
        out_.push_back({ContactTerm::Kind::vertex_triangle, pair.points, -1, pair.key(), pair.thickness,
                        range, surface_.stiffness(pair.points[0], pair.points[3], dt_)});
      }
    }
    const ContactPair& first = all[static_cast<std::size_t>(pairs[0])];
    const int v = first.points[0];
    if (reduced && is_lone_point(v)) add_corners(v, first);
    for (const Feature& e : edges_.all) {
      if (e.triangles == 1) continue;
      const ContactSurface::Edge& ends = surface_.edges()[static_cast<std::size_t>(e.index)];
      for (const int end : ends) {
        const std::size_t place = corners_.places.find(end);
        if (place < corners_.all.size()) corners_.all[place].coefficient -= 1 - e.triangles;
      }
      add_feature(e, {v, ends[0], ends[1], -1}, ContactTerm::Kind::vertex_edge, 1 - e.triangles);
    }
    for (const Feature& corner : corners_.all) {
      add_feature(corner, {v, corner.index, -1, -1}, ContactTerm::Kind::vertex_vertex,
                  corner.coefficient + 1 - corner.triangles);
    }
  }

 private:
  bool is_lone_point(int v) const {
    if (!surface_.is_round(v)) return false;
    const Vec3i& t = surface_.triangles()[static_cast<std::size_t>(surface_.round_triangle(v))];
    return t[0] == t[1] && t[1] == t[2];
  }

  /// The centre of a sphere and the corners of triangles; the search finds them with the triangles only.
  void add_corners(int v, const ContactPair& pair) {
    for (const Feature& corner : corners_.all) {
      ContactTerm term;
      term.kind = ContactTerm::Kind::vertex_vertex;
      term.points = {v, corner.index, -1, -1};
      term.key = ContactPair::key_of(PairKind::vertex_triangle, corner.index, surface_.round_triangle(v));
      term.thickness = pair.thickness;
      term.range = pair.range;
      term.stiffness = surface_.stiffness(v, corner.index, dt_);
      const double gap = term_geometry(surface_, term, distances_.points()).distance - term.thickness;
      if (is_near(gap, term.range)) out_.push_back(term);
    }
  }

  struct Feature {
    int index = 0, triangles = 0, coefficient = 0;
    double thickness = 0, range = 0;
  };
  /// Edges or corners, each once.
  struct Features {
    std::vector<Feature> all;
    Places<int, std::hash<int>> places;
    void clear() {
      all.clear();
      places.clear();
    }
  };

  void note(Features& features, int index, const ContactPair& pair) const {
    const double range = range_of(surface_, pair, distances_.points());
    const std::size_t place = features.places.find(index);
    if (place < features.all.size()) {
      Feature& known = features.all[place];
      ++known.triangles;
      known.thickness = std::min(known.thickness, pair.thickness);
      known.range = std::min(known.range, range);
      return;
    }
    features.all.push_back({index, 1, 0, pair.thickness, range});
    features.places.add(index);
  }

  void add_feature(const Feature& feature, const std::array<int, 4>& points, ContactTerm::Kind kind,
                   int coefficient) {
    if (coefficient == 0) return;
    const ContactTerm term = {kind,
                              points,
                              -1,
                              0,
                              feature.thickness,
                              feature.range,
                              coefficient * surface_.stiffness(points[0], points[1], dt_)};
    if (!(term.range > 0)) return;
    const double gap = term_geometry(surface_, term, distances_.points()).distance - term.thickness;
    if (is_near(gap, term.range)) out_.push_back(term);
  }

  const ContactSurface& surface_;
  const PairDistances& distances_;
  double dt_;
  std::vector<ContactTerm>& out_;
  Features edges_, corners_;
};

/// Leaves out points without weight and names each point once.
MergedContact reduced(const ContactTerm& term, const PairGeometry& at) {
  MergedContact contact;
  contact.key = term.key;
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
std::vector<int> by_features(std::span<const ContactPair> pairs, std::vector<int> found, std::size_t point_count) {
  const auto pair_of = [&](int i) -> const ContactPair& { return pairs[static_cast<std::size_t>(i)]; };
  std::vector<std::size_t> begins(point_count + 1, 0);
  for (const int i : found) ++begins[static_cast<std::size_t>(pair_of(i).first) + 1];
  std::partial_sum(begins.begin(), begins.end(), begins.begin());
  std::vector<int> sorted(found.size());
  std::vector<std::size_t> next(begins.begin(), begins.end() - 1);
  for (const int i : found) sorted[next[static_cast<std::size_t>(pair_of(i).first)]++] = i;
  for (std::size_t v = 0; v < point_count; ++v) {
    std::sort(sorted.begin() + static_cast<std::ptrdiff_t>(begins[v]),
              sorted.begin() + static_cast<std::ptrdiff_t>(begins[v + 1]),
              [&](int i, int j) { return pair_of(i).second < pair_of(j).second; });
  }
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
  struct Block {
    std::vector<ContactTerm> terms;
    std::vector<int> of_vertices;  // pairs
  };
  std::vector<Block> blocks((pairs.size() + grain - 1) / grain);
  parallel_for(pairs.size(), grain, [&](std::size_t begin, std::size_t end) {
    Block& block = blocks[begin / grain];
    for (std::size_t i = begin; i < end; ++i) {
      const ContactPair& pair = pairs[i];
      if (!distances.is_known(i) || !is_near(distances[i].distance - pair.thickness, pair.range)) continue;
      if (pair.kind == PairKind::vertex_triangle) {
        block.of_vertices.push_back(static_cast<int>(i));
        continue;
      }
      const double stiffness =
          surface.stiffness(pair.points[0], pair.points[static_cast<std::size_t>(pair.point_count() - 1)], dt);
      if (pair.kind == PairKind::point_plane) {
        block.terms.push_back({ContactTerm::Kind::point_plane, pair.points, pair.second, pair.key(), pair.thickness,
                               pair.range, stiffness});
        continue;
      }
      const double factor = edge_factor(surface, pair, distances[i], distances.points());
      const double range = range_of(surface, pair, distances.points());
      if (factor > 0 && range > 0) {
        block.terms.push_back({ContactTerm::Kind::edge_edge, pair.points, -1, pair.key(), pair.thickness, range,
                               factor * stiffness});
      }
    }
  });
  std::vector<ContactTerm> terms;
  std::vector<int> found;
  for (const Block& block : blocks) {
    terms.insert(terms.end(), block.terms.begin(), block.terms.end());
    found.insert(found.end(), block.of_vertices.begin(), block.of_vertices.end());
  }
  const auto pair_of = [&](int i) -> const ContactPair& { return pairs[static_cast<std::size_t>(i)]; };
  const std::vector<int> of_vertices = by_features(pairs, std::move(found), distances.points().size());
  // A vertex meets the triangles of one body as one surface; another body is another contact.
  std::vector<std::size_t> begins;
  for (std::size_t k = 0; k < of_vertices.size(); ++k) {
    const auto meets = [&](std::size_t at) {
      const ContactPair& pair = pair_of(of_vertices[at]);
      return std::pair(pair.first, surface.body_of(pair.points[3]));
    };
    if (k == 0 || meets(k) != meets(k - 1)) begins.push_back(k);
  }
  const std::size_t surfaces = begins.size();
  begins.push_back(of_vertices.size());
  std::vector<std::vector<ContactTerm>> terms_of_block((surfaces + surface_grain - 1) / surface_grain);
  parallel_for(surfaces, surface_grain, [&](std::size_t begin, std::size_t end) {
    VertexTerms of_vertex(distances, dt, terms_of_block[begin / surface_grain]);
    for (std::size_t s = begin; s < end; ++s)
      of_vertex.add(std::span(of_vertices).subspan(begins[s], begins[s + 1] - begins[s]));
  });
  for (const std::vector<ContactTerm>& block : terms_of_block) terms.insert(terms.end(), block.begin(), block.end());
  return terms;
}

std::vector<MergedContact> merged_contacts(const ContactSurface& surface, std::span<const ContactTerm> terms,
                                           ConstVectors x) {
  const std::size_t blocks = (terms.size() + grain - 1) / grain;
  std::vector<std::vector<MergedContact>> parts(blocks);
  parallel_for(terms.size(), grain, [&](std::size_t begin, std::size_t end) {
    std::vector<MergedContact>& part = parts[begin / grain];
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
      part.push_back(contact);
    }
  });
  // Terms of one vertex follow one another.
  std::vector<MergedContact> merged;
  std::size_t first = 0;
  Places<TouchingPoints, HashOfPoints> places;
  for (const std::vector<MergedContact>& part : parts) {
    for (const MergedContact& contact : part) {
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
      if (same.key == 0) same.key = contact.key;
    }
  }
  std::erase_if(merged, [](const MergedContact& contact) {
    return contact.stiffness == 0 && std::abs(contact.slope) <= rounding * contact.magnitude;
  });
  return merged;
}

}  // namespace muslin
