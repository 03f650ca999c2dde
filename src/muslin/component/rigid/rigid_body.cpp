#include "muslin/component/rigid/rigid_body.hpp"

#include <numbers>
#include <vector>

#include <fmt/format.h>

#include "muslin/component/collider/collider_kind.hpp"
#include "muslin/component/solid.hpp"
#include "muslin/energy/affine_body.hpp"
#include "muslin/potential/stopping_time.hpp"
#include "muslin/solver/rigid_prediction.hpp"

namespace muslin {
namespace {

constexpr double smallest_volume = 1e-21;  // [m³]
/// In units of mass/stopping_time²: a body that is accelerated by g through a point of its surface is dented
/// there by about 5 g stopping_time²/1000, 1 µm. The same in steps of any length: stiffness that grew while a
/// body is dented would add energy.
constexpr double rigidity = 1000;

void require_solid(const ColliderSettings& c, const MeshReport& report, const Mesh& mesh) {
  if (kind_of(mesh, report) == MeshKind::solid && report.flipped_edges == 0) return;
  throw Error(ErrorKind::input, c.mesh_place,
              fmt::format("collider {}: {} does not enclose a solid, so it has no mass", c.name, c.mesh),
              report.flipped_edges > 0 ? "let all its faces look outward"
                                       : "close its holes, or leave `density` out");
}

std::vector<schema::Key> rigid_keys(ColliderSettings::Shape shape) {
  using Collider = ColliderSettings;
  if (shape == Collider::Shape::plane) return {};
  const char* remedy = "give a `density` to let it move by itself, or `keyframes`";
  const auto is_free = [](const Collider& collider) { return collider.is_free(); };
  return {
      schema::number("density", &Collider::density)
          .unit("kg/m³")
          .range({1e-6, 1e9, false})
          .excludes("sequence", "`density` stands beside `sequence`, which says how it moves")
          .excludes("keyframes", "`density` makes a body that moves by itself, `keyframes` say how it moves",
                    "keep one of them; a [[pin]] holds or moves a body for a while")
          .means("makes it a rigid body of this density; a mesh must be closed. Without it gravity and other "
                 "forces do not act on it"),
      schema::vector("velocity", &Collider::velocity)
          .unit("m/s")
          .needs("density", remedy)
          .shown_if<Collider>(is_free)
          .means("velocity at the start; only with a density"),
      schema::vector("angular_velocity", &Collider::angular_velocity)
          .unit("degrees/s")
          .needs("density", remedy)
          .shown_if<Collider>(is_free)
          .means("rate of rotation at the start, along the axis through the centre of mass; only with a "
                 "density")};
}

}  // namespace

RigidBody::RigidBody(const ColliderSettings& the_settings, const ComponentInputs& inputs) {
  begin(the_settings, inputs);
  if (settings.shape == ColliderSettings::Shape::mesh) require_solid(settings, report, mesh);
  const MassProperties mass = mass_properties(settings, mesh);
  if (!(mass.volume > smallest_volume)) {
    throw Error(
        ErrorKind::input, settings.place,
        fmt::format("collider {}: its volume of {:.3g} m³ is too small to have mass", name, mass.volume),
        "lengths are metres: set `scale`");
  }
  frame = equimomental_frame(mass);
  mass_ = *settings.density * mass.volume;
  finish_affine();
  weigh(*this);
  const double stiffness = rigidity * statistics.mass / (stopping_time * stopping_time);
  potentials.push_back(
      {"rigidity", EnergyRole::elastic, std::make_shared<AffineBodyEnergy>(frame.radii, stiffness)});
}

std::vector<double> RigidBody::masses() const { return std::vector<double>(4, mass_ / 4); }

std::vector<Vec3> RigidBody::velocities() const {
  const Vec3 spin = settings.angular_velocity * std::numbers::pi / 180;
  std::vector<Vec3> velocities;
  for (const Vec3& corner : frame.corners())
    velocities.emplace_back(settings.velocity + spin.cross(corner - frame.centre));
  return velocities;
}

void RigidBody::predict(Integrator integrator, const State& state, std::span<const std::uint8_t> fixed,
                        StepContext& context) const {
  const auto first = static_cast<std::size_t>(first_vertex);
  if (fixed[first] == 0) predict_rigid(integrator, state, first, context);
}

const ColliderKind rigid_kind = {
    .is_meant = [](const ColliderSettings& settings) { return settings.is_free(); },
    .keys = rigid_keys,
    .build = [](const ColliderSettings& settings, const ComponentInputs& inputs)
        -> std::shared_ptr<Component> { return std::make_shared<RigidBody>(settings, inputs); }};

}  // namespace muslin
