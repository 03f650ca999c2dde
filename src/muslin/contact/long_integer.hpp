// LongInteger is an integer of any length, for the few determinants out of the range of doubles.
#pragma once

#include <cstdint>
#include <vector>

namespace muslin {

/// A sign and a magnitude of 32-bit digits, smallest first, without leading zeros.
class LongInteger {
 public:
  LongInteger() = default;
  /// value · 2^shift, which must be a whole number; value finite.
  LongInteger(double value, int shift);

  int sign() const { return sign_; }
  LongInteger operator-() const;
  friend LongInteger operator+(const LongInteger& a, const LongInteger& b);
  friend LongInteger operator-(const LongInteger& a, const LongInteger& b) { return a + -b; }
  friend LongInteger operator*(const LongInteger& a, const LongInteger& b);

 private:
  int sign_ = 0;
  std::vector<std::uint32_t> digits_;
};

}  // namespace muslin
