#include "muslin/scene/pin_sequence.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#include <fmt/format.h>

#include "muslin/core/parallel.hpp"
#include "muslin/io/point_sequence_file.hpp"

namespace muslin {
namespace {

constexpr std::size_t grain = 64;

/// Vertices of the mesh that those of a body may follow, ascending.
std::vector<int> leaders(const Component& body, const Selection& where) {
  for (const MeshGroup& group : body.mesh.groups) {
    if (!where.group || group.name != *where.group) continue;
    std::vector<int> vertices = group.vertices;
    for (const int f : group.faces) {
      for (const int v : body.mesh.face(static_cast<std::size_t>(f))) vertices.push_back(v);
    }
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    return vertices;
  }
  std::vector<int> all(body.mesh.vertex_count());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

int nearest(const Vec3& place, const std::vector<int>& among, const std::vector<Vec3>& positions) {
  double least = std::numeric_limits<double>::infinity();
  int best = among.front();
  for (const int v : among) {
    const double distance = (positions[static_cast<std::size_t>(v)] - place).squaredNorm();
    if (distance < least) {
      least = distance;
      best = v;
    }
  }
  return best;
}

}  // namespace

void follow_sequence(const Scene& scene, const PinSettings& settings, const Component& body, Pin& pin) {
  const auto file = resolve_path(scene, settings.sequence);
  PointSequence sequence;
  try {
    sequence = read_point_sequence(file, scene.time.frame_rate);
  } catch (const Error& error) {
    throw Error(error.kind(), settings.sequence_place, file.string() + ": " + error.problem(),
                error.remedy());
  }
  const std::size_t count = body.skin_mesh().vertex_count();
  if (sequence.points != count) {
    throw Error(ErrorKind::input, settings.sequence_place,
                fmt::format("{} moves {} points, the mesh of body `{}` has {} vertices", file.string(),
                            sequence.points, body.name, count),
                "export the sequence from the same mesh");
  }
  const std::vector<int> among = body.is_mesh() ? std::vector<int>{} : leaders(body, settings.where);
  pin.points.resize(pin.vertices.size());
  parallel_for(pin.vertices.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const int local = pin.vertices[i] - body.first_vertex;
      const int point = body.is_mesh() ? local
                                       : nearest(body.rest_position(static_cast<std::size_t>(local)), among,
                                                 body.mesh.positions);
      pin.points[i] = body.source ? body.source->origins[static_cast<std::size_t>(point)] : point;
    }
  });
  pin.sequence = std::make_shared<const PointSequence>(std::move(sequence));
}

}  // namespace muslin
