#include "muslin/cache/contact_record.hpp"

#include "muslin/core/error.hpp"

namespace muslin {
namespace {

using Json = nlohmann::ordered_json;

Json triple(const Vec3& v) { return Json::array({v.x(), v.y(), v.z()}); }

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
  }
  for (std::size_t p = 0; p < surface.point_count(); ++p) {
    const int point = static_cast<int>(p);
    Json& body = bodies[static_cast<std::size_t>(surface.body_of(point))];
    body["points"] = body["points"].get<std::size_t>() + 1;
    if (surface.is_round(point)) body["axis"].push_back(triple(contact.rest[p]));
  }
  Json record = {{"distance", contact.distance}, {"bodies", bodies}};
  const ContactExemptions& exempt = contact.exempt;
  if (!exempt.empty())
    record["joints"] = {{"point_triangles", exempt.point_triangles}, {"point_planes", exempt.point_planes}};
  return record;
}

ContactRecord read_contact_record(const Json& contact) {
  try {
    ContactRecord record;
    record.distance = contact.at("distance").get<double>();
    for (const Json& entry : contact.at("bodies")) {
      ContactRecord::Body body;
      body.name = entry.at("name").get<std::string>();
      body.points = entry.at("points").get<std::size_t>();
      body.radius = entry.at("radius").get<double>();
      body.self_contact = entry.at("self_contact").get<bool>();
      body.fixed = entry.at("fixed").get<bool>();
      for (const Json& point : entry.value("axis", Json::array()))
        body.axis.emplace_back(point.at(0).get<double>(), point.at(1).get<double>(),
                               point.at(2).get<double>());
      record.bodies.push_back(std::move(body));
    }
    if (contact.contains("joints")) {
      contact["joints"].at("point_triangles").get_to(record.exempt.point_triangles);
      contact["joints"].at("point_planes").get_to(record.exempt.point_planes);
    }
    return record;
  } catch (const Json::exception&) {
    throw Error(ErrorKind::input, "the object `contact` is damaged", "run the scene again");
  }
}

}  // namespace muslin
