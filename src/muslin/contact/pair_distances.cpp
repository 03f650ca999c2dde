#include "muslin/contact/pair_distances.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "muslin/core/error.hpp"
#include "muslin/core/parallel.hpp"

namespace muslin {
namespace {

constexpr std::size_t distance_grain = 2048;

/// Displacement of a point since the pairs were found [m]; padded, so that it is one load.
using Displacement = std::array<float, 4>;

float squared_difference(const Displacement& a, const Displacement& b) {
  const float x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
  return x * x + y * y + z * z;
}

/// Returns a bound of how much closer the features of a pair can have come [m].
float approach(const ContactPair& pair, const std::vector<Displacement>& moved) {
  const Displacement &a = moved[static_cast<std::size_t>(pair.points[0])],
                     &b = moved[static_cast<std::size_t>(pair.points[1])],
                     &c = moved[static_cast<std::size_t>(pair.points[2])],
                     &d = moved[static_cast<std::size_t>(pair.points[3])];
  float most = std::max(squared_difference(a, c), squared_difference(a, d));
  most = pair.kind == PairKind::vertex_triangle
             ? std::max(most, squared_difference(a, b))
             : std::max(most, std::max(squared_difference(b, c), squared_difference(b, d)));
  constexpr float rounding = 1 + 1e-5F;
  return rounding * std::sqrt(most);
}

}  // namespace

void PairDistances::update(ConstVectors x) {
  const ConstVectors from = candidates_->found_at();
  if (x.size() != from.size())
    throw Error(ErrorKind::usage, "distances of pairs need one position for each point", "give #P positions");
  if (std::equal(x.begin(), x.end(), x_.begin(), x_.end())) return;
  x_.assign(x.begin(), x.end());
  std::vector<Displacement> moved(x.size());
  parallel_for(x.size(), distance_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const Vec3 way = x[p] - from[p];
      moved[p] = {static_cast<float>(way.x()), static_cast<float>(way.y()), static_cast<float>(way.z()), 0};
    }
  });
  const std::span<const ContactPair> pairs = candidates_->pairs();
  const std::span<const float> distances = candidates_->least_distances();
  const double reach = ranges_known * candidates_->longest_range();
  geometry_.resize(pairs.size());
  known_.resize(pairs.size());
  parallel_for(pairs.size(), distance_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      known_[i] = 0;
      geometry_[i].distance =
          pairs[i].kind == PairKind::point_plane ? 0 : distances[i] - approach(pairs[i], moved);
      if (geometry_[i].distance < pairs[i].thickness + reach) find(i);
    }
  });
}

const PairGeometry& PairDistances::find(std::size_t i) {
  if (known_[i] == 0) {
    geometry_[i] = pair_geometry(candidates_->surface(), candidates_->pairs()[i], x_);
    known_[i] = 1;
  }
  return geometry_[i];
}

double PairDistances::smallest_gap() const {
  const std::span<const ContactPair> pairs = candidates_->pairs();
  double gap = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < pairs.size(); ++i)
    if (known_[i] != 0) gap = std::min(gap, geometry_[i].distance - pairs[i].thickness);
  return gap <= candidates_->longest_range() ? gap : std::numeric_limits<double>::infinity();
}

}  // namespace muslin
