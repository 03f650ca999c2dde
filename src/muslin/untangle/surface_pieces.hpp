// SurfacePieces divides a contact surface into connected pieces.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "muslin/contact/contact_surface.hpp"
#include "muslin/core/vectors.hpp"

namespace muslin {

/// The connected pieces of a surface: of two shirts in one mesh, each is a piece. Constant during a run.
class SurfacePieces {
 public:
  /// `rest` (#P by 3, [m]) weighs the points by their area.
  SurfacePieces(const ContactSurface& surface, ConstVectors rest);

  int count() const { return static_cast<int>(pieces_.size()); }
  int of_point(int point) const { return of_point_[static_cast<std::size_t>(point)]; }
  int of_triangle(int triangle) const { return of_triangle_[static_cast<std::size_t>(triangle)]; }
  std::span<const int> triangles(int piece) const { return of(piece).triangles; }
  std::span<const int> points(int piece) const { return of(piece).points; }
  int body(int piece) const { return of(piece).body; }
  /// True of a piece with an inside: its body is solid, and triangles pass every edge as often in one
  /// direction as in the other, also where sheets touch in an edge. Then its winding numbers are whole.
  bool is_solid(int piece) const { return of(piece).solid; }
  /// Rest area around a point [m²].
  double area(int point) const { return areas_[static_cast<std::size_t>(point)]; }

 private:
  struct Piece {
    std::vector<int> triangles, points;  // ascending
    int body = 0;
    bool solid = false;
  };
  const Piece& of(int piece) const { return pieces_[static_cast<std::size_t>(piece)]; }

  std::vector<Piece> pieces_;
  std::vector<int> of_point_, of_triangle_;
  std::vector<double> areas_;
};

}  // namespace muslin
