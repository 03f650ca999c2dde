// The split system against its definition in dense matrices, and the same bits from every kernel.
#include "muslin/solver/eisenstat_pcg.hpp"

#include <cmath>
#include <cstring>

#include "support/lattice_box.hpp"
#include "support/linearized_product.hpp"
#include "support/potential_battery.hpp"
#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "muslin/core/parallel.hpp"
#include "muslin/energy/neo_hookean_energy.hpp"
#include "muslin/energy/spring_energy.hpp"

namespace muslin {
namespace {

/// The couplings of springs are central, those of tetrahedra full.
struct Box {
  Vec3i extent;
  bool solid = false;

  std::unique_ptr<Potential> energy() const {
    const Lattice lattice = test::box_lattice(extent);
    if (solid)
      return std::make_unique<NeoHookeanEnergy>(lattice, SolidModuli{20000, 0.3},
                                                tetrahedron_pattern(lattice));
    return std::make_unique<SpringEnergy>(build_springs(lattice, Bracing::kuhn), 1,
                                          std::array<double, 3>{20000, 100, 100});
  }
};

/// A crumpled box, some of its vertices held, and a few vertices more that nothing couples.
class EisenstatPcgTest : public testing::TestWithParam<Box> {
 protected:
  static constexpr std::size_t loose = 3;
  void SetUp() override {
    energy_ = GetParam().energy();
    x_ = test::rest_positions(test::box_lattice(GetParam().extent));
    const std::vector<Vec3> noise = test::random_vectors(x_.size(), 0.2, 4);
    for (std::size_t v = 0; v < x_.size(); ++v) x_[v] += noise[v];
    body_ = x_.size();
    x_.resize(body_ + loose, Vec3(9, 9, 9));
    masses_.assign(x_.size(), 2);
    for (std::size_t v = 0; v < x_.size(); v += 3) masses_[v] = 5;
    fixed_.assign(x_.size(), 0);
    fixed_[0] = fixed_[body_ / 2] = 1;
    h_.reset(masses_, fixed_, 1.0 / 240 / 240);
    energy_->linearize(std::span(x_).first(body_), h_, 0);
    h_.finish();
  }
  std::vector<Vec3> free_vectors(unsigned seed) const {
    std::vector<Vec3> p = test::random_vectors(x_.size(), 1, seed);
    for (std::size_t v = 0; v < p.size(); ++v)
      if (fixed_[v] != 0) p[v].setZero();
    return p;
  }
  double dot(ConstVectors a, ConstVectors b) const {
    double sum = 0;
    for (std::size_t v = 0; v < a.size(); ++v)
      if (fixed_[v] == 0) sum += a[v].dot(b[v]);
    return sum;
  }

  std::unique_ptr<Potential> energy_;
  std::vector<Vec3> x_;
  std::size_t body_ = 0;
  std::vector<double> masses_;
  std::vector<std::uint8_t> fixed_;
  Linearization h_;
};

TEST_P(EisenstatPcgTest, PreconditionsByASymmetricPositiveDefiniteMatrixAndMultipliesByTheHessian) {
  EisenstatPcg system;
  system.factor(h_);
  const std::vector<Vec3> b = free_vectors(1), c = free_vectors(2);
  std::vector<Vec3> s(b.size()), r(c.size());
  // s = (F Fᵀ)⁻¹ b, its quadratic form and that of H.
  const double rr = system.start(b, 1);
  const double curvature = system.direction(0, 0);
  system.solution(1, 1, s);
  EXPECT_GT(rr, 0);
  EXPECT_NEAR(rr, dot(b, s), 1e-4 * rr);
  const std::vector<Vec3> hs = test::product(h_, s);
  EXPECT_NEAR(curvature, dot(s, hs), 1e-4 * rr);
  // F⁻¹ (b − 0.3 H s) by recurrence and anew.
  const double by_recurrence = system.residual(0.3);
  std::vector<Vec3> rest = b;
  for (std::size_t v = 0; v < b.size(); ++v)
    rest[v] = fixed_[v] != 0 ? Vec3(Vec3::Zero()) : Vec3(b[v] - 0.3 * hs[v]);
  EXPECT_NEAR(by_recurrence, system.start(rest, 1), 1e-4 * rr);
  // Symmetric: bᵀ P c = cᵀ P b.
  system.start(c, 1);
  system.direction(0, 0);
  system.solution(1, 1, r);
  EXPECT_NEAR(dot(b, r), dot(c, s), 1e-4 * rr);
  for (std::size_t v = 0; v < b.size(); ++v) {
    if (fixed_[v] != 0) {
      EXPECT_EQ(s[v], Vec3::Zero());
    }
    if (v >= body_) {
      EXPECT_LE((s[v] - b[v] / masses_[v]).norm(), 1e-6);
    }
  }
}

TEST(EisenstatPcg, KeepsPrecisionOfLightVerticesBesideAStiffBody) {
  const auto pattern = std::make_shared<const SymmetricPattern>(std::vector<std::pair<int, int>>{{0, 1}}, 2);
  constexpr std::size_t light = 10;
  const std::vector<double> masses(light + 2, 1e-4);
  const std::vector<std::uint8_t> fixed(light + 2, 0);
  Linearization h;
  h.reset(masses, fixed, 1);
  SymmetricMatrix& stiff = h.matrix(pattern, light);
  for (int v = 0; v < 2; ++v)
    for (int k = 0; k < 3; ++k) stiff.block(pattern->find(v, v))[k][k] = 1e5F;
  h.finish();
  EisenstatPcg system;
  system.factor(h);
  std::vector<Vec3> b = test::random_vectors(masses.size(), 1, 3);
  b[light].setZero(), b[light + 1].setZero();
  const double rr = system.start(b, 1);
  system.direction(0, 0);
  EXPECT_LT(system.residual(1), 1e-8 * rr);  // nothing couples what is light: the preconditioner is H
}

TEST_P(EisenstatPcgTest, AddsCorrectionsToItsDirections) {
  EisenstatPcg system;
  system.factor(h_);
  const EliminationOrder& pattern = h_.sets()[0]->pattern();
  const std::vector<Vec3> b = free_vectors(1), c = free_vectors(5);
  std::vector<Vec3> s(b.size()), plain(b.size());
  system.start(b, 1);
  system.direction(0, 0);
  system.solution(1, 1, plain);
  system.start(b, 1);
  system.find_product();
  // The residual comes back from between the halves of the factorisation.
  const auto place = [](std::size_t i) { return i / 16 * 48 + i % 16; };
  for (std::size_t v = 0; v < body_; ++v) {
    const auto i = place(static_cast<std::size_t>(pattern.position(v)));
    const float* const r = system.product();
    if (fixed_[v] == 0) {
      EXPECT_LE((Vec3(r[i], r[i + 16], r[i + 32]) - b[v]).norm(), 1e-4) << v;
    }
  }
  // t = (F Fᵀ)⁻¹ b + c on the body; its quadratic form is that of H.
  const Floats correction = system.correction();
  std::size_t positions = 0;
  for (const SpringHessian* set : h_.sets()) positions += set->pattern().position_count();
  for (float* each : {correction.x, correction.y, correction.z}) std::fill_n(each, positions, 0.0F);
  for (std::size_t v = 0; v < body_; ++v) {
    const auto i = pattern.position(v);
    correction.x[i] = static_cast<float>(c[v].x()), correction.y[i] = static_cast<float>(c[v].y());
    correction.z[i] = static_cast<float>(c[v].z());
  }
  const double curvature = system.corrected_direction(0, 0);
  const double by_recurrence = system.residual_and_product(0.2);
  for (std::size_t v = 0; v < body_; v += 7) {
    const auto i = place(static_cast<std::size_t>(pattern.position(v)));
    EXPECT_TRUE(std::isfinite(system.product()[i]));
  }
  system.solution(1, 1, s);
  std::vector<Vec3> expected = plain;
  for (std::size_t v = 0; v < body_; ++v) expected[v] += c[v];
  for (std::size_t v = 0; v < b.size(); ++v) EXPECT_LE((s[v] - expected[v]).norm(), 1e-4) << v;
  const std::vector<Vec3> hs = test::product(h_, expected);
  const double form = dot(expected, hs);
  EXPECT_NEAR(curvature, form, 1e-4 * std::abs(form));
  std::vector<Vec3> rest = b;
  for (std::size_t v = 0; v < b.size(); ++v)
    rest[v] = fixed_[v] != 0 ? Vec3(Vec3::Zero()) : Vec3(b[v] - 0.2 * hs[v]);
  EXPECT_NEAR(by_recurrence, system.start(rest, 1), 1e-4 * std::abs(by_recurrence));
}

TEST_P(EisenstatPcgTest, HasTheSameBitsForAnyThreadCount) {
  const std::vector<Vec3> b = free_vectors(1);
  std::vector<std::vector<Vec3>> solutions;
  for (const int threads : {1, 2, 7}) {
    set_thread_count(threads);
    EisenstatPcg system;
    system.factor(h_);
    double rr = system.start(b, 1), alpha = 0, beta = 0;
    for (int i = 0; i < 5; ++i) {
      alpha = rr / system.direction(alpha, beta);
      const double next = system.residual(alpha);
      beta = next / rr, rr = next;
    }
    solutions.emplace_back(b.size());
    system.solution(alpha, 1, solutions.back());
  }
  set_thread_count(0);
  for (const auto& s : solutions)
    EXPECT_EQ(std::memcmp(s.data(), solutions[0].data(), s.size() * sizeof(Vec3)), 0);
}

TEST_P(EisenstatPcgTest, RecoversFromASolveThatOverflowed) {
  EisenstatPcg system;
  system.factor(h_);
  const std::vector<Vec3> b = free_vectors(1);
  const double rr = system.start(b, 1);
  EXPECT_FALSE(std::isfinite(system.start(b, 1e38) + system.direction(0, 0)));
  EXPECT_EQ(system.start(b, 1), rr);
}

INSTANTIATE_TEST_SUITE_P(Boxes, EisenstatPcgTest,
                         testing::Values(Box{{1, 1, 1}}, Box{{12, 5, 1}}, Box{{6, 7, 8}}, Box{{100, 60, 1}},
                                         Box{{1, 1, 1}, true}, Box{{12, 5, 1}, true}, Box{{6, 7, 8}, true},
                                         Box{{40, 30, 9}, true}));

TEST(EisenstatPcg, IsExactOnALine) {
  // A chain of vertices with couplings B = s sᵀ: its factorisation has no fill, so that one iteration solves.
  const int count = 200;
  const auto pattern =
      std::make_shared<const EliminationOrder>(std::vector<CouplingRun>{{0, 0, 1, count - 1}}, count);
  const std::vector<double> masses(count, 0.01);
  std::vector<std::uint8_t> fixed(count, 0);
  fixed[70] = 1;
  Linearization h;
  h.reset(masses, fixed, 1);
  SpringHessian& couplings = h.couplings(pattern, 0);
  for (std::size_t b = 0; b < pattern->block_count(); ++b) {
    float sx[16] = {}, sy[16] = {}, sz[16] = {}, t[16] = {};
    for (int l = 0; l < 16; ++l) {
      if ((pattern->blocks()[b].used >> l & 1) == 0) continue;
      sx[l] = 1, sy[l] = 0.5F, sz[l] = -0.25F, t[l] = 0.125F;
    }
    couplings.store(b, 1, sx, sy, sz, t);
  }
  h.finish();
  EisenstatPcg system;
  system.factor(h);
  std::vector<Vec3> b = test::random_vectors(count, 1, 1);
  b[70].setZero();
  const double rr = system.start(b, 1);
  const double alpha = rr / system.direction(0, 0);
  EXPECT_NEAR(alpha, 1, 1e-4);
  EXPECT_LE(system.residual(alpha), 1e-6 * rr);
}

class SweepKernels : public testing::TestWithParam<bool> {};

TEST_P(SweepKernels, AllHaveTheSameBits) {
  const Box box{{20, 12, 2}, GetParam()};
  const auto kind = box.solid ? sweep_kernels::Couplings::full : sweep_kernels::Couplings::central;
  std::vector<Vec3> x = test::rest_positions(test::box_lattice(box.extent));
  const std::vector<Vec3> noise = test::random_vectors(x.size(), 0.2, 4);
  for (std::size_t v = 0; v < x.size(); ++v) x[v] += noise[v];
  const std::vector<double> masses(x.size(), 1);
  const std::vector<std::uint8_t> fixed(x.size(), 0);
  Linearization h;
  h.reset(masses, fixed, 1e-4);
  const auto energy = box.energy();
  energy->linearize(x, h, 0);
  h.finish();
  ASSERT_EQ(h.sets().size(), 1U);
  const SpringHessian& couplings = *h.sets()[0];
  const FullCouplings* const full = h.full(couplings);
  ASSERT_EQ(full != nullptr, box.solid);
  const EliminationOrder& pattern = couplings.pattern();
  const std::size_t positions = pattern.position_count();

  std::vector<std::vector<float>> results;
  for (const sweep_kernels::Kernels* kernels : sweep_kernels::all_kernels(kind)) {
    const std::size_t groups = pattern.groups().size();
    std::vector<float> identity(positions, 0), m(6 * positions), flat(3 * positions), vectors(15 * positions),
        units(2 * groups);
    std::vector<std::uint32_t> packed(8 * positions);
    std::vector<std::uint16_t> free(pattern.groups().size());
    for (std::size_t i = 0; i < positions; ++i) {
      if (pattern.vertex(i) < 0) continue;
      identity[i] = 1;
      free[i / 16] = static_cast<std::uint16_t>(free[i / 16] | 1U << i % 16);
    }
    sweep_kernels::Sweep sweep;
    sweep.group_begin = pattern.tasks()[0].group_begin;
    sweep.group_end = pattern.tasks()[0].group_end;
    ASSERT_EQ(pattern.tasks().size(), 1U);
    sweep.groups = pattern.groups().data();
    sweep.blocks = pattern.blocks().data();
    sweep.links = pattern.links().data();
    sweep.coefficients = full ? full->coefficients() : couplings.coefficients();
    sweep.units = full ? full->units() : couplings.units();
    sweep.pivots = {packed.data(), units.data()};
    sweep.excess = {packed.data() + 4 * positions, units.data() + groups};
    sweep.flat = {flat.data(), flat.data() + positions, flat.data() + 2 * positions};
    sweep_kernels::Diagonal diagonal;
    diagonal.identity = identity.data();
    diagonal.free = free.data();
    const Floats upper = {m.data(), m.data() + positions, m.data() + 2 * positions};
    const Floats lower = upper + static_cast<std::ptrdiff_t>(3 * positions);
    const float stiffest = kernels->factor(sweep, diagonal, upper, lower);
    float* const r = vectors.data();
    float *const p = r + 3 * positions, *const y = p + 3 * positions, *const c = y + 3 * positions,
                 *const further = c + 3 * positions;
    for (std::size_t i = 0; i < 3 * positions; ++i) further[i] = static_cast<float>(i % 13) - 6.0F;
    for (std::size_t i = 0; i < 3 * positions; ++i) r[i] = static_cast<float>(i % 97) - 48.0F;
    const double rr = kernels->solve_forward(sweep, r);
    const double curvature = kernels->direction(sweep, 0.5F, 0.25F, r, y, p, c);
    const double next = kernels->residual(sweep, 0.3F, c, nullptr, r);
    std::vector<float> other(3 * positions);
    for (std::size_t i = 0; i < other.size(); ++i)
      if (identity[i % positions] > 0) other[i] = static_cast<float>(i % 31) - 15.0F;
    const Floats correction = {other.data(), other.data() + positions, other.data() + 2 * positions};
    const double corrected = kernels->corrected_direction(sweep, 0.5F, 0.25F, r, y, p, c, correction);
    const double last = kernels->residual_and_product(sweep, 0.1F, c, further, r, correction);
    kernels->solve_backward(sweep, 0.1F, y, p);
    std::vector<float> result = {stiffest,
                                 static_cast<float>(rr),
                                 static_cast<float>(curvature),
                                 static_cast<float>(next),
                                 static_cast<float>(corrected),
                                 static_cast<float>(last)};
    for (const std::uint32_t word : packed) result.push_back(static_cast<float>(word));
    for (const auto* part : {&units, &flat, &vectors, &other})
      result.insert(result.end(), part->begin(), part->end());
    results.push_back(std::move(result));
  }
  for (const auto& result : results)
    EXPECT_EQ(std::memcmp(result.data(), results[0].data(), result.size() * sizeof(float)), 0);
}

INSTANTIATE_TEST_SUITE_P(CentralAndFull, SweepKernels, testing::Bool());

}  // namespace
}  // namespace muslin
