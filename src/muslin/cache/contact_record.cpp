#include "muslin/cache/contact_record.hpp"

#include <cmath>

#include "muslin/core/error.hpp"

namespace muslin {
namespace {

using Json = nlohmann::ordered_json;

Json triple(const Vec3& v) { return Json::array({v.x(), v.y(), v.z()}); }

/// Ascending points as runs of their numbers: [[first, last], …].
Json runs_of(const std::vector<int>& points) {
  Json runs = Json::array();
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i == 0 || points[i] != points[i - 1] + 1) runs.push_back({points[i], points[i]});
    runs.back()[1] = points[i];
  }
  return runs;
}

std::vector<int> points_of(const Json& runs, std::size_t count) {
  std::vector<int> points;
  for (const Json& run : runs) {
    const int first = run.at(0).get<int>(), last = run.at(1).get<int>();
    if (first < 0 || last < first || static_cast<std::size_t>(last) >= count)
      throw Error(ErrorKind::input, "the object `contact` has a point that does not exist",
                  "run the scene again");
    for (int point = first; point <= last; ++point) points.push_back(point);
  }
  return points;
}

Json optional(const std::optional<double>& number) { return number ? Json(*number) : Json(); }
std::optional<double> optional(const Json& json) {
  return json.is_null() ? std::nullopt : std::optional(json.get<double>());
}

Json rule_json(const ContactRule& rule) {
  return {{"points", {runs_of(rule.sides[0]), runs_of(rule.sides[1])}},
          {"contact", rule.touches},
          {"thickness", optional(rule.thickness)},
          {"distance", optional(rule.range)},
          {"from", rule.from},
          {"until", std::isfinite(rule.until) ? Json(rule.until) : Json()}};
}

ContactRule read_rule(const Json& json, std::size_t point_count) {
  ContactRule rule;
  for (std::size_t side = 0; side < 2; ++side)
    rule.sides[side] = points_of(json.at("points").at(side), point_count);
  rule.touches = json.at("contact").get<bool>();
  rule.thickness = optional(json.at("thickness"));
  rule.range = optional(json.at("distance"));
  rule.from = json.at("from").get<double>();
  rule.until = optional(json.at("until")).value_or(rule.until);
  return rule;
}

}  // namespace

Json contact_record_json(const ContactModel& contact) {
  const ContactSurface& surface = *contact.surface;
  Json bodies = Json::array();
  for (std::size_t b = 0; b < surface.bodies().size(); ++b) {
    const ContactBody& body = surface.bodies()[b];
    bodies.push_back({{"name", b < contact.names.size() ? contact.names[b] : std::string()},
                      {"points", 0},
                      {"radius", body.radius},
                      {"self_contact", body.self_contact},
                      {"fixed", body.fixed}});
    if (body.range) bodies.back()["distance"] = *body.range;
  }
  for (std::size_t p = 0; p < surface.point_count(); ++p) {
    const int point = static_cast<int>(p);
    Json& body = bodies[static_cast<std::size_t>(surface.body_of(point))];
    body["points"] = body["points"].get<std::size_t>() + 1;
    const std::vector<double>& radii = surface.varying().radius;
    if (!radii.empty() && radii[p] >= 0) body["radii"].push_back(radii[p]);
    if (surface.is_round(point)) body["axis"].push_back(triple(contact.rest[p]));
  }
  Json record = {{"distance", contact.distance}, {"bodies", bodies}};
  const ContactExemptions& exempt = contact.exempt;
  if (!exempt.empty())
    record["joints"] = {{"point_triangles", exempt.point_triangles}, {"point_planes", exempt.point_planes}};
  for (const ContactRule& rule : surface.rules().all()) record["rules"].push_back(rule_json(rule));
  return record;
}

ContactRecord read_contact_record(const Json& contact) {
  try {
    ContactRecord record;
    record.distance = contact.at("distance").get<double>();
    std::size_t points = 0;
    for (const Json& entry : contact.at("bodies")) {
      ContactRecord::Body body;
      body.name = entry.at("name").get<std::string>();
      body.points = entry.at("points").get<std::size_t>();
      body.radius = entry.at("radius").get<double>();
      body.self_contact = entry.at("self_contact").get<bool>();
      body.fixed = entry.at("fixed").get<bool>();
      body.range = optional(entry.value("distance", Json()));
      body.radii = entry.value("radii", std::vector<double>());
      if (!body.radii.empty() && body.radii.size() != body.points)
        throw Error(ErrorKind::input, "the object `contact` has radii of another number of points",
                    "run the scene again");
      points += body.points;
      for (const Json& point : entry.value("axis", Json::array()))
        body.axis.emplace_back(point.at(0).get<double>(), point.at(1).get<double>(),
                               point.at(2).get<double>());
      record.bodies.push_back(std::move(body));
    }
    if (contact.contains("joints")) {
      contact["joints"].at("point_triangles").get_to(record.exempt.point_triangles);
      contact["joints"].at("point_planes").get_to(record.exempt.point_planes);
    }
    for (const Json& rule : contact.value("rules", Json::array()))
      record.rules.push_back(read_rule(rule, points));
    return record;
  } catch (const Json::exception&) {
    throw Error(ErrorKind::input, "the object `contact` is damaged", "run the scene again");
  }
}

}  // namespace muslin
