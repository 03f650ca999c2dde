#include "muslin/component/kinds.hpp"

#include <algorithm>
#include <array>
#include <memory>

#include "muslin/component/kinematic/kinematic_body.hpp"
#include "muslin/component/lattice/lattice_body.hpp"
#include "muslin/component/rigid/rigid_body.hpp"
#include "muslin/component/shell/shell_body.hpp"
#include "muslin/core/error.hpp"

namespace muslin {
namespace {

template <class Settings>
using Build = std::shared_ptr<Component> (*)(const Settings&, const ComponentInputs&);

struct BodyKind {
  BodyModel model;
  Build<BodySettings> build;
};
constexpr std::array body_kinds = {BodyKind{BodyModel::lattice, build_lattice_body},
                                   BodyKind{BodyModel::shell, build_shell_body}};

/// Kinds of [[collider]], by whether forces move them.
struct ColliderKind {
  bool is_free;
  Build<ColliderSettings> build;
};
constexpr std::array collider_kinds = {ColliderKind{false, build_kinematic},
                                       ColliderKind{true, build_rigid_body}};

template <class Settings>
ComponentSource source(const Settings& settings, Build<Settings> build) {
  return {settings.name, [settings, build](const ComponentInputs& inputs) { return build(settings, inputs); },
          settings.place};
}

}  // namespace

ComponentSource source_of(const BodySettings& settings) {
  const auto kind = std::find_if(body_kinds.begin(), body_kinds.end(),
                                 [&](const BodyKind& each) { return each.model == settings.model; });
  require(kind != body_kinds.end(), "the model of a body is that of a collider",
          "use BodyModel::lattice or BodyModel::shell");
  return source(settings, kind->build);
}

ComponentSource source_of(const ColliderSettings& settings) {
  const auto kind = std::find_if(collider_kinds.begin(), collider_kinds.end(), [&](const ColliderKind& each) {
    return each.is_free == settings.is_free();
  });
  ComponentSource collider = source(settings, kind->build);
  collider.surrounds = settings.shape == ColliderSettings::Shape::plane;
  return collider;
}

}  // namespace muslin
