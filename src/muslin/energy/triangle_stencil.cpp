#include "muslin/energy/triangle_stencil.hpp"

#include <algorithm>
#include <limits>

namespace muslin {
namespace {

/// Share of the masses that buckling triangles may use, and the ratio of stiffness to mass above which they
/// use none, because float would round away the rest of the masses.
constexpr double held_share = 0.9, max_stiff = 3e4;

}  // namespace

std::vector<std::array<int, 3>> corners_of(const Shell& shell) {
  std::vector<std::array<int, 3>> corners;
  for (const Vec3i& t : shell.triangles) corners.push_back({t[0], t[1], t[2]});
  return corners;
}

std::shared_ptr<const ElementSlabs<3>> triangle_slabs(const Shell& shell) {
  return std::make_shared<const ElementSlabs<3>>(corners_of(shell), shell.vertex_count());
}

TriangleStencil::TriangleStencil(const ElementSlabs<3>& slabs, const Shell& shell) {
  for (std::size_t i = 0; i < 4; ++i)
    rest_[i] = slabs.by_entry<double>([&](std::size_t t) { return shell.inverses[t].data()[i]; });
  rest_[4] = slabs.by_entry<double>([&](std::size_t t) { return shell.areas[t]; });
}

void TriangleStencil::use_masses(const ElementSlabs<3>& slabs, const Shell& shell,
                                 const std::vector<PlaneModuli>& moduli) {
  mass_shares_ = slabs.by_entry<std::array<double, 3>>([&](std::size_t t) {
    const Vec3i& corners = shell.triangles[t];
    std::array<double, 3> shares;
    for (int c = 0; c < 3; ++c)
      shares[static_cast<std::size_t>(c)] =
          shell.areas[t] / 3 / shell.vertex_areas[static_cast<std::size_t>(corners[c])];
    return shares;
  });
  stiffness_ = slabs.by_entry<double>([&](std::size_t t) {
    const Mat2& d = shell.inverses[t];
    const PlaneModuli& c = moduli[t];
    const Eigen::RowVector2d first = -(d.row(0) + d.row(1));
    const double uu = d.col(0).squaredNorm() + first[0] * first[0];
    const double vv = d.col(1).squaredNorm() + first[1] * first[1];
    return shell.areas[t] * ((c.c11 + c.g) * uu + (c.c22 + c.g) * vv);
  });
}

void TriangleStencil::find_held(int first, int count, std::span<const double> masses,
                                const std::vector<std::array<int, 3>>& vertices, MassBound& bound) const {
  if (stiffness_.empty()) return;
  for (int l = 0; l < count; ++l) {
    const auto entry = static_cast<std::size_t>(first + l);
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t c = 0; c < 3; ++c)
      least = std::min(least, mass_shares_[entry][c] * masses[static_cast<std::size_t>(vertices[entry][c])]);
    bound.held[l] = bound.scale * stiffness_[entry] < max_stiff * least ? held_share * least : 0;
  }
}

}  // namespace muslin
