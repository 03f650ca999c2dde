#include "muslin/io/mesh_writers.hpp"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstdint>

#include "muslin/io/groups.hpp"

namespace muslin {
namespace {

std::string one_line(std::string name) {
  std::replace_if(name.begin(), name.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  return name;
}

/// Ends a line of names; a trailing backslash would join it to the next line.
void end_names(std::string& text) {
  if (text.back() == '\\') text.back() = '_';
  text += '\n';
}

template <class Number>
void append(std::string& text, Number value) {
  char digits[40];
  text.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
}

template <class Number>
void append_bytes(std::string& bytes, Number value) {
  char raw[sizeof value];
  std::copy_n(reinterpret_cast<const char*>(&value), sizeof value, raw);
  if constexpr (std::endian::native == std::endian::big) std::reverse(raw, raw + sizeof value);
  bytes.append(raw, sizeof value);
}

// For each face, the groups it belongs to, ascending: group g of face f is in
// groups[begin[f]] … groups[begin[f + 1] − 1].
struct FaceGroups {
  std::vector<std::size_t> begin;
  std::vector<int> groups;

  explicit FaceGroups(const Mesh& mesh) : begin(mesh.face_count() + 1, 0) {
    for (const MeshGroup& group : mesh.groups)
      for (const int f : group.faces) ++begin[static_cast<std::size_t>(f) + 1];
    for (std::size_t f = 1; f < begin.size(); ++f) begin[f] += begin[f - 1];
    groups.resize(begin.back());
    std::vector<std::size_t> at(begin.begin(), begin.end() - 1);
    for (std::size_t g = 0; g < mesh.groups.size(); ++g)
      for (const int f : mesh.groups[g].faces)
        groups[at[static_cast<std::size_t>(f)]++] = static_cast<int>(g);
  }
  std::span<const int> of(std::size_t f) const { return {groups.data() + begin[f], begin[f + 1] - begin[f]}; }
};

void append_vertex_groups(std::string& text, const Mesh& mesh) {
  for (const MeshGroup& group : mesh.groups) {
    MeshGroup of_faces{group.name, group.faces, {}};
    complete_group(mesh, of_faces);
    std::vector<int> points;
    std::set_difference(group.vertices.begin(), group.vertices.end(), of_faces.vertices.begin(),
                        of_faces.vertices.end(), std::back_inserter(points));
    if (points.empty()) continue;
    text += "g " + one_word(group.name);
    end_names(text);
    text += 'p';
    for (const int v : points) {
      text += ' ';
      append(text, v + 1);
    }
    text += '\n';
  }
}

}  // namespace

std::string to_obj(const Mesh& mesh, ConstVectors positions) {
  std::string text;
  text.reserve(60 * positions.size() + 8 * mesh.face_vertices.size());
  if (!mesh.name.empty()) {
    text += "o " + one_line(mesh.name);
    end_names(text);
  }
  for (const Vec3& position : positions) {
    text += 'v';
    for (const double coordinate : position) {
      text += ' ';
      append(text, coordinate);
    }
    text += '\n';
  }
  for (const Vec2& uv : mesh.uvs) {
    text += "vt ";
    append(text, uv.x());
    text += ' ';
    append(text, uv.y());
    text += '\n';
  }
  const FaceGroups groups(mesh);
  const std::vector<int> materials = mesh.material_of_face();
  std::span<const int> active;
  int material = -1;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    if (const auto wanted = groups.of(f);
        !std::equal(wanted.begin(), wanted.end(), active.begin(), active.end())) {
      text += 'g';
      for (const int g : wanted) text += ' ' + one_word(mesh.groups[static_cast<std::size_t>(g)].name);
      end_names(text);
      active = wanted;
    }
    if (materials[f] != material) {
      material = materials[f];
      text += "usemtl";
      if (material >= 0) text += ' ' + one_line(mesh.materials[static_cast<std::size_t>(material)].name);
      end_names(text);
    }
    text += 'f';
    for (int c = mesh.face_offsets[f]; c < mesh.face_offsets[f + 1]; ++c) {
      text += ' ';
      append(text, mesh.face_vertices[static_cast<std::size_t>(c)] + 1);
      const int uv = mesh.corner_uvs.empty() ? -1 : mesh.corner_uvs[static_cast<std::size_t>(c)];
      if (uv < 0) continue;
      text += '/';
      append(text, uv + 1);
    }
    text += '\n';
  }
  append_vertex_groups(text, mesh);
  return text;
}

std::string to_ply(const Mesh& mesh, ConstVectors positions) {
  std::size_t max_corners = 0;
  for (std::size_t f = 0; f < mesh.face_count(); ++f)
    max_corners = std::max(max_corners, mesh.face(f).size());
  const bool long_faces = max_corners > 255;
  std::string bytes = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                      std::to_string(positions.size()) +
                      "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
                      std::to_string(mesh.face_count()) + "\nproperty list " +
                      (long_faces ? "uint" : "uchar") + " int vertex_indices\nend_header\n";
  bytes.reserve(bytes.size() + 24 * positions.size() + 4 * (mesh.face_vertices.size() + mesh.face_count()));
  for (const Vec3& position : positions)
    for (const double coordinate : position) append_bytes(bytes, coordinate);
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(f);
    if (long_faces)
      append_bytes(bytes, static_cast<std::uint32_t>(face.size()));
    else
      append_bytes(bytes, static_cast<std::uint8_t>(face.size()));
    for (const int v : face) append_bytes(bytes, static_cast<std::int32_t>(v));
  }
  return bytes;
}

}  // namespace muslin
