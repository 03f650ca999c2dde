#include "muslin/energy/stress_curve.hpp"

#include <algorithm>
#include <cassert>
#include <limits>
#include <vector>

namespace muslin {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double steepest = 1.5, flattest = 0.5;  // of a point's slope to the chords beside it
constexpr double smallest_share = 0.25;           // of an interval, to a piece

/// The slopes at the points, the origin first: those of the parabola through three points, as far as the
/// curve between them can bend enough.
std::vector<double> slopes_at(const std::vector<double>& widths, const std::vector<double>& chords) {
  const std::size_t n = chords.size();
  if (n == 1) return {chords[0], chords[0]};
  const auto at_end = [&](std::size_t end, std::size_t inner) {
    const double bend = (chords[end] - chords[inner]) * widths[end] / (widths[end] + widths[inner]);
    return std::clamp(chords[end] + bend, flattest * chords[end], steepest * chords[end]);
  };
  std::vector<double> slopes = {at_end(0, 1)};
  for (std::size_t i = 1; i < n; ++i) {
    const double parabola =
        (widths[i] * chords[i - 1] + widths[i - 1] * chords[i]) / (widths[i - 1] + widths[i]);
    slopes.push_back(std::min(parabola, steepest * std::min(chords[i - 1], chords[i])));
  }
  slopes.push_back(at_end(n - 1, n - 2));
  return slopes;
}

/// The share of an interval in which the slope changes from p to that of the chord s, so that it is monotone.
double first_share(double p, double s, double q) {
  if ((s - p) * (q - s) <= 0) return 0.5;
  return std::clamp((q - s) / (q - p), smallest_share, 1 - smallest_share);
}

}  // namespace

StressCurve::StressCurve(double slope) {
  pieces_.fill({});
  pieces_[0] = straight(0, 0, slope);
}

StressCurve::StressCurve(std::span<const Vec2> points) : StressCurve() {
  assert(!points.empty() && points.size() <= static_cast<std::size_t>(most_points));
  std::vector<double> widths, chords;
  Vec2 before = Vec2::Zero();
  for (const Vec2& point : points) {
    widths.push_back(point[0] - before[0]);
    chords.push_back((point[1] - before[1]) / widths.back());
    before = point;
  }
  const std::vector<double> slopes = slopes_at(widths, chords);
  pieces_[0] = straight(0, 0, slopes[0]);
  for (std::size_t i = 0; i < chords.size(); ++i) {
    const double p = slopes[i], q = slopes[i + 1], u = first_share(p, chords[i], q);
    append(u * widths[i], 2 * chords[i] - u * p - (1 - u) * q);
    append((1 - u) * widths[i], q);
  }
}

StressCurve::Piece StressCurve::straight(double from, double stress, double slope) {
  return {from, infinity, stress, slope, 0, slope / 2, 0, 0};
}

void StressCurve::Piece::end(double at_width, double slope_there) {
  width = at_width;
  growth = (slope_there - slope) / width;
  half_growth = growth / 2, sixth_growth = growth / 6;
}

/// Ends the last piece after `width`, where the next one begins.
void StressCurve::append(double width, double slope_at_end) {
  Piece& last = pieces_[used_ - 1];
  last.end(width, slope_at_end);
  pieces_[used_++] =
      straight(last.from + width, last.stress + 0.5 * width * (last.slope + slope_at_end), slope_at_end);
}

StressCurve::State StressCurve::at(double strain) const {
  double energy = 0;
  std::size_t i = 0;
  const auto energy_of = [](const Piece& p, double t) {
    return t * (p.stress + t * (p.half_slope + t * p.sixth_growth));
  };
  for (; i + 1 < used_ && strain >= pieces_[i + 1].from; ++i)
    energy += energy_of(pieces_[i], pieces_[i].width);
  const Piece& p = pieces_[i];
  const double t = strain - p.from;
  return {energy + energy_of(p, t), p.stress + t * (p.slope + t * p.half_growth), p.slope + t * p.growth};
}

StressCurve StressCurve::plus(double slope) const {
  StressCurve sum = *this;
  for (std::size_t i = 0; i < used_; ++i) {
    sum.pieces_[i].stress += slope * pieces_[i].from;
    sum.pieces_[i].slope += slope;
    sum.pieces_[i].half_slope += slope / 2;
  }
  return sum;
}

double StressCurve::least_slope() const {
  double least = infinity;
  for (std::size_t i = 0; i < used_; ++i) least = std::min(least, pieces_[i].slope);
  return least;
}

double StressCurve::greatest_slope() const {
  double greatest = 0;
  for (std::size_t i = 0; i < used_; ++i) greatest = std::max(greatest, pieces_[i].slope);
  return greatest;
}

}  // namespace muslin
