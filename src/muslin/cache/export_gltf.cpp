#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "muslin/cache/export_formats.hpp"
#include "muslin/core/error.hpp"
#include "muslin/core/output_file.hpp"
#include "muslin/version.hpp"

namespace muslin {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// Numbers of the glTF 2.0 specification.
constexpr int float_component = 5126, unsigned_component = 5125;
constexpr int vertex_buffer = 34962, index_buffer = 34963;

/// glTF has one texture coordinate per vertex: a vertex on a seam becomes several.
struct SplitMesh {
  std::vector<int> vertices;  ///< the mesh's vertex of each glTF vertex
  std::vector<float> uvs;     ///< 2 per glTF vertex, empty without texture coordinates
  /// Three per triangle: a list for each material of the mesh, then one for faces without a material.
  std::vector<std::vector<std::uint32_t>> indices;
};

SplitMesh split(const Mesh& mesh) {
  // Triangulates with corners as vertices, so that every corner keeps its texture coordinate.
  Mesh corners;
  corners.face_offsets = mesh.face_offsets;
  for (std::size_t c = 0; c < mesh.face_vertices.size(); ++c) {
    corners.positions.push_back(mesh.positions[static_cast<std::size_t>(mesh.face_vertices[c])]);
    corners.face_vertices.push_back(static_cast<int>(c));
  }
  SplitMesh result;
  result.indices.resize(mesh.materials.size() + 1);
  const std::vector<int> materials = mesh.material_of_face();
  const Triangulation cut = triangulate(corners);
  std::map<std::pair<int, int>, std::uint32_t> known;
  for (std::size_t t = 0; t < cut.triangles.size(); ++t) {
    const int material = materials[static_cast<std::size_t>(cut.faces[t])];
    std::vector<std::uint32_t>& indices =
        material < 0 ? result.indices.back() : result.indices[static_cast<std::size_t>(material)];
    for (const int c : cut.triangles[t]) {
      const auto corner = static_cast<std::size_t>(c);
      const int vertex = mesh.face_vertices[corner];
      const int uv = mesh.corner_uvs.empty() ? -1 : mesh.corner_uvs[corner];
      const auto [place, added] =
          known.try_emplace({vertex, uv}, static_cast<std::uint32_t>(result.vertices.size()));
      if (added) {
        result.vertices.push_back(vertex);
        if (!mesh.corner_uvs.empty()) {
          const Vec2 st = uv < 0 ? Vec2(0, 0) : mesh.uvs[static_cast<std::size_t>(uv)];
          // glTF counts v from the top of the picture, OBJ from its bottom.
          result.uvs.push_back(static_cast<float>(st.x()));
          result.uvs.push_back(static_cast<float>(1 - st.y()));
        }
      }
      indices.push_back(place->second);
    }
  }
  return result;
}

/// The document and its binary buffer, built together.
class Document {
 public:
  Json json = {{"asset", {{"version", "2.0"}, {"generator", fmt::format("muslin {}", version())}}}};

  /// A buffer view over everything that is appended until the next call.
  int open_view(int target, int stride) {
    Json view = {{"buffer", 0}, {"byteOffset", buffer_.size()}, {"byteLength", 0}};
    if (stride > 0) view["byteStride"] = stride;
    if (target > 0) view["target"] = target;
    json["bufferViews"].push_back(view);
    return static_cast<int>(json["bufferViews"].size()) - 1;
  }
  template <class Number>
  int accessor(int view, const char* type, int components, const std::vector<Number>& numbers, bool bounds) {
    Json& record = json["bufferViews"][static_cast<std::size_t>(view)];
    const std::size_t offset = buffer_.size() - record["byteOffset"].get<std::size_t>();
    Json accessor = {{"bufferView", view},
                     {"byteOffset", offset},
                     {"componentType", std::is_same_v<Number, float> ? float_component : unsigned_component},
                     {"count", numbers.size() / static_cast<std::size_t>(components)},
                     {"type", type}};
    if (bounds) {
      for (int c = 0; c < components; ++c) {
        Number low = std::numeric_limits<Number>::max(), high = std::numeric_limits<Number>::lowest();
        for (std::size_t i = static_cast<std::size_t>(c); i < numbers.size();
             i += static_cast<std::size_t>(components)) {
          low = std::min(low, numbers[i]);
          high = std::max(high, numbers[i]);
        }
        accessor["min"].push_back(low);
        accessor["max"].push_back(high);
      }
    }
    buffer_.append(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(Number));
    record["byteLength"] = buffer_.size() - record["byteOffset"].get<std::size_t>();
    json["accessors"].push_back(accessor);
    return static_cast<int>(json["accessors"].size()) - 1;
  }
  const std::string& buffer() const { return buffer_; }

 private:
  std::string buffer_;
};

void write_glb(const fs::path& file, Document& document) {
  document.json["buffers"] = {{{"byteLength", document.buffer().size()}}};
  std::string text = document.json.dump();
  text.append((4 - text.size() % 4) % 4, ' ');
  // All accessors are of 4-byte numbers, so the buffer needs no padding.
  const std::uint64_t length = 12 + 8 + text.size() + 8 + document.buffer().size();
  if (length > std::numeric_limits<std::uint32_t>::max()) {
    throw Error(ErrorKind::usage, {file.string()}, "the animation is larger than the 4 GiB a .glb can hold",
                "export .gltf or .usda instead");
  }
  WholeFile out(file);
  const auto word = [&out](std::uint64_t value) {
    const auto narrow = static_cast<std::uint32_t>(value);
    out.append(&narrow, sizeof narrow);
  };
  word(0x46546C67);  // "glTF"
  word(2);
  word(length);
  word(text.size());
  word(0x4E4F534A);  // "JSON"
  out.append(text);
  word(document.buffer().size());
  word(0x004E4942);  // "BIN"
  out.append(document.buffer());
  out.commit();
}

void write_gltf(const fs::path& file, Document& document) {
  fs::path binary = file;
  binary.replace_extension(".bin");
  document.json["buffers"] = {
      {{"uri", binary.filename().string()}, {"byteLength", document.buffer().size()}}};
  WholeFile data(binary);
  data.append(document.buffer());
  data.commit();
  WholeFile out(file);
  out.append(document.json.dump(1) + "\n");
  out.commit();
}

}  // namespace

void export_gltf(const RunReader& run, const fs::path& file, ExportedSurface& surface,
                 const Progress& progress) {
  const SplitMesh mesh = split(surface.mesh());
  const std::vector<Vec3f> start = surface.points(0);
  const int frames = run.frame_count();
  const std::string& name = surface.name();
  Document document;

  int view = document.open_view(index_buffer, 0);
  Json primitives = Json::array(), materials = Json::array();
  for (std::size_t m = 0; m < mesh.indices.size(); ++m) {
    if (mesh.indices[m].empty()) continue;
    const std::vector<MeshMaterial>& of_mesh = surface.mesh().materials;
    primitives.push_back({{"indices", document.accessor(view, "SCALAR", 1, mesh.indices[m], false)},
                          {"material", materials.size()}});
    materials.push_back({{"name", m < of_mesh.size() ? of_mesh[m].name : "cloth"},
                         {"doubleSided", true},
                         {"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0.9}}}});
  }
  Json vertices;  // of all primitives
  view = document.open_view(vertex_buffer, 12);
  std::vector<float> numbers;
  for (int v : mesh.vertices) {
    const Vec3f& p = start[static_cast<std::size_t>(v)];
    numbers.insert(numbers.end(), p.data(), p.data() + 3);
  }
  vertices["attributes"]["POSITION"] = document.accessor(view, "VEC3", 3, numbers, true);
  if (!mesh.uvs.empty()) {
    const int uv_view = document.open_view(vertex_buffer, 8);
    vertices["attributes"]["TEXCOORD_0"] = document.accessor(uv_view, "VEC2", 2, mesh.uvs, false);
  }
  if (frames > 1) view = document.open_view(vertex_buffer, 12);
  for (int frame = 1; frame < frames; ++frame) {
    progress.at(static_cast<double>(frame) / frames, "export");
    const std::vector<Vec3f> points = surface.points(frame);
    numbers.clear();
    for (int v : mesh.vertices) {
      const Vec3f d = points[static_cast<std::size_t>(v)] - start[static_cast<std::size_t>(v)];
      numbers.insert(numbers.end(), d.data(), d.data() + 3);
    }
    vertices["targets"].push_back({{"POSITION", document.accessor(view, "VEC3", 3, numbers, true)}});
  }
  for (Json& primitive : primitives) primitive.update(vertices);
  document.json["materials"] = std::move(materials);
  document.json["meshes"] = {{{"name", name}, {"primitives", std::move(primitives)}}};
  document.json["nodes"] = {{{"name", name}, {"mesh", 0}}};
  document.json["scenes"] = {{{"nodes", {0}}}};
  document.json["scene"] = 0;

  if (frames > 1) {
    std::vector<float> times, weights;
    for (int frame = 0; frame < frames; ++frame) {
      times.push_back(static_cast<float>(frame / run.frame_rate()));
      for (int target = 1; target < frames; ++target) weights.push_back(target == frame ? 1.0f : 0.0f);
    }
    document.json["meshes"][0]["weights"] = std::vector<float>(static_cast<std::size_t>(frames) - 1, 0.0f);
    view = document.open_view(0, 0);
    const int input = document.accessor(view, "SCALAR", 1, times, true);
    view = document.open_view(0, 0);
    const int output = document.accessor(view, "SCALAR", 1, weights, false);
    document.json["animations"] = {
        {{"name", run.title().empty() ? name : run.title()},
         {"samplers", {{{"input", input}, {"output", output}, {"interpolation", "LINEAR"}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}}}}}};
  }
  if (file.extension() == ".glb") return write_glb(file, document);
  write_gltf(file, document);
}

}  // namespace muslin
