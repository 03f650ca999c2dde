#include "muslin/io/ply_reader.hpp"

#include <cmath>
#include <limits>
#include <optional>

#include "muslin/geometry/inspect.hpp"
#include "muslin/io/binary_reader.hpp"
#include "muslin/io/text_scanner.hpp"

namespace muslin {
namespace {

enum class Role { none, x, y, z, u, v, corners, corner_uvs };

struct Property {
  std::optional<Scalar> count;  // of a list
  Scalar type{};
  Role role = Role::none;
  int attribute = -1;  // of a vertex
};

struct Element {
  std::string name;
  std::size_t count = 0;
  std::vector<Property> properties;

  /// The fewest bytes one of its entries can take.
  std::size_t least_size(bool ascii) const {
    std::size_t size = 0;
    for (const Property& property : properties)
      size += ascii ? 1 : size_of(property.count ? *property.count : property.type);
    return size;
  }
};

enum class Format { ascii, little_endian, big_endian };

std::optional<Scalar> scalar_named(std::string_view name) {
  if (name == "char" || name == "int8") return Scalar::int8;
  if (name == "uchar" || name == "uint8") return Scalar::uint8;
  if (name == "short" || name == "int16") return Scalar::int16;
  if (name == "ushort" || name == "uint16") return Scalar::uint16;
  if (name == "int" || name == "int32") return Scalar::int32;
  if (name == "uint" || name == "uint32") return Scalar::uint32;
  if (name == "float" || name == "float32") return Scalar::float32;
  if (name == "double" || name == "float64") return Scalar::float64;
  return std::nullopt;
}

Role role_of(std::string_view element, std::string_view name, bool list) {
  if (element == "vertex" && !list) {
    if (name == "x") return Role::x;
    if (name == "y") return Role::y;
    if (name == "z") return Role::z;
    if (name == "s" || name == "u" || name == "texture_u") return Role::u;
    if (name == "t" || name == "v" || name == "texture_v") return Role::v;
  }
  if (element == "tristrips" && list && (name == "vertex_indices" || name == "vertex_index"))
    return Role::corners;
  if (element == "face" && list) {
    if (name == "vertex_indices" || name == "vertex_index") return Role::corners;
    if (name == "texcoord") return Role::corner_uvs;
  }
  return Role::none;
}

bool has_role(const Element& element, Role role) {
  for (const Property& property : element.properties)
    if (property.role == role) return true;
  return false;
}

class PlyReader {
 public:
  PlyReader(std::string_view bytes, const std::string& file)
      : bytes_(bytes), file_(file), scanner_(bytes, file, TextScanner::Syntax::plain) {}

  MeshFile read() {
    header();
    for (const Element& element : elements_) {
      const std::size_t least = element.least_size(format_ == Format::ascii);
      if (least == 0) continue;  // empty entries, in any number
      if (element.count > (bytes_.size() - at_) / least)
        refuse("there are too few bytes for " + std::to_string(element.count) + " entries of '" +
               element.name + "'");
      if (element.name == "vertex" && has_role(element, Role::x)) mesh_.positions.reserve(element.count);
      if (element.name == "face") mesh_.face_offsets.reserve(element.count + 1);
      for (std::size_t entry = 0; entry < element.count; ++entry) {
        entry_ = entry;
        read_entry(element);
      }
    }
    check_indices();
    if (!vertex_uvs_.empty() && mesh_.uvs.empty()) {
      mesh_.uvs = std::move(vertex_uvs_);
      mesh_.corner_uvs = mesh_.face_vertices;
    }
    return {std::move(mesh_), "", std::move(attributes_)};
  }

 private:
  void header() {
    if (scanner_.next_word() != "ply")
      scanner_.fail({}, "this is not a PLY file: it does not begin with 'ply'",
                    "give the file the suffix of its real format, or export it as PLY");
    bool has_format = false;
    for (;;) {
      const std::string_view keyword = scanner_.next_word();
      if (keyword == "format") {
        const std::string_view name = scanner_.word();
        if (name == "ascii")
          format_ = Format::ascii;
        else if (name == "binary_little_endian")
          format_ = Format::little_endian;
        else if (name == "binary_big_endian")
          format_ = Format::big_endian;
        else
          scanner_.fail(name, "unknown PLY format", "export the file as ASCII or binary PLY 1.0");
        has_format = true;
      } else if (keyword == "element") {
        const std::string_view name = scanner_.word(), word = scanner_.word();
        const std::int64_t count = scanner_.integer(word, "the number of entries");
        if (count < 0 || count > std::numeric_limits<int>::max() - 1)
          scanner_.fail(word, "impossible number of entries", "the file is damaged: export it again");
        if (elements_.size() == 64)
          scanner_.fail(word, "too many elements", "the file is damaged: export it again");
        elements_.push_back({std::string(name), static_cast<std::size_t>(count), {}});
      } else if (keyword == "property") {
        property();
      } else if (keyword == "end_header") {
        break;
      } else if (keyword.empty()) {
        scanner_.fail({}, "the header has no end", "the file is cut off: export it again");
      } else if (keyword != "comment" && keyword != "obj_info") {
        scanner_.fail(keyword, "unknown word in the header", "the file is damaged: export it again");
      }
      scanner_.rest_of_line();
    }
    if (!has_format) scanner_.fail({}, "the header names no format", "export the file again");
    scanner_.rest_of_line();
    scanner_.next_line();
    at_ = scanner_.offset();
    for (const Element& element : elements_)
      if (element.name == "vertex" &&
          !(has_role(element, Role::x) && has_role(element, Role::y) && has_role(element, Role::z)))
        refuse("the vertices have no x, y and z");
  }

  void property() {
    if (elements_.empty())
      scanner_.fail({}, "a property belongs to no element", "the file is damaged: export it again");
    const auto type = [&](std::string_view word) {
      const auto scalar = scalar_named(word);
      if (!scalar) scanner_.fail(word, "unknown type of a property", "export the file again");
      return *scalar;
    };
    Element& element = elements_.back();
    Property property;
    std::string_view word = scanner_.word();
    if (word == "list") {
      word = scanner_.word();
      property.count = type(word);
      if (*property.count == Scalar::float32 || *property.count == Scalar::float64)
        scanner_.fail(word, "the length of a list is not a whole number", "export the file again");
      word = scanner_.word();
    }
    property.type = type(word);
    const std::string_view name = scanner_.word();
    property.role = role_of(element.name, name, property.count.has_value());
    if (property.role == Role::none && element.name == "vertex" && !property.count) {
      property.attribute = static_cast<int>(attributes_.size());
      attributes_.push_back({std::string(name), {}});
    }
    if (property.role != Role::none && has_role(element, property.role)) property.role = Role::none;
    element.properties.push_back(property);
    if (element.properties.size() > 1024) scanner_.fail(word, "too many properties", "export the file again");
  }

  double number(Scalar type) {
    if (format_ == Format::ascii) {
      word_ = scanner_.next_word();
      if (word_ == "nan" || word_ == "-nan") return std::numeric_limits<double>::quiet_NaN();
      return scanner_.number(word_, "a value");
    }
    const std::size_t size = size_of(type);
    if (bytes_.size() - at_ < size) refuse("the file ends too early");
    const double value = load_number(bytes_.data() + at_, type, format_ == Format::big_endian);
    at_ += size;
    return value;
  }

  void read_entry(const Element& element) {
    Vec3 position = Vec3::Zero();
    Vec2 uv = Vec2::Zero();
    for (const Property& property : element.properties) {
      if (property.count) {
        list(property);
        continue;
      }
      const double value = number(property.type);
      if (property.attribute >= 0)
        attributes_[static_cast<std::size_t>(property.attribute)].values.push_back(
            property.type == Scalar::uint8 ? value / 255 : value);
      switch (property.role) {
        case Role::x:
          position.x() = value;
          break;
        case Role::y:
          position.y() = value;
          break;
        case Role::z:
          position.z() = value;
          break;
        case Role::u:
          uv.x() = value;
          break;
        case Role::v:
          uv.y() = value;
          break;
        default:
          break;
      }
    }
    if (element.name == "vertex") {
      if (!position.allFinite() || position.cwiseAbs().maxCoeff() > largest_coordinate)
        refuse_entry("vertex", "has a coordinate that is not a number or is beyond 1e9 m");
      mesh_.positions.push_back(position);
      if (has_uvs(element)) vertex_uvs_.push_back(checked(uv, "vertex"));
    } else if (element.name == "face") {
      face();
    } else if (element.name == "tristrips") {
      strips();
    }
  }

  /// Strips of triangles one after the other, with −1 between them: every corner after the second makes a
  /// triangle with the two before it, and every second triangle is turned.
  void strips() {
    const std::vector<double> strip = std::move(corners_);
    std::size_t begin = 0;
    for (std::size_t i = 0; i < strip.size(); ++i) {
      if (strip[i] == -1) begin = i + 1;
      if (strip[i] == -1 || i < begin + 2) continue;
      const double a = strip[i - 2], b = strip[i - 1], c = strip[i];
      if (a == b || b == c || c == a) continue;  // joins two strips
      const bool turned = (i - begin) % 2 != 0;
      corners_ = {turned ? b : a, turned ? a : b, c};
      face();
    }
    corners_.clear();
  }

  static bool has_uvs(const Element& element) {
    return has_role(element, Role::u) && has_role(element, Role::v);
  }

  Vec2 checked(const Vec2& uv, const char* what) const {
    if (!uv.allFinite()) refuse_entry(what, "has a texture coordinate that is not a number");
    return uv;
  }

  void list(const Property& property) {
    const double count = number(*property.count);
    const std::size_t least = format_ == Format::ascii ? 2 : size_of(property.type);
    const std::size_t left = bytes_.size() - (format_ == Format::ascii ? scanner_.offset() : at_);
    const std::size_t most = (left + 1) / least;
    if (!(count >= 0) || count != std::floor(count) || count > static_cast<double>(most))
      refuse_entry("entry", "has a list of impossible length");
    std::vector<double>* values = property.role == Role::corners      ? &corners_
                                  : property.role == Role::corner_uvs ? &corner_uvs_
                                                                      : nullptr;
    if (values) values->clear();
    for (double i = 0; i < count; ++i) {
      const double value = number(property.type);
      if (values) values->push_back(value);
    }
  }

  void face() {
    if (corners_.size() < 3) refuse_entry("face", "has fewer than three corners");
    if (mesh_.face_offsets.empty()) mesh_.face_offsets.push_back(0);
    if (mesh_.face_vertices.size() + corners_.size() >
        static_cast<std::size_t>(std::numeric_limits<int>::max() - 1))
      refuse("the mesh is too large");
    for (const double corner : corners_) {
      if (!(corner >= 0) || corner > std::numeric_limits<int>::max() - 1 || corner != std::floor(corner))
        refuse_entry("face", "uses an impossible vertex");
      mesh_.face_vertices.push_back(static_cast<int>(corner));
      largest_ = std::max(largest_, static_cast<int>(corner));
    }
    mesh_.face_offsets.push_back(static_cast<int>(mesh_.face_vertices.size()));
    if (corner_uvs_.size() == 2 * corners_.size()) {
      mesh_.corner_uvs.resize(mesh_.face_vertices.size() - corners_.size(), -1);
      for (std::size_t c = 0; c < corners_.size(); ++c) {
        mesh_.corner_uvs.push_back(static_cast<int>(mesh_.uvs.size()));
        mesh_.uvs.push_back(checked({corner_uvs_[2 * c], corner_uvs_[2 * c + 1]}, "face"));
      }
    } else if (!mesh_.corner_uvs.empty()) {
      mesh_.corner_uvs.resize(mesh_.face_vertices.size(), -1);
    }
    corners_.clear();
    corner_uvs_.clear();
  }

  // Faces may come before the vertices, so this waits for the end.
  void check_indices() const {
    const auto count = static_cast<int>(mesh_.positions.size());
    if (largest_ < count) return;
    std::size_t f = 0, c = 0;
    while (mesh_.face_vertices[c] < count) ++c;
    while (static_cast<std::size_t>(mesh_.face_offsets[f + 1]) <= c) ++f;
    refuse("face " + std::to_string(f + 1) + " uses vertex " + std::to_string(mesh_.face_vertices[c]) +
           " (counted from 0), but there are " + std::to_string(count));
  }

  [[noreturn]] void refuse_entry(const char* what, const std::string& problem) const {
    refuse(std::string(what) + " " + std::to_string(entry_ + 1) + " " + problem);
  }
  [[noreturn]] void refuse(const std::string& problem) const {
    throw Error(ErrorKind::input, Place{file_, format_ == Format::ascii ? scanner_.line() : 0}, problem,
                "the file is damaged or cut off: export it again");
  }

  std::string_view bytes_;
  std::string file_;
  TextScanner scanner_;
  Format format_ = Format::ascii;
  std::vector<Element> elements_;
  std::size_t at_ = 0;  // of binary data
  std::size_t entry_ = 0;
  std::string_view word_;
  std::vector<double> corners_, corner_uvs_;
  std::vector<Vec2> vertex_uvs_;
  std::vector<VertexAttribute> attributes_;
  int largest_ = -1;
  Mesh mesh_;
};

}  // namespace

MeshFile read_ply(std::string_view bytes, const std::string& file) { return PlyReader(bytes, file).read(); }

}  // namespace muslin
