#include "muslin/energy/hinge_angles.hpp"

#include <algorithm>
#include <utility>

#include "muslin/core/index.hpp"

namespace muslin {
namespace {

MUSLIN_VECTOR_CODE void deviations_of(const Batch<4>& x, const double* rest, double* out) {
  BentHinge h;
  bend_hinge(x, h);
  find_deviations(h, rest, out);
}

MUSLIN_VECTOR_CODE void gradients_of(const Batch<4>& x, Batch<4>& out) {
  BentHinge h;
  AngleGradient d;
  bend_hinge(x, h);
  gradient_of_angle(h, d);
  angle_to_corners(d, out);
}

MUSLIN_VECTOR_CODE void changes_of(const Batch<4>& x, const Batch<4>& p, double* out) {
  BentHinge h;
  AngleGradient d;
  Batch<4> g;
  bend_hinge(x, h);
  gradient_of_angle(h, d);
  angle_to_corners(d, g);
  for (int l = 0; l < element_lanes; ++l)
    out[l] = dot_lanes(g[0], p[0], l) + dot_lanes(g[1], p[1], l) + dot_lanes(g[2], p[2], l) +
             dot_lanes(g[3], p[3], l);
}

/// force = factor ∇θ
MUSLIN_VECTOR_CODE void forces_of(const Batch<4>& x, const double* factor, Batch<4>& force) {
  BentHinge h;
  AngleGradient d;
  bend_hinge(x, h);
  gradient_of_angle(h, d);
  angle_to_corners(d, force);
  for (int c = 0; c < 4; ++c)
    for (int k = 0; k < 3; ++k)
      for (int l = 0; l < element_lanes; ++l) force[c][k][l] *= factor[l];
}

/// force = factor ∇θ + moment ∇²θ p
MUSLIN_VECTOR_CODE void changes_of_forces(const Batch<4>& x, const double* factor, const double* moment,
                                          const Batch<4>& p, Batch<4>& force) {
  BentHinge h;
  AngleGradient d;
  Batch<4> change;
  bend_hinge(x, h);
  gradient_of_angle(h, d);
  angle_to_corners(d, force);
  change_of_angle_gradient(h, d, p, change);
  for (int c = 0; c < 4; ++c)
    for (int k = 0; k < 3; ++k)
      for (int l = 0; l < element_lanes; ++l)
        force[c][k][l] = factor[l] * force[c][k][l] + moment[l] * change[c][k][l];
}

}  // namespace

HingeAngles::HingeAngles(const Shell& shell, std::shared_ptr<const SymmetricPattern> pattern)
    : count_(shell.hinges.size()),
      pattern_(std::move(pattern)),
      slabs_(hinge_vertices(shell), shell.vertex_count()),
      rest_(slabs_.by_entry<double>([&](std::size_t e) { return shell.hinges[e].angle; })) {
  if (pattern_) slots_ = slabs_.slots(*pattern_);
}

void HingeAngles::load(std::span<const double> of_hinge, int first, int count, double* lanes) const {
  for (int l = 0; l < element_lanes; ++l)
    lanes[l] = of_hinge[at(slabs_.elements()[at(first + std::min(l, count - 1))])];
}

std::vector<double> HingeAngles::deviations(ConstVectors x) const {
  std::vector<double> result(count_);
  slabs_.for_each_owned_batch([&](int first, int count) {
    Batch<4> corners;
    double lanes[element_lanes];
    slabs_.gather(first, count, x, corners);
    deviations_of(corners, rest_.data() + first, lanes);
    for (int l = 0; l < count; ++l) result[at(slabs_.elements()[at(first + l)])] = lanes[l];
  });
  return result;
}

std::vector<double> HingeAngles::changes(ConstVectors x, ConstVectors p) const {
  std::vector<double> result(count_);
  slabs_.for_each_owned_batch([&](int first, int count) {
    Batch<4> corners, along;
    double lanes[element_lanes];
    slabs_.gather(first, count, x, corners);
    slabs_.gather(first, count, p, along);
    changes_of(corners, along, lanes);
    for (int l = 0; l < count; ++l) result[at(slabs_.elements()[at(first + l)])] = lanes[l];
  });
  return result;
}

void HingeAngles::add_forces(ConstVectors x, std::span<const double> moments, Vectors g) const {
  slabs_.for_each_batch([&](int first, int count, const Slabs::Slab& slab) {
    Batch<4> corners, force;
    double moment[element_lanes];
    slabs_.gather(first, count, x, corners);
    load(moments, first, count, moment);
    forces_of(corners, moment, force);
    slabs_.scatter(first, count, slab, force, g);
  });
}

void HingeAngles::add_force_changes(ConstVectors x, std::span<const double> factors,
                                    std::span<const double> moments, ConstVectors p, Vectors y) const {
  slabs_.for_each_batch([&](int first, int count, const Slabs::Slab& slab) {
    Batch<4> corners, along, force;
    double factor[element_lanes], moment[element_lanes];
    slabs_.gather(first, count, x, corners);
    slabs_.gather(first, count, p, along);
    load(factors, first, count, factor);
    load(moments, first, count, moment);
    changes_of_forces(corners, factor, moment, along, force);
    slabs_.scatter(first, count, slab, force, y);
  });
}

void HingeAngles::add_blocks(ConstVectors x, std::span<const double> lumped, std::span<Mat3> blocks) const {
  slabs_.for_each_batch([&](int first, int count, const Slabs::Slab& slab) {
    Batch<4> corners, gradient;
    slabs_.gather(first, count, x, corners);
    gradients_of(corners, gradient);
    for (int l = 0; l < count; ++l) {
      const double weight = lumped[at(slabs_.elements()[at(first + l)])];
      for (int c = 0; c < 4; ++c) {
        const int v = slabs_.vertices()[at(first + l)][at(c)];
        if (v < slab.vertex_begin || v >= slab.vertex_end) continue;
        const Vec3 g(gradient[c][0][l], gradient[c][1][l], gradient[c][2][l]);
        blocks[at(v)] += weight * g * g.transpose();
      }
    }
  });
}

void HingeAngles::assemble(ConstVectors x, std::span<const double> lumped, double scale, PairBlocks blocks,
                           Float4* gradients) const {
  slabs_.for_each_batch([&](int first, int count, const Slabs::Slab& slab) {
    Batch<4> corners, gradient;
    double weights[element_lanes];
    unsigned rows[element_lanes];
    slabs_.gather(first, count, x, corners);
    gradients_of(corners, gradient);
    load(lumped, first, count, weights);
    slabs_.corners_in(first, count, slab, rows);
    add_angle_squares(weights, gradient, scale, count, rows, slots_.data() + first, blocks.columns);
    if (gradients == nullptr) return;
    for (int l = 0; l < std::min(count, slab.owned_end - first); ++l) {
      Float4* const to = gradients + 4 * at(slabs_.elements()[at(first + l)]);
      for (int c = 0; c < 4; ++c) {
        to[c] = Float4{static_cast<float>(gradient[c][0][l]), static_cast<float>(gradient[c][1][l]),
                       static_cast<float>(gradient[c][2][l]), 0};
      }
    }
  });
}

}  // namespace muslin
