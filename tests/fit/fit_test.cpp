// Known fabrics are found again from measurements made of them, with noise.
#include "muslin/fit/fit.hpp"

#include <array>
#include <cmath>
#include <memory>
#include <limits>
#include <numbers>
#include <random>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "muslin/core/parallel.hpp"
#include "muslin/energy/measured_membrane_law.hpp"
#include "muslin/fit/elastica.hpp"
#include "muslin/material/measured_sheet.hpp"
#include "muslin/scene/model.hpp"
#include "muslin/scene/scene.hpp"
#include "muslin/simulation/simulation.hpp"

namespace muslin {
namespace {

using testing::HasSubstr;

constexpr double gravity = 9.80665;

Measured exactly(double x) { return {x, std::nullopt}; }

/// A fabric with curves, and noisy tests of it.
class KnownFabric {
 public:
  ShellMaterial sheet = known();
  double noise = 0.01;

  Measurements tests(int specimens) {
    Measurements m;
    m.name = "known";
    m.areal_density = Measured{sheet.areal_density, 0.001};
    m.poisson = exactly(sheet.poisson);
    for (int i = 0; i < specimens; ++i) {
      m.tensile.push_back(strip(Thread::warp));
      m.tensile.push_back(strip(Thread::weft));
      m.shear.push_back(frame());
    }
    m.bending.push_back(cantilever(Thread::warp, sheet.bending_warp));
    m.bending.push_back(cantilever(Thread::weft, sheet.bending_weft));
    return m;
  }

  TensileTest strip(Thread direction) {
    const SheetStress stress = stress_of(sheet);
    const StressCurve& curve = direction == Thread::warp ? stress.warp : stress.weft;
    TensileTest test;
    test.direction = direction;
    for (int i = 1; i <= 25; ++i) {
      const double strain = 0.06 * i / 25;
      test.points.emplace_back(strain, noisy((1 + strain) * curve.stress(strain * (1 + strain / 2))));
    }
    return test;
  }

  ShearTest frame() {
    const StressCurve curve = stress_of(sheet).shear;
    ShearTest test;
    for (double angle = 0.5; angle <= 8; angle += 0.5) {
      const double radians = angle * std::numbers::pi / 180;
      test.points.emplace_back(angle, noisy(curve.stress(std::sin(radians)) * std::cos(radians)));
    }
    return test;
  }

  /// A strip along the bias, by minimising the energy of the law over what is free.
  TensileTest bias() {
    const SheetStress s = stress_of(sheet);
    const double nu = sheet.poisson, rest = 1 - nu * nu, p = s.warp.slope(0), q = s.weft.slope(0);
    constexpr double elastic = std::numeric_limits<double>::infinity();
    const MeasuredMembraneLaw::Constants c{{p / rest, nu * std::sqrt(p * q) / rest, q / rest, elastic, elastic},
                                           s.warp.plus(-p),
                                           s.weft.plus(-q),
                                           s.shear};
    const auto energy = [&](double stretch, double uu, double vv) {
      const double along = (stretch * stretch - 1) / 2;  // E_mm
      return MeasuredMembraneLaw::energy(c, 1, {2 * uu + 1, 2 * vv + 1, 2 * along - uu - vv});
    };
    const auto least = [&](double stretch) {
      double uu = 0, vv = 0;
      for (double step = 0.01; step > 1e-9; step /= 2)
        for (int i = 0; i < 40; ++i)
          for (double* x : {&uu, &vv})
            for (const double change : {-step, step}) {
              const double before = energy(stretch, uu, vv);
              *x += change;
              if (energy(stretch, uu, vv) >= before) *x -= change;
            }
      return energy(stretch, uu, vv);
    };
    TensileTest test;
    test.direction = Thread::bias;
    for (double strain = 0.005; strain <= 0.05; strain += 0.005)
      test.points.emplace_back(strain, (least(1 + strain + 1e-4) - least(1 + strain - 1e-4)) / 2e-4);
    return test;
  }

  BendingTest cantilever(Thread direction, double rigidity) {
    // Half the overhang: by the inverse of a length of 1.
    const double share = cantilever_bending_length(1, 41.5 * std::numbers::pi / 180);
    const double length = std::cbrt(rigidity / (sheet.areal_density * gravity));
    BendingTest test;
    test.direction = direction;
    test.bending_length = Measured{noisy(length / share / 2), 0.01 * length};
    return test;
  }

 private:
  static ShellMaterial known() {
    ShellMaterial m;
    m.areal_density = 0.12;
    m.warp_curve = {{0.01, 20}, {0.02, 60}, {0.03, 130}, {0.045, 280}, {0.06, 480}};
    m.weft_curve = {{0.015, 12}, {0.03, 35}, {0.045, 80}, {0.06, 160}};
    m.shear_curve = {{1, 0.8}, {3, 2.1}, {5, 3.6}, {8, 6.8}};
    m.poisson = 0.2;
    m.bending_warp = 1.1e-5;
    m.bending_weft = 7e-6;
    m.bending_bias = 8e-6;
    return m;
  }
  double noisy(double x) { return x * (1 + noise * normal_(random_)); }

  std::mt19937 random_{5};
  std::normal_distribution<double> normal_;
};

const FittedValue& value_of(const Fit& fit, const std::string& key) {
  for (const FittedValue& value : fit.values)
    if (value.key == key) return value;
  throw std::invalid_argument(key);
}

TEST(Fit, FindsAKnownFabricWithinTheNoise) {
  KnownFabric fabric;
  const Fit fit = fit_fabric(fabric.tests(3));
  const SheetStress known = stress_of(fabric.sheet), found = stress_of(*fit.material.shell);
  for (double strain = 0.01; strain < 0.06; strain += 0.002) {
    EXPECT_NEAR(found.warp.stress(strain), known.warp.stress(strain), 0.02 * known.warp.stress(strain) + 0.5);
    EXPECT_NEAR(found.weft.stress(strain), known.weft.stress(strain), 0.02 * known.weft.stress(strain) + 0.5);
  }
  for (double shear = 0.02; shear < 0.13; shear += 0.01)
    EXPECT_NEAR(found.shear.stress(shear), known.shear.stress(shear), 0.02 * known.shear.stress(shear));
  EXPECT_NEAR(value_of(fit, "warp_curve").residual.value(), fabric.noise, 0.5 * fabric.noise);
  for (const auto& [key, rigidity] :
       {std::pair{"bending_warp", fabric.sheet.bending_warp}, {"bending_weft", fabric.sheet.bending_weft}}) {
    const FittedValue& bending = value_of(fit, key);
    EXPECT_NEAR(bending.value, rigidity, 3 * *bending.plus_minus) << key;
    EXPECT_LT(*bending.plus_minus, 0.05 * rigidity) << key;
  }
  EXPECT_EQ(fit.material.guesses, (std::vector<std::string>{"shell.stiffness_damping",
                                                            "shell.bending_damping", "shell.bending_bias"}));
}

TEST(Fit, BiasStripGivesTheShear) {
  KnownFabric fabric;
  fabric.noise = 0;
  Measurements m = fabric.tests(1);
  m.shear.clear();
  m.tensile.push_back(fabric.bias());
  const SheetStress known = stress_of(fabric.sheet), found = stress_of(*fit_fabric(m).material.shell);
  for (double shear = 0.02; shear < 0.08; shear += 0.01)
    EXPECT_NEAR(found.shear.stress(shear), known.shear.stress(shear), 0.01 * known.shear.stress(shear))
        << shear;
}

/// The force per width of a simulated strip with clamped ends.
double clamped_force(const ShellMaterial& sheet, double width, double length, double strain) {
  const auto energy = [&](double pull) {
    Scene scene = parse_scene(fmt::format(R"(
[time]
frame_rate = 1e-4
steps_per_frame = 1
duration = 1e4
[solver]
effort = "exact"
[[body]]
name = "strip"
mesh = "strip"
model = "shell"
warp = [1, 0, 0]
material = {{ areal_density = 0.1, membrane_warp = 1000, bending_warp = 1e-5 }}
contact = false
[[pin]]
where = {{ plane = {{ point = [0, 0, 0], normal = [1, 0, 0], distance = 1e-6 }} }}
[[pin]]
where = {{ plane = {{ point = [{0}, 0, 0], normal = [1, 0, 0], distance = 1e-6 }} }}
keyframes = [{{ time = 0 }}, {{ time = 1e4, translate = [{1}, 0, 0] }}]
)",
                                          length, pull * length),
                              "strip.toml");
    Mesh mesh;
    constexpr int cells = 16;
    for (int j = 0; j <= cells; ++j)
      for (int i = 0; i <= cells; ++i) mesh.positions.emplace_back(length * i / cells, 0, width * j / cells);
    for (int j = 0; j < cells; ++j)
      for (int i = 0; i < cells; ++i) {
        const int v = j * (cells + 1) + i, w = v + cells + 1;
        mesh.add_face(std::array{v, w, w + 1, v + 1});
      }
    scene.meshes["strip"] = std::make_shared<const Mesh>(mesh);
    scene.bodies.front().material.shell = sheet;
    Simulation simulation(std::make_shared<const Model>(build_model(scene)));
    simulation.advance();
    return simulation.diagnostics().elastic;
  };
  constexpr double step = 2e-4;
  return (energy(strain + step) - energy(strain - step)) / (2 * step * length * width);
}

TEST(Fit, ClampsOfWideStripsAreTakenOut) {
  KnownFabric fabric;
  fabric.sheet.poisson = 0.35;
  fabric.sheet.warp_curve = {{0.02, 40}, {0.04, 90}, {0.06, 150}};
  fabric.sheet.weft_curve = {{0.02, 30}, {0.04, 70}, {0.06, 120}};
  Measurements m = fabric.tests(1);
  TensileTest test;
  for (const double strain : {0.01, 0.02, 0.04})
    test.points.emplace_back(strain, clamped_force(fabric.sheet, 0.2, 0.05, strain));
  std::erase_if(m.tensile, [](const TensileTest& t) { return t.direction == Thread::warp; });
  m.tensile.push_back(test);
  const StressCurve known = stress_of(fabric.sheet).warp;
  const double as_if_free = stress_of(*fit_fabric(m).material.shell).warp.stress(0.02);
  EXPECT_GT(as_if_free, 1.06 * known.stress(0.02));
  m.tensile.back().width = 0.2;
  m.tensile.back().length = 0.05;
  const StressCurve found = stress_of(*fit_fabric(m).material.shell).warp;
  for (const double strain : {0.01, 0.02, 0.04})
    EXPECT_NEAR(found.stress(strain), known.stress(strain), 0.03 * known.stress(strain)) << strain;
}

TEST(Fit, UncertaintyFollowsThePropagationByHand) {
  Measurements m;
  m.name = "hand";
  m.areal_density = Measured{0.2, 0.004};
  BendingTest test;
  test.bending_length = Measured{0.02, 0.0002};
  m.bending.push_back(test);
  const Fit fit = fit_fabric(m);
  // D ~ ρ c³: 2 % and 3 · 1 %.
  const FittedValue& warp = value_of(fit, "bending_warp");
  EXPECT_NEAR(*warp.plus_minus / warp.value, std::hypot(0.02, 0.03), 0.0005);
  const FittedValue& weft = value_of(fit, "bending_weft");
  EXPECT_TRUE(weft.guess);
  EXPECT_EQ(weft.value, warp.value);
  EXPECT_FALSE(weft.plus_minus);
}

TEST(Fit, SpecimensThatDifferGiveTheirScatter) {
  Measurements m;
  m.name = "scatter";
  m.areal_density = exactly(0.2);
  for (const double factor : {0.9, 1.0, 1.1}) {
    TensileTest test;
    for (double strain = 0.01; strain < 0.05; strain += 0.01)
      test.points.emplace_back(strain, factor * 5000 * strain * (1 + 10 * strain));
    m.tensile.push_back(test);
  }
  EXPECT_NEAR(*value_of(fit_fabric(m), "warp_curve").plus_minus, 0.1 / std::sqrt(3), 0.002);
}

TEST(Fit, KesSheetGivesItsNumbersBack) {
  Measurements m;
  m.name = "kes";
  m.kes.emplace();
  m.areal_density = exactly(0.125);
  KesSide& warp = m.kes->warp.emplace();
  warp.extension = exactly(0.04);
  warp.linearity = exactly(0.65);
  m.poisson = exactly(0);  // so that clamps do not matter
  warp.shear = exactly(50);
  warp.bending = exactly(1e-5);
  warp.bending_hysteresis = exactly(5e-4);
  KesSide& weft = m.kes->weft.emplace();
  weft.shear = exactly(54);
  const Fit fit = fit_fabric(m);
  const StressCurve curve = stress_of(*fit.material.shell).warp;
  const auto force = [&](double strain) { return (1 + strain) * curve.stress(strain * (1 + strain / 2)); };
  EXPECT_NEAR(force(0.04), kes_tension, 0.01);
  double work = 0;
  for (int i = 0; i < 1000; ++i) work += 0.04 / 1000 * force((i + 0.5) * 0.04 / 1000);
  EXPECT_NEAR(2 * work / (kes_tension * 0.04), 0.65, 0.01);
  EXPECT_EQ(fit.material.shell->membrane_shear, 52);
  EXPECT_EQ(fit.material.shell->bending_warp, 1e-5);
  EXPECT_THAT(fit.text, HasSubstr("bending_hysteresis_warp = 0.0005"));
  EXPECT_THAT(fit_table(fit), HasSubstr("note: hysteresis"));
}

/// A sheet whose extension is known to 10 %, and what else it states of tension.
Fit kes_fit(const KesSide& warp) {
  Measurements m;
  m.name = "kes";
  m.areal_density = exactly(0.125);
  m.poisson = exactly(0);
  m.kes.emplace().warp = warp;
  return fit_fabric(m);
}

TEST(Fit, ErrorsOfAKesSheetShiftAllPointsOfItsCurve) {
  // F = F_m (e/EMT)ⁿ: a share of EMT changes every force by n times it, not by the area below the curve.
  KesSide warp;
  warp.extension = Measured{0.04, 0.0004};
  warp.linearity = exactly(0.5);
  const Fit by_linearity = kes_fit(warp);
  EXPECT_NEAR(*value_of(by_linearity, "warp_curve").plus_minus, 3 * 0.01, 0.002);
  // WT keeps the area below the curve, and n = F_m EMT/WT − 1 grows with EMT: every force changes by
  // n − (n + 1) ln(e/EMT) times the share, or more than n.
  warp.linearity.reset();
  warp.tensile_energy = exactly(0.5 * kes_tension * 0.04 / 2);
  const Fit by_energy = kes_fit(warp);
  EXPECT_GT(*value_of(by_energy, "warp_curve").plus_minus, 3 * 0.01);
  EXPECT_LT(*value_of(by_energy, "warp_curve").plus_minus, 4 * 0.01);
  // LT = 1 is a straight line, whose uncertainty is that of a curve too.
  warp.tensile_energy.reset();
  warp.linearity = Measured{1, 0.05};
  EXPECT_GT(*value_of(kes_fit(warp), "warp_curve").plus_minus, 0.01);
}

TEST(Fit, RulesFillWhatIsNotMeasured) {
  Measurements m;
  m.name = "bare";
  m.source = "a \"quoted\" source";
  m.areal_density = exactly(0.197);
  const Fit fit = fit_fabric(m);
  EXPECT_NEAR(fit.material.shell->bending_warp, 13.6e-6, 1e-12);
  EXPECT_NEAR(fit.material.shell->bending_weft, 8.7e-6, 1e-12);
  EXPECT_EQ(fit.material.shell->membrane_shear, 56.2);
  EXPECT_THAT(fit.material.source, HasSubstr("a \"quoted\" source"));
  EXPECT_THAT(fit.material.source, HasSubstr("bending_warp: guess, the median of 618 fabrics"));
  EXPECT_EQ(fit.material.guesses.size(), 9u);
}

TEST(Fit, SofteningCurvesGetAPoissonRatioThatIsStable) {
  // The part that is nearly flat has another slope when it is written with six digits.
  Measurements m;
  m.name = "soft";
  m.areal_density = exactly(0.12);
  TensileTest strip;
  strip.direction = Thread::warp;
  strip.points = {{0.079, 20.1}, {0.091, 20.55}, {0.187, 20.59}, {0.269, 30.9}};
  m.tensile = {strip};
  const Fit fit = fit_fabric(m);
  EXPECT_GT(fit.material.shell->poisson, 0);
  EXPECT_LE(fit.material.shell->poisson, highest_poisson(stress_of(*fit.material.shell)));
}

TEST(Fit, LowBiasIsRaisedToWhatResistsTwisting) {
  Measurements m;
  m.name = "twist";
  m.areal_density = exactly(0.2);
  for (const auto& [thread, rigidity] :
       {std::pair{Thread::warp, 1e-5}, {Thread::weft, 1e-5}, {Thread::bias, 1e-6}}) {
    BendingTest test;
    test.direction = thread;
    test.rigidity = exactly(rigidity);
    m.bending.push_back(test);
  }
  const Fit fit = fit_fabric(m);
  EXPECT_NEAR(fit.material.shell->bending_bias, 1.01 * 0.25 * 2.5e-5, 1e-10);
  EXPECT_THAT(fit_table(fit), HasSubstr("note: bending_bias was measured as 1e-06"));
}

// --- drape, on a coarse mesh ---

const DrapeOptions coarse{4, 1, 8};

Measurements draped(double coefficient) {
  Measurements m;
  m.name = "draped";
  m.areal_density = Measured{0.15, 0.0015};
  m.drape.emplace();
  m.drape->coefficient = Measured{coefficient, 0.02};
  return m;
}

TEST(Drape, FindsTheBendingOfAKnownDrape) {
  Measurements m = draped(0.5);
  BendingTest known;
  known.rigidity = exactly(1.2e-5);
  m.bending.push_back(known);
  known.direction = Thread::weft;
  known.rigidity = exactly(1.2e-5 * 8.7 / 13.6);
  m.bending.push_back(known);
  const Fit checked = fit_fabric(m, coarse);
  EXPECT_EQ(checked.material.shell->bending_warp, 1.2e-5);  // the drape is simulated only

  const Fit fit = fit_fabric(draped(*checked.simulated_drape + 0.01), coarse);  // half its uncertainty off
  const FittedValue& warp = value_of(fit, "bending_warp");
  EXPECT_NEAR(warp.value, 1.2e-5, 2 * *warp.plus_minus);
  EXPECT_LT(*warp.plus_minus, 0.3 * warp.value);
  EXPECT_NEAR(*fit.simulated_drape, *checked.simulated_drape + 0.01, 0.01);
  EXPECT_EQ(warp.from, "drape");
}

TEST(Drape, CanvasDrapesAlikeOnAnyTriangulation) {
  DrapeOptions options = coarse;
  for (const char* mesh : {"right", "crossed", "equilateral", "delaunay"}) {
    options.mesh = mesh;
    EXPECT_NEAR(drape_coefficient(find_material("canvas"), {}, options), 0.90, 0.03) << mesh;
  }
}

TEST(Drape, LoweredClothHangsInThreeToEightFoldsAlikeInEveryDrop) {
  DrapeOptions options = coarse;
  options.drops = 2;
  const std::vector<Drape> drapes = simulate_drapes(find_material("wool"), {}, options);
  ASSERT_EQ(drapes.size(), 2u);
  for (const Drape& drape : drapes) {
    EXPECT_GE(drape.folds, 3);
    EXPECT_LE(drape.folds, 8);
  }
  EXPECT_NEAR(drapes[0].coefficient, drapes[1].coefficient, 0.02);
}

TEST(Drape, ImpossibleCoefficientNamesTheRange) {
  try {
    fit_fabric(draped(0.999), coarse);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    EXPECT_THAT(error.what(),
                HasSubstr("no bending gives a drape coefficient of 99.9 %: bending lengths from 4 "
                          "to 120 mm give"));
  }
}

TEST(Drape, CanBeCancelledBetweenSteps) {
  int frames = 0, polls = 0;
  const Progress progress{[&](double, std::string_view) { ++frames; }, [&] { return ++polls > 60; }};
  try {
    drape_coefficient(find_material("cotton"), {}, coarse, progress);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::interrupted);
  }
  EXPECT_EQ(polls, 61);
  EXPECT_LT(2 * frames, polls);  // between frames and between steps
}

TEST(Drape, SameBitsOnAnyNumberOfThreads) {
  Material material = find_material("cotton");
  const auto coefficient = [&](int threads) {
    set_thread_count(threads);
    const double result = drape_coefficient(material, {}, coarse);
    set_thread_count(0);
    return result;
  };
  EXPECT_EQ(coefficient(1), coefficient(2));
}

}  // namespace
}  // namespace muslin
