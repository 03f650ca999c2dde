#include "muslin/material/material_table.hpp"

namespace muslin {
namespace {

struct Quantity {
  const char* key;
  const char* unit;
  double Material::*member;
  Range range;
};

// Upper bounds far above any material: they keep products of the quantities finite.
const Quantity quantities[] = {
    {"density", "kg/m³", &Material::density, {0, 1e6, true}},
    {"edge_modulus", "N/m²", &Material::edge_modulus, {0, 1e15, false}},
    {"face_diagonal_modulus", "N/m²", &Material::face_diagonal_modulus, {0, 1e15, false}},
    {"body_diagonal_modulus", "N/m²", &Material::body_diagonal_modulus, {0, 1e15, false}},
    {"volume_modulus", "N/m²", &Material::volume_modulus, {0, 1e15, false}},
    {"young_modulus", "Pa", &Material::young_modulus, {0, 1e15, false}},
    {"poisson", "", &Material::poisson, {-0.99, 0.499, false}},
    {"mass_damping", "1/s", &Material::mass_damping, {0, 1e6, false}},
    {"stiffness_damping", "s", &Material::stiffness_damping, {0, 1e6, false}},
};

}  // namespace

const std::vector<std::string>& material_keys() {
  static const std::vector<std::string> keys = [] {
    std::vector<std::string> result;
    for (const Quantity& quantity : quantities) result.emplace_back(quantity.key);
    return result;
  }();
  return keys;
}

void read_material_keys(const TomlTable& table, Material& material) {
  for (const Quantity& quantity : quantities) {
    double& value = material.*quantity.member;
    value = table.number(quantity.key, quantity.unit, quantity.range, value);
  }
  if (table.has("poisson") && material.young_modulus == 0)
    throw table.error("poisson", "`poisson` stands without `young_modulus`", "give both");
}

}  // namespace muslin
