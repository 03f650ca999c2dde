#include "muslin/scene/build_contact_rules.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "muslin/core/error.hpp"
#include "muslin/core/nearest_name.hpp"
#include "muslin/schema/over_time.hpp"

namespace muslin {
namespace {

class RuleBuilder {
 public:
  RuleBuilder(Model& model, const ContactPoints& points) : model_(model), points_(points) {}

  std::vector<ContactRule> build() {
    for (const ContactPairSettings& pair : model_.scene.contact.pairs) add(pair);
    for (std::size_t p = 0; p < model_.pins.size(); ++p) add(model_.scene.pins[p], model_.pins[p]);
    return std::move(rules_);
  }

 private:
  void add(const ContactPairSettings& pair) {
    ContactRule rule;
    for (std::size_t side = 0; side < 2; ++side) rule.sides[side] = points_of(pair.between[side]);
    rule.touches = pair.contact;
    rule.thickness = pair.thickness;
    rule.range = pair.distance;
    rule.friction = schema::over_time(pair.variations, "friction", pair.friction);
    rule.stiffness = pair.stiffness;
    rule.from = pair.from;
    rule.until = pair.until;
    append(std::move(rule), pair.place);
  }

  void add(const PinSettings& settings, const Pin& pin) {
    if (settings.ignore.empty()) return;
    const std::vector<int> held = points_held_by(pin);
    for (const std::string& body : settings.ignore) {
      ContactRule rule;
      rule.sides = {held, points_of({body, std::nullopt, settings.place})};
      rule.touches = false;
      rule.from = settings.from;
      rule.until = settings.until;
      append(std::move(rule), settings.place);
    }
  }

  void append(ContactRule rule, const Place& place) {
    if (rules_.size() == ContactRules::most)
      throw Error(ErrorKind::input, place,
                  fmt::format("the scene has more than {} rules of contact between pairs", rules_.size()),
                  "join bodies that follow the same rule into one, or leave rules out");
    rules_.push_back(std::move(rule));
  }

  std::vector<int> points_held_by(const Pin& pin) const {
    std::vector<std::uint8_t> is_held(model_.vertex_count(), 0);
    for (const int v : pin.vertices) is_held[static_cast<std::size_t>(v)] = 1;
    std::vector<int> held;
    for (std::size_t p = 0; p < points_.body_of_point.size(); ++p) {
      const auto row = points_.map.row(p);
      if (std::all_of(row.begin(), row.end(), [&](const SurfaceMap::Entry& entry) {
            return is_held[static_cast<std::size_t>(entry.vertex)] != 0;
          }))
        held.push_back(static_cast<int>(p));
    }
    return held;
  }

  std::vector<int> points_of(const ContactPairSettings::Side& side) {
    const auto at = std::find(points_.names.begin(), points_.names.end(), side.body);
    if (at == points_.names.end()) {
      model_.warnings.push_back(fmt::format(
          "a rule of contact names \"{}\", which touches nothing (`contact = false`)", side.body));
      return {};
    }
    const int body = static_cast<int>(at - points_.names.begin());
    std::vector<int> all;
    for (std::size_t p = 0; p < points_.body_of_point.size(); ++p)
      if (points_.body_of_point[p] == body) all.push_back(static_cast<int>(p));
    return side.group ? in_group(side, all) : all;
  }

  std::vector<int> in_group(const ContactPairSettings::Side& side, const std::vector<int>& all) const {
    const Component& component = model_.body(side.body);
    const std::vector<MeshGroup>& groups = component.mesh.groups;
    std::vector<std::string> names;
    names.reserve(groups.size());
    for (const MeshGroup& group : groups) names.push_back(group.name);
    const auto group = std::find(names.begin(), names.end(), *side.group);
    if (group == names.end())
      throw Error(ErrorKind::input, side.place,
                  fmt::format("the mesh of \"{}\" has no group `{}`", side.body, *side.group),
                  names.empty() ? "it has none; name the whole body" : name_advice(*side.group, names));
    // A group is of the mesh, which is the surface, whatever `where` selects among.
    const std::vector<std::uint8_t> members =
        component.Component::in_group(groups[static_cast<std::size_t>(group - names.begin())]);
    if (members.size() != all.size())
      throw Error(ErrorKind::input, side.place,
                  fmt::format("the surface with which \"{}\" touches others is not its mesh", side.body),
                  "name the whole of it");
    std::vector<int> chosen;
    for (std::size_t i = 0; i < all.size(); ++i)
      if (members[i] != 0) chosen.push_back(all[i]);
    return chosen;
  }

  Model& model_;
  const ContactPoints& points_;
  std::vector<ContactRule> rules_;
};

}  // namespace

ContactRules build_contact_rules(Model& model, const ContactPoints& points) {
  return {RuleBuilder(model, points).build(), points.body_of_point.size()};
}

}  // namespace muslin
