#include "muslin/component/kinds.hpp"

#include <algorithm>

#include "muslin/component/kinematic/kinematic_body.hpp"
#include "muslin/component/lattice/lattice_kind.hpp"
#include "muslin/component/rigid/rigid_body.hpp"
#include "muslin/component/shell/shell_kind.hpp"
#include "muslin/core/error.hpp"

namespace muslin {

const std::vector<BodyKind>& body_kinds() {
  static const std::vector<BodyKind> kinds = {lattice_kind, shell_kind};
  return kinds;
}

const std::vector<ColliderKind>& collider_kinds() {
  static const std::vector<ColliderKind> kinds = {kinematic_kind, rigid_kind};
  return kinds;
}

const BodyKind& kind_of(const BodySettings& settings) {
  const auto kind = std::find_if(body_kinds().begin(), body_kinds().end(),
                                 [&](const BodyKind& each) { return each.name == settings.model; });
  require(kind != body_kinds().end(), "the model of a body is no kind of body",
          "use one that `model` of a scene file has");
  return *kind;
}

const ColliderKind& kind_of(const ColliderSettings& settings) {
  return *std::find_if(collider_kinds().begin(), collider_kinds().end(),
                       [&](const ColliderKind& each) { return each.is_meant(settings); });
}

ComponentSource source_of(const BodySettings& settings) {
  return {settings.name,
          [settings, build = kind_of(settings).build](const ComponentInputs& inputs) {
            return build(settings, inputs);
          },
          settings.place};
}

ComponentSource source_of(const ColliderSettings& settings) {
  return {settings.name,
          [settings, build = kind_of(settings).build](const ComponentInputs& inputs) {
            return build(settings, inputs);
          },
          settings.place, settings.shape == ColliderSettings::Shape::plane};
}

}  // namespace muslin
