#include "muslin/contact/long_integer.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

namespace muslin {
namespace {

using Digits = std::vector<std::uint32_t>;

void trim(Digits& digits) {
  while (!digits.empty() && digits.back() == 0) digits.pop_back();
}

int compare(const Digits& a, const Digits& b) {
  if (a.size() != b.size()) return a.size() < b.size() ? -1 : 1;
  for (std::size_t i = a.size(); i-- > 0;)
    if (a[i] != b[i]) return a[i] < b[i] ? -1 : 1;
  return 0;
}

Digits sum(const Digits& a, const Digits& b) {
  Digits result(std::max(a.size(), b.size()) + 1);
  std::uint64_t carry = 0;
  for (std::size_t i = 0; i < result.size(); ++i) {
    carry += (i < a.size() ? a[i] : 0ULL) + (i < b.size() ? b[i] : 0ULL);
    result[i] = static_cast<std::uint32_t>(carry);
    carry >>= 32;
  }
  trim(result);
  return result;
}

/// a − b for a ≥ b.
Digits difference(const Digits& a, const Digits& b) {
  Digits result(a.size());
  std::int64_t borrow = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::int64_t digit = static_cast<std::int64_t>(a[i]) - (i < b.size() ? b[i] : 0) + borrow;
    borrow = digit < 0 ? -1 : 0;
    if (digit < 0) digit += std::int64_t{1} << 32;
    result[i] = static_cast<std::uint32_t>(digit);
  }
  trim(result);
  return result;
}

}  // namespace

LongInteger::LongInteger(double value, int shift) {
  if (value == 0) return;
  sign_ = value > 0 ? 1 : -1;
  int exponent = 0;
  const double fraction = std::frexp(std::fabs(value), &exponent);
  auto mantissa = static_cast<std::uint64_t>(std::ldexp(fraction, 53));
  exponent += shift - 53;
  while (exponent < 0) {
    assert((mantissa & 1) == 0);
    mantissa >>= 1;
    ++exponent;
  }
  digits_.assign(static_cast<std::size_t>(exponent / 32), 0);
  const int bits = exponent % 32;
  const std::uint64_t low = mantissa << bits;
  digits_.push_back(static_cast<std::uint32_t>(low));
  digits_.push_back(static_cast<std::uint32_t>(low >> 32));
  digits_.push_back(bits == 0 ? 0 : static_cast<std::uint32_t>(mantissa >> (64 - bits)));
  trim(digits_);
}

LongInteger LongInteger::operator-() const {
  LongInteger result = *this;
  result.sign_ = -sign_;
  return result;
}

LongInteger operator+(const LongInteger& a, const LongInteger& b) {
  if (a.sign_ == 0) return b;
  if (b.sign_ == 0) return a;
  LongInteger result;
  if (a.sign_ == b.sign_) {
    result.sign_ = a.sign_;
    result.digits_ = sum(a.digits_, b.digits_);
    return result;
  }
  const int order = compare(a.digits_, b.digits_);
  if (order == 0) return result;
  const LongInteger& larger = order > 0 ? a : b;
  result.sign_ = larger.sign_;
  result.digits_ = difference(larger.digits_, order > 0 ? b.digits_ : a.digits_);
  return result;
}

LongInteger operator*(const LongInteger& a, const LongInteger& b) {
  LongInteger result;
  if (a.sign_ == 0 || b.sign_ == 0) return result;
  result.sign_ = a.sign_ * b.sign_;
  result.digits_.assign(a.digits_.size() + b.digits_.size(), 0);
  for (std::size_t i = 0; i < a.digits_.size(); ++i) {
    std::uint64_t carry = 0;
    for (std::size_t j = 0; j < b.digits_.size(); ++j) {
      carry += result.digits_[i + j] + std::uint64_t{a.digits_[i]} * b.digits_[j];
      result.digits_[i + j] = static_cast<std::uint32_t>(carry);
      carry >>= 32;
    }
    result.digits_[i + b.digits_.size()] = static_cast<std::uint32_t>(carry);
  }
  trim(result.digits_);
  return result;
}

}  // namespace muslin
