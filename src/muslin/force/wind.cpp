#include "muslin/force/wind.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <string>
#include <utility>

#include "muslin/core/error.hpp"
#include "muslin/core/parallel.hpp"
#include "muslin/force/gusts.hpp"

namespace muslin {

namespace {

constexpr std::size_t wind_grain = 1024;

/// A sparse matrix of weights, row after row.
struct Rows {
  std::vector<std::size_t> offsets;  ///< #rows + 1
  std::vector<int> columns;
  std::vector<double> weights;

  std::size_t size() const { return offsets.size() - 1; }
  Vec3 apply(std::size_t row, const Vec3* x) const {
    Vec3 sum = Vec3::Zero();
    for (std::size_t e = offsets[row]; e < offsets[row + 1]; ++e)
      sum += weights[e] * x[static_cast<std::size_t>(columns[e])];
    return sum;
  }
  Rows transposed(std::size_t column_count) const {
    Rows result;
    result.offsets.assign(column_count + 1, 0);
    for (const int c : columns) ++result.offsets[static_cast<std::size_t>(c) + 1];
    for (std::size_t c = 0; c < column_count; ++c) result.offsets[c + 1] += result.offsets[c];
    result.columns.resize(columns.size());
    result.weights.resize(columns.size());
    std::vector<std::size_t> next(result.offsets.begin(), result.offsets.end() - 1);
    for (std::size_t row = 0; row < size(); ++row) {
      for (std::size_t e = offsets[row]; e < offsets[row + 1]; ++e) {
        const std::size_t slot = next[static_cast<std::size_t>(columns[e])]++;
        result.columns[slot] = static_cast<int>(row);
        result.weights[slot] = weights[e];
      }
    }
    return result;
  }
};

/// Row t: the centroid of triangle t as a weighted sum of vertices.
Rows centroid_rows(const Embedding& skin, const std::vector<Vec3i>& triangles) {
  Rows rows;
  rows.offsets.reserve(triangles.size() + 1);
  rows.offsets.push_back(0);
  std::array<std::pair<int, double>, 24> entries;
  for (const Vec3i& triangle : triangles) {
    std::size_t count = 0;
    for (const int corner : triangle) {
      const auto p = static_cast<std::size_t>(corner);
      for (std::size_t i = 0; i < 8; ++i)
        if (skin.weights[p][i] != 0) entries[count++] = {skin.vertices[p][i], skin.weights[p][i] / 3};
    }
    std::sort(entries.begin(), entries.begin() + static_cast<std::ptrdiff_t>(count));
    for (std::size_t i = 0; i < count; ++i) {
      if (rows.columns.size() > rows.offsets.back() && rows.columns.back() == entries[i].first) {
        rows.weights.back() += entries[i].second;
      } else {
        rows.columns.push_back(entries[i].first);
        rows.weights.push_back(entries[i].second);
      }
    }
    rows.offsets.push_back(rows.columns.size());
  }
  return rows;
}

/// The force on a face is K v with K = along·I + across·n nᵀ, v the relative wind at the end of the step.
struct FaceDrag {
  double along = 0;            ///< [kg/s]
  double across = 0;           ///< [kg/s]
  Vec3 normal = Vec3::Zero();  ///< unit
  Vec3 target = Vec3::Zero();  ///< where the centroid would end if it moved with the wind [m]

  Vec3 times(const Vec3& v) const { return along * v + across * normal.dot(v) * normal; }
};

void check(bool good, const char* setting, double value, const char* range) {
  if (good) return;
  throw Error(ErrorKind::usage, "wind: " + std::string(setting) + " = " + std::to_string(value),
              "give " + std::string(range));
}

void check(const KeyedNumber& number, const char* setting, const char* range) {
  for (const KeyedNumber::Key& key : number.keys)
    check(std::isfinite(key.value) && key.value >= 0, setting, key.value, range);
}

void check_lift(const KeyedNumber& lift, const KeyedNumber& drag) {
  check(lift, "lift", "a lift coefficient from 0 to that of drag");
  for (const KeyedNumber* number : {&lift, &drag})
    for (const KeyedNumber::Key& key : number->keys)
      check(lift.at(key.time) <= drag.at(key.time), "lift", lift.at(key.time),
            "a lift coefficient from 0 to that of drag");
}

}  // namespace

struct Wind::Faces {
  Embedding skin;
  std::vector<Vec3i> triangles;
  Rows centroids;  ///< #T by #V
  Rows vertices;   ///< #V by #T, its transpose
};

namespace {

/// W = Σ ½ dt vᵀ K v with v = (target − c(x)) / dt for the centroids c(x).
class RelativeDrag : public Potential {
 public:
  RelativeDrag(std::shared_ptr<const Wind::Faces> faces, std::vector<FaceDrag> drags, double dt)
      : faces_(std::move(faces)), drags_(std::move(drags)), dt_(dt) {}

  double value(ConstVectors x) const override {
    return parallel_sum(drags_.size(), wind_grain, 0.0, [&](std::size_t begin, std::size_t end) {
      double sum = 0;
      for (std::size_t t = begin; t < end; ++t) {
        const Vec3 d = drags_[t].target - faces_->centroids.apply(t, x.data());
        sum += d.dot(drags_[t].times(d));
      }
      return sum / (2 * dt_);
    });
  }
  void add_gradient(ConstVectors x, Vectors g) const override {
    scatter(g, [&](std::size_t t) -> Vec3 {
      return drags_[t].times(faces_->centroids.apply(t, x.data()) - drags_[t].target) / dt_;
    });
  }
  void add_hessian_product(ConstVectors, ConstVectors p, Vectors y) const override {
    scatter(y, [&](std::size_t t) -> Vec3 {
      return drags_[t].times(faces_->centroids.apply(t, p.data())) / dt_;
    });
  }
  void add_diagonal_blocks(ConstVectors, std::span<Mat3> blocks) const override {
    const Rows& rows = faces_->vertices;
    parallel_for(rows.size(), wind_grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) {
        for (std::size_t e = rows.offsets[v]; e < rows.offsets[v + 1]; ++e) {
          const FaceDrag& face = drags_[static_cast<std::size_t>(rows.columns[e])];
          const double w = rows.weights[e] * rows.weights[e] / dt_;
          blocks[v] += w * face.along * Mat3::Identity();
          blocks[v] += w * face.across * face.normal * face.normal.transpose();
        }
      }
    });
  }

 private:
  /// y += Cᵀ f, C the rows of the centroids: gathered vertex by vertex, so that threads do not conflict.
  template <class Force>
  void scatter(Vectors y, const Force& force) const {
    assert(y.size() == faces_->vertices.size());
    const auto forces = std::make_unique_for_overwrite<Vec3[]>(drags_.size());
    parallel_for(drags_.size(), wind_grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t) forces[t] = force(t);
    });
    parallel_for(y.size(), wind_grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) y[v] += faces_->vertices.apply(v, forces.get());
    });
  }

  std::shared_ptr<const Wind::Faces> faces_;
  std::vector<FaceDrag> drags_;
  double dt_;
};

}  // namespace

Wind::Wind(WindSettings settings, Embedding skin, std::vector<Vec3i> triangles, std::size_t vertex_count)
    : settings_(std::move(settings)) {
  const WindSettings& s = settings_;
  check(s.air_density, "air_density", "kg/m3, 0 or more (1.2 near the ground)");
  check(s.drag, "drag", "a drag coefficient of 0 or more");
  check_lift(s.lift, s.drag);
  check(s.gust, "gust", "m/s, 0 or more");
  check(std::isfinite(s.gust_length) && s.gust_length > 0, "gust_length", s.gust_length, "m, more than 0");
  check(s.porosity >= 0 && s.porosity <= 1, "porosity", s.porosity, "a share from 0 to 1");

  auto faces = std::make_shared<Faces>();
  faces->centroids = centroid_rows(skin, triangles);
  faces->vertices = faces->centroids.transposed(vertex_count);
  faces->skin = std::move(skin);
  faces->triangles = std::move(triangles);
  faces_ = std::move(faces);
}

std::unique_ptr<Potential> Wind::potential(const StepContext& step) const {
  const WindSettings& s = settings_;
  const double share = s.window.share(step.time_begin, step.time_end);
  if (share == 0) return nullptr;
  const double time = s.window.sample(step.time_end);
  const Vec3 mean = s.velocity.at(time);
  const Vec3 carried = s.velocity.integral(time);
  const double density = s.air_density.at(time), drag = s.drag.at(time), gust = s.gust.at(time);
  const double lift = std::min(s.lift.at(time), drag);
  const double turned = s.gust.integral(time) / s.gust_length;  // eddy turnover times
  std::vector<double> strengths;
  strengths.reserve(s.fields.size());
  for (const Field& field : s.fields)
    strengths.push_back(field.extent.strength_in(step.time_begin, step.time_end));

  std::vector<Vec3> points(faces_->skin.size());
  faces_->skin.apply(step.positions, points);
  std::vector<FaceDrag> drags(faces_->triangles.size());
  parallel_for(drags.size(), wind_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const Vec3i& corner = faces_->triangles[t];
      const Vec3& a = points[static_cast<std::size_t>(corner[0])];
      const Vec3& b = points[static_cast<std::size_t>(corner[1])];
      const Vec3& c = points[static_cast<std::size_t>(corner[2])];
      const Vec3 cross = (b - a).cross(c - a);
      const double twice_area = cross.norm();
      if (twice_area == 0) continue;

      Vec3 air = mean;
      if (gust > 0) {
        const Vec3 place = ((a + b + c) / 3 - carried) / s.gust_length;
        air += gust * gust_noise(place, turned, s.seed);
      }
      for (std::size_t f = 0; f < strengths.size(); ++f) {
        if (strengths[f] == 0) continue;
        air += strengths[f] * s.fields[f].at((a + b + c) / 3, s.fields[f].extent.sampled(step.time_end));
      }
      FaceDrag& face = drags[t];
      face.normal = cross / twice_area;
      face.target = faces_->centroids.apply(t, step.anchor.data()) + step.dt * air;

      const Vec3 relative = air - faces_->centroids.apply(t, step.velocities.data());
      const double speed = relative.norm();
      const double through = face.normal.dot(relative);
      if (speed == 0 || (!s.two_sided && through >= 0)) continue;
      const double normal_speed = std::min(std::abs(through), speed);
      const double factor = 0.25 * share * density * twice_area * (1 - s.porosity);  // ½ ρ A
      face.along = factor * normal_speed * (drag - lift * normal_speed / speed);
      face.across = factor * lift * speed;
    }
  });
  return std::make_unique<RelativeDrag>(faces_, std::move(drags), step.dt);
}

}  // namespace muslin
