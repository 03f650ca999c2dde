#include "muslin/component/select.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include <fmt/format.h>

#include "muslin/core/nearest_name.hpp"
#include "muslin/core/parallel.hpp"

namespace muslin {
namespace {

constexpr double tolerance = 1e-6;  // in voxel widths or mean edges
constexpr std::size_t grain = 8192;

double distance_to_segment(const Vec3& x, const Vec3& a, const Vec3& b) {
  const Vec3 along = b - a;
  const double t = std::clamp((x - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (x - a - t * along).norm();
}

/// A shape of `where`: how far a point lies outside of it [m], 0 or less inside.
struct ChosenShape {
  std::string name;
  std::function<double(const Vec3&)> outside;
};

std::vector<ChosenShape> shapes_of(const Selection& where, double spacing) {
  std::vector<ChosenShape> shapes;
  if (where.box) {
    const Box box(where.box->min, where.box->max);
    shapes.push_back({"box", [box](const Vec3& x) { return box.exteriorDistance(x); }});
  }
  if (where.sphere) {
    const auto sphere = *where.sphere;
    shapes.push_back(
        {"sphere", [sphere](const Vec3& x) { return (x - sphere.center).norm() - sphere.radius; }});
  }
  if (where.plane) {
    const auto plane = *where.plane;
    const double distance = plane.distance.value_or(spacing / 2);
    shapes.push_back({"plane", [plane, distance](const Vec3& x) {
                        return std::abs((x - plane.point).dot(plane.normal)) - distance;
                      }});
  }
  if (where.line) {
    const auto line = *where.line;
    const double distance = line.distance.value_or(0.75 * spacing);
    shapes.push_back({"line", [line, distance](const Vec3& x) {
                        return distance_to_segment(x, line.a, line.b) - distance;
                      }});
  }
  return shapes;
}

const MeshGroup& find_group(const Component& body, const Selection& where, const std::string& what) {
  std::vector<std::string> names;
  for (const MeshGroup& group : body.mesh.groups) {
    if (group.name == *where.group) return group;
    names.push_back(group.name);
  }
  if (names.empty()) {
    throw Error(ErrorKind::input, where.place,
                fmt::format("{}: the mesh of body `{}` has no groups", what, body.name),
                "select by box, sphere, plane, line or nearest");
  }
  throw Error(ErrorKind::input, where.place,
              fmt::format("{}: the mesh of body `{}` has no group `{}`", what, body.name, *where.group),
              name_advice(*where.group, names));
}

class Selector {
 public:
  Selector(const Component& body, const Selection& where, const std::string& what)
      : body_(body),
        where_(where),
        what_(what),
        shapes_(shapes_of(where, body.spacing())),
        slack_(tolerance * body.spacing()),
        kept_(body.selectable_count(), 1) {}

  std::vector<int> select() {
    if (where_.group) keep_group();
    const std::vector<std::uint8_t> of_group = kept_;
    parallel_for(kept_.size(), grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) {
        const Vec3 x = position(v);
        for (const ChosenShape& shape : shapes_) kept_[v] &= shape.outside(x) <= slack_;
      }
    });
    if (std::find(kept_.begin(), kept_.end(), 1) == kept_.end()) fail(of_group);
    if (!where_.nearest.empty()) keep_nearest();
    std::vector<int> vertices;
    for (std::size_t v = 0; v < kept_.size(); ++v) {
      if (kept_[v]) vertices.push_back(static_cast<int>(v));
    }
    return vertices;
  }

 private:
  Vec3 position(std::size_t v) const { return body_.selectable(v); }

  void keep_group() {
    const MeshGroup& group = find_group(body_, where_, what_);
    kept_ = body_.in_group(group);
    if (std::find(kept_.begin(), kept_.end(), 1) == kept_.end()) refuse_empty(group);
  }

  [[noreturn]] void refuse_empty(const MeshGroup& group) const {
    throw Error(ErrorKind::input, where_.place, fmt::format("{}: the group `{}` is empty", what_, group.name),
                "fill the group in the modeller or select by a shape");
  }

  void keep_nearest() {
    std::vector<std::uint8_t> near(kept_.size(), 0);
    for (const Vec3& point : where_.nearest) {
      const double least = least_over(kept_, [&](const Vec3& x) { return (x - point).norm(); }).distance;
      for (std::size_t v = 0; v < kept_.size(); ++v) {
        if (kept_[v] && (position(v) - point).norm() <= least + slack_) near[v] = 1;
      }
    }
    kept_ = std::move(near);
  }

  struct Least {
    double distance = std::numeric_limits<double>::infinity();
    std::size_t vertex = 0;
    Least operator+(const Least& other) const { return other.distance < distance ? other : *this; }
  };
  template <class Distance>
  Least least_over(const std::vector<std::uint8_t>& among, const Distance& distance) const {
    return parallel_sum(among.size(), grain, Least{}, [&](std::size_t begin, std::size_t end) {
      Least least;
      for (std::size_t v = begin; v < end; ++v) {
        if (among[v]) least = least + Least{distance(position(v)), v};
      }
      return least;
    });
  }

  [[noreturn]] void fail(const std::vector<std::uint8_t>& among) const {
    const Least least = least_over(among, [&](const Vec3& x) {
      double worst = 0;
      for (const ChosenShape& shape : shapes_) worst = std::max(worst, shape.outside(x));
      return worst;
    });
    std::string names;
    for (const ChosenShape& shape : shapes_) names += (names.empty() ? "`" : " and `") + shape.name + "`";
    const Vec3 x = position(least.vertex);
    throw Error(ErrorKind::input, where_.place,
                fmt::format("{}: no vertex of body `{}` lies within {}", what_, body_.name, names),
                fmt::format("the nearest is [{:.6g}, {:.6g}, {:.6g}], {:.3g} m outside", x.x(), x.y(), x.z(),
                            least.distance));
  }

  const Component& body_;
  const Selection& where_;
  const std::string& what_;
  std::vector<ChosenShape> shapes_;
  double slack_;
  std::vector<std::uint8_t> kept_;
};

}  // namespace

std::vector<int> select_vertices(const Component& body, const Selection& where, const std::string& what) {
  return Selector(body, where, what).select();
}

}  // namespace muslin
