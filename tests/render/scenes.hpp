// Small things to draw in the tests.
#pragma once

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <unistd.h>

#include "muslin/render/raytrace.hpp"

namespace muslin::testing {

/// A flat grid in the plane z = 0, facing +z, from the origin.
inline Mesh grid(int columns, int rows, double width, double height) {
  Mesh mesh;
  mesh.name = "grid";
  mesh.face_offsets = {0};
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) mesh.positions.emplace_back(width * i / columns, height * j / rows, 0);
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const int a = j * (columns + 1) + i;
      mesh.add_face(std::array{a, a + 1, a + columns + 2, a + columns + 1});
    }
  return mesh;
}

inline Mesh box(const Vec3& low, const Vec3& high) {
  Mesh mesh;
  mesh.name = "box";
  mesh.face_offsets = {0};
  for (int i = 0; i < 8; ++i)
    mesh.positions.emplace_back(i & 1 ? high.x() : low.x(), i & 2 ? high.y() : low.y(),
                                i & 4 ? high.z() : low.z());
  for (const auto& face : {std::array{0, 4, 6, 2}, std::array{1, 3, 7, 5}, std::array{0, 1, 5, 4},
                           std::array{2, 6, 7, 3}, std::array{0, 2, 3, 1}, std::array{4, 5, 7, 6}})
    mesh.add_face(face);
  return mesh;
}

/// Grey value 0…255 of a pixel.
inline double grey(const Image& image, int x, int y) {
  const auto* p = image.pixel(x, y);
  return (p[0] + p[1] + p[2]) / 3.0;
}

/// A fresh folder, removed at the end.
class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "muslin-render-XXXXXX").string();
    path_ = mkdtemp(name.data());
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

inline std::string read_text(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace muslin::testing
