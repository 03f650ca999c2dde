#include "muslin/post/subdivision.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <opensubdiv/far/primvarRefiner.h>
#include <opensubdiv/far/stencilTable.h>
#include <opensubdiv/far/stencilTableFactory.h>
#include <opensubdiv/far/topologyDescriptor.h>

#include "muslin/core/error.hpp"
#include "muslin/core/index.hpp"
#include "muslin/core/parallel.hpp"

namespace muslin {
namespace {

namespace Far = OpenSubdiv::Far;
namespace Sdc = OpenSubdiv::Sdc;
using Refiner = std::unique_ptr<const Far::TopologyRefiner>;

constexpr double most_faces = 5e7;

/// A texture coordinate as OpenSubdiv combines it.
struct Texture {
  Vec2 uv = Vec2::Zero();
  void Clear() { uv.setZero(); }
  void AddWithWeight(const Texture& other, float weight) { uv += static_cast<double>(weight) * other.uv; }
};

void require_subdivisible(const Mesh& mesh, int levels) {
  double faces = 0;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    std::vector<int> corners(mesh.face(f).begin(), mesh.face(f).end());
    faces += corners.size() == 3 ? 1 : static_cast<double>(corners.size()) / 4;
    std::sort(corners.begin(), corners.end());
    if (std::adjacent_find(corners.begin(), corners.end()) != corners.end())
      throw Error(ErrorKind::usage, fmt::format("face {} names a vertex twice, it cannot be subdivided", f),
                  "remove such faces from the mesh");
  }
  for (int level = 0; level < levels; ++level) faces *= 4;
  if (faces > most_faces)
    throw Error(ErrorKind::usage,
                fmt::format("{} levels of subdivision make {:.0f} million faces", levels, faces / 1e6),
                "use fewer levels");
}

/// Corners without texture coordinates get one of their own, of index mesh.uvs.size().
Refiner refine(const Mesh& mesh, int levels) {
  std::vector<int> counts;
  counts.reserve(mesh.face_count());
  for (std::size_t f = 0; f < mesh.face_count(); ++f) counts.push_back(static_cast<int>(mesh.face(f).size()));
  const bool triangles = std::all_of(counts.begin(), counts.end(), [](int count) { return count == 3; });
  Far::TopologyDescriptor descriptor;
  descriptor.numVertices = static_cast<int>(mesh.vertex_count());
  descriptor.numFaces = static_cast<int>(counts.size());
  descriptor.numVertsPerFace = counts.data();
  descriptor.vertIndicesPerFace = mesh.face_vertices.data();
  std::vector<int> uvs = mesh.corner_uvs;
  Far::TopologyDescriptor::FVarChannel channel;
  if (!uvs.empty()) {
    for (int& uv : uvs)
      if (uv < 0) uv = static_cast<int>(mesh.uvs.size());
    channel.numValues = static_cast<int>(mesh.uvs.size()) + 1;
    channel.valueIndices = uvs.data();
    descriptor.numFVarChannels = 1;
    descriptor.fvarChannels = &channel;
  }
  Sdc::Options options;
  options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
  options.SetFVarLinearInterpolation(Sdc::Options::FVAR_LINEAR_BOUNDARIES);
  using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
  std::unique_ptr<Far::TopologyRefiner> refiner(Factory::Create(
      descriptor, Factory::Options(triangles ? Sdc::SCHEME_LOOP : Sdc::SCHEME_CATMARK, options)));
  if (!refiner)
    throw Error(ErrorKind::usage, "the mesh cannot be subdivided", "check it with `muslin check`");
  Far::TopologyRefiner::UniformOptions uniform(levels);
  uniform.fullTopologyInLastLevel = true;
  refiner->RefineUniform(uniform);
  return refiner;
}

std::vector<Vec2> refined_uvs(const Mesh& mesh, const Far::TopologyRefiner& refiner) {
  std::vector<Texture> from(mesh.uvs.size() + 1);
  for (std::size_t i = 0; i < mesh.uvs.size(); ++i) from[i].uv = mesh.uvs[i];
  const Far::PrimvarRefiner primvars(refiner);
  for (int level = 1; level <= refiner.GetMaxLevel(); ++level) {
    std::vector<Texture> to(at(refiner.GetLevel(level).GetNumFVarValues()));
    primvars.InterpolateFaceVarying(level, from, to);
    from.swap(to);
  }
  std::vector<Vec2> uvs;
  uvs.reserve(from.size());
  for (const Texture& value : from) uvs.push_back(value.uv);
  return uvs;
}

/// Returns the face of the mesh that each face of the last level is a part of.
std::vector<int> first_parents(const Far::TopologyRefiner& refiner) {
  std::vector<int> parents;
  for (int level = 1; level <= refiner.GetMaxLevel(); ++level) {
    const Far::TopologyLevel& refined = refiner.GetLevel(level);
    std::vector<int> next(at(refined.GetNumFaces()));
    for (int f = 0; f < refined.GetNumFaces(); ++f) {
      const int parent = refined.GetFaceParentFace(f);
      next[at(f)] = level == 1 ? parent : parents[at(parent)];
    }
    parents.swap(next);
  }
  return parents;
}

/// The parts of a face of which a corner has no texture coordinate have none.
std::vector<int> refined_corner_uvs(const Mesh& mesh, const std::vector<int>& parents,
                                    const Far::TopologyLevel& last) {
  std::vector<int> corners;
  for (int f = 0; f < last.GetNumFaces(); ++f) {
    const auto parent = at(parents[at(f)]);
    const auto first = mesh.corner_uvs.begin() + mesh.face_offsets[parent];
    const auto end = mesh.corner_uvs.begin() + mesh.face_offsets[parent + 1];
    const bool textured = std::find(first, end, -1) == end;
    const Far::ConstIndexArray values = last.GetFaceFVarValues(f);
    for (int i = 0; i < values.size(); ++i) corners.push_back(textured ? values[i] : -1);
  }
  return corners;
}

/// Returns the group of the parts of a group's faces, and of the vertices for which `depends` is true.
template <class Depends>
MeshGroup refined_group(const MeshGroup& group, const std::vector<int>& parents, const Mesh& refined,
                        const Depends& depends) {
  MeshGroup result{group.name, {}, {}};
  for (std::size_t f = 0; f < parents.size(); ++f) {
    if (!std::binary_search(group.faces.begin(), group.faces.end(), parents[f])) continue;
    result.faces.push_back(static_cast<int>(f));
    const std::span<const int> face = refined.face(f);
    result.vertices.insert(result.vertices.end(), face.begin(), face.end());
  }
  for (std::size_t v = 0; result.faces.empty() && v < refined.vertex_count(); ++v)
    if (depends(v)) result.vertices.push_back(static_cast<int>(v));
  std::sort(result.vertices.begin(), result.vertices.end());
  result.vertices.erase(std::unique(result.vertices.begin(), result.vertices.end()), result.vertices.end());
  return result;
}

}  // namespace

Subdivision::Subdivision(const Mesh& mesh, int levels) {
  require_subdivisible(mesh, levels);
  const Refiner refiner = refine(mesh, levels);
  const Far::TopologyLevel& last = refiner->GetLevel(refiner->GetMaxLevel());
  const std::vector<int> parents = first_parents(*refiner);

  Far::StencilTableFactoryReal<double>::Options options;
  options.generateIntermediateLevels = false;
  options.generateOffsets = true;
  const std::unique_ptr<const Far::StencilTableReal<double>> stencils(
      Far::StencilTableFactoryReal<double>::Create(*refiner, options));
  offsets_.assign(stencils->GetOffsets().begin(), stencils->GetOffsets().end());
  sources_ = stencils->GetControlIndices();
  weights_ = stencils->GetWeights();
  offsets_.push_back(static_cast<int>(sources_.size()));

  mesh_.name = mesh.name;
  for (int f = 0; f < last.GetNumFaces(); ++f) {
    const Far::ConstIndexArray face = last.GetFaceVertices(f);
    mesh_.add_face(std::span<const int>(face.begin(), at(face.size())));
  }
  if (!mesh.corner_uvs.empty()) {
    mesh_.uvs = refined_uvs(mesh, *refiner);
    mesh_.corner_uvs = refined_corner_uvs(mesh, parents, last);
  }
  mesh_.positions = points(mesh.positions);

  for (const MeshMaterial& material : mesh.materials) mesh_.materials.push_back({material.name, {}});
  const std::vector<int> materials = mesh.material_of_face();
  for (std::size_t f = 0; f < parents.size(); ++f)
    if (const int material = materials[at(parents[f])]; material >= 0)
      mesh_.materials[at(material)].faces.push_back(static_cast<int>(f));
  for (const MeshGroup& group : mesh.groups) {
    const auto inside = [&](int v) {
      return std::binary_search(group.vertices.begin(), group.vertices.end(), v);
    };
    mesh_.groups.push_back(refined_group(group, parents, mesh_, [&](std::size_t v) {
      return std::all_of(sources_.begin() + offsets_[v], sources_.begin() + offsets_[v + 1], inside);
    }));
  }
}

std::vector<Vec3> Subdivision::points(ConstVectors positions) const {
  std::vector<Vec3> result(offsets_.size() - 1);
  parallel_for(result.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      Vec3 sum = Vec3::Zero();
      for (int i = offsets_[v]; i < offsets_[v + 1]; ++i)
        sum += weights_[at(i)] * positions[at(sources_[at(i)])];
      result[v] = sum;
    }
  });
  return result;
}

}  // namespace muslin
