// Tangled starts, small: sheets through sheets, a sleeve that reaches into an arm, a shirt inside a body.
#pragma once

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <unistd.h>

#include "muslin/hosts.hpp"

namespace muslin::test {

/// A folder of meshes, and the scene of them.
class TangledScene {
 public:
  TangledScene() {
    static int number = 0;
    folder_ = std::filesystem::path(testing::TempDir()) /
              ("tangled" + std::to_string(getpid()) + "_" + std::to_string(number++));
    std::filesystem::create_directories(folder_);
  }
  ~TangledScene() { std::filesystem::remove_all(folder_); }
  TangledScene(const TangledScene&) = delete;
  TangledScene& operator=(const TangledScene&) = delete;

  using Height = std::function<double(double x, double z)>;

  /// A sheet of `size` by `size` metres with `cells` by `cells` quads, turned upward.
  TangledScene& sheet(const std::string& name, double size, int cells, const Height& height,
                      const std::string& keys = "") {
    return sheet(name, size, cells, [&](double x, double z) { return Vec3(x, height(x, z), z); }, keys);
  }
  using Place = std::function<Vec3(double x, double z)>;
  TangledScene& sheet(const std::string& name, double size, int cells, const Place& place,
                      const std::string& keys = "") {
    std::ofstream file(folder_ / (name + ".obj"));
    for (int j = 0; j <= cells; ++j)
      for (int i = 0; i <= cells; ++i)
        write(file, place(size * (1.0 * i / cells - 0.5), size * (1.0 * j / cells - 0.5)));
    for (int j = 0; j < cells; ++j) {
      for (int i = 0; i < cells; ++i) {
        const int a = j * (cells + 1) + i + 1, b = a + cells + 1;
        file << "f " << a << ' ' << b << ' ' << b + 1 << ' ' << a + 1 << '\n';
      }
    }
    add_shell(name, keys);
    return *this;
  }

  /// A tube of radius r(angle, y) and length `length` about the y axis, turned outward; closed by caps if it
  /// is a collider.
  TangledScene& tube(const std::string& name, double length, int around, int along,
                     const std::function<double(double angle, double y)>& radius, bool collider,
                     const std::string& keys = "") {
    std::ofstream file(folder_ / (name + ".obj"));
    for (int j = 0; j <= along; ++j) {
      for (int i = 0; i < around; ++i) {
        const double angle = 2 * M_PI * i / around, y = length * (1.0 * j / along - 0.5);
        const double r = radius(angle, y);
        write(file, {r * std::cos(angle), y, r * std::sin(angle)});
      }
    }
    if (collider) {
      write(file, {0, -length / 2, 0});
      write(file, {0, length / 2, 0});
    }
    const auto at = [&](int i, int j) { return j * around + i % around + 1; };
    for (int j = 0; j < along; ++j)
      for (int i = 0; i < around; ++i)
        file << "f " << at(i, j) << ' ' << at(i, j + 1) << ' ' << at(i + 1, j + 1) << ' ' << at(i + 1, j)
             << '\n';
    const int low = around * (along + 1) + 1;
    for (int i = 0; collider && i < around; ++i) {
      file << "f " << low << ' ' << at(i, 0) << ' ' << at(i + 1, 0) << '\n';
      file << "f " << low + 1 << ' ' << at(i + 1, along) << ' ' << at(i, along) << '\n';
    }
    if (collider) {
      text_ +=
          "[[collider]]\nname = '" + name + "'\nshape = 'mesh'\nmesh = '" + name + ".obj'\n" + keys + "\n";
    } else {
      add_shell(name, keys);
    }
    return *this;
  }

  /// The material of the shells that follow.
  TangledScene& cloth(const std::string& material) {
    material_ = material;
    return *this;
  }

  TangledScene& add(const std::string& text) {
    text_ += text;
    return *this;
  }

  std::shared_ptr<const Model> build() const {
    return std::make_shared<const Model>(
        build_model(parse_scene(text_ + "[contact]\n", (folder_ / "scene.toml").string())));
  }
  std::shared_ptr<const Model> build(const std::string& contact) const {
    return std::make_shared<const Model>(
        build_model(parse_scene(text_ + "[contact]\n" + contact + "\n", (folder_ / "scene.toml").string())));
  }

 private:
  static void write(std::ofstream& file, const Vec3& v) {
    file.precision(17);
    file << "v " << v.x() << ' ' << v.y() << ' ' << v.z() << '\n';
  }
  void add_shell(const std::string& name, const std::string& keys) {
    text_ += "[[body]]\nname = '" + name + "'\nmesh = '" + name +
             ".obj'\nmodel = 'shell'\nwarp = [1, 0, 0]\nmaterial = " + material_ + "\n" + keys + "\n";
  }

  std::filesystem::path folder_;
  std::string text_;
  std::string material_ =
      "{ areal_density = 0.2, membrane_warp = 500, membrane_weft = 500, membrane_shear = 200, poisson = 0.2, "
      "bending_warp = 1e-5, bending_weft = 1e-5 }";
};

/// A dent of 12 mm in a height of 5 mm: its bottom is 7 mm under the plane.
inline double dent(double x, double z) {
  return 0.005 - 0.012 * std::exp(-(x * x + z * z) / (2 * 0.03 * 0.03));
}

/// A sleeve of 54 mm with a dent of 12 mm, about an arm of 50 mm.
inline double dented_sleeve(double angle, double y) {
  const double s = (angle - M_PI) * 0.054;
  return 0.054 - 0.012 * std::exp(-(s * s + y * y) / (2 * 0.02 * 0.02));
}

}  // namespace muslin::test
