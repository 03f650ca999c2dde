#include "muslin/energy/volume_energy.hpp"

#include "muslin/core/error.hpp"
#include "muslin/core/parallel.hpp"

namespace muslin {

namespace {

constexpr std::size_t volume_grain = 512;

using Corners = std::array<Vec3, 8>;

/// Corners of the faces, counter-clockwise from outside.
constexpr int faces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                             {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};

/// Twelve times the gradient, of one face a, b, c, d: the mean of its two cuts into triangles. `cross(i, j)`
/// stands for the product of two corners, or for its change.
template <class Cross>
void add_face(const int (&face)[4], const Cross& cross, Corners& gradient) {
  const auto at = [&](int i) -> Vec3& { return gradient[static_cast<std::size_t>(face[i])]; };
  const Vec3 ab = cross(face[0], face[1]), ac = cross(face[0], face[2]), ad = cross(face[0], face[3]),
             bc = cross(face[1], face[2]), bd = cross(face[1], face[3]), cd = cross(face[2], face[3]);
  at(0) += bc + bd + cd;
  at(1) += cd - ac - ad;
  at(2) += ab - ad - bd;
  at(3) += ab + ac + bc;
}

/// Volume of a voxel and its gradients with respect to the eight corners.
struct Volume {
  Corners from_first;  ///< corners relative to the first: a sum over closed faces does not depend on it
  Corners gradient;
  double volume = 0;

  template <class At>
  explicit Volume(const At& at) {
    for (std::size_t i = 0; i < 8; ++i) {
      from_first[i] = at(i) - at(0);
      gradient[i].setZero();
    }
    const auto cross = [&](int i, int j) {
      return Vec3(from_first[static_cast<std::size_t>(i)].cross(from_first[static_cast<std::size_t>(j)]));
    };
    for (const auto& face : faces) add_face(face, cross, gradient);
    for (std::size_t i = 0; i < 8; ++i) {
      gradient[i] /= 12;
      volume += from_first[i].dot(gradient[i]) / 3;  // V is homogeneous of degree 3
    }
  }

  /// Computes the change of the gradients when the corners move.
  Corners change(const Corners& moves) const {
    Corners result;
    result.fill(Vec3::Zero());
    const auto cross = [&](int left, int right) {
      const auto i = static_cast<std::size_t>(left), j = static_cast<std::size_t>(right);
      return Vec3(moves[i].cross(from_first[j]) + from_first[i].cross(moves[j]));
    };
    for (const auto& face : faces) add_face(face, cross, result);
    for (Vec3& change : result) change /= 12;
    return result;
  }
};

}  // namespace

VolumeEnergy::VolumeEnergy(const Lattice& lattice, double volume_modulus)
    : rest_volume_(lattice.width * lattice.width * lattice.width) {
  require(volume_modulus >= 0, "a volume modulus is negative", "give 0 or more");
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
    parallel_for(cells.size(), volume_grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) kernel(cells[i]);
    });
  }
}

double VolumeEnergy::value(ConstVectors x) const {
  double sum = 0;
  for (const std::vector<Cell>& cells : colours_) {
    sum += parallel_sum(cells.size(), volume_grain, 0.0, [&](std::size_t begin, std::size_t end) {
      double part = 0;
      for (std::size_t i = begin; i < end; ++i) {
        const Volume v([&](std::size_t corner) -> const Vec3& { return x[cells[i].vertex(corner)]; });
        const double change = v.volume / rest_volume_ - 1;
        part += 0.5 * cells[i].modulus * rest_volume_ * change * change;
      }
      return part;
    });
  }
  return sum;
}

void VolumeEnergy::add_gradient(ConstVectors x, Vectors g) const {
  for_each_cell([&](const Cell& cell) {
    const Volume v([&](std::size_t corner) -> const Vec3& { return x[cell.vertex(corner)]; });
    const double pressure = cell.modulus * (v.volume / rest_volume_ - 1);
    for (std::size_t i = 0; i < 8; ++i) g[cell.vertex(i)] += pressure * v.gradient[i];
  });
}

void VolumeEnergy::add_hessian_product(ConstVectors x, ConstVectors p, Vectors y) const {
  for_each_cell([&](const Cell& cell) {
    const Volume v([&](std::size_t corner) -> const Vec3& { return x[cell.vertex(corner)]; });
    const double pressure = cell.modulus * (v.volume / rest_volume_ - 1);
    Corners moves;
    double change = 0;
    for (std::size_t i = 0; i < 8; ++i) {
      moves[i] = p[cell.vertex(i)] - p[cell.vertex(0)];
      change += v.gradient[i].dot(moves[i]);
    }
    const Corners turned = v.change(moves);
    const double slope = cell.modulus / rest_volume_ * change;
    for (std::size_t i = 0; i < 8; ++i) y[cell.vertex(i)] += slope * v.gradient[i] + pressure * turned[i];
  });
}

void VolumeEnergy::add_diagonal_blocks(ConstVectors x, std::span<Mat3> blocks) const {
  // V is linear in each corner, so the diagonal blocks of the Hessian are those of the positive
  // semidefinite part κ/V₀ ∇V ∇Vᵀ alone: nothing to clamp.
  for_each_cell([&](const Cell& cell) {
    const Volume v([&](std::size_t corner) -> const Vec3& { return x[cell.vertex(corner)]; });
    for (std::size_t i = 0; i < 8; ++i)
      blocks[cell.vertex(i)] += cell.modulus / rest_volume_ * v.gradient[i] * v.gradient[i].transpose();
  });
}

}  // namespace muslin
