#include "muslin/contact/crossings.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "muslin/contact/contact_candidates.hpp"
#include "muslin/contact/contact_model.hpp"
#include "muslin/contact/intersections.hpp"
#include "muslin/core/error.hpp"
#include "muslin/core/index.hpp"

namespace muslin {
namespace {

constexpr std::size_t listed = 8;

/// One triangle of each point and edge, −1: none.
struct Owners {
  std::vector<int> of_point, of_edge;

  explicit Owners(const ContactSurface& surface)
      : of_point(surface.point_count(), -1), of_edge(surface.edges().size(), -1) {
    for (std::size_t t = surface.triangles().size(); t-- > 0;) {
      for (int i = 0; i < 3; ++i) {
        of_point[at(surface.triangles()[t][i])] = static_cast<int>(t);
        const int e = surface.triangle_edges()[t][i];
        if (e >= 0) of_edge[at(e)] = static_cast<int>(t);
      }
    }
  }
};

std::string body_name(const ContactModel& model, int body) {
  if (at(body) < model.names.size()) return '"' + model.names[at(body)] + '"';
  return "surface " + std::to_string(body);
}

std::string feature_name(const ContactModel& model, int triangle, int body) {
  if (triangle < 0) return body_name(model, body);
  if (!model.faces.empty() && model.faces[at(triangle)] < 0) return body_name(model, body);
  if (!model.faces.empty())
    return fmt::format("face {} of {}", model.faces[at(triangle)], body_name(model, body));
  const std::span<const Vec3i> triangles = model.surface->triangles();
  const auto first = std::find_if(triangles.begin(), triangles.end(),
                                  [&](const Vec3i& t) { return model.surface->body_of(t[0]) == body; });
  return fmt::format("triangle {} of {}", triangle - (first - triangles.begin()), body_name(model, body));
}

}  // namespace

std::vector<Crossing> find_crossings(const ContactModel& model, ConstVectors q, double time,
                                     std::size_t limit) {
  const ContactSurface& surface = *model.surface;
  std::vector<Vec3> x(surface.point_count());
  model.map->apply(q, x);
  const auto body_of = [&](int triangle) { return surface.body_of(surface.triangles()[at(triangle)][0]); };

  std::vector<Crossing> all;
  IntersectionOptions options;
  options.limit = limit;
  const ContactRules::Set rules = surface.rules().in_force(time);
  options.wanted = [&](int a, int b) { return model.forbids_crossing(a, b, rules); };
  for (const Intersection& i : find_intersections(x, surface.triangles(), options))
    all.push_back({Crossing::Kind::crossing, body_of(i.first), body_of(i.second), i.first, i.second, i.at});

  ContactCandidates candidates(model.surface, model.rest, model.distance);
  candidates.ignore_pairs({}, model.exempt);
  candidates.apply_rules(rules);
  candidates.update(x, x, 0);
  const Owners owners(surface);
  std::vector<Crossing> close;
  for (const ContactPair& pair : candidates.pairs()) {
    const PairGeometry geometry = pair_geometry(surface, pair, x);
    if (geometry.distance > pair.thickness) continue;
    Crossing c;
    c.first_body = surface.body_of(pair.points[0]);
    c.second_body = surface.body_of(pair.points[at(pair.point_count() - 1)]);
    c.kind = Crossing::Kind::too_close;
    if (pair.kind == PairKind::vertex_triangle) {
      c.first_triangle = owners.of_point[at(pair.first)];
      c.second_triangle = pair.second;
    } else if (pair.kind == PairKind::edge_edge) {
      c.first_triangle = owners.of_edge[at(pair.first)];
      c.second_triangle = owners.of_edge[at(pair.second)];
    } else {
      if (geometry.distance < 0) c.kind = Crossing::Kind::beneath;
      c.first_triangle = owners.of_point[at(pair.first)];
    }
    c.at = visible_point(surface, pair, geometry, x);
    if (pair.kind != PairKind::point_plane && c.first_triangle > c.second_triangle) {
      std::swap(c.first_triangle, c.second_triangle);
      std::swap(c.first_body, c.second_body);
    }
    close.push_back(c);
  }
  const auto of_triangles = [](const Crossing& c) {
    return std::tuple(c.first_triangle, c.second_triangle, c.first_body, c.second_body);
  };
  const auto before = [&](const Crossing& a, const Crossing& b) { return of_triangles(a) < of_triangles(b); };
  std::stable_sort(close.begin(), close.end(), before);
  const std::size_t crossing = all.size();
  for (const Crossing& c : close) {
    if (all.size() >= limit) break;
    const auto end = all.begin() + static_cast<std::ptrdiff_t>(crossing);
    const auto same = std::lower_bound(all.begin(), end, c, before);
    if (same != end && of_triangles(*same) == of_triangles(c)) continue;
    if (all.size() > crossing && of_triangles(all.back()) == of_triangles(c)) continue;
    all.push_back(c);
  }
  return all;
}

std::vector<Crossing> one_of_each_pair(const ContactModel& model, std::span<const Crossing> found) {
  using Feature = std::pair<int, int>;  // a body and a face
  const auto feature = [&](int body, int triangle) {
    return Feature(body, triangle < 0 || model.faces.empty() ? triangle : model.faces[at(triangle)]);
  };
  std::set<std::pair<Feature, Feature>> seen;
  std::vector<Crossing> result;
  for (const Crossing& c : found) {
    const Feature a = feature(c.first_body, c.first_triangle), b = feature(c.second_body, c.second_triangle);
    if (seen.insert({std::min(a, b), std::max(a, b)}).second) result.push_back(c);
  }
  return result;
}

std::string describe(const ContactModel& model, const Crossing& c) {
  const std::string first = feature_name(model, c.first_triangle, c.first_body),
                    second = feature_name(model, c.second_triangle, c.second_body),
                    near = fmt::format("near ({:.4g}, {:.4g}, {:.4g}) m", c.at.x(), c.at.y(), c.at.z());
  if (c.kind == Crossing::Kind::crossing) return fmt::format("{} crosses {} {}", first, second, near);
  if (c.kind == Crossing::Kind::beneath) return fmt::format("{} lies beneath {} {}", first, second, near);
  return fmt::format("{} and {} are closer to each other than their thickness allows {}", first, second,
                     near);
}

std::string describe_bodies(const ContactModel& model, std::span<const Crossing> found) {
  std::map<std::pair<int, int>, int> counts;
  for (const Crossing& c : found) ++counts[std::minmax(c.first_body, c.second_body)];
  std::string list;
  for (const auto& [bodies, count] : counts) {
    const std::string first = body_name(model, bodies.first);
    const std::string other =
        bodies.first == bodies.second ? " with itself" : " and " + body_name(model, bodies.second);
    list += fmt::format("{}{} of {}{}", list.empty() ? "" : ", ", count, first, other);
  }
  return list;
}

std::string advice(const ContactModel& model, ConstVectors q, std::span<const Crossing> found) {
  std::vector<Vec3> x(model.surface->point_count());
  model.map->apply(q, x);
  const bool unwelded = std::any_of(found.begin(), found.end(), [&](const Crossing& c) {
    if (c.first_body != c.second_body || c.first_triangle < 0 || c.second_triangle < 0) return false;
    const Vec3i &a = model.surface->triangles()[at(c.first_triangle)],
                &b = model.surface->triangles()[at(c.second_triangle)];
    for (int i : a)
      for (int j : b)
        if (i != j && x[at(i)] == x[at(j)]) return true;
    return false;
  });
  if (unwelded) return "merge vertices of a mesh that lie at one place (Blender: Mesh > Merge > By Distance)";
  const bool alone = std::all_of(found.begin(), found.end(),
                                 [](const Crossing& c) { return c.first_body == c.second_body; });
  return alone ? "repair the mesh, or set `self_contact = false` if the body need not touch itself"
               : "move them apart";
}

void refuse_crossings(const ContactModel& model, ConstVectors q, double time, const Place& place) {
  const std::vector<Crossing> found = one_of_each_pair(model, find_crossings(model, q, time));
  if (found.empty()) return;
  std::string list;
  for (std::size_t i = 0; i < std::min(found.size(), listed); ++i)
    list += (i > 0 ? "; " : "") + describe(model, found[i]);
  if (found.size() > listed) list += fmt::format("; and {} more", found.size() - listed);
  throw Error(
      ErrorKind::input, place, fmt::format("surfaces cross at the start: {}", list),
      advice(model, q, found) +
          " (`muslin check` lists and draws them), or let the run pull them apart (`contact.tangled = "
          "\"repair\"`) or leave them free until they part (`\"ignore\"`)");
}

}  // namespace muslin
