#include "muslin/material/keyed_material.hpp"

#include <algorithm>
#include <iterator>

#include "muslin/material/varied_material.hpp"

namespace muslin {
namespace {

bool changes(const schema::Variation& variation) {
  return std::any_of(variation.keyframes.begin(), variation.keyframes.end(),
                     [&](const NumberKeyframe& key) { return key.value != variation.nominal(); });
}

template <class AnyMaterial>
AnyMaterial at_time(const AnyMaterial& material, double time) {
  AnyMaterial result = with_numbers(material, numbers_at(material.variations, time));
  std::copy_if(material.variations.begin(), material.variations.end(), std::back_inserter(result.variations),
               [](const schema::Variation& variation) { return variation.is_map(); });
  return result;
}

}  // namespace

Material material_at(const Material& material, double time) { return at_time(material, time); }
ShellMaterial material_at(const ShellMaterial& material, double time) { return at_time(material, time); }

std::vector<double> numbers_at(const schema::Variations& variations, double time) {
  std::vector<double> numbers;
  numbers.reserve(variations.size());
  for (const schema::Variation& variation : variations)
    numbers.push_back(variation.is_map() ? variation.nominal() : value_at(variation.keyframes, time));
  return numbers;
}

std::vector<double> keyframe_times(const schema::Variations& variations) {
  std::vector<double> times;
  for (const schema::Variation& variation : variations)
    if (changes(variation))
      for (const NumberKeyframe& key : variation.keyframes) times.push_back(key.time);
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

std::vector<double> times_to_check(const schema::Variations& variations) {
  constexpr int parts = 16;
  const std::vector<double> keys = keyframe_times(variations);
  std::vector<double> times;
  for (std::size_t k = 0; k + 1 < keys.size(); ++k)
    for (int i = 0; i < parts; ++i) times.push_back(keys[k] + (keys[k + 1] - keys[k]) * i / parts);
  if (!keys.empty()) times.push_back(keys.back());
  return times;
}

std::vector<double> keyed_numbers(const schema::Variations& variations, double time) {
  std::vector<double> numbers;
  for (const schema::Variation& variation : variations)
    if (!variation.is_map()) numbers.push_back(value_at(variation.keyframes, time));
  return numbers;
}

}  // namespace muslin
