// SceneView describes a picture as plain data: surfaces with fixed triangles and vertices that move from
// frame to frame, markers, a ground, and the look of each.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "muslin/core/vectors.hpp"
#include "muslin/geometry/mesh.hpp"
#include "muslin/render/colour.hpp"

namespace muslin {

enum class Pattern {
  plain,
  weave,   ///< over and under of warp and weft
  checks,  ///< squares, which show how a surface stretches and shears
};

/// Optical properties of a surface. Colours are sRGB 0…1.
struct Look {
  Vec3 colour = Vec3(0.70, 0.22, 0.18);
  std::optional<Vec3> back_colour;  ///< of the back of the faces; none: the same
  double roughness = 0.6;           ///< Oren and Nayar's σ [rad]: 0 is chalk-smooth, 0.6 is woollen
  double sheen = 0;                 ///< 0…1, the bright rim of fibres seen edge on
  double gloss = 0;                 ///< 0…1, highlights, as of rubber
  double translucency = 0;          ///< 0…1, share of the light on one side that shows on the other
  Pattern pattern = Pattern::plain;
  double pattern_period = 0;  ///< length of one repeat in pattern coordinates [m]
};

/// Matt, with sheen, a little translucent, a faint weave and a slightly different back.
Look fabric_look(const Vec3& colour);
/// Slightly glossy, both sides alike: soft solids.
Look solid_look(const Vec3& colour);
/// Grey and plain: poles, balls and other props.
Look prop_look();

struct Surface {
  std::string name;
  std::vector<Vec3i> triangles;         ///< #T vertex indices
  std::vector<Vec3> rest_positions;     ///< #V; edges sharp at rest stay crisp, folds stay smooth
  std::vector<Vec2> pattern_positions;  ///< 3 × #T corners, where the pattern lies [m]; empty = no pattern
  Look look;
  double crease_angle = 0.7;  ///< faces that meet at a larger angle at rest keep their edge [rad]
  double thickness = 0;       ///< drawn thickness of an open sheet [m]; 0 draws the triangles alone
};

/// Makes a surface to draw from a mesh. The pattern lies on the texture coordinates scaled to metres or,
/// without any, on the rest positions seen along the thinnest side of their box; a period of 0 becomes 1/120
/// of the largest side.
Surface make_surface(const Mesh& mesh, const Look& look);

/// A small ball, such as a pin.
struct Marker {
  Vec3 position = Vec3::Zero();
  double radius = 0.01;  ///< [m]
  Vec3 colour = Vec3(0.95, 0.75, 0.20);
};

struct SceneView {
  std::vector<Surface> surfaces;
  std::optional<double> ground;             ///< height y of the ground [m]
  std::optional<ColourScale> colour_scale;  ///< of SurfaceFrame::values; a legend is drawn if set
  Vec3 background_top = Vec3(0.64, 0.70, 0.77);
  Vec3 background_bottom = Vec3(0.87, 0.89, 0.91);
};

struct SurfaceFrame {
  ConstVectors positions;          ///< #V by 3 [m]
  std::span<const double> values;  ///< #V in the units of SceneView::colour_scale; empty = own colour
};

struct FrameView {
  std::vector<SurfaceFrame> surfaces;  ///< one for each of SceneView::surfaces
  std::vector<Marker> markers;
  std::string label;  ///< drawn at the bottom left, such as "flag   1.20 s"; may be empty
};

}  // namespace muslin
