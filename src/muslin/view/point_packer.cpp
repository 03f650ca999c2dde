#include "muslin/view/point_packer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace muslin {
namespace {

using Word = std::uint16_t;

constexpr double steps = 65535;

/// Folds in the sign, so that small differences of either sign have a high byte of zero.
Word folded(Word difference) {
  const auto value = static_cast<std::int16_t>(difference);
  return static_cast<Word>(static_cast<Word>(difference << 1) ^ static_cast<Word>(value < 0 ? 0xffff : 0));
}

}  // namespace

PointPacker::PointPacker(const Vec3& low, const Vec3& size, std::size_t points) : low_(low) {
  for (Eigen::Index axis = 0; axis < 3; ++axis) scale_[axis] = size[axis] > 0 ? steps / size[axis] : 0;
  before_.fill(Words(points, 0));
  earlier_.fill(Words(points, 0));
}

void PointPacker::append(const std::vector<Vec3f>& points, std::string& record) {
  const std::size_t count = points.size();
  Words now(count), best(count), trial(count);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<Eigen::Index>(axis);
    for (std::size_t p = 0; p < count; ++p) {
      const double q = std::round((static_cast<double>(points[p][a]) - low_[a]) * scale_[a]);
      now[p] = static_cast<Word>(std::clamp(q, 0.0, steps));
    }
    std::uint64_t least = std::numeric_limits<std::uint64_t>::max();
    char way = 0;
    for (const int mode : {0, 1, 2, 3}) {
      if ((mode & 1) && frames_ < 2) continue;
      std::uint64_t sum = 0;
      Word beside = 0;
      for (std::size_t p = 0; p < count; ++p) {
        const Word before = before_[axis][p];
        const int expected = mode & 1 ? 2 * before - earlier_[axis][p] : before;
        const auto off = static_cast<Word>(now[p] - expected);
        trial[p] = folded(static_cast<Word>(mode & 2 ? off - beside : off));
        beside = off;
        sum += trial[p];
      }
      if (sum >= least) continue;
      least = sum;
      way = static_cast<char>(mode);
      best.swap(trial);
    }
    record += way;
    for (const Word word : best) record += static_cast<char>(word & 0xff);
    for (const Word word : best) record += static_cast<char>(word >> 8);
    earlier_[axis] = before_[axis];
    before_[axis] = now;
  }
  ++frames_;
}

}  // namespace muslin
