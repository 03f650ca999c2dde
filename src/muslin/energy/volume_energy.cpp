#include "muslin/energy/volume_energy.hpp"

#include <algorithm>
#include <cassert>

#include "muslin/core/parallel.hpp"
#include "muslin/lattice/springs.hpp"

namespace muslin {

namespace {

constexpr std::size_t kGrain = 512;

/// A tetrahedron's volume and its gradients with respect to the four corners.
struct Volume {
  Vec3 a, b, c;  ///< edges from corner 0
  std::array<Vec3, 4> gradient;
  double volume;

  Volume(const Vec3& x0, const Vec3& x1, const Vec3& x2, const Vec3& x3)
      : a(x1 - x0), b(x2 - x0), c(x3 - x0) {
    gradient[1] = b.cross(c) / 6;
    gradient[2] = c.cross(a) / 6;
    gradient[3] = a.cross(b) / 6;
    gradient[0] = -(gradient[1] + gradient[2] + gradient[3]);
    volume = a.dot(gradient[1]);
  }
};

}  // namespace

VolumeEnergy::VolumeEnergy(const Lattice& lattice, double volume_modulus)
    : rest_volume_(lattice.width * lattice.width * lattice.width / 6) {
  assert(volume_modulus >= 0);
  if (lattice.voxel_count() == 0) return;

  // Every voxel is cut alike, so the corners of the first one's tetrahedra do for all.
  const std::vector<std::array<int, 4>> tetrahedra = build_tetrahedra(lattice);
  const std::array<int, 8>& first = lattice.voxel_vertices.front();
  for (std::size_t t = 0; t < 6; ++t) {
    for (std::size_t i = 0; i < 4; ++i)
      corners_[t][i] =
          static_cast<int>(std::find(first.begin(), first.end(), tetrahedra[t][i]) - first.begin());
  }
  for (std::size_t voxel = 0; voxel < lattice.voxel_count(); ++voxel) {
    const Vec3i& p = lattice.voxels[voxel];
    const int colour = (p.x() & 1) | (p.y() & 1) << 1 | (p.z() & 1) << 2;
    colours_[static_cast<std::size_t>(colour)].push_back(
        {lattice.voxel_vertices[voxel], volume_modulus * lattice.fill[voxel]});
  }
}

template <class Kernel>
void VolumeEnergy::for_each_cell(const Kernel& kernel) const {
  for (const std::vector<Cell>& cells : colours_) {
    parallel_for(cells.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) kernel(cells[i]);
    });
  }
}

double VolumeEnergy::value(ConstVectors x) const {
  double sum = 0;
  for (const std::vector<Cell>& cells : colours_) {
    sum += parallel_sum(cells.size(), kGrain, 0.0, [&](std::size_t begin, std::size_t end) {
      double part = 0;
      for (std::size_t i = begin; i < end; ++i) {
        const auto at = [&](int corner) -> const Vec3& {
          return x[static_cast<std::size_t>(cells[i].vertices[static_cast<std::size_t>(corner)])];
        };
        for (const std::array<int, 4>& t : corners_) {
          const double change = Volume(at(t[0]), at(t[1]), at(t[2]), at(t[3])).volume / rest_volume_ - 1;
          part += 0.5 * cells[i].modulus * rest_volume_ * change * change;
        }
      }
      return part;
    });
  }
  return sum;
}

void VolumeEnergy::add_gradient(ConstVectors x, Vectors g) const {
  for_each_cell([&](const Cell& cell) {
    const auto vertex = [&](int corner) {
      return static_cast<std::size_t>(cell.vertices[static_cast<std::size_t>(corner)]);
    };
    for (const std::array<int, 4>& t : corners_) {
      const Volume v(x[vertex(t[0])], x[vertex(t[1])], x[vertex(t[2])], x[vertex(t[3])]);
      const double pressure = cell.modulus * (v.volume / rest_volume_ - 1);
      for (std::size_t i = 0; i < 4; ++i) g[vertex(t[i])] += pressure * v.gradient[i];
    }
  });
}

void VolumeEnergy::add_hessian_product(ConstVectors x, ConstVectors p, Vectors y) const {
  for_each_cell([&](const Cell& cell) {
    const auto vertex = [&](int corner) {
      return static_cast<std::size_t>(cell.vertices[static_cast<std::size_t>(corner)]);
    };
    for (const std::array<int, 4>& t : corners_) {
      const Volume v(x[vertex(t[0])], x[vertex(t[1])], x[vertex(t[2])], x[vertex(t[3])]);
      const double pressure = cell.modulus * (v.volume / rest_volume_ - 1);
      const Vec3 da = p[vertex(t[1])] - p[vertex(t[0])];
      const Vec3 db = p[vertex(t[2])] - p[vertex(t[0])];
      const Vec3 dc = p[vertex(t[3])] - p[vertex(t[0])];
      const double change = v.gradient[1].dot(da) + v.gradient[2].dot(db) + v.gradient[3].dot(dc);
      const double slope = cell.modulus / rest_volume_ * change;
      const Vec3 y1 = slope * v.gradient[1] + pressure / 6 * (db.cross(v.c) + v.b.cross(dc));
      const Vec3 y2 = slope * v.gradient[2] + pressure / 6 * (dc.cross(v.a) + v.c.cross(da));
      const Vec3 y3 = slope * v.gradient[3] + pressure / 6 * (da.cross(v.b) + v.a.cross(db));
      y[vertex(t[0])] -= y1 + y2 + y3;
      y[vertex(t[1])] += y1;
      y[vertex(t[2])] += y2;
      y[vertex(t[3])] += y3;
    }
  });
}

void VolumeEnergy::add_diagonal_blocks(ConstVectors x, std::span<Mat3> blocks) const {
  // V is linear in each corner, so the diagonal blocks of the Hessian are those of the positive
  // semidefinite part κ/V₀ ∇V ∇Vᵀ alone: nothing to clamp.
  for_each_cell([&](const Cell& cell) {
    const auto vertex = [&](int corner) {
      return static_cast<std::size_t>(cell.vertices[static_cast<std::size_t>(corner)]);
    };
    for (const std::array<int, 4>& t : corners_) {
      const Volume v(x[vertex(t[0])], x[vertex(t[1])], x[vertex(t[2])], x[vertex(t[3])]);
      for (std::size_t i = 0; i < 4; ++i)
        blocks[vertex(t[i])] += cell.modulus / rest_volume_ * v.gradient[i] * v.gradient[i].transpose();
    }
  });
}

}  // namespace muslin
