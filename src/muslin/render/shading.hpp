// Provides the formulas for lights and materials of the preview, without the ray tracing.
#pragma once

#include <cmath>

#include <Eigen/Core>

#include "muslin/render/colour.hpp"
#include "muslin/render/scene_view.hpp"

namespace muslin {

/// A Look in linear light and float.
struct Material {
  explicit Material(const Look& look);

  Light front, back;
  float oren_nayar_a, oren_nayar_b;
  float sheen, gloss, translucency;
  Pattern pattern;
  float pattern_period;
};

/// The sun is a bright disc; the sky is a dome that is brighter and bluer above.
struct Lighting {
  Eigen::Vector3f to_sun = Eigen::Vector3f(0, 1, 0);
  float sun_spread = 0.055f;               ///< tangent of the disc's angular radius
  Light sun = Light(2.65f, 2.48f, 2.22f);  ///< irradiance on a plane that faces it
  Light zenith = Light(0.48f, 0.54f, 0.64f);
  Light horizon = Light(0.42f, 0.42f, 0.41f);
  Light below = Light(0.20f, 0.19f, 0.18f);  ///< where there is no ground

  Light sky(const Eigen::Vector3f& direction) const {
    const float y = direction.y();
    return y <= 0 ? below : Light(horizon + std::sqrt(y) * (zenith - horizon));
  }
  Light mean_sky() const { return 0.5f * (horizon + zenith); }
};

/// Returns the reflected part of sunlight per irradiance · cosine · colour/π: Oren and Nayar 1994, their
/// qualitative model. All unit vectors; normal · to_light > 0.
float oren_nayar(const Material& material, const Eigen::Vector3f& normal, const Eigen::Vector3f& to_light,
                 const Eigen::Vector3f& to_eye);

/// Returns the highlight for the same light: a normalised Blinn–Phong lobe with Schlick's Fresnel term (n =
/// 1.5).
float highlight(const Material& material, const Eigen::Vector3f& normal, const Eigen::Vector3f& to_light,
                const Eigen::Vector3f& to_eye);

/// Returns the brightness of the pattern about 1, fading out where a repeat is smaller than `footprint` [m].
float pattern_factor(const Material& material, const Eigen::Vector2f& position, float footprint);

}  // namespace muslin
