// The quick cases of `muslin verify`: every number within its tolerance.
#include <algorithm>
#include <cmath>
#include <set>

#include "verify_case.hpp"
#include <gtest/gtest.h>

namespace muslin::app {
namespace {

std::vector<VerifyCase> quick_cases() {
  std::vector<VerifyCase> quick = verify_cases();
  std::erase_if(quick, [](const VerifyCase& c) { return c.slow; });
  return quick;
}

class QuickCase : public testing::TestWithParam<VerifyCase> {};

TEST_P(QuickCase, MeetsItsReferences) {
  const std::vector<Comparison> numbers = GetParam().run();
  ASSERT_FALSE(numbers.empty());
  for (const Comparison& number : numbers) {
    EXPECT_TRUE(number.passed()) << number.quantity << ": " << number.measured << ", reference "
                                 << number.reference << ", tolerance " << number.tolerance;
  }
}

INSTANTIATE_TEST_SUITE_P(Verify, QuickCase, testing::ValuesIn(quick_cases()), [](const auto& info) {
  std::string name = info.param.name;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

TEST(Comparison, NaNFails) {
  EXPECT_FALSE((Comparison{"", 1, std::nan(""), 1e9}.passed()));
  EXPECT_TRUE((Comparison{"", 2, 2.1, 0.051}.passed()));
  EXPECT_FALSE((Comparison{"", 2, 2.1, 0.051, false}.passed()));
}

TEST(VerifyCases, HaveUniqueNames) {
  std::set<std::string> names;
  for (const VerifyCase& c : verify_cases()) EXPECT_TRUE(names.insert(c.name).second) << c.name;
}

}  // namespace
}  // namespace muslin::app
