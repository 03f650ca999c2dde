#include "muslin/render/shading.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace muslin {

Material::Material(const Look& look)
    : front(linear_of_srgb(look.colour)),
      back(linear_of_srgb(look.back_colour.value_or(look.colour))),
      sheen(static_cast<float>(look.sheen)),
      gloss(static_cast<float>(look.gloss)),
      translucency(static_cast<float>(look.translucency)),
      pattern(look.pattern),
      pattern_period(static_cast<float>(look.pattern_period)) {
  const float sigma2 = static_cast<float>(look.roughness * look.roughness);
  oren_nayar_a = 1 - 0.5f * sigma2 / (sigma2 + 0.33f);
  oren_nayar_b = 0.45f * sigma2 / (sigma2 + 0.09f);
}

float oren_nayar(const Material& material, const Eigen::Vector3f& normal, const Eigen::Vector3f& to_light,
                 const Eigen::Vector3f& to_eye) {
  const float nl = normal.dot(to_light);
  const float nv = std::max(normal.dot(to_eye), 1e-3f);
  // cos(φl − φv) sin α tan β, without the angles: the dot product of the parts along the surface over the
  // greater cosine.
  const float along = to_light.dot(to_eye) - nl * nv;
  return material.oren_nayar_a + material.oren_nayar_b * std::max(0.0f, along) / std::max(nl, nv);
}

float highlight(const Material& material, const Eigen::Vector3f& normal, const Eigen::Vector3f& to_light,
                const Eigen::Vector3f& to_eye) {
  if (material.gloss <= 0) return 0;
  constexpr float exponent = 40;
  const Eigen::Vector3f half = (to_light + to_eye).normalized();
  const float fresnel = 0.04f + 0.96f * std::pow(1 - std::clamp(half.dot(to_eye), 0.0f, 1.0f), 5.0f);
  const float lobe = (exponent + 8) / (8 * std::numbers::pi_v<float>);
  return material.gloss * fresnel * lobe * std::pow(std::max(0.0f, normal.dot(half)), exponent);
}

float pattern_factor(const Material& material, const Eigen::Vector2f& position, float footprint) {
  if (material.pattern == Pattern::plain || material.pattern_period <= 0) return 1;
  const float period = material.pattern_period;
  const float fade = std::clamp(1.5f - 3 * footprint / period, 0.0f, 1.0f);
  const Eigen::Vector2f place = position / period;
  if (material.pattern == Pattern::checks) {
    const int parity = static_cast<int>(std::floor(place.x())) + static_cast<int>(std::floor(place.y()));
    return 1 - fade * (parity % 2 == 0 ? 0.0f : 0.35f);
  }
  if (fade <= 0) return 1;
  // Plain weave: where warp is over, the thread is round across x; where weft is over, across y.
  const float tau = 2 * std::numbers::pi_v<float>;
  const float warp = std::cos(2 * tau * place.x());
  const float weft = std::cos(2 * tau * place.y());
  const float over = 0.5f + 0.5f * std::sin(tau * place.x()) * std::sin(tau * place.y());
  return 1 + 0.10f * fade * (over * warp + (1 - over) * weft - 0.4f);
}

}  // namespace muslin
