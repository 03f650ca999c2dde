// yield_strain and strain_hardening of shells and lattices: what is stretched and let go keeps what is beyond
// yield, losses are in the energy account, resumed runs have the same bits; what is wrong.
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "support/sheet.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "muslin/core/error.hpp"
#include "muslin/simulation/simulation.hpp"

namespace muslin {
namespace {

using testing::HasSubstr;

constexpr double length = 0.4, yield = 0.05, stretched = 0.2;
const std::string shell =
    "model = 'shell'\nwarp = [1, 0, 0]\ncompression = 'elastic'\nmaterial = { areal_density = 10, "
    "membrane_warp = 50, bending_warp = 1e-5, poisson = 0, mass_damping = 60";
const std::string lattice =
    "thickness = 0.05\nvoxel_width = 0.05\nmass = 'cells'\nmaterial = { density = 100, edge_modulus = 1000, "
    "mass_damping = 60";

std::shared_ptr<const Model> model(const std::string& keys) {
  Scene scene = parse_scene(
      "[time]\nframe_rate = 1000\nduration = 1\nsteps_per_frame = 1\n[solver]\nintegrator = "
      "'implicit_euler'\n"
      "[[body]]\nname = 'cloth'\nmesh = 'sheet'\ncontact = false\n" +
          keys + " }\n",
      "scene.toml");
  scene.meshes["sheet"] = std::make_shared<Mesh>(test::flat_sheet(8, 2, length, 0.1));
  return std::make_shared<const Model>(build_model(scene));
}

/// The run after it was stretched along x for a step and let go, but for a little of what springs back.
Simulation pulled(const std::shared_ptr<const Model>& body, double kept) {
  Simulation simulation(body);
  const auto stretch = [&](double by) {
    std::vector<Vec3> x = body->rest_positions;
    for (Vec3& p : x) p.x() *= by;
    simulation.set_positions(x);
  };
  simulation.advance();
  stretch(1 + stretched);
  simulation.advance();
  stretch(kept + 0.001);
  return simulation;
}

/// The ratio of the length after a second to that at rest.
double settled(const std::string& keys, double kept) {
  Simulation simulation = pulled(model(keys), kept);
  const Diagnostics start = simulation.diagnostics();
  while (simulation.frame() < 400) simulation.advance();
  const Diagnostics& end = simulation.diagnostics();
  EXPECT_NEAR(end.balance() - end.unbalanced, start.balance() - start.unbalanced,
              1e-9 * (1 + start.dissipated));
  const auto extent = [&](const std::vector<Vec3>& x) {
    Box box;
    for (const Vec3& p : x) box.extend(p);
    return box.sizes().x();
  };
  return extent(simulation.state().positions) / extent(simulation.model().rest_positions);
}

TEST(PlasticStretch, ShellAndLatticeKeepWhatIsBeyondYieldAndTheAccountCloses) {
  for (const double hardening : {0.0, 0.2}) {
    const std::string keys = ", yield_strain = 0.05, strain_hardening = " + std::to_string(hardening);
    const double green = 0.5 * ((1 + stretched) * (1 + stretched) - 1);
    const double of_shell = std::sqrt(1 + 2 * (1 - hardening) * (green - yield));
    EXPECT_NEAR(settled(shell + keys, of_shell), of_shell, 1e-3) << hardening;
    const double of_lattice = 1 + (1 - hardening) * (stretched - yield);
    EXPECT_NEAR(settled(lattice + keys, of_lattice), of_lattice, 1e-3) << hardening;
  }
}

TEST(PlasticStretch, ResumedRunsHaveTheSameBits) {
  for (const std::string& body : {shell, lattice}) {
    const auto cloth = model(body + ", yield_strain = 0.05, strain_hardening = 0.1");
    Simulation whole = pulled(cloth, 1.1), first = pulled(cloth, 1.1), second(cloth);
    for (int f = 0; f < 3; ++f) whole.advance();
    first.advance();
    second.restore(first.checkpoint());
    for (int f = 0; f < 2; ++f) second.advance();
    EXPECT_EQ(whole.state().positions, second.state().positions);
  }
}

TEST(PlasticStretch, NamesWhatIsWrong) {
  const auto complaint = [](const std::string& keys) {
    try {
      model(keys);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_THAT(complaint(shell + ", strain_hardening = 0.1"), HasSubstr("add the strain from which on"));
  EXPECT_THAT(complaint(lattice + ", strain_hardening = 0.1"), HasSubstr("add the strain from which on"));
  EXPECT_THAT(
      complaint("model = 'shell'\nmaterial = { areal_density = 0.1, membrane_warp = 50, bending_warp = "
                "1e-5, yield_strain = 0.1"),
      HasSubstr("set `compression` to \"elastic\""));
  EXPECT_THAT(
      complaint("model = 'shell'\ncompression = 'elastic'\nmaterial = { areal_density = 0.1, warp_curve "
                "= [[0.1, 5]], bending_warp = 1e-5, yield_strain = 0.1"),
      HasSubstr("a sheet with measured curves of stretch cannot yield"));
  EXPECT_THAT(complaint("thickness = 0.05\nvoxel_width = 0.05\nmaterial = { density = 100, law = "
                        "'neo_hookean', youngs_modulus = 1000, yield_strain = 0.1"),
              HasSubstr("a solid does not yield"));
}

}  // namespace
}  // namespace muslin
