// Defines the vector types that all folders share. Lengths are in metres and y is up unless a comment says
// otherwise.
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace muslin {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Vec3i = Eigen::Vector3i;
using Mat3 = Eigen::Matrix3d;
using Box = Eigen::AlignedBox3d;

/// One 3-vector per vertex, read only and writable: shape (#V by 3).
using ConstVectors = std::span<const Vec3>;
using Vectors = std::span<Vec3>;

}  // namespace muslin
