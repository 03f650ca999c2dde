#include "muslin/fit/outline.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include <fmt/format.h>

#include "muslin/core/error.hpp"
#include "muslin/fit/points_file.hpp"

namespace muslin {
namespace {

// The outline's centre of area stands for that of the support, which a photograph does not show.
constexpr double most_beyond = 1.02;  // farthest point, in radii of the specimen
constexpr double most_within = 0.95;  // nearest point, in radii of the support

double twice_area(const Vec2& a, const Vec2& b, const Vec2& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

bool in_box(const Vec2& p, const Vec2& a, const Vec2& b) {
  return std::min(a[0], b[0]) <= p[0] && p[0] <= std::max(a[0], b[0]) && std::min(a[1], b[1]) <= p[1] &&
         p[1] <= std::max(a[1], b[1]);
}

/// True if two line segments have a point in common.
bool meet(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const double ac = twice_area(c, d, a), bd = twice_area(c, d, b), ca = twice_area(a, b, c),
               db = twice_area(a, b, d);
  if (((ac > 0 && bd < 0) || (ac < 0 && bd > 0)) && ((ca > 0 && db < 0) || (ca < 0 && db > 0))) return true;
  return (ac == 0 && in_box(a, c, d)) || (bd == 0 && in_box(b, c, d)) || (ca == 0 && in_box(c, a, b)) ||
         (db == 0 && in_box(d, a, b));
}

/// A closed polygon without points that repeat the one before.
class Outline {
 public:
  explicit Outline(const std::filesystem::path& file) : file_(file), rows_(read_points(file)) {
    rows_.erase(std::unique(rows_.begin(), rows_.end(),
                            [](const PointRow& a, const PointRow& b) { return a.point == b.point; }),
                rows_.end());
    if (rows_.size() > 1 && rows_.back().point == rows_.front().point) rows_.pop_back();
    if (rows_.size() < 3)
      throw Error(ErrorKind::input, place(0), "an outline needs three points or more",
                  "list the points around the shadow");
  }

  /// Sides are taken by their least x, and compared with those that begin before they end.
  void require_simple() const {
    const std::size_t n = rows_.size();
    std::vector<std::size_t> sides(n);
    for (std::size_t i = 0; i < n; ++i) sides[i] = i;
    const auto least = [&](std::size_t i) { return std::min(at(i)[0], at(i + 1)[0]); };
    std::sort(sides.begin(), sides.end(), [&](std::size_t a, std::size_t b) {
      return least(a) != least(b) ? least(a) < least(b) : a < b;
    });
    for (std::size_t k = 0; k < n; ++k) {
      const double end = std::max(at(sides[k])[0], at(sides[k] + 1)[0]);
      for (std::size_t l = k + 1; l < n && least(sides[l]) <= end; ++l) {
        const auto [i, j] = std::minmax(sides[k], sides[l]);
        if (j - i == 1 || j - i == n - 1) continue;
        if (meet(at(i), at(i + 1), at(j), at(j + 1)))
          throw Error(ErrorKind::input, place(j),
                      fmt::format("the outline meets itself: its side from here meets that from line {}",
                                  rows_[i].line),
                      "list the points in order, once around the shadow");
      }
    }
  }

  double area() const {
    double twice = 0;
    for (std::size_t i = 0; i < rows_.size(); ++i) twice += twice_area(at(0), at(i), at(i + 1));
    return std::abs(twice) / 2;
  }

  /// Checks the distances of the points from the centre, in units of the file.
  void require_within(double specimen_radius, double support_radius) const {
    const Vec2 middle = centre();
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const double radius = (at(i) - middle).norm();
      if (radius > most_beyond * specimen_radius)
        throw Error(
            ErrorKind::input, place(i),
            fmt::format("the outline leaves the specimen: the point is {:.4g} from the outline's centre, "
                        "the specimen's edge {:.4g}",
                        radius, specimen_radius),
            "take out points that are not of the shadow, or correct `specimen_diameter`");
      if (radius < most_within * support_radius)
        throw Error(ErrorKind::input, place(i),
                    fmt::format("the outline runs over the support: the point is {:.4g} from the outline's "
                                "centre, the support's edge {:.4g}",
                                radius, support_radius),
                    "take out points that are not of the shadow, or correct `support_diameter`");
    }
  }

 private:
  const Vec2& at(std::size_t i) const { return rows_[i % rows_.size()].point; }
  Place place(std::size_t i) const { return {file_.string(), rows_.empty() ? 0 : rows_[i].line, 0}; }

  Vec2 centre() const {
    Vec2 sum = Vec2::Zero();
    double twice = 0;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const double part = twice_area(at(0), at(i), at(i + 1));
      sum += part * (at(0) + at(i) + at(i + 1)) / 3;
      twice += part;
    }
    return sum / twice;
  }

  std::filesystem::path file_;
  std::vector<PointRow> rows_;
};

}  // namespace

double outline_coefficient(const std::filesystem::path& file, double unit, const DrapeTest& test) {
  const Outline outline(file);
  outline.require_simple();
  const double disc = test.support_diameter * test.support_diameter,
               whole = test.specimen_diameter * test.specimen_diameter;
  const double area = outline.area() * unit * unit;
  const double share = (area * 4 / std::numbers::pi - disc) / (whole - disc);
  if (share <= 0 || share > 1)
    throw Error(
        ErrorKind::input, Place{file.string(), 0, 0},
        fmt::format("the outline's area of {:.4g} m² is not between those of support and specimen", area),
        "check `outline_unit`, and list the points in order around the shadow");
  outline.require_within(test.specimen_diameter / 2 / unit, test.support_diameter / 2 / unit);
  return share;
}

}  // namespace muslin
