// The edge length up to which a mesh drapes as the fabric does.
#include "muslin/component/shell/trusted_edge.hpp"

#include <cmath>

#include "support/sheet.hpp"
#include <gtest/gtest.h>

#include "muslin/energy/membrane_energy.hpp"
#include "muslin/material/material.hpp"
#include "muslin/shell/shell.hpp"

namespace muslin {
namespace {

ShellMaterial sheet(double stiffness, double bending) {
  ShellMaterial m;
  m.areal_density = 0.1;
  m.membrane_warp = m.membrane_weft = stiffness;
  m.membrane_shear = stiffness / 2;
  m.bending_warp = m.bending_weft = m.bending_bias = bending;
  return m;
}

TEST(TrustedEdge, HasTheMembraneAtSixteenTimesTheEnergyOfBending) {
  const ShellMaterial m = sheet(1e8, 1e-5);
  const double h = trusted_edge(m, Compression::elastic).unlocked,
               radius = 2.5 * trusted_edge(m, Compression::elastic).resolved;
  EXPECT_NEAR(radius, std::cbrt(1e-5 / 0.981), 1e-12);
  ASSERT_LT(h, radius / 10);
  const int cells = 8;
  const Mesh mesh = test::flat_sheet(cells, cells, cells * h, cells * h);
  const Shell shell = build_shell(mesh, mesh.positions, {Vec3(1, 0, 0)});
  const std::vector<Vec3> fold = test::rolled(mesh.positions, 1 / radius);
  const double stretched =
      MembraneEnergy(shell, {m.membrane_warp, m.membrane_weft, m.membrane_shear, 0}).value(fold);
  const double bent = 0.5 * m.bending_warp / (radius * radius) * shell.area;
  EXPECT_NEAR(stretched / bent, 16, 0.3);
}

TEST(TrustedEdge, IsLimitedByFoldsIfTheSheetIsThick) {
  const TrustedEdge thick = trusted_edge(sheet(1e4, 1e-3), Compression::elastic),
                    thin = trusted_edge(sheet(1e4, 1e-6), Compression::elastic);
  EXPECT_EQ(thick.length(), thick.resolved);
  EXPECT_EQ(thin.length(), thin.unlocked);
  EXPECT_NEAR(thin.unlocked / thick.unlocked, std::pow(1e-3, 5.0 / 12), 1e-9);
}

TEST(TrustedEdge, OfFabricsIsLongestForStiffOnes) {
  const auto edge = [](const char* name) {
    return trusted_edge(*find_material(name).shell, Compression::elastic).length();
  };
  EXPECT_NEAR(edge("silk"), 0.00377, 1e-5);
  EXPECT_GT(edge("denim"), 2 * edge("silk"));
  EXPECT_GT(edge("canvas"), edge("denim"));
}

TEST(TrustedEdge, IsThatOfFoldsIfThreadsBuckle) {
  const TrustedEdge silk = trusted_edge(*find_material("silk").shell, Compression::buckling);
  EXPECT_TRUE(std::isinf(silk.unlocked));
  EXPECT_NEAR(silk.length(), 0.4 * std::cbrt(std::sqrt(1.1e-6 * 0.85e-6) / (9.81 * 0.06)), 1e-9);
  EXPECT_TRUE(std::isinf(trusted_edge(sheet(0, 1e-5), Compression::elastic).unlocked));
  EXPECT_TRUE(std::isinf(trusted_edge(sheet(0, 0), Compression::elastic).unlocked));
  EXPECT_EQ(trusted_edge(sheet(1e6, 0), Compression::elastic).length(), 0);
}

}  // namespace
}  // namespace muslin
