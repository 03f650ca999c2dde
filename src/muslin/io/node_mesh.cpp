#include "muslin/io/node_mesh.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "muslin/core/error.hpp"
#include "muslin/geometry/inspect.hpp"
#include "muslin/io/groups.hpp"

namespace muslin {
namespace {

// Far beyond any mesh that can be simulated; stops small files that instance a mesh many times. Also the most
// numbers of all attributes.
constexpr std::size_t max_corners = std::size_t{1} << 28;

}  // namespace

void NodeMesh::begin_node(const std::string& name, const Eigen::Matrix4d& transform) {
  if (!transform.allFinite()) refuse("the transform of node " + name + " is not finite");
  transform_ = transform;
  mirrored_ = transform.topLeftCorner<3, 3>().determinant() < 0;
  welder_.start_anew();
  mesh_.groups.push_back({name, {}, {}});
}

void NodeMesh::begin_part(std::size_t positions, std::size_t uvs, const std::string& material) {
  stored_ += positions;
  if (stored_ > max_corners) refuse("the mesh is too large");
  part_vertices_.clear();
  part_vertices_.reserve(positions);
  first_uv_ = mesh_.uvs.size();
  part_uvs_ = uvs;
  part_material_ = 0;
  if (material.empty()) return;
  const auto known = std::find_if(mesh_.materials.begin(), mesh_.materials.end(),
                                  [&](const MeshMaterial& other) { return other.name == material; });
  part_material_ = static_cast<std::size_t>(known - mesh_.materials.begin()) + 1;
  if (known == mesh_.materials.end()) mesh_.materials.push_back({material, {}});
}

void NodeMesh::position(const Vec3& local) {
  const Vec3 position = (transform_ * local.homogeneous()).head<3>();
  if (!position.allFinite() || position.cwiseAbs().maxCoeff() > largest_coordinate)
    refuse("a coordinate is not a number or is beyond 1e9 m");
  part_vertices_.push_back(welder_.vertex(position));
}

void NodeMesh::uv(const Vec2& uv) {
  if (!uv.allFinite()) refuse("a texture coordinate is not a number");
  mesh_.uvs.push_back(uv);
}

void NodeMesh::attribute(const std::string& name, std::span<const double> values) {
  const auto known = std::find_if(attributes_.begin(), attributes_.end(),
                                  [&](const Attribute& other) { return other.mean.name == name; });
  Attribute& own = known != attributes_.end() ? *known : attributes_.emplace_back();
  own.mean.name = name;
  complete(own);
  for (std::size_t p = 0; p < part_vertices_.size(); ++p) {
    const auto v = static_cast<std::size_t>(part_vertices_[p]);
    double& mean = own.mean.values[v];
    // The mean of equal numbers has their bits.
    mean = own.counts[v] == 0 ? values[p] : mean + (values[p] - mean) / (own.counts[v] + 1);
    ++own.counts[v];
  }
}

void NodeMesh::complete(Attribute& attribute) const {
  if (attributes_.size() * mesh_.positions.size() > max_corners) refuse("the mesh has too many attributes");
  attribute.mean.values.resize(mesh_.positions.size(), std::numeric_limits<double>::quiet_NaN());
  attribute.counts.resize(mesh_.positions.size(), 0);
}

void NodeMesh::face(std::span<const std::size_t> corners) {
  if (mesh_.face_vertices.size() + corners.size() > max_corners) refuse("the mesh is too large");
  if (mesh_.face_offsets.empty()) mesh_.face_offsets.push_back(0);
  for (std::size_t c = 0; c < corners.size(); ++c) {
    const std::size_t corner = corners[mirrored_ ? corners.size() - 1 - c : c];
    if (corner >= part_vertices_.size()) refuse("a face uses a vertex that does not exist");
    mesh_.face_vertices.push_back(part_vertices_[corner]);
    mesh_.corner_uvs.push_back(part_uvs_ > 0 ? static_cast<int>(first_uv_ + corner) : -1);
  }
  const int face = static_cast<int>(mesh_.face_count());
  mesh_.groups.back().faces.push_back(face);
  if (part_material_ > 0) mesh_.materials[part_material_ - 1].faces.push_back(face);
  mesh_.face_offsets.push_back(static_cast<int>(mesh_.face_vertices.size()));
}

MeshFile NodeMesh::finish(const std::string& reason, const std::string& extra) {
  if (mesh_.uvs.empty()) mesh_.corner_uvs.clear();
  std::erase_if(mesh_.groups, [](const MeshGroup& group) { return group.faces.empty(); });
  if (mesh_.groups.size() == 1) {
    mesh_.name = mesh_.groups[0].name;
    mesh_.groups.clear();
  }
  for (MeshGroup& group : mesh_.groups) {
    group.name = one_word(group.name);
    complete_group(mesh_, group);
  }
  std::erase_if(mesh_.materials, [](const MeshMaterial& material) { return material.faces.empty(); });
  std::string note = reason + ": " + std::to_string(stored_) +
                     " stored vertices were welded by position into " +
                     std::to_string(mesh_.positions.size()) + "." + extra;
  MeshFile file{{}, std::move(note), {}};
  file.attributes.reserve(attributes_.size());
  for (Attribute& attribute : attributes_) {
    complete(attribute);
    file.attributes.push_back(std::move(attribute.mean));
  }
  file.mesh = std::move(mesh_);
  return file;
}

void NodeMesh::refuse(const std::string& problem) const {
  throw Error(ErrorKind::input, Place{file_}, problem, "repair the mesh in the modeller and export it again");
}

}  // namespace muslin
