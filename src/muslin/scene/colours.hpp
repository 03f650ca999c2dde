// Provides default colours of components in pictures.
#pragma once

#include <array>
#include <cstddef>

#include "muslin/component/component.hpp"

namespace muslin {

/// Returns the colour of the body with this number, sRGB 0…1.
inline Vec3 palette_colour(std::size_t index) {
  static const std::array<Vec3, 5> palette = {Vec3(0.72, 0.20, 0.17), Vec3(0.16, 0.42, 0.62),
                                              Vec3(0.82, 0.60, 0.20), Vec3(0.30, 0.52, 0.32),
                                              Vec3(0.50, 0.34, 0.58)};
  return palette[index % palette.size()];
}

/// Returns the colour of colliders: muted, so that bodies stand out.
inline Vec3 collider_colour() { return {0.52, 0.54, 0.57}; }

/// Returns the colour of the component with this number.
inline Vec3 colour_of(const Component& component, std::size_t index) {
  const Appearance look = component.appearance();
  return look.colour.value_or(look.shape.empty() ? palette_colour(index) : collider_colour());
}

}  // namespace muslin
