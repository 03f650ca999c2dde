// Measurements of one quantity that contradict each other are named.
#include "muslin/fit/contradictions.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "muslin/fit/fit.hpp"

namespace muslin {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Measurements bare() {
  Measurements m;
  m.name = "bare";
  m.areal_density = Measured{0.2, std::nullopt};
  return m;
}

BendingTest rigidity(double value, std::optional<double> plus_minus, int line) {
  BendingTest test;
  test.rigidity = Measured{value, plus_minus};
  test.place = {"m.toml", line, 1};
  return test;
}

TensileTest strip(double factor, std::optional<double> plus_minus) {
  TensileTest test;
  for (double strain = 0.01; strain < 0.05; strain += 0.01)
    test.points.emplace_back(strain, factor * 5000 * strain * (1 + 10 * strain));
  test.factor.plus_minus = plus_minus;
  return test;
}

TEST(Contradictions, BothTestsAreNamed) {
  Measurements m = bare();
  m.bending = {rigidity(1.0e-5, 1e-6, 4), rigidity(1.1e-5, 1e-6, 7), rigidity(2.0e-5, 1e-6, 10)};
  EXPECT_THAT(
      contradictions(m),
      ElementsAre(AllOf(HasSubstr("the bending rigidity along warp is 1e-05 N·m ± 10 % by [[bending]] 0 "
                                  "(m.toml:4), but 2e-05 N·m ± 5 % by [[bending]] 2 (m.toml:10)"),
                        HasSubstr("χ² is"))));
  m.bending.pop_back();
  EXPECT_THAT(contradictions(m), IsEmpty());
}

TEST(Contradictions, TestsWithoutUncertaintyAreKnownToTenPercent) {
  Measurements m = bare();
  m.bending = {rigidity(1.0e-5, std::nullopt, 4), rigidity(1.3e-5, std::nullopt, 7)};
  EXPECT_THAT(contradictions(m), IsEmpty());
  m.bending.back() = rigidity(3e-5, std::nullopt, 7);
  EXPECT_THAT(contradictions(m), ElementsAre(HasSubstr("± 10 % (assumed)")));
}

TEST(Contradictions, CurvesAreComparedByTheirForces) {
  Measurements m = bare();
  m.tensile = {strip(0.98, 0.02), strip(1.02, 0.02)};
  EXPECT_THAT(contradictions(m), IsEmpty());
  m.tensile.push_back(strip(1.3, 0.02));
  EXPECT_THAT(contradictions(m), ElementsAre(AllOf(HasSubstr("the force along warp"),
                                                   HasSubstr("[[tensile]] 0"), HasSubstr("[[tensile]] 2"))));
}

TEST(Contradictions, KesIsComparedWithOtherTests) {
  Measurements m = bare();
  m.kes.emplace().weight = Measured{0.1, 0.001};
  KesSide& warp = m.kes->warp.emplace();
  warp.bending = Measured{1e-5, 1e-6};
  warp.extension = Measured{0.04, 0.001};
  m.bending = {rigidity(1.1e-5, 1e-6, 4)};
  m.tensile = {strip(0.5, 0.05)};
  EXPECT_THAT(contradictions(m),
              ElementsAre(AllOf(HasSubstr("areal_density is 0.2 kg/m²"), HasSubstr("`W` of [kes]")),
                          HasSubstr("EMT, LT or WT of `warp` of [kes]")));
}

TEST(Contradictions, StandInTheMaterialFile) {
  Measurements m = bare();
  m.bending = {rigidity(1.0e-5, 1e-6, 4), rigidity(3.0e-5, 1e-6, 7)};
  const Fit fit = fit_fabric(m);
  ASSERT_EQ(fit.warnings.size(), 1u);
  EXPECT_THAT(fit.text, testing::StartsWith("# warning: measurements contradict each other"));
}

}  // namespace
}  // namespace muslin
