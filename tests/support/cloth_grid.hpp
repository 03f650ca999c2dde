// A rectangle of triangles in the plane y = 0, for tests and benchmarks of contact.
#pragma once

#include <vector>

#include "muslin/core/vectors.hpp"

namespace muslin::test {

struct ClothGrid {
  int columns, rows;                  ///< of vertices
  std::vector<Vec3> positions, rest;  ///< the same to begin with
  std::vector<Vec3i> triangles;

  /// columns × rows vertices `spacing` [m] apart; diagonals alternate.
  ClothGrid(int columns_, int rows_, double spacing) : columns(columns_), rows(rows_) {
    for (int j = 0; j < rows; ++j)
      for (int i = 0; i < columns; ++i) positions.emplace_back(i * spacing, 0, j * spacing);
    rest = positions;
    for (int j = 0; j + 1 < rows; ++j) {
      for (int i = 0; i + 1 < columns; ++i) {
        const int a = j * columns + i, b = a + 1, c = a + columns, d = c + 1;
        if ((i + j) % 2 == 0) {
          triangles.emplace_back(a, c, b);
          triangles.emplace_back(b, c, d);
        } else {
          triangles.emplace_back(a, d, b);
          triangles.emplace_back(a, c, d);
        }
      }
    }
  }
};

}  // namespace muslin::test
