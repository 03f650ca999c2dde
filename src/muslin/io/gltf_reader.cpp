#include "muslin/io/gltf_reader.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "muslin/core/error.hpp"
#include "muslin/core/input_file.hpp"
#include "muslin/io/binary_reader.hpp"
#include "muslin/io/node_mesh.hpp"

// Compiled here with hidden symbols, not linked: Debian's libdraco, which assimp brings along, exports
// another version of the same classes, and the linker would mix the two. Images and files are not needed.
#include <fstream>
#include <sstream>

#include <nlohmann/json.hpp>
#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_INCLUDE_JSON
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_FS
#pragma GCC visibility push(hidden)
#include <tiny_gltf.h>
#pragma GCC visibility pop

namespace muslin {
namespace {

bool skip_image(tinygltf::Image*, int, std::string*, std::string*, int, int, const unsigned char*, int,
                void*) {
  return true;
}

// tinygltf reads other files through these; user data is the folder, or null.
bool file_exists(const std::string& path, void* folder) {
  std::error_code error;
  return folder != nullptr && std::filesystem::is_regular_file(path, error);
}
std::string same_path(const std::string& path, void*) { return path; }
bool read_other_file(std::vector<unsigned char>* out, std::string* problem, const std::string& path,
                     void* folder) {
  if (folder == nullptr) {
    *problem += "the buffer is in another file";
    return false;
  }
  try {
    const std::string bytes = read_file(path);
    out->assign(bytes.begin(), bytes.end());
    return true;
  } catch (const Error& error) {
    *problem += error.what();
    return false;
  }
}
bool write_nothing(std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
  return false;
}

// A checked view of an accessor's numbers.
struct Numbers {
  const char* data = nullptr;
  std::size_t count = 0, stride = 0, components = 0;
  Scalar type{};
  bool normalized = false;

  double at(std::size_t element, std::size_t component) const {
    const double value = load_number(data + element * stride + component * size_of(type), type, false);
    if (!normalized) return value;
    switch (type) {
      case Scalar::int8:
        return std::max(value / 127, -1.0);
      case Scalar::uint8:
        return value / 255;
      case Scalar::int16:
        return std::max(value / 32767, -1.0);
      case Scalar::uint16:
        return value / 65535;
      default:
        return value;
    }
  }
};

class GltfReader {
 public:
  explicit GltfReader(const std::string& file) : file_(file), out_(file) {}

  MeshFile read(std::string_view bytes, const std::filesystem::path& folder) {
    load_model(bytes, folder);
    visited_.assign(model_.nodes.size(), false);
    if (model_.scenes.empty()) {
      for (std::size_t n = 0; n < model_.nodes.size(); ++n)
        if (!is_child(static_cast<int>(n))) visit(static_cast<int>(n));
    } else {
      const bool named =
          model_.defaultScene >= 0 && static_cast<std::size_t>(model_.defaultScene) < model_.scenes.size();
      for (const int root : model_.scenes[named ? static_cast<std::size_t>(model_.defaultScene) : 0].nodes)
        visit(root);
    }
    std::string extra;
    if (skipped_ > 0) extra += " Points and lines were left out.";
    if (!model_.skins.empty() || !model_.animations.empty())
      extra += " Skins and animations were left out: the mesh is in its rest pose.";
    return out_.finish("glTF stores seams apart", extra);
  }

 private:
  [[noreturn]] void refuse(const std::string& problem,
                           const std::string& remedy = "export the file again") const {
    throw Error(ErrorKind::input, Place{file_}, problem, remedy);
  }

  void load_model(std::string_view bytes, const std::filesystem::path& folder) {
    if (bytes.size() > std::numeric_limits<unsigned>::max())
      refuse("the file is larger than 4 GiB", "split it");
    tinygltf::TinyGLTF loader;
    loader.SetImageLoader(skip_image, nullptr);
    std::string base = folder.string();
    loader.SetFsCallbacks(
        {file_exists, same_path, read_other_file, write_nothing, folder.empty() ? nullptr : &base});
    std::string problem, warning;
    bool loaded = false;
    try {
      loaded = bytes.starts_with("glTF")
                   ? loader.LoadBinaryFromMemory(&model_, &problem, &warning,
                                                 reinterpret_cast<const unsigned char*>(bytes.data()),
                                                 static_cast<unsigned>(bytes.size()), base)
                   : loader.LoadASCIIFromString(&model_, &problem, &warning, bytes.data(),
                                                static_cast<unsigned>(bytes.size()), base);
    } catch (const std::exception& exception) {
      problem = exception.what();
    }
    if (!loaded) {
      std::replace(problem.begin(), problem.end(), '\n', ' ');
      refuse("this is not a valid glTF file: " + problem.substr(0, 200),
             "export it as glTF 2.0 again, best as one .glb file");
    }
    for (const std::string& extension : model_.extensionsRequired)
      if (extension.find("compression") != extension.npos)
        refuse("the mesh is stored with " + extension, "export it without compression");
  }

  bool is_child(int node) const {
    return std::any_of(model_.nodes.begin(), model_.nodes.end(), [&](const tinygltf::Node& parent) {
      return std::find(parent.children.begin(), parent.children.end(), node) != parent.children.end();
    });
  }

  static Eigen::Matrix4d transform_of(const tinygltf::Node& node) {
    if (node.matrix.size() == 16) return Eigen::Map<const Eigen::Matrix4d>(node.matrix.data());
    Eigen::Affine3d transform = Eigen::Affine3d::Identity();
    if (node.translation.size() == 3) transform.translate(Eigen::Map<const Vec3>(node.translation.data()));
    if (node.rotation.size() == 4) {
      const Eigen::Quaterniond rotation(Eigen::Map<const Eigen::Vector4d>(node.rotation.data()));
      transform.rotate(rotation.normalized());
    }
    if (node.scale.size() == 3) transform.scale(Vec3(Eigen::Map<const Vec3>(node.scale.data())));
    return transform.matrix();
  }

  // The tree is traversed with an explicit stack: a malicious file can be as deep as it is long.
  void visit(int root) {
    std::vector<std::pair<int, Eigen::Matrix4d>> pending{{root, Eigen::Matrix4d::Identity()}};
    while (!pending.empty()) {
      const auto [index, parent] = pending.back();
      pending.pop_back();
      if (index < 0 || static_cast<std::size_t>(index) >= model_.nodes.size())
        refuse("a node does not exist");
      if (visited_[static_cast<std::size_t>(index)])
        refuse("node " + std::to_string(index) + " has two parents");
      visited_[static_cast<std::size_t>(index)] = true;
      const tinygltf::Node& node = model_.nodes[static_cast<std::size_t>(index)];
      const Eigen::Matrix4d transform = parent * transform_of(node);
      if (node.mesh >= 0) mesh(node, transform);
      for (auto child = node.children.rbegin(); child != node.children.rend(); ++child)
        pending.push_back({*child, transform});
    }
  }

  void mesh(const tinygltf::Node& node, const Eigen::Matrix4d& transform) {
    if (static_cast<std::size_t>(node.mesh) >= model_.meshes.size()) refuse("a mesh does not exist");
    const tinygltf::Mesh& mesh = model_.meshes[static_cast<std::size_t>(node.mesh)];
    out_.begin_node(node.name.empty() ? mesh.name : node.name, transform);
    for (const tinygltf::Primitive& part : mesh.primitives) primitive(part);
  }

  void primitive(const tinygltf::Primitive& part) {
    const bool triangles = part.mode == TINYGLTF_MODE_TRIANGLES || part.mode == -1,
               strip = part.mode == TINYGLTF_MODE_TRIANGLE_STRIP,
               fan = part.mode == TINYGLTF_MODE_TRIANGLE_FAN;
    const auto found = part.attributes.find("POSITION");
    if (!(triangles || strip || fan) || found == part.attributes.end()) {
      ++skipped_;
      return;
    }
    const Numbers positions = numbers(found->second, 3);
    Numbers uvs;
    if (const auto uv = part.attributes.find("TEXCOORD_0"); uv != part.attributes.end()) {
      uvs = numbers(uv->second, 2);
      if (uvs.count != positions.count) refuse("texture coordinates and positions differ in number");
    }
    Numbers indices;
    if (part.indices >= 0) indices = numbers(part.indices, 1);
    const std::size_t corners = part.indices >= 0 ? indices.count : positions.count;
    const auto index = [&](std::size_t corner) {
      if (part.indices < 0) return corner;
      const double value = indices.at(corner, 0);
      if (!(value >= 0 && value < static_cast<double>(positions.count)) || value != std::floor(value))
        refuse("a face uses vertex " + std::to_string(value) + ", but there are " +
               std::to_string(positions.count));
      return static_cast<std::size_t>(value);
    };
    const bool named =
        part.material >= 0 && static_cast<std::size_t>(part.material) < model_.materials.size();
    out_.begin_part(positions.count, uvs.count,
                    named ? model_.materials[static_cast<std::size_t>(part.material)].name : "");
    for (std::size_t v = 0; v < positions.count; ++v)
      out_.position({positions.at(v, 0), positions.at(v, 1), positions.at(v, 2)});
    for (std::size_t v = 0; v < uvs.count; ++v)
      out_.uv({uvs.at(v, 0), 1 - uvs.at(v, 1)});  // v counts down in glTF
    for (const auto& [name, accessor] : part.attributes)
      if (name == "COLOR_0" || name.starts_with('_')) attribute(name, accessor, positions.count);
    for (std::size_t c = 2; c < corners; c += triangles ? 3 : 1) {
      std::size_t a = fan ? 0 : c - 2, b = c - 1;
      if (strip && c % 2 == 1) std::swap(a, b);
      out_.face(std::array{index(a), index(b), index(c)});
    }
  }

  // Vectors and colours become one attribute for each component. What is stored sparsely, or has no data or
  // matrices, is left out: the mesh is usable without.
  void attribute(const std::string& name, int accessor_index, std::size_t count) {
    if (accessor_index < 0 || static_cast<std::size_t>(accessor_index) >= model_.accessors.size())
      refuse("an accessor does not exist");
    const tinygltf::Accessor& accessor = model_.accessors[static_cast<std::size_t>(accessor_index)];
    const std::size_t components = accessor.type == TINYGLTF_TYPE_SCALAR ? 1
                                   : accessor.type == TINYGLTF_TYPE_VEC2 ? 2
                                   : accessor.type == TINYGLTF_TYPE_VEC3 ? 3
                                   : accessor.type == TINYGLTF_TYPE_VEC4 ? 4
                                                                         : 0;
    if (components == 0 || accessor.sparse.isSparse || accessor.bufferView < 0) return;
    const Numbers all = numbers(accessor_index, components);
    if (all.count != count)
      refuse("the attribute " + name + " has " + std::to_string(all.count) + " values for " +
             std::to_string(count) + " positions");
    constexpr std::array colours = {"red", "green", "blue", "alpha"};
    constexpr std::array axes = {".x", ".y", ".z", ".w"};
    std::vector<double> values(count);
    for (std::size_t c = 0; c < components; ++c) {
      for (std::size_t v = 0; v < count; ++v) values[v] = all.at(v, c);
      out_.attribute(name == "COLOR_0" ? colours[c] : components == 1 ? name : name + axes[c], values);
    }
  }

  // Everything tinygltf leaves to its caller: that the accessor lies inside its buffer.
  Numbers numbers(int accessor_index, std::size_t components) const {
    if (accessor_index < 0 || static_cast<std::size_t>(accessor_index) >= model_.accessors.size())
      refuse("an accessor does not exist");
    const tinygltf::Accessor& accessor = model_.accessors[static_cast<std::size_t>(accessor_index)];
    if (accessor.sparse.isSparse) refuse("the mesh uses sparse accessors", "export it without them");
    if (accessor.bufferView < 0 || static_cast<std::size_t>(accessor.bufferView) >= model_.bufferViews.size())
      refuse("an accessor has no data");
    const tinygltf::BufferView& view = model_.bufferViews[static_cast<std::size_t>(accessor.bufferView)];
    if (view.buffer < 0 || static_cast<std::size_t>(view.buffer) >= model_.buffers.size())
      refuse("a buffer does not exist");
    const std::vector<unsigned char>& data = model_.buffers[static_cast<std::size_t>(view.buffer)].data;
    Numbers result;
    switch (accessor.componentType) {
      case TINYGLTF_COMPONENT_TYPE_BYTE:
        result.type = Scalar::int8;
        break;
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        result.type = Scalar::uint8;
        break;
      case TINYGLTF_COMPONENT_TYPE_SHORT:
        result.type = Scalar::int16;
        break;
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        result.type = Scalar::uint16;
        break;
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        result.type = Scalar::uint32;
        break;
      case TINYGLTF_COMPONENT_TYPE_FLOAT:
        result.type = Scalar::float32;
        break;
      default:
        refuse("an accessor has an unknown type");
    }
    const int wanted = components == 1   ? TINYGLTF_TYPE_SCALAR
                       : components == 2 ? TINYGLTF_TYPE_VEC2
                       : components == 3 ? TINYGLTF_TYPE_VEC3
                                         : TINYGLTF_TYPE_VEC4;
    if (accessor.type != wanted) refuse("an accessor has the wrong type for its use");
    result.components = components;
    result.normalized = accessor.normalized;
    result.count = accessor.count;
    const std::size_t element = components * size_of(result.type);
    result.stride = view.byteStride == 0 ? element : view.byteStride;
    if (result.stride < element) refuse("a buffer view has too small a stride");
    const std::size_t size = data.size();
    const bool inside =
        view.byteOffset <= size && view.byteLength <= size - view.byteOffset &&
        accessor.byteOffset <= view.byteLength &&
        (result.count == 0 ||
         (element <= view.byteLength - accessor.byteOffset &&
          (result.count - 1) <= (view.byteLength - accessor.byteOffset - element) / result.stride));
    if (!inside)
      refuse("an accessor reaches beyond its buffer", "the file is damaged or cut off: export it again");
    result.data = reinterpret_cast<const char*>(data.data()) + view.byteOffset + accessor.byteOffset;
    return result;
  }

  std::string file_;
  NodeMesh out_;
  tinygltf::Model model_;
  std::vector<bool> visited_;
  std::size_t skipped_ = 0;
};

}  // namespace

MeshFile read_gltf(std::string_view bytes, const std::string& file, const std::filesystem::path& folder) {
  return GltfReader(file).read(bytes, folder);
}

}  // namespace muslin
