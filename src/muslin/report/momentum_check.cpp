#include "muslin/report/momentum_check.hpp"

#include <algorithm>
#include <cmath>

#include "muslin/report/json_list.hpp"

namespace muslin {
namespace {

using Json = nlohmann::ordered_json;

constexpr double slowest = 1e-6;  // momenta of smaller speeds are noise [m/s]

bool is_given(const Json& table, const char* key) {
  return table.contains(key) && !table[key].is_null() && table[key] != Json("");
}

/// Returns the reason why the momentum depends on impulses that are not recorded; empty if it does not.
std::string unknown_impulses(const RunReader& run, const Json& scene) {
  if (!scene.is_object()) return "the scene of the run is not recorded";
  if (!json_list(scene, "pin").empty()) return "pins push on the bodies, and their impulses are not recorded";
  for (const Json& collider : json_list(scene, "collider"))
    if (!is_given(collider, "density") && collider.value("contact", true))
      return "colliders push on the bodies, and their impulses are not recorded";
  if (!json_list(scene, "pressure").empty())
    return "pressure may push on the bodies, and its impulse is not recorded";
  for (const Json& force : json_list(scene, "force"))
    if (force.value("type", "") != "gravity" || is_given(force, "body") || is_given(force, "until") ||
        is_given(force, "keyframes") || force.value("from", 0.0) > 0)
      return "forces other than constant gravity act, and their impulses are not recorded";
  for (const Json& body : json_list(scene, "body"))
    if (body.contains("material") && body["material"].is_object() &&
        body["material"].value("mass_damping", 0.0) > 0)
      return "`mass_damping` takes momentum away, as a fluid does";
  for (const Diagnostics& row : run.diagnostics())
    if (row.work != 0) return "something did work on the bodies, and its impulse is not recorded";
  return "";
}

double total_mass(const Json& statistics) {
  double mass = 0;
  for (const char* key : {"bodies", "colliders"})
    for (const Json& body : json_list(statistics, key)) mass += body.value("mass", 0.0);
  return mass;
}

Vec3 gravity_of(const Json& scene) {
  Vec3 sum = Vec3::Zero();
  for (const Json& force : json_list(scene, "force")) {
    const Json& g = force.at("acceleration");
    sum += Vec3(g.at(0).get<double>(), g.at(1).get<double>(), g.at(2).get<double>());
  }
  return sum;
}

}  // namespace

MomentumCheck check_momentum(const RunReader& run, const Json& scene, const Json& statistics) {
  MomentumCheck check;
  const std::vector<Diagnostics>& rows = run.diagnostics();
  check.why_not = unknown_impulses(run, scene);
  if (check.why_not.empty() && statistics.is_null()) check.why_not = "stats.json is missing";
  if (check.why_not.empty() && rows.size() < 2) check.why_not = "the run has no frame after the start";
  if (!check.why_not.empty()) return check;
  const double mass = total_mass(statistics);
  const Vec3 force = mass * gravity_of(scene), start = rows.front().momentum;
  check.scale = std::max(start.norm(), mass * slowest);
  for (const Diagnostics& row : rows) {
    const Vec3 change = row.momentum - start, impulse = row.time * force;
    check.scale = std::max({check.scale, change.norm(), impulse.norm(), std::sqrt(2 * mass * row.kinetic)});
    if ((change - impulse).norm() <= check.deviation) continue;
    check.deviation = (change - impulse).norm();
    check.frame = row.frame;
  }
  return check;
}

}  // namespace muslin
