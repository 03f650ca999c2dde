#include "muslin/cache/selections.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <nlohmann/json.hpp>

#include "muslin/component/select.hpp"
#include "muslin/core/error.hpp"
#include "muslin/core/input_file.hpp"
#include "muslin/geometry/closest_point.hpp"

namespace muslin {
namespace {

using Json = nlohmann::ordered_json;

Json common(const Chosen& chosen, const Model& model) {
  return {{"name", chosen.name}, {"body", model.bodies[static_cast<std::size_t>(chosen.body)].name}};
}

/// True if a run of the component has its vertices in a cache.
bool caches_vertices(const Component& component) {
  const std::vector<CachedPoints> cached = component.cached_points();
  return component.is_mesh() || std::any_of(cached.begin(), cached.end(), [](const CachedPoints& points) {
           return points.embedding == nullptr;
         });
}

/// Returns the points of the cache at vertices of the component, ascending.
std::vector<int> cached(const Component& component, std::vector<int> vertices) {
  if (!component.source || !component.is_mesh()) return vertices;
  const std::vector<int>& of_point = component.source->vertices;
  std::vector<int> points;
  for (std::size_t p = 0; p < of_point.size(); ++p)
    if (std::binary_search(vertices.begin(), vertices.end(), of_point[p]))
      points.push_back(static_cast<int>(p));
  return points;
}

/// Finds points of the skin of a body.
class SkinPoints {
 public:
  SkinPoints(const Model& model, int body)
      : body_(body),
        component_(model.bodies[static_cast<std::size_t>(body)]),
        triangles_(triangulate(component_.mesh).triangles),
        nearest_(component_.mesh.positions, triangles_) {}

  /// Returns the one that is nearest to a place at the start.
  Cord::End operator()(const Vec3& place) const {
    const ClosestPoint nearest = nearest_(place);
    Cord::End end{body_, {}, nearest.barycentric};
    for (int c = 0; c < 3; ++c) {
      const int vertex = triangles_[static_cast<std::size_t>(nearest.triangle)][c];
      end.points[static_cast<std::size_t>(c)] =
          component_.source ? cached(component_, {vertex}).at(0) : vertex;
    }
    return end;
  }

 private:
  int body_;
  const Component& component_;
  std::vector<Vec3i> triangles_;
  ClosestPointQuery nearest_;
};

std::vector<Cord> cords_of(const Model& model) {
  std::vector<Cord> cords;
  for (std::size_t a = 0; a < model.attachments.size(); ++a) {
    const AttachmentSettings& settings = model.scene.attachments[a];
    if (settings.rest == AttachmentSettings::Rest::joined) continue;
    const Attached& attached = model.attachments[a];
    const SkinPoints first(model, attached.bodies[0]), second(model, attached.bodies[1]);
    for (const std::array<Vec3, 2>& place : attached.places)
      cords.push_back({attached.name,
                       settings.rest == AttachmentSettings::Rest::cord,
                       settings.from,
                       settings.until,
                       {first(place[0]), second(place[1])}});
  }
  return cords;
}

Json until_json(double until) { return std::isfinite(until) ? Json(until) : Json(nullptr); }

double until_of(const Json& entry) {
  const Json& until = entry.at("until");
  return until.is_null() ? std::numeric_limits<double>::infinity() : until.get<double>();
}

/// Errors: any exception of Json, and std::out_of_range.
int index_of(const Json& name, const std::vector<std::string>& bodies) {
  const auto body = std::find(bodies.begin(), bodies.end(), name.get<std::string>());
  if (body == bodies.end()) throw std::out_of_range("body");
  return static_cast<int>(body - bodies.begin());
}

/// Errors: as index_of.
Cord parsed_cord(const Json& entry, const std::vector<std::string>& bodies,
                 const std::vector<std::size_t>& skins) {
  Cord cord;
  cord.name = entry.at("name").get<std::string>();
  cord.slackens = entry.at("slackens").get<bool>();
  cord.from = entry.at("from").get<double>();
  cord.until = until_of(entry);
  for (std::size_t e = 0; e < 2; ++e) {
    const Json& told = entry.at("ends").at(e);
    Cord::End& end = cord.ends[e];
    end.body = index_of(told.at("body"), bodies);
    for (std::size_t c = 0; c < 3; ++c) {
      const auto point = told.at("points").at(c).get<std::int64_t>();
      if (point < 0 || static_cast<std::size_t>(point) >= skins[static_cast<std::size_t>(end.body)])
        throw std::out_of_range("point");
      end.points[c] = static_cast<int>(point);
      end.weights[static_cast<int>(c)] = told.at("weights").at(c).get<double>();
    }
  }
  return cord;
}

/// Errors: as index_of.
Chosen parsed(const Json& entry, const std::vector<std::string>& bodies,
              const std::vector<std::size_t>& points) {
  Chosen chosen;
  chosen.name = entry.at("name").get<std::string>();
  chosen.body = index_of(entry.at("body"), bodies);
  const std::size_t count = points[static_cast<std::size_t>(chosen.body)];
  for (const Json& vertex : entry.at("vertices")) {
    const auto v = vertex.get<std::int64_t>();
    if (v < 0 || static_cast<std::size_t>(v) >= count) throw std::out_of_range("vertex");
    chosen.vertices.push_back(static_cast<int>(v));
  }
  return chosen;
}

}  // namespace

Selections selections_of(const Model& model) {
  Selections selections;
  for (const Pin& pin : model.pins) {
    if (pin.vertices.empty()) continue;
    const Component& body = model.body_of(static_cast<std::size_t>(pin.vertices.front()));
    if (!caches_vertices(body)) continue;  // such as those that carry a rigid body
    Chosen chosen{pin.name, model.bodies.index_of(body), {}, pin.from, pin.until, -1};
    for (const int v : pin.vertices) chosen.vertices.push_back(v - body.first_vertex);
    chosen.vertices = cached(body, std::move(chosen.vertices));
    selections.pins.push_back(std::move(chosen));
  }
  for (std::size_t f = 0; f < model.scene.forces.size(); ++f) {
    const ForceSettings& force = model.scene.forces[f];
    if (!force.where) continue;
    const Component& body = model.body(force.body);
    if (body.selects_vertices() != caches_vertices(body)) continue;
    selections.point_forces.push_back(
        {force.name, model.bodies.index_of(body),
         cached(body, select_vertices(body, *force.where, "force " + force.name)), force.from, force.until,
         static_cast<int>(f)});
  }
  selections.cords = cords_of(model);
  return selections;
}

std::string selections_json(const Model& model) {
  const Selections selections = selections_of(model);
  Json json = {{"pins", Json::array()}, {"point_forces", Json::array()}, {"cords", Json::array()}};
  for (const Chosen& pin : selections.pins) {
    Json entry = common(pin, model);
    entry["from"] = pin.from;
    entry["until"] = until_json(pin.until);
    entry["vertices"] = pin.vertices;
    json["pins"].push_back(std::move(entry));
  }
  for (const Chosen& force : selections.point_forces) {
    Json entry = common(force, model);
    entry["force"] = force.force;
    entry["vertices"] = force.vertices;
    json["point_forces"].push_back(std::move(entry));
  }
  for (const Cord& cord : selections.cords) {
    Json entry = {{"name", cord.name}, {"slackens", cord.slackens}, {"from", cord.from}};
    entry["until"] = until_json(cord.until);
    for (const Cord::End& end : cord.ends)
      entry["ends"].push_back({{"body", model.bodies[static_cast<std::size_t>(end.body)].name},
                               {"points", end.points},
                               {"weights", {end.weights.x(), end.weights.y(), end.weights.z()}}});
    json["cords"].push_back(std::move(entry));
  }
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

Selections read_selections(const std::filesystem::path& path, const std::vector<std::string>& bodies,
                           const std::vector<std::size_t>& points, const std::vector<std::size_t>& skins) {
  Selections selections;
  if (!std::filesystem::exists(path)) return selections;
  const Json json = Json::parse(read_file(path), nullptr, false);
  try {
    for (const Json& entry : json.at("pins")) {
      selections.pins.push_back(parsed(entry, bodies, points));
      selections.pins.back().from = entry.at("from").get<double>();
      selections.pins.back().until = until_of(entry);
    }
    for (const Json& entry : json.at("point_forces")) {
      selections.point_forces.push_back(parsed(entry, bodies, points));
      selections.point_forces.back().force = entry.at("force").get<int>();
    }
    for (const Json& entry : json.value("cords", Json::array()))
      selections.cords.push_back(parsed_cord(entry, bodies, skins));
  } catch (const std::exception&) {
    throw Error(ErrorKind::input, {path.string()}, "the list of held vertices is damaged",
                "remove the file to continue without it, or run the scene again");
  }
  return selections;
}

}  // namespace muslin
