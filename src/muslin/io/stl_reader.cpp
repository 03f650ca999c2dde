#include "muslin/io/stl_reader.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <string>

#include "muslin/geometry/inspect.hpp"
#include "muslin/io/binary_reader.hpp"
#include "muslin/io/groups.hpp"
#include "muslin/io/text_scanner.hpp"
#include "muslin/io/weld.hpp"

namespace muslin {
namespace {

constexpr std::size_t header_size = 84, triangle_size = 50;

std::string weld_note(const Mesh& mesh) {
  return "STL stores triangles apart: " + std::to_string(mesh.face_vertices.size()) +
         " corners were welded by position into " + std::to_string(mesh.positions.size()) + " vertices.";
}

MeshFile read_binary(std::string_view bytes, std::size_t triangles, const std::string& file) {
  Mesh mesh;
  Welder welder(mesh.positions);
  for (std::size_t t = 0; t < triangles; ++t) {
    const char* at = bytes.data() + header_size + t * triangle_size + 12;
    std::array<int, 3> face{};
    for (int& corner : face) {
      Vec3 position;
      for (int axis = 0; axis < 3; ++axis, at += 4)
        position[axis] = static_cast<double>(load<float>(at, false));
      if (!position.allFinite() || position.cwiseAbs().maxCoeff() > largest_coordinate)
        throw Error(
            ErrorKind::input, Place{file},
            "triangle " + std::to_string(t + 1) + " has a coordinate that is not a number or is beyond 1e9 m",
            "the file is damaged: export it again");
      corner = welder.vertex(position);
    }
    mesh.add_face(face);
  }
  std::string note = weld_note(mesh);
  return {std::move(mesh), std::move(note)};
}

std::string lowered(std::string_view word) {
  std::string text(word);
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// Programs write keywords in any case, and the closing ones in one word or two.
class AsciiStl {
 public:
  AsciiStl(std::string_view text, const std::string& file)
      : scanner_(text, file, TextScanner::Syntax::plain), welder_(mesh_.positions) {}

  MeshFile read() {
    expect("solid");
    do {
      solid();
    } while (keyword() == "solid");
    if (mesh_.groups.size() == 1) {
      mesh_.name = mesh_.groups[0].name;
      mesh_.groups.clear();
    }
    for (MeshGroup& group : mesh_.groups) {
      group.name = one_word(group.name);
      complete_group(mesh_, group);
    }
    std::string note = weld_note(mesh_);
    return {std::move(mesh_), std::move(note)};
  }

 private:
  /// Reads the next keyword, in lower case; the two words "end solid" are one.
  std::string keyword() {
    word_ = scanner_.next_word();
    const std::string word = lowered(word_);
    return word == "end" ? word + lowered(scanner_.next_word()) : word;
  }

  void expect(std::string_view wanted) { check(keyword(), wanted); }

  void check(const std::string& found, std::string_view wanted) const {
    if (found != wanted)
      scanner_.fail(word_, "expected '" + std::string(wanted) + "' of an ASCII STL file",
                    word_.empty() ? "the file is cut off: export it again"
                                  : "the file is damaged or of another format: export it again");
  }

  void solid() {
    mesh_.groups.push_back({std::string(scanner_.rest_of_line()), {}, {}});
    for (std::string word = keyword(); word != "endsolid"; word = keyword()) {
      check(word, "facet");
      facet();
    }
    scanner_.rest_of_line();
  }

  void facet() {
    expect("normal");
    for (int axis = 0; axis < 3; ++axis) scanner_.next_word();  // unused, and often not a number
    expect("outer");
    expect("loop");
    std::vector<int> face;
    for (std::string word = keyword(); word != "endloop"; word = keyword()) {
      check(word, "vertex");
      Vec3 position;
      for (int axis = 0; axis < 3; ++axis) position[axis] = scanner_.coordinate(scanner_.next_word());
      face.push_back(welder_.vertex(position));
    }
    if (face.size() < 3)
      scanner_.fail(word_, "a facet has fewer than three vertices", "the file is damaged: export it again");
    expect("endfacet");
    mesh_.groups.back().faces.push_back(static_cast<int>(mesh_.face_count()));
    mesh_.add_face(face);
  }

  TextScanner scanner_;
  std::string_view word_;  ///< the last one that was read as a keyword
  Mesh mesh_;
  Welder welder_;
};

}  // namespace

MeshFile read_stl(std::string_view bytes, const std::string& file) {
  // A binary file may begin with "solid" too; its length gives it away.
  const bool has_count = bytes.size() >= header_size;
  const std::size_t triangles = has_count ? load<std::uint32_t>(bytes.data() + 80, false) : 0;
  const std::size_t size = header_size + triangles * triangle_size;
  if (has_count && bytes.size() == size) return read_binary(bytes, triangles, file);
  const std::size_t first = bytes.find_first_not_of(" \t\r\n");
  if (first != bytes.npos && lowered(bytes.substr(first, 5)) == "solid") return AsciiStl(bytes, file).read();
  if (has_count && bytes.size() > size && triangles > 0) return read_binary(bytes, triangles, file);
  throw Error(ErrorKind::input, Place{file},
              has_count ? "the file should hold " + std::to_string(triangles) + " triangles in " +
                              std::to_string(size) + " bytes, but has " + std::to_string(bytes.size())
                        : "the file is too short for STL",
              "it is cut off or of another format: export it again");
}

}  // namespace muslin
