#include "muslin/post/finish.hpp"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "muslin/core/error.hpp"
#include "muslin/geometry/thicken.hpp"
#include "muslin/post/smoothing.hpp"
#include "muslin/post/subdivision.hpp"

namespace muslin {

struct Finish::Stages {
  FinishOptions options;
  std::optional<Smoothing> smoothing;
  std::optional<Subdivision> subdivision;
  std::optional<CarriedMesh> carrier;
  Mesh sheet;     ///< before it is thickened
  Mesh finished;  ///< at rest
};

Finish::Finish(const Mesh& rest, FinishOptions options) : stages_(std::make_unique<Stages>()) {
  if (options.smooth < 0 || options.smooth > 1000)
    throw Error(ErrorKind::usage, fmt::format("{} rounds of smoothing", options.smooth), "use 0 to 1000");
  if (options.subdivide < 0 || options.subdivide > 8)
    throw Error(ErrorKind::usage, fmt::format("{} levels of subdivision", options.subdivide), "use 0 to 8");
  if (!(options.thickness >= 0) || !std::isfinite(options.thickness))
    throw Error(ErrorKind::usage, fmt::format("a thickness of {} m", options.thickness),
                "use a positive thickness in metres");
  Stages& s = *stages_;
  s.options = std::move(options);
  s.sheet = rest;
  if (s.options.smooth > 0) {
    s.smoothing.emplace(rest, s.options.smooth);
    s.sheet.positions = s.smoothing->points(rest.positions);
  }
  if (s.options.subdivide > 0) {
    s.subdivision.emplace(s.sheet, s.options.subdivide);
    s.sheet = s.subdivision->mesh();
  }
  if (s.options.carried) {
    s.carrier.emplace(s.sheet, *s.options.carried);
    s.sheet = *s.options.carried;
  }
  s.finished = s.options.thickness > 0 ? thicken(s.sheet, s.options.thickness) : s.sheet;
}

Finish::~Finish() = default;
Finish::Finish(Finish&&) noexcept = default;
Finish& Finish::operator=(Finish&&) noexcept = default;

const Mesh& Finish::mesh() const { return stages_->finished; }

Carried Finish::points(ConstVectors positions, const Obstacles& obstacles) const {
  const Stages& s = *stages_;
  Carried result;
  result.points.assign(positions.begin(), positions.end());
  if (s.smoothing) result.points = s.smoothing->points(result.points);
  if (s.subdivision) result.points = s.subdivision->points(result.points);
  if (s.carrier) result = s.carrier->points(result.points, obstacles);
  if (s.options.thickness > 0) {
    Mesh sheet = s.sheet;
    sheet.positions = std::move(result.points);
    result.points = thicken(sheet, s.options.thickness).positions;
  }
  return result;
}

}  // namespace muslin
