// Numbers are written with three digits and the prefix that suits.
#include "muslin/report/quantity.hpp"

#include <gtest/gtest.h>

namespace muslin {
namespace {

TEST(Quantity, ChoosesThePrefix) {
  EXPECT_EQ(quantity(0.00012, "m"), "120 µm");
  EXPECT_EQ(quantity(-3.4e3, "J"), "-3.4 kJ");
  EXPECT_EQ(quantity(0, "m"), "0 m");
  EXPECT_EQ(quantity(0.99999, "m"), "1 m");
  EXPECT_EQ(quantity(1e-15, "J"), "1e-15 J");
}

}  // namespace
}  // namespace muslin
