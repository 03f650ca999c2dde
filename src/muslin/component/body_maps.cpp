#include "muslin/component/body_maps.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "muslin/core/hash.hpp"
#include "muslin/core/index.hpp"
#include "muslin/core/nearest_name.hpp"
#include "muslin/core/parallel.hpp"
#include "muslin/geometry/closest_point.hpp"
#include "muslin/io/grey_image.hpp"
#include "muslin/io/number_file.hpp"

namespace muslin {
namespace {

class MapReader {
 public:
  MapReader(const schema::Variation& variation, const SceneFiles& files, const Component& component)
      : variation_(variation), files_(files), component_(component) {}

  std::vector<double> weights() const {
    std::vector<double> weights = values();
    if (component_.source && weights.size() == component_.source->vertices.size())
      weights = of_origins(weights);
    const std::size_t count = component_.mesh.vertex_count();
    if (weights.size() != count)
      refuse(fmt::format("has {} numbers, but the mesh of body `{}` has {} vertices", weights.size(),
                         component_.name, count),
             "give one for each vertex, in the order of the mesh");
    const auto [lowest, highest] = std::pair(variation_.lowest, variation_.highest);
    for (std::size_t v = 0; v < count; ++v) {
      double& weight = weights[v];
      if (std::isnan(weight))
        refuse(fmt::format("has no number at vertex {}, counted from 0", v), "give every vertex a number");
      if (!(weight >= lowest && weight <= highest))
        refuse(fmt::format("is {} at vertex {}, counted from 0, which is not between {} and {}", weight, v,
                           lowest, highest),
               "set `lowest` and `highest` of the map to the range of its values");
      weight = (weight - lowest) / (highest - lowest);
    }
    return weights;
  }

 private:
  /// Reads the file of the map. `remedy` replaces that of a malformed file, unless it is null.
  template <class Read>
  auto in_file(const Read& read, const char* remedy) const {
    try {
      return read(files_.resolve(variation_.map));
    } catch (const Error& error) {
      const Place& place = error.place();
      const std::string line = place.line > 0 ? fmt::format(" line {}:", place.line) : "";
      throw Error(error.kind(), variation_.place,
                  fmt::format("the map `{}`:{} {}", variation_.map, line, error.problem()),
                  error.kind() == ErrorKind::input && remedy != nullptr ? remedy : error.remedy());
    }
  }

  /// The numbers of the vertices that are left of those of the file.
  std::vector<double> of_origins(const std::vector<double>& of_file) const {
    std::vector<double> left;
    for (const int v : component_.source->origins) left.push_back(of_file[static_cast<std::size_t>(v)]);
    return left;
  }

  std::vector<double> values() const {
    if (is_number_file(variation_.map))
      return in_file([](const auto& path) { return read_numbers(path); },
                     "give one finite number for each vertex, a line each in .csv");
    if (is_image_file(variation_.map))
      return from_image(in_file([](const auto& path) { return read_grey_image(path); }, nullptr));
    const std::vector<VertexAttribute>& attributes = component_.attributes;
    for (const VertexAttribute& attribute : attributes)
      if (attribute.name == variation_.map) return attribute.values;
    for (const MeshGroup& group : component_.mesh.groups)
      if (group.name == variation_.map) return from_group(group);
    std::vector<std::string> names;
    names.reserve(attributes.size() + component_.mesh.groups.size());
    for (const VertexAttribute& attribute : attributes) names.push_back(attribute.name);
    for (const MeshGroup& group : component_.mesh.groups) names.push_back(group.name);
    refuse(fmt::format("is no attribute or group of the mesh of body `{}`", component_.name),
           names.empty() ? "the mesh has none; name a .csv or .npy file with a number for each vertex"
                         : name_advice(variation_.map, names));
  }

  /// The mean over the corners of each vertex, which differ on a seam.
  std::vector<double> from_image(const GreyImage& image) const {
    const Mesh& mesh = component_.mesh;
    std::vector<double> sums(mesh.vertex_count(), 0.0), corners(mesh.vertex_count(), 0.0);
    for (std::size_t c = 0; c < mesh.face_vertices.size(); ++c) {
      const int vertex = mesh.face_vertices[c];
      const int index = c < mesh.corner_uvs.size() ? mesh.corner_uvs[c] : -1;
      if (index < 0)
        refuse(
            fmt::format("is an image, but vertex {} of body `{}`, counted from 0, has no texture coordinates",
                        vertex, component_.name),
            "unwrap the mesh in the modeller");
      const Vec2& uv = mesh.uvs[at(index)];
      if (!(uv.minCoeff() >= 0 && uv.maxCoeff() <= 1))
        refuse(fmt::format(
                   "does not reach vertex {}, counted from 0, at the texture coordinates ({:.4g}, {:.4g})",
                   vertex, uv.x(), uv.y()),
               "move the islands into the unit square");
      sums[at(vertex)] += image.at(uv);
      ++corners[at(vertex)];
    }
    for (std::size_t v = 0; v < sums.size(); ++v)
      if (corners[v] > 0) sums[v] /= corners[v];
    return sums;
  }

  std::vector<double> from_group(const MeshGroup& group) const {
    std::vector<double> weights(component_.mesh.vertex_count(), variation_.lowest);
    for (const int v : group.vertices) weights[static_cast<std::size_t>(v)] = variation_.highest;
    return weights;
  }

  [[noreturn]] void refuse(const std::string& problem, std::string remedy) const {
    throw Error(ErrorKind::input, variation_.place,
                fmt::format("the map `{}` of `{}` {}", variation_.map, variation_.key, problem),
                std::move(remedy));
  }

  const schema::Variation& variation_;
  const SceneFiles& files_;
  const Component& component_;
};

}  // namespace

std::vector<MappedNumber> read_maps(const schema::Variations& variations, const schema::Table& keys,
                                    const SceneFiles& files, const Component& component) {
  std::vector<MappedNumber> maps;
  for (std::size_t i = 0; i < variations.size(); ++i) {
    const schema::Variation& variation = variations[i];
    if (!variation.is_map()) continue;
    const schema::Key& key = *keys.find(variation.key);
    maps.push_back(
        {variation, key.unit, i, MapReader(variation, files, component).weights(), key.may_change_on_resume});
  }
  return maps;
}

std::vector<MappedNumber> over_points(const std::vector<MappedNumber>& maps, const Mesh& mesh,
                                      const std::vector<Vec3>& points) {
  std::vector<MappedNumber> result = maps;
  if (maps.empty()) return result;
  const std::vector<Vec3i> triangles = triangulate(mesh).triangles;
  const ClosestPointQuery nearest(mesh.positions, triangles);
  for (MappedNumber& map : result) map.weights.resize(points.size());
  parallel_for(points.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const ClosestPoint at = nearest(points[v]);
      const Vec3i& corners = triangles[static_cast<std::size_t>(at.triangle)];
      for (std::size_t m = 0; m < maps.size(); ++m) {
        double weight = 0;
        for (int c = 0; c < 3; ++c)
          weight += at.barycentric[c] * maps[m].weights[static_cast<std::size_t>(corners[c])];
        result[m].weights[v] = std::clamp(weight, 0.0, 1.0);
      }
    }
  });
  return result;
}

std::vector<double> numbers_at(const schema::Variations& variations, const schema::Table& keys,
                               std::string_view key, const SceneFiles& files, const Component& component,
                               const std::vector<int>& selected, double otherwise) {
  const std::vector<MappedNumber> maps = read_maps(variations, keys, files, component);
  const MappedNumber* map = find_map(maps, key);
  if (map == nullptr) return std::vector<double>(selected.size(), otherwise);
  std::vector<double> numbers;
  numbers.reserve(selected.size());
  if (component.is_mesh() || !component.selects_vertices()) {
    for (const int v : selected) numbers.push_back(map->at(at(v)));
    return numbers;
  }
  std::vector<Vec3> points;
  points.reserve(selected.size());
  for (const int v : selected) points.push_back(component.selectable(at(v)));
  return over_points({*map}, component.mesh, points).front().numbers();
}

std::uint64_t maps_hash(const std::vector<MappedNumber>& maps, std::uint64_t seed) {
  for (const MappedNumber& map : maps) {
    if (map.may_change_on_resume) continue;
    const std::vector<double> numbers = map.numbers();
    seed = hash_bytes(map.variation.key.data(), map.variation.key.size(), seed);
    seed = hash_bytes(numbers.data(), numbers.size() * sizeof(double), seed);
  }
  return seed;
}

}  // namespace muslin
