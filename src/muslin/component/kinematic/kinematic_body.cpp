#include "muslin/component/kinematic/kinematic_body.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "muslin/component/collider/collider_kind.hpp"
#include "muslin/io/point_sequence_file.hpp"
#include "muslin/schema/over_time.hpp"

namespace muslin {
namespace {

/// Returns a frame from the bounding box; any four points can carry a body without mass.
AffineFrame box_frame(const Box& bounds) {
  AffineFrame frame;
  frame.centre = bounds.center();
  frame.radii = Vec3::Constant(std::max(bounds.diagonal().norm() / 2, 1e-6));
  return frame;
}

/// Returns the mean velocities in the first step.
std::vector<Vec3> first_velocities(const Prescribed& motion, double step) {
  std::vector<Vec3> velocities(motion.start.size());
  motion.positions(step, velocities);
  for (std::size_t v = 0; v < velocities.size(); ++v)
    velocities[v] = (velocities[v] - motion.start[v]) / step;
  return velocities;
}

std::shared_ptr<const PointSequence> read_sequence(const ColliderSettings& c, const ComponentInputs& inputs,
                                                   std::size_t vertex_count) {
  const std::string file = inputs.files.resolve(c.sequence).string();
  const auto fail = [&](ErrorKind kind, const std::string& problem, const std::string& remedy) {
    throw Error(kind, c.sequence_place, file + ": " + problem, remedy);
  };
  PointSequence sequence;
  try {
    sequence = read_point_sequence(file, c.frame_rate.value_or(inputs.frame_rate));
  } catch (const Error& error) {
    fail(error.kind(), error.problem(), error.remedy());
  }
  if (sequence.points != vertex_count) {
    fail(ErrorKind::input,
         fmt::format("it moves {} points, {} has {} vertices", sequence.points, c.mesh, vertex_count),
         "export the sequence from the same mesh");
  }
  if (c.start) {
    const double shift = *c.start - sequence.times.front();
    for (double& time : sequence.times) time += shift;
  }
  return std::make_shared<const PointSequence>(std::move(sequence));
}

std::vector<schema::Key> sequence_keys(ColliderSettings::Shape shape) {
  using Collider = ColliderSettings;
  if (shape != Collider::Shape::mesh) return {};
  return {
      schema::path("sequence", &Collider::sequence, &Collider::sequence_place)
          .means("motion, in place of `keyframes`: a file with the position of every vertex of the mesh per "
                 "frame: `.pc2`, `.mdd`, or numbered files `walk.####.obj`. `translate`, `rotate` and "
                 "`scale` "
                 "apply to it as to the mesh"),
      schema::number("frame_rate", &Collider::frame_rate)
          .unit("1/s")
          .range({1e-6, 1e6, false})
          .otherwise("the scene's")
          .needs("sequence", "remove it")
          .means("frames per second of the sequence; not for an `.mdd`, which stores its own frame times"),
      schema::number("start", &Collider::start)
          .unit("s")
          .range({-1e9, 1e9, false})
          .otherwise("as the file says, or 0")
          .needs("sequence", "remove it")
          .means("time of the first sample; the collider is static before the first and after the last "
                 "sample")};
}

}  // namespace

KinematicBody::KinematicBody(const ColliderSettings& the_settings, const ComponentInputs& inputs) {
  begin(the_settings, inputs);
  frame = box_frame(mesh.bounds());
  motion_.motion = settings.motion;
  motion_.motion.pivot = settings.pivot.value_or(
      settings.shape == ColliderSettings::Shape::plane ? settings.center : frame.centre);
  const Eigen::Isometry3d start = motion_.motion.at(0);
  for (Vec3& x : mesh.positions) x = start * x;
  frame.centre = start * frame.centre;
  frame.axes = start.linear();
  const auto corners = frame.corners();
  motion_.start.assign(corners.begin(), corners.end());
  finish_affine();
  velocities_ = first_velocities(motion_, inputs.step);
}

KinematicMesh::KinematicMesh(const ColliderSettings& the_settings, const ComponentInputs& inputs) {
  begin(the_settings, inputs);
  motion_.sequence = read_sequence(settings, inputs, mesh.vertex_count());
  motion_.placement = placement_of(settings);
  motion_.start.resize(mesh.vertex_count());
  motion_.positions(0, motion_.start);
  mesh.positions = motion_.start;
  skin = identity_embedding(mesh.vertex_count());
  vertex_count = static_cast<int>(mesh.vertex_count());
  finish();
  velocities_ = first_velocities(motion_, inputs.step);
}

std::optional<ContactPart> KinematicMesh::contact_part() const {
  if (!settings.contact) return std::nullopt;
  ContactPart part;
  part.body.fixed = true;
  part.body.self_contact = false;
  part.body.solid = true;
  part.body.friction = schema::over_time(settings.variations, "friction", settings.friction);
  part.body.layer = settings.layer;
  part.body.stiffness = std::numeric_limits<double>::infinity();
  part.add_mesh(mesh, triangulate(mesh), skin);
  return part;
}

const ColliderKind kinematic_kind = {
    .is_meant = [](const ColliderSettings& settings) { return !settings.is_free(); },
    .keys = sequence_keys,
    .build = [](const ColliderSettings& settings,
                const ComponentInputs& inputs) -> std::shared_ptr<Component> {
      if (settings.sequence.empty()) return std::make_shared<KinematicBody>(settings, inputs);
      return std::make_shared<KinematicMesh>(settings, inputs);
    }};

}  // namespace muslin
