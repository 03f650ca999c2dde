// Declares the loops over consecutive springs, as vector code on columns.
#pragma once

#include <cstddef>

#include "muslin/potential/spring_network.hpp"

namespace muslin {

/// #n by 3 numbers as three arrays.
struct Columns {
  double* x = nullptr;
  double* y = nullptr;
  double* z = nullptr;

  Columns operator+(std::ptrdiff_t i) const { return {x + i, y + i, z + i}; }
};

/// Springs of one type: k [N/m] times a weight by spring, rest length [m].
struct SpringType {
  double k = 0;
  double rest = 0;
  const float* weight = nullptr;  ///< null: all 1
};

/// The largest number of springs in one call.
inline constexpr int max_springs = 1024;

/// Return the distance between columns of n entries [entries], and this thread's memory for columns, valid
/// until its next call.
std::size_t column_stride(int n);
double* column_memory(std::size_t entries);

/// Loads n vectors stored x y z x y z … into columns.
void load_columns(const double* vectors, int n, Columns to);
/// Loads p − q into columns.
void load_differences(const double* p, const double* q, int n, Columns to);
void clear_columns(Columns c, int n);
/// vectors += columns
void add_columns(Columns from, int n, double* vectors);
double sum_of(const double* w, int n);

/// Output of spring forces: subtracted from y_a and added to y_b, where these are not null. b_after_a is b −
/// a.
struct SpringTargets {
  Columns y_a, y_b;
  int b_after_a = 0;
};

/// Energies ½ k (|z| − r)², z = b − a.
void add_spring_energies(const SpringType& type, int n, Columns a, Columns b, double* w);
/// Adds these energies and the forces k (1 − r/|z|) z.
void add_spring_forces(const SpringType& type, int n, Columns a, Columns b, const SpringTargets& to,
                       double* w);
/// ∂²W/∂z² d, d = p_b − p_a.
void add_spring_products(const SpringType& type, int n, Columns a, Columns b, Columns p_a, Columns p_b,
                         const SpringTargets& to);
/// Energies ½ k (n·d)² and forces k (n·d) n, n = z/|z| and d = p_b − p_a.
void add_dashpot_forces(const SpringType& type, int n, Columns a, Columns b, Columns p_a, Columns p_b,
                        const SpringTargets& to, double* w);
void add_dashpot_energies(const SpringType& type, int n, Columns a, Columns b, Columns p_a, Columns p_b,
                          double* w);

}  // namespace muslin
