// The springs of every material in the library have the moduli that its file quotes.
#include <algorithm>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "muslin/lattice/lattice_moduli.hpp"
#include "muslin/material/material.hpp"

namespace muslin {
namespace {

/// Woven fabrics are made for Kuhn bracing, the default of a body; solids for full bracing, which alone can
/// be isotropic.
const std::set<std::string> fabrics = {"cotton", "wool", "silk", "denim", "nylon", "polyester", "canvas"};

double reference(const Material& material, const std::string& key) {
  for (const auto& [name, value] : material.reference)
    if (name == key) return value;
  return 0;
}

TEST(MaterialLibrary, SpringsHaveTheQuotedModuli) {
  std::size_t checked = 0;
  for (const std::string& name : material_names()) {
    if (name == "thesis_flag") continue;  // quotes springs, no moduli
    const Material material = find_material(name);
    if (!material.has_lattice) continue;
    const Bracing bracing = fabrics.contains(name) ? Bracing::kuhn : Bracing::full;
    const ElasticModuli moduli = elastic_moduli(
        {material.edge_modulus, material.face_diagonal_modulus, material.body_diagonal_modulus}, bracing,
        material.volume_modulus);
    EXPECT_NEAR(moduli.youngs / reference(material, "youngs_modulus"), 1, 0.05) << name;
    if (const double shear = reference(material, "shear_modulus"); shear > 0)
      EXPECT_NEAR(moduli.shear / shear, 1, 0.05) << name;
    else
      EXPECT_NEAR(moduli.youngs_greatest / moduli.youngs_least, 1, 0.05) << name << " is not isotropic";
    EXPECT_NEAR(material.density / reference(material, "density"), 1, 0.01) << name;
    EXPECT_GT(material.stiffness_damping, 0) << name;
    ++checked;
  }
  EXPECT_GE(checked, 13u);
}

TEST(MaterialLibrary, RubberHardlyChangesItsVolume) {
  const Material rubber = find_material("rubber");
  EXPECT_NEAR(
      elastic_moduli({rubber.edge_modulus, rubber.face_diagonal_modulus, rubber.body_diagonal_modulus},
                     Bracing::full, rubber.volume_modulus)
          .poisson,
      0.45, 0.005);
}

}  // namespace
}  // namespace muslin
