#include "muslin/io/mesh_bytes.hpp"

#include <cstdint>
#include <cstring>
#include <type_traits>
#include <utility>
#include <vector>

#include "muslin/core/error.hpp"

namespace muslin {
namespace {

class ByteWriter {
 public:
  template <class List>
  void list(List& list) {
    count(list.size());
    bytes.append(reinterpret_cast<const char*>(list.data()), list.size() * sizeof(list[0]));
  }
  template <class Item, class Visit>
  void items(std::vector<Item>& items, const Visit& visit) {
    count(items.size());
    for (Item& item : items) visit(item);
  }
  std::string bytes;

 private:
  void count(std::uint64_t n) { bytes.append(reinterpret_cast<const char*>(&n), sizeof n); }
};

class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}

  template <class List>
  void list(List& list) {
    using Item = std::remove_reference_t<decltype(list[0])>;
    const std::string_view raw = take(count(sizeof(Item)) * sizeof(Item));
    list.resize(raw.size() / sizeof(Item));
    if (!raw.empty()) std::memcpy(static_cast<void*>(list.data()), raw.data(), raw.size());
  }
  template <class Item, class Visit>
  void items(std::vector<Item>& items, const Visit& visit) {
    items.resize(count(sizeof(std::uint64_t)));
    for (Item& item : items) visit(item);
  }

 private:
  std::string_view take(std::size_t size) {
    require_left(size);
    const std::string_view taken = bytes_.substr(0, size);
    bytes_.remove_prefix(size);
    return taken;
  }
  /// Reads the number of items, of at least this size.
  std::size_t count(std::size_t size) {
    std::uint64_t n = 0;
    std::memcpy(&n, take(sizeof n).data(), sizeof n);
    if (n > bytes_.size() / size) require_left(bytes_.size() + 1);
    return n;
  }
  void require_left(std::size_t size) const {
    if (bytes_.size() < size)
      throw Error(ErrorKind::input, "a mesh did not come back whole from the process that read it",
                  "try again");
  }

  std::string_view bytes_;
};

/// Lists the parts of a mesh once, for both ways.
template <class Bytes>
void each_part(Bytes& bytes, MeshFile& file) {
  Mesh& mesh = file.mesh;
  bytes.list(mesh.face_offsets);
  bytes.list(mesh.face_vertices);
  bytes.list(mesh.name);
  bytes.list(mesh.positions);
  bytes.list(mesh.uvs);
  bytes.list(mesh.corner_uvs);
  bytes.items(mesh.groups, [&](MeshGroup& group) {
    bytes.list(group.name);
    bytes.list(group.faces);
    bytes.list(group.vertices);
  });
  bytes.items(mesh.materials, [&](MeshMaterial& material) {
    bytes.list(material.name);
    bytes.list(material.faces);
  });
  bytes.list(file.note);
  bytes.items(file.attributes, [&](VertexAttribute& attribute) {
    bytes.list(attribute.name);
    bytes.list(attribute.values);
  });
}

}  // namespace

std::string to_bytes(const MeshFile& file) {
  ByteWriter writer;
  MeshFile copy = file;
  each_part(writer, copy);
  return std::move(writer.bytes);
}

MeshFile from_bytes(std::string_view bytes) {
  MeshFile file;
  ByteReader reader(bytes);
  each_part(reader, file);
  return file;
}

}  // namespace muslin
