// Every fabric of the library hangs and swings with symplectic Euler and automatic steps.
#include <filesystem>
#include <string>

#include "support/sheet.hpp"
#include <gtest/gtest.h>
#include <unistd.h>

#include "muslin/io/mesh_file.hpp"
#include "muslin/material/library.hpp"
#include "muslin/scene/model.hpp"
#include "muslin/simulation/simulation.hpp"

namespace muslin {
namespace {

TEST(ExplicitFabrics, AreStableWithAutomaticSteps) {
  const auto folder =
      std::filesystem::temp_directory_path() / ("muslin_explicit_" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  write_mesh(folder / "sheet.obj", test::flat_sheet(6, 5, 0.3, 0.25));
  int fabrics = 0;
  for (const LibraryMaterial& material : material_library()) {
    if (material.text.find("areal_density") == std::string_view::npos) continue;
    SCOPED_TRACE(std::string(material.name));
    ++fabrics;
    const std::string scene =
        "[time]\nframe_rate = 200\nduration = 0.1\n"
        "[solver]\nintegrator = 'symplectic_euler'\n"
        "[[body]]\nmesh = 'sheet.obj'\nmodel = 'shell'\nmaterial = '" +
        std::string(material.name) +
        "'\n[[pin]]\nwhere = { box = [[-1, -1, -1], [1e-9, 1, 1]] }\n"
        "[[force]]\ntype = 'gravity'\nacceleration = [0, 0, -9.8]\n";
    Simulation simulation(
        std::make_shared<const Model>(build_model(parse_scene(scene, folder / "scene.toml"))));
    const double balance = simulation.diagnostics().balance();
    for (int frame = 0; frame < 4; ++frame) simulation.advance();
    const Diagnostics& end = simulation.diagnostics();
    EXPECT_NEAR(end.balance(), balance, 1e-6);
    EXPECT_LT(end.max_stretch, 1.05);
  }
  EXPECT_GE(fabrics, 10);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace muslin
