#include "muslin/cache/exported_surface.hpp"

#include <algorithm>
#include <utility>

#include <nlohmann/json.hpp>

#include "muslin/component/placement.hpp"
#include "muslin/core/error.hpp"
#include "muslin/io/mesh_file.hpp"

namespace muslin {
namespace {

using Json = nlohmann::ordered_json;

Vec3 vector_in(const Json& body, const char* key, const Vec3& otherwise) {
  if (!body.contains(key)) return otherwise;
  const Json& value = body[key];
  if (value.is_number()) return Vec3::Constant(value.get<double>());
  return {value.at(0).get<double>(), value.at(1).get<double>(), value.at(2).get<double>()};
}

/// Returns the place of the body's mesh in the world, which the mesh that it carries shares.
Eigen::Affine3d placement_of(const Json& scene, const std::string& body) {
  for (const char* list : {"body", "collider"})
    for (const Json& entry : scene.value(list, Json::array()))
      if (entry.value("name", "") == body)
        return placement(vector_in(entry, "translate", Vec3::Zero()),
                         vector_in(entry, "rotate", Vec3::Zero()), vector_in(entry, "scale", Vec3::Ones()));
  return Eigen::Affine3d::Identity();
}

Mesh read_carried(const std::filesystem::path& file, const Eigen::Affine3d& place) {
  Mesh mesh = read_mesh(file).mesh;
  for (Vec3& x : mesh.positions) x = place * x;
  return mesh;
}

}  // namespace

std::vector<Vec3> widened(const std::vector<Vec3f>& points) {
  std::vector<Vec3> result(points.size());
  std::transform(points.begin(), points.end(), result.begin(),
                 [](const Vec3f& p) -> Vec3 { return p.cast<double>(); });
  return result;
}

ExportedSurface::ExportedSurface(const RunReader& run, int body, const ExportOptions& options)
    : run_(run), body_(body), surface_(options.surface) {
  FinishOptions finish{options.smooth, options.subdivide, std::nullopt, options.thickness};
  if (!options.carry.empty()) {
    const Json scene = Json::parse(run.resolved_scene());
    finish.carried = read_carried(options.carry, placement_of(scene, name()));
    guarded_ = scene.contains("contact");
  }
  if (!finish.changes_nothing()) finish_.emplace(run.mesh(body, surface_), std::move(finish));
}

const std::string& ExportedSurface::name() const { return run_.bodies()[static_cast<std::size_t>(body_)]; }

const Mesh& ExportedSurface::mesh() const { return finish_ ? finish_->mesh() : run_.mesh(body_, surface_); }

Obstacles ExportedSurface::obstacles(int frame) const {
  Obstacles result;
  if (!guarded_) return result;
  for (int other = 0; other < static_cast<int>(run_.bodies().size()); ++other) {
    if (other == body_) continue;
    const auto first = static_cast<int>(result.positions.size());
    const std::vector<Vec3> points = widened(run_.points(other, SurfaceKind::skin, frame));
    result.positions.insert(result.positions.end(), points.begin(), points.end());
    for (const Vec3i& t : triangulate(run_.mesh(other, SurfaceKind::skin)).triangles)
      result.triangles.emplace_back(t.array() + first);
  }
  return result;
}

const std::vector<Vec3f>& ExportedSurface::finished(int frame) {
  if (const auto known = recent_.find(frame); known != recent_.end()) return known->second;
  const Carried carried = finish_->points(widened(run_.points(body_, surface_, frame)), obstacles(frame));
  if (frame > last_reported_) {  // later reads of a frame are not counted again
    last_reported_ = frame;
    report_.frames_drawn_in += carried.drawn_in > 0 ? 1 : 0;
    report_.frames_crossing += carried.crossings > 0 ? 1 : 0;
  }
  if (carried.crossings > report_.most_crossings) {
    report_.most_crossings = carried.crossings;
    report_.frame_of_most = frame;
  }
  std::vector<Vec3f> points(carried.points.size());
  std::transform(carried.points.begin(), carried.points.end(), points.begin(),
                 [](const Vec3& p) -> Vec3f { return p.cast<float>(); });
  if (recent_.size() >= 3) recent_.erase(recent_.begin());
  return recent_.emplace(frame, std::move(points)).first->second;
}

std::vector<Vec3f> ExportedSurface::points(int frame) {
  return finish_ ? finished(frame) : run_.points(body_, surface_, frame);
}

std::vector<Vec3f> ExportedSurface::velocities(int frame) {
  if (!finish_) return run_.velocities(body_, surface_, frame);
  const int before = std::max(0, frame - 1), after = std::min(run_.frame_count() - 1, frame + 1);
  const std::vector<Vec3f> earlier = points(before);
  std::vector<Vec3f> result = points(after);
  const auto scale = static_cast<float>(after > before ? run_.frame_rate() / (after - before) : 0.0);
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = scale * (result[i] - earlier[i]);
  return result;
}

}  // namespace muslin
