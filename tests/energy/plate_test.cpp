// The bending of shells is that of a plate on any mesh: cantilever, torsion, coupling of bending and twist
// off the threads, lateral buckling, a curved beam; at three resolutions, with orders of convergence.
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "support/potential_battery.hpp"
#include <Eigen/SparseCholesky>
#include <Eigen/SparseLU>
#include <gtest/gtest.h>

#include "muslin/energy/membrane_energy.hpp"
#include "muslin/energy/shell_bending.hpp"
#include "muslin/geometry/triangulated_strip.hpp"

namespace muslin {
namespace {

constexpr double width = 0.25;
using Vector = Eigen::VectorXd;
using Sparse = Eigen::SparseMatrix<double>;

/// A strip with degrees of freedom of some axes, held where `hold` says.
class Strip {
 public:
  Strip(Mesh mesh, const Vec3& warp, const BendingModuli& moduli,
        const std::function<bool(const Vec3&)>& hold)
      : rest(std::move(mesh.positions)) {
    mesh.positions = rest;
    shell = build_shell(mesh, rest, {warp});
    for (const Vec3& p : rest) held.push_back(hold(p) ? 1 : 0);
    bending = std::make_unique<ShellBending>(shell, moduli, nullptr, held);
  }

  /// Numbers of the free ones among 3 #V components with these axes, −1 elsewhere.
  std::vector<int> freedoms(const std::vector<int>& axes) const {
    std::vector<int> number(3 * rest.size(), -1);
    int next = 0;
    for (std::size_t v = 0; v < rest.size(); ++v)
      for (const int axis : axes)
        if (held[v] == 0) number[3 * v + static_cast<std::size_t>(axis)] = next++;
    return number;
  }

  /// The exact Hessian of an energy at x. A product gives columns of vertices too far apart to be coupled.
  Sparse hessian(const Potential& energy, const std::vector<Vec3>& x, const std::vector<int>& number) const {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < number.size(); ++i)
      if (number[i] >= 0) order.push_back(i);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t i, std::size_t j) { return rest[i / 3].x() < rest[j / 3].x(); });
    const double reach = 8 * shell.mean_edge;
    std::vector<Eigen::Triplet<double>> entries;
    std::vector<char> done(number.size(), 0);
    for (const std::size_t first : order) {
      if (done[first]) continue;
      std::vector<Vec3> unit(rest.size(), Vec3::Zero()), column = unit;
      std::vector<std::size_t> together;
      for (const std::size_t i : order) {
        if (done[i] || (!together.empty() && rest[i / 3].x() < rest[together.back() / 3].x() + 2 * reach))
          continue;
        together.push_back(i);
        done[i] = 1;
        unit[i / 3][static_cast<Eigen::Index>(i % 3)] = 1;
      }
      energy.add_hessian_product(x, unit, column);
      for (std::size_t j = 0; j < number.size(); ++j) {
        const double value = column[j / 3][static_cast<Eigen::Index>(j % 3)];
        if (number[j] < 0 || value == 0) continue;
        for (const std::size_t i : together)
          if (std::abs(rest[i / 3].x() - rest[j / 3].x()) < reach)
            entries.emplace_back(number[j], number[i], value);
      }
    }
    const auto count = static_cast<Eigen::Index>(order.size());
    Sparse h(count, count);
    h.setFromTriplets(entries.begin(), entries.end());
    return h;
  }

  /// Per area along an axis.
  Vector load(const std::vector<int>& number, int axis) const {
    Vector f = Vector::Zero(1 + *std::max_element(number.begin(), number.end()));
    for (std::size_t v = 0; v < rest.size(); ++v) {
      const int i = number[3 * v + static_cast<std::size_t>(axis)];
      if (i >= 0) f[i] = shell.vertex_areas[v];
    }
    return f;
  }

  std::vector<Vec3> moved(const std::vector<int>& number, const Vector& u, double factor = 1) const {
    std::vector<Vec3> x = rest;
    for (std::size_t i = 0; i < number.size(); ++i)
      if (number[i] >= 0) x[i / 3][static_cast<Eigen::Index>(i % 3)] += factor * u[number[i]];
    return x;
  }

  /// z where (x, y) was, at a vertex.
  double height(const std::vector<Vec3>& x, double at_x, double at_y) const {
    for (std::size_t v = 0; v < rest.size(); ++v)
      if ((rest[v] - Vec3(at_x, at_y, 0)).norm() < 1e-9) return x[v].z();
    ADD_FAILURE() << "no vertex";
    return 0;
  }

  Shell shell;
  std::vector<Vec3> rest;
  std::vector<std::uint8_t> held;
  std::unique_ptr<ShellBending> bending;
};

Vector solve(const Sparse& h, const Vector& f) {
  Eigen::SimplicialLDLT<Sparse> factor(h);
  EXPECT_EQ(factor.info(), Eigen::Success);
  return factor.solve(f);
}

bool before_clamp(const Vec3& p) { return p.x() < 1e-9; }

/// Deflections of the end's corners at y = 0 and y = width under a load of 1 per area.
std::array<double, 2> loaded_ends(const std::string& kind, int n, const Vec3& warp,
                                  const BendingModuli& moduli) {
  const Strip strip(triangulated_strip(kind, n, width, true), warp, moduli, before_clamp);
  const std::vector<int> number = strip.freedoms({2});
  const std::vector<Vec3> x =
      strip.moved(number, solve(strip.hessian(*strip.bending, strip.rest, number), strip.load(number, 2)));
  return {strip.height(x, 1, 0), strip.height(x, 1, width)};
}

/// The ratio of the stiffness against a twist, of ends that are held twisted, to D (1 − ν).
double torsion(const std::string& kind, int n) {
  const double poisson = 0.3;
  const Strip strip(triangulated_strip(kind, n, width, false), Vec3::UnitX(), {1, 1, 1, poisson},
                    [](const Vec3& p) { return p.x() < 1e-9 || p.x() > 1 - 1e-9; });
  const Shell& shell = strip.shell;
  const ShellBending bending(shell, {1, 1, 1, poisson});  // ends that may curve
  std::vector<Vec3> x = strip.rest;
  constexpr double small = 1e-5;
  for (std::size_t v = 0; v < x.size(); ++v)
    if (strip.held[v] != 0) x[v].z() = small * x[v].x() * x[v].y();
  const std::vector<int> number = strip.freedoms({2});
  const std::vector<Vec3> up = test::sum(x, -1, strip.rest);
  const std::vector<Vec3> force = test::hessian_product(bending, strip.rest, up);
  Vector f(1 + *std::max_element(number.begin(), number.end()));
  for (std::size_t i = 0; i < number.size(); ++i)
    if (number[i] >= 0) f[number[i]] = -force[i / 3][static_cast<Eigen::Index>(i % 3)];
  const Vector u = solve(strip.hessian(bending, strip.rest, number), f);
  for (std::size_t i = 0; i < number.size(); ++i)
    if (number[i] >= 0) x[i / 3].z() += u[number[i]];
  const std::vector<Vec3> all = test::sum(x, -1, strip.rest);
  const double energy = 0.5 * test::inner(all, test::hessian_product(bending, strip.rest, all));
  return energy / (small * small * (1 - poisson) * width);
}

/// ρ g L³/D at which a strip that stands on edge buckles sideways under its weight.
double lateral_buckling(const std::string& kind, int n) {
  const double poisson = 0.25;
  const Strip strip(triangulated_strip(kind, n, width, true), Vec3::UnitX(), {1, 1, 1, poisson},
                    before_clamp);
  const MembraneEnergy membrane(strip.shell, {1, 1, 1 / (2 * (1 + poisson)), poisson});
  const std::vector<int> plane = strip.freedoms({0, 1}), across = strip.freedoms({2});
  const Vector u = solve(strip.hessian(membrane, strip.rest, plane), strip.load(plane, 1));
  // The membrane's stiffness across the plane is linear in a small load.
  const double small = 1e-7 / u.cwiseAbs().maxCoeff();
  const Sparse geometric = strip.hessian(membrane, strip.moved(plane, u, small), across) / small;
  const Sparse plate = strip.hessian(*strip.bending, strip.rest, across);
  // The load nearest to a guess, by inverse iteration.
  const double guess = 18;
  Eigen::SparseLU<Sparse> factor(plate + guess * geometric);
  Vector w = strip.load(across, 2);
  double gamma = 0;
  for (int i = 0; i < 60; ++i) {
    w = factor.solve(geometric * w).eval();
    w /= w.norm();
    const double next = -w.dot(plate * w) / w.dot(geometric * w);
    if (std::abs(next - gamma) < 1e-8) break;
    gamma = next;
  }
  return gamma;
}

struct Kind {
  std::string name;
  bool regular;
};

class PlateOnAnyMesh : public testing::TestWithParam<Kind> {
 protected:
  /// error(n) is relative to a reference of this accuracy; errors no larger have no order.
  void expect_convergence(const std::function<double(int)>& error, double accuracy = 1e-6) const {
    const bool regular = GetParam().regular;
    const double coarse = std::abs(error(20)), middle = std::abs(error(40)), fine = std::abs(error(80));
    const std::string errors = testing::PrintToString(std::array{coarse, middle, fine});
    EXPECT_LT(middle, regular ? 0.01 : 0.02) << errors;
    EXPECT_LT(coarse, 0.04) << errors;
    EXPECT_LT(fine, 0.004) << errors;
    if (regular && fine > accuracy) {
      EXPECT_GE(std::log2(middle / fine), 1.8) << errors;
    }
  }
  std::string kind() const { return GetParam().name; }
};

TEST_P(PlateOnAnyMesh, CantileverDeflectsByQL4Over8D) {
  expect_convergence([&](int n) {
    const auto [a, b] = loaded_ends(kind(), n, Vec3::UnitX(), {1, 1, 1, 0});
    return (a + b) / 2 * 8 - 1;
  });
}

TEST_P(PlateOnAnyMesh, TorsionHasTheStiffnessOfThePlate) {
  expect_convergence([&](int n) { return torsion(kind(), n) - 1; });
}

// The plate's own numbers: Morley's element on strips of crossed squares, 40, 80 and 160 long, extrapolated,
// which is right to 0.04 %.
const Vec3 oblique(std::cos(std::numbers::pi / 6), std::sin(std::numbers::pi / 6), 0);
constexpr BendingModuli fabric{1, 0.25, 0.5875, 0.3};

TEST_P(PlateOnAnyMesh, ThreadsAt30DegreesBendTheStrip) {
  expect_convergence(
      [&](int n) {
        const auto [a, b] = loaded_ends(kind(), n, oblique, fabric);
        return (a + b) / 2 / 0.187701 - 1;
      },
      4e-4);
}

TEST_P(PlateOnAnyMesh, ThreadsAt30DegreesTwistTheStrip) {
  expect_convergence(
      [&](int n) {
        const auto [a, b] = loaded_ends(kind(), n, oblique, fabric);
        return (a - b) / width / 0.0717044 - 1;
      },
      4e-4);
}

// 18.457 is extrapolated in the same way, on right-angled triangles. The beam's 15.24 is that of strips
// without width.
TEST_P(PlateOnAnyMesh, LateralBucklingIsThatOfThePlate) {
  expect_convergence([&](int n) { return lateral_buckling(kind(), n) / 18.457 - 1; });
}

INSTANTIATE_TEST_SUITE_P(Meshes, PlateOnAnyMesh,
                         testing::Values(Kind{"right", true}, Kind{"left", true}, Kind{"alternating", true},
                                         Kind{"crossed", true}, Kind{"equilateral", true},
                                         Kind{"jittered", false}, Kind{"random", false},
                                         Kind{"delaunay", false}),
                         [](const auto& info) { return info.param.name; });

TEST(CurvedPlate, QuarterCircleBendsAsACurvedBeam) {
  // Clamped at one end and loaded at the other along the axis that its tangent has there:
  // the end moves by P R³/(D w) (3π/4 − 2).
  const int n = 20;
  const double length = std::numbers::pi / 2, load = 1e-3;
  for (const std::string kind : {"right", "alternating"}) {
    Mesh mesh = triangulated_strip(kind, n, width, true);
    std::vector<char> end;
    for (Vec3& p : mesh.positions) {
      const double s = length * p.x();
      end.push_back(p.x() > 1 - 1e-9);
      p = s > 0 ? Vec3(std::sin(s), p.y(), 1 - std::cos(s)) : Vec3(s, p.y(), 0);
    }
    const Strip strip(mesh, Vec3::UnitX(), {1, 1, 1, 0}, before_clamp);
    const MembraneEnergy membrane(strip.shell, {1e5, 1e5, 5e4, 0});
    const std::vector<int> number = strip.freedoms({0, 1, 2});
    Vector f = Vector::Zero(1 + *std::max_element(number.begin(), number.end()));
    double share = 0, moved = 0;
    const auto part = [&](std::size_t v) {
      return strip.rest[v].y() < 1e-9 || strip.rest[v].y() > width - 1e-9 ? 0.5 : 1;
    };
    for (std::size_t v = 0; v < end.size(); ++v) share += end[v] ? part(v) : 0;
    for (std::size_t v = 0; v < end.size(); ++v)
      if (end[v]) f[number[3 * v + 2]] = load * width * part(v) / share;
    const Vector u = solve(
        strip.hessian(*strip.bending, strip.rest, number) + strip.hessian(membrane, strip.rest, number), f);
    for (std::size_t v = 0; v < end.size(); ++v)
      if (end[v]) moved += part(v) / share * u[number[3 * v + 2]];
    EXPECT_NEAR(moved / (load * (3 * std::numbers::pi / 4 - 2)), 1, 0.01) << kind;
  }
}

TEST(SeamOfThreeSheets, BearsMomentsAsAFrame) {
  // Sheets at 120 degrees; two are clamped at their far ends, the third is loaded at its own: half of its
  // moment goes to each of the others, whose ends cannot move. The tip moves by P L³/(D w) (1/3 + 1/8).
  const int n = 20;
  Mesh mesh;
  std::vector<char> end, clamp;
  std::vector<int> seam;
  for (int sheet = 0; sheet < 3; ++sheet) {
    const Mesh part = triangulated_strip("right", n, width, sheet < 2);
    const double angle = 2 * std::numbers::pi / 3 * sheet + 0.3;
    std::vector<int> id;
    for (const Vec3& p : part.positions) {
      const double away = sheet < 2 ? 1 - p.x() : p.x();
      int known = -1;
      for (const int v : seam)
        if (away < 1e-9 && std::abs(mesh.positions[static_cast<std::size_t>(v)].y() - p.y()) < 1e-9)
          known = v;
      id.push_back(known >= 0 ? known : static_cast<int>(mesh.positions.size()));
      if (known >= 0) continue;
      if (away < 1e-9) seam.push_back(id.back());
      mesh.positions.emplace_back(away * std::cos(angle), p.y(), away * std::sin(angle));
      clamp.push_back(sheet < 2 && away > 1 - 1e-9);
      end.push_back(sheet == 2 && away > 1 - 1e-9);
    }
    for (std::size_t f = 0; f < part.face_count(); ++f) {
      std::array<int, 3> face{};
      for (std::size_t c = 0; c < 3; ++c) face[c] = id[static_cast<std::size_t>(part.face(f)[c])];
      mesh.add_face(face);
    }
  }
  std::size_t next = 0;
  const Strip strip(mesh, Vec3(0.1, 0, 0.2), {1, 1, 1, 0}, [&](const Vec3&) { return clamp[next++] != 0; });
  const MembraneEnergy membrane(strip.shell, {1e5, 1e5, 5e4, 0});
  const std::vector<int> number = strip.freedoms({0, 1, 2});
  const double angle = 4 * std::numbers::pi / 3 + 0.3;
  const Vec3 across(-std::sin(angle), 0, std::cos(angle));
  Vector f = Vector::Zero(1 + *std::max_element(number.begin(), number.end()));
  const auto part = [&](std::size_t v) {
    return strip.rest[v].y() < 1e-9 || strip.rest[v].y() > width - 1e-9 ? 0.5 : 1;
  };
  double share = 0, moved = 0;
  for (std::size_t v = 0; v < end.size(); ++v) share += end[v] ? part(v) : 0;
  const auto at = [&](std::size_t v, Eigen::Index axis) {
    return number[3 * v + static_cast<std::size_t>(axis)];
  };
  for (std::size_t v = 0; v < end.size(); ++v)
    for (Eigen::Index axis : {0, 2})
      if (end[v]) f[at(v, axis)] = width * part(v) / share * across[axis];
  const Vector u = solve(
      strip.hessian(*strip.bending, strip.rest, number) + strip.hessian(membrane, strip.rest, number), f);
  for (std::size_t v = 0; v < end.size(); ++v)
    for (Eigen::Index axis : {0, 2})
      if (end[v]) moved += part(v) / share * u[at(v, axis)] * across[axis];
  EXPECT_NEAR(moved / (1.0 / 3 + 1.0 / 8), 1, 0.01);
}

}  // namespace
}  // namespace muslin
