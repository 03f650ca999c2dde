// Provides exact sums of doubles for exact_predicates.cpp. An expansion is a number written as a sum of
// doubles that do not overlap, smallest first (Shewchuk 1997): its sign is that of its last term. It is exact
// unless a term overflows or underflows.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace muslin {

template <std::size_t capacity>
struct Expansion {
  std::array<double, capacity> terms;
  std::size_t size = 0;

  /// Adds a term; zeros are left out.
  void append(double term) {
    if (term != 0) terms[size++] = term;
  }
  int sign() const { return size == 0 ? 0 : terms[size - 1] > 0 ? 1 : -1; }
};

/// a + b = sum + error, exactly (Knuth).
inline double two_sum(double a, double b, double& error) {
  const double sum = a + b;
  const double b_part = sum - a;
  error = (a - (sum - b_part)) + (b - b_part);
  return sum;
}

inline Expansion<2> exact_difference(double a, double b) {
  Expansion<2> result;
  double error;
  const double difference = two_sum(a, -b, error);
  result.append(error);
  result.append(difference);
  return result;
}

/// e + f (theorem 12).
template <std::size_t n, std::size_t m>
Expansion<n + m> operator+(const Expansion<n>& e, const Expansion<m>& f) {
  Expansion<n + m> result;
  for (std::size_t i = 0; i < e.size; ++i) result.append(e.terms[i]);
  for (std::size_t j = 0; j < f.size; ++j) {
    double carry = f.terms[j];
    std::size_t size = 0;
    for (std::size_t i = 0; i < result.size; ++i) {
      double error;
      carry = two_sum(carry, result.terms[i], error);
      if (error != 0) result.terms[size++] = error;
    }
    result.size = size;
    result.append(carry);
  }
  return result;
}

template <std::size_t n>
Expansion<n> operator-(Expansion<n> e) {
  for (std::size_t i = 0; i < e.size; ++i) e.terms[i] = -e.terms[i];
  return e;
}

/// e · b (theorem 19).
template <std::size_t n>
Expansion<2 * n> scaled(const Expansion<n>& e, double b) {
  Expansion<2 * n> result;
  double carry = 0;
  for (std::size_t i = 0; i < e.size; ++i) {
    const double product = e.terms[i] * b;
    const double product_error = std::fma(e.terms[i], b, -product);
    double error;
    const double sum = two_sum(carry, product_error, error);
    result.append(error);
    carry = two_sum(product, sum, error);
    result.append(error);
  }
  result.append(carry);
  return result;
}

/// e · (f₀ + f₁).
template <std::size_t n>
Expansion<4 * n> operator*(const Expansion<n>& e, const Expansion<2>& f) {
  Expansion<2 * n> parts[2];
  for (std::size_t i = 0; i < f.size; ++i) parts[i] = scaled(e, f.terms[i]);
  return parts[0] + parts[1];
}

}  // namespace muslin
