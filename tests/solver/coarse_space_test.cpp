// The coarse space against its definition in dense matrices, and what it is for: numbers of iterations that
// stay as they are however fine a body is cut.
#include "muslin/solver/coarse_space.hpp"

#include <cmath>
#include <cstring>

#include "support/flag.hpp"
#include "support/linearized_product.hpp"
#include "support/potential_battery.hpp"
#include "support/sheet.hpp"
#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "muslin/core/parallel.hpp"
#include "muslin/energy/membrane_energy.hpp"
#include "muslin/energy/shell_bending.hpp"
#include "muslin/energy/spring_energy.hpp"
#include "muslin/potential/restricted.hpp"
#include "muslin/solver/solver.hpp"

namespace muslin {
namespace {

/// By vertex, what CoarseSpace reads and writes by position.
class ByVertex {
 public:
  ByVertex(CoarseSpace& space, const Linearization& h) : space_(space), place_(h.size()) {
    for (const SpringHessian* set : h.sets()) {
      for (std::size_t i = 0; i < set->pattern().position_count(); ++i)
        if (const int v = set->pattern().vertex(i); v >= 0)
          place_[set->first() + static_cast<std::size_t>(v)] = positions_ + i;
      positions_ += set->pattern().position_count();
    }
  }
  /// t, and rᵀt as the space has it.
  std::vector<Vec3> correct(ConstVectors r, double& product) {
    std::vector<float> from(3 * positions_, 0);
    for (std::size_t v = 0; v < r.size(); ++v)
      for (std::size_t c = 0; c < 3; ++c)
        from[place_[v] / 16 * 48 + 16 * c + place_[v] % 16] = static_cast<float>(r[v][static_cast<int>(c)]);
    FloatVectors to;
    to.resize(positions_);
    product = space_.correct(from.data(), to.data());
    std::vector<Vec3> t(r.size());
    for (std::size_t v = 0; v < r.size(); ++v) {
      const std::size_t i = place_[v];
      t[v] = Vec3(to.data().x[i], to.data().y[i], to.data().z[i]);
    }
    return t;
  }

 private:
  CoarseSpace& space_;
  std::vector<std::size_t> place_;
  std::size_t positions_ = 0;
};

/// Input of tests of the linear algebra: two lattices with pins, one of them with a hole, at any x, and a
/// potential that is neither couplings nor blocks.
struct Bodies {
  explicit Bodies(double noise) {
    add({26, 18, 1}, Vec3::Zero(), {});
    add({9, 11, 8}, Vec3(40, 0, 0), {4, 5});
    x = rest;
    const std::vector<Vec3> moved = test::random_vectors(x.size(), noise, 4);
    for (std::size_t v = 0; v < x.size(); ++v) x[v] += moved[v];
    masses.assign(x.size(), 2);
    for (std::size_t v = 0; v < x.size(); v += 3) masses[v] = 5;
    fixed.assign(x.size(), 0);
    fixed[0] = fixed[20] = fixed[first[1] + 7] = 1;
    linearize();
  }
  void linearize() {
    h.reset(masses, fixed, 1.0 / 24 / 24);
    for (std::size_t b = 0; b < springs.size(); ++b)
      springs[b]->linearize(std::span(x).subspan(first[b], count[b]), h, first[b]);
    h.finish();
  }
  void add(const Vec3i& extent, const Vec3& at, const std::vector<int>& without_columns) {
    Lattice lattice = test::box_lattice(extent);
    std::erase_if(lattice.voxels, [&](const Vec3i& voxel) {
      return voxel.y() < 8 &&
             std::find(without_columns.begin(), without_columns.end(), voxel.x()) != without_columns.end();
    });
    Springs all = build_springs(lattice, Bracing::kuhn);
    springs.push_back(std::make_unique<SpringEnergy>(all, 1, std::array<double, 3>{20000, 100, 100}));
    first.push_back(rest.size());
    count.push_back(lattice.vertex_count());
    for (const Vec3& p : test::rest_positions(lattice)) rest.push_back(p + at);
  }

  std::vector<std::unique_ptr<SpringEnergy>> springs;
  std::vector<std::size_t> first, count;
  std::vector<Vec3> rest, x;
  std::vector<double> masses;
  std::vector<std::uint8_t> fixed;
  Linearization h;
};

double dot(ConstVectors a, ConstVectors b) {
  double sum = 0;
  for (std::size_t v = 0; v < a.size(); ++v) sum += a[v].dot(b[v]);
  return sum;
}

TEST(CoarseSpace, IsTheGalerkinInverseWhereCouplingsAreEqual) {
  // A sheet at rest: all springs of a direction are the same, and the coarse matrix is factorised.
  test::Flag flag({26, 18, 1});
  flag.hold_top_corners();
  Linearization h;
  h.reset(flag.masses, flag.fixed, 1.0 / 24 / 24);
  flag.springs->linearize(flag.rest, h, 0);
  h.finish();
  CoarseSpace space(h, flag.rest);
  ASSERT_FALSE(space.empty());
  space.assemble(h);
  ByVertex by_vertex(space, h);

  const std::vector<int> component(flag.rest.size(), 0);
  const BackgroundGrid grid(flag.rest, component, std::array{8.0});
  const auto nodes = static_cast<Eigen::Index>(grid.node_count());
  ASSERT_EQ(nodes, 5 * 4);
  Eigen::MatrixXd z = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(3 * flag.rest.size()), 3 * nodes);
  for (std::size_t v = 0; v < flag.rest.size(); ++v) {
    if (flag.fixed[v] != 0) continue;
    float w[8];
    const BackgroundGrid::Cell& cell = grid.weights(grid.point(v), w);
    for (int k = 0; k < cell.count; ++k)
      for (Eigen::Index c = 0; c < 3; ++c)
        z(static_cast<Eigen::Index>(3 * v) + c, 3 * cell.nodes[static_cast<std::size_t>(k)] + c) +=
            static_cast<double>(w[k]);
  }
  Eigen::MatrixXd hz(z.rows(), z.cols());
  for (Eigen::Index k = 0; k < z.cols(); ++k) {
    std::vector<Vec3> p(flag.rest.size());
    for (std::size_t v = 0; v < p.size(); ++v) p[v] = z.block<3, 1>(static_cast<Eigen::Index>(3 * v), k);
    const std::vector<Vec3> y = test::product(h, p);
    for (std::size_t v = 0; v < p.size(); ++v) hz.block<3, 1>(static_cast<Eigen::Index>(3 * v), k) = y[v];
  }
  const Eigen::MatrixXd galerkin = z.transpose() * hz;
  const std::vector<Vec3> r = test::random_vectors(flag.rest.size(), 1, 1);
  Eigen::VectorXd flat(z.rows());
  for (std::size_t v = 0; v < r.size(); ++v) flat.segment<3>(static_cast<Eigen::Index>(3 * v)) = r[v];
  const Eigen::VectorXd expected = z * galerkin.ldlt().solve(z.transpose() * flat);
  double product;
  const std::vector<Vec3> t = by_vertex.correct(r, product);
  for (std::size_t v = 0; v < t.size(); ++v) {
    EXPECT_LE((t[v] - expected.segment<3>(static_cast<Eigen::Index>(3 * v))).norm(),
              2e-3 * expected.norm() / std::sqrt(t.size()))
        << v;
  }
  EXPECT_NEAR(product, flat.dot(expected), 1e-3 * product);
}

TEST(CoarseSpace, IsSymmetricPositiveAndSeparatesHeldVerticesAndBodies) {
  for (const double noise : {0.0, 0.2, 3.0}) {
    Bodies bodies(noise);
    CoarseSpace space(bodies.h, bodies.rest);
    space.assemble(bodies.h);
    ByVertex by_vertex(space, bodies.h);
    const std::vector<Vec3> p = test::random_vectors(bodies.rest.size(), 1, 1),
                            q = test::random_vectors(bodies.rest.size(), 1, 2);
    double pp, qq;
    const std::vector<Vec3> cp = by_vertex.correct(p, pp), cq = by_vertex.correct(q, qq);
    EXPECT_GT(pp, 0);
    EXPECT_GT(qq, 0);
    EXPECT_NEAR(dot(p, cp), pp, 1e-4 * pp);
    EXPECT_NEAR(dot(q, cp), dot(p, cq), 1e-4 * pp);
    for (std::size_t v = 0; v < p.size(); ++v) {
      if (bodies.fixed[v] != 0) {
        EXPECT_EQ(cp[v], Vec3::Zero());
      }
    }
    // A residual on one body moves nothing of the other.
    std::vector<Vec3> only = p;
    std::fill(only.begin() + static_cast<std::ptrdiff_t>(bodies.first[1]), only.end(), Vec3::Zero());
    const std::vector<Vec3> c = by_vertex.correct(only, pp);
    for (std::size_t v = bodies.first[1]; v < c.size(); ++v) EXPECT_EQ(c[v], Vec3::Zero());
  }
}

TEST(CoarseSpace, FollowsTheVerticesThatAreHeld) {
  Bodies bodies(0.1);
  CoarseSpace space(bodies.h, bodies.rest);
  space.assemble(bodies.h);
  std::fill(bodies.fixed.begin(), bodies.fixed.end(), std::uint8_t{0});
  bodies.fixed[100] = 1;
  bodies.linearize();
  ASSERT_TRUE(space.fits(bodies.h, bodies.rest));
  space.assemble(bodies.h);
  CoarseSpace anew(bodies.h, bodies.rest);
  anew.assemble(bodies.h);
  const std::vector<Vec3> r = test::random_vectors(bodies.rest.size(), 1, 1);
  double a, b;
  const std::vector<Vec3> t = ByVertex(space, bodies.h).correct(r, a),
                          u = ByVertex(anew, bodies.h).correct(r, b);
  EXPECT_EQ(std::memcmp(t.data(), u.data(), t.size() * sizeof(Vec3)), 0);
  EXPECT_EQ(t[100], Vec3::Zero());
}

/// A square of cloth, 1 m wide, of n by n squares, hanging from two corners.
struct Cloth {
  explicit Cloth(int n) {
    Mesh mesh = test::flat_sheet(n, n, 1, 1);
    test::add_flat_uvs(mesh);
    const Shell shell = build_shell(mesh, mesh.positions, {});
    const auto pattern = block_pattern(shell);
    membrane = std::make_unique<MembraneEnergy>(shell, MembraneModuli{1000, 1000, 400, 0.3}, pattern);
    bending = std::make_unique<ShellBending>(shell, BendingModuli{1e-5, 1e-5, 1e-5}, pattern);
    for (const double area : shell.vertex_areas) masses.push_back(0.2 * area);
    gravity = std::make_unique<test::UniformGravity>(masses, Vec3(0, -9.8, 0));
    rest = mesh.positions;
    fixed.assign(rest.size(), 0);
    fixed[0] = fixed[static_cast<std::size_t>(n)] = 1;
    state.positions = rest;
    state.velocities.assign(rest.size(), Vec3::Zero());
  }
  /// Newton and linear iterations of some steps.
  std::pair<int, int> steps(int count, bool coarse, int threads = 0) {
    set_thread_count(threads);
    SolverSettings settings;
    settings.effort = Effort::exact;
    StepProblem problem{masses, {membrane.get(), bending.get(), gravity.get()}, fixed, rest};
    if (coarse) problem.rest_positions = rest;
    Stepper stepper;
    std::pair<int, int> iterations;
    for (int i = 0; i < count; ++i) {
      const StepContext context = step_context(settings.integrator, state, 1.0 / 240);
      const StepReport report = stepper.step(settings, context, problem, state);
      EXPECT_TRUE(report.converged) << report.failure;
      iterations.first += report.newton_iterations;
      iterations.second += report.linear_iterations;
    }
    set_thread_count(0);
    return iterations;
  }

  std::unique_ptr<MembraneEnergy> membrane;
  std::unique_ptr<ShellBending> bending;
  std::unique_ptr<test::UniformGravity> gravity;
  std::vector<Vec3> rest;
  std::vector<double> masses;
  std::vector<std::uint8_t> fixed;
  State state;
};

TEST(CoarseSpace, KeepsTheIterationsOfClothAtAnyResolution) {
  double coarsest = 0;
  for (const int n : {25, 50, 100}) {
    const auto [newton, linear] = Cloth(n).steps(6, true);
    const double each = static_cast<double>(linear) / newton;
    RecordProperty("linear_per_newton_" + std::to_string(n), std::to_string(each));
    if (n == 25) coarsest = each;
    EXPECT_LE(each, 1.5 * coarsest + 2) << n;
    if (n == 100) {
      const auto [newton_without, linear_without] = Cloth(n).steps(6, false);
      EXPECT_GE(static_cast<double>(linear_without) / newton_without, 4 * each);
    }
  }
}

/// Iterations of one linear system of the thesis's flag cut into voxels of 1/`cut` m, after it hung for a
/// step of 1/8 s.
int lattice_iterations(int cut, bool coarse) {
  test::Flag flag({10 * cut, 6 * cut, 1}, {20000, 100, 100}, 1.0 / cut);
  flag.hold_top_corners();
  SolverSettings settings;
  settings.integrator = Integrator::linearly_implicit_euler;
  settings.linear_tolerance = 1e-5;
  StepProblem problem = flag.problem();
  if (coarse) problem.rest_positions = flag.rest;
  int iterations = 0;
  for (int n = 0; n < 2; ++n) {
    const StepContext context = step_context(settings.integrator, flag.state, 1.0 / 8);
    const StepReport report = solve_step(settings, context, problem, flag.state);
    EXPECT_TRUE(report.converged) << report.failure;
    iterations = report.linear_iterations;
  }
  return iterations;
}

TEST(CoarseSpace, BoundsTheIterationsOfLatticesAtAnyResolution) {
  // k dt²/m is 1600 for the first and 16 times as much for the last. Below some 40 iterations the coarse
  // space stays off, and two solves are refined into one.
  for (const int cut : {5, 10, 20}) EXPECT_LE(lattice_iterations(cut, true), 90) << cut;
  EXPECT_GE(lattice_iterations(20, false), 1.8 * lattice_iterations(20, true));
}

TEST(CoarseSpace, HasTheSameBitsForAnyThreadCount) {
  std::vector<State> states;
  for (const int threads : {1, 2, 5}) {
    Cloth cloth(60);
    cloth.steps(4, true, threads);
    states.push_back(cloth.state);
  }
  for (const State& state : states)
    EXPECT_EQ(std::memcmp(state.positions.data(), states[0].positions.data(),
                          state.positions.size() * sizeof(Vec3)),
              0);
}

TEST(CoarseSpace, DoesNotChangeTheSolutionOfAStep) {
  Cloth with(40), without(40);
  with.steps(10, true);
  without.steps(10, false);
  for (std::size_t v = 0; v < with.rest.size(); ++v)
    EXPECT_LE((with.state.positions[v] - without.state.positions[v]).norm(), 1e-4) << v;
}

}  // namespace
}  // namespace muslin
