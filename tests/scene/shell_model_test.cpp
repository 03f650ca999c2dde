// Shells from a scene: counts, masses, threads, selections, probes, and what is wrong.
#include <algorithm>
#include <filesystem>
#include <fstream>

#include "support/sheet.hpp"
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "muslin/component/shell/shell_body.hpp"
#include "muslin/io/mesh_file.hpp"
#include "muslin/scene/describe.hpp"
#include "muslin/scene/model.hpp"

namespace muslin {
namespace {

using testing::HasSubstr;

/// A folder with a sheet of 4 x 3 squares of 0.2 m, the same bent, and sheets that cannot be shells.
class ShellModel : public testing::Test {
 protected:
  static std::filesystem::path folder() {
    return std::filesystem::temp_directory_path() / ("muslin_shell_test_" + std::to_string(getpid()));
  }
  static void SetUpTestSuite() {
    std::filesystem::create_directories(folder());
    Mesh sheet = test::flat_sheet(4, 3, 0.8, 0.6);
    sheet.groups.push_back({"hem", {0, 1, 2, 3}, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}});
    write_mesh(folder() / "sheet.obj", sheet);
    write_mesh(folder() / "bent.obj", sheet, test::rolled(sheet.positions, 2));
    write_mesh(folder() / "other.obj", test::flat_sheet(3, 4, 0.8, 0.6));
    sheet.add_face(std::array{0, 5, 6, 1});
    write_mesh(folder() / "double.obj", sheet);
  }
  static void TearDownTestSuite() { std::filesystem::remove_all(folder()); }

  static Model build(const std::string& text) {
    return build_model(parse_scene(text, folder() / "scene.toml"));
  }
  static std::string body(const std::string& mesh = "sheet.obj", const std::string& more = "") {
    return "[[body]]\nname = 'cloth'\nmesh = '" + mesh +
           "'\nmodel = 'shell'\nmaterial = { areal_density = 0.5, membrane_warp = 100, bending_warp = 1e-4 "
           "}\n" +
           more;
  }
  static std::string message(const std::string& text) {
    try {
      build(text);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input);
      return error.what();
    }
    return "no error";
  }
};

TEST_F(ShellModel, IsTheMeshItself) {
  const Model model = build(body("sheet.obj", "rotate = [0, 90, 0]\ntranslate = [0, 2, 0]\nscale = 2\n"));
  const Component& cloth = model.bodies[0];
  EXPECT_TRUE(as_shell(cloth) != nullptr);
  EXPECT_EQ(model.vertex_count(), 20u);
  EXPECT_EQ(model.rest_positions, cloth.mesh.positions);
  EXPECT_NEAR(cloth.statistics.mass, 0.5 * 1.6 * 1.2, 1e-12);
  EXPECT_EQ(cloth.statistics.triangles, 24);
  EXPECT_EQ(cloth.statistics.hinges, 29);
  EXPECT_LT(cloth.statistics.stable_step, 0.1);
  std::vector<Vec3> skin(20);
  cloth.skin.apply(model.rest_positions, skin);
  EXPECT_EQ(skin, model.rest_positions);
  ASSERT_EQ(model.potentials.size(), 2u);
  for (const PotentialTerm& term : model.potentials)
    EXPECT_NEAR(term.potential->value(model.rest_positions), 0, 1e-20) << term.name;
}

TEST_F(ShellModel, DampingAddsTerms) {
  const Model model = build(
      "[[body]]\nmesh = 'sheet.obj'\nmodel = 'shell'\nmaterial = { areal_density = 0.5, membrane_warp = 100, "
      "bending_warp = 1e-4, mass_damping = 1, stiffness_damping = 0.01 }\n");
  ASSERT_EQ(model.loads.size(), 3u);
  for (const LoadTerm& load : model.loads) EXPECT_EQ(load.role, EnergyRole::dissipation);
}

TEST_F(ShellModel, SelectsVerticesOfTheMesh) {
  const Model model =
      build(body("sheet.obj",
                 "[[pin]]\nwhere = { group = 'hem' }\n[[pin]]\nwhere = { plane = { point = [0, 0, "
                 "0], normal = [1, 0, 0] } }\n[[pin]]\nwhere = { nearest = [0.81, 0, 0.61] }\n"));
  EXPECT_EQ(model.pins[0].vertices.size(), 10u);
  EXPECT_THAT(model.pins[1].vertices, testing::ElementsAre(0, 5, 10, 15));
  EXPECT_THAT(model.pins[2].vertices, testing::ElementsAre(19));
  EXPECT_THAT(
      message(body("sheet.obj", "[[pin]]\nwhere = { sphere = { center = [9, 0, 0], radius = 1 } }\n")),
      HasSubstr("the nearest is [0.8, 0, 0]"));
}

TEST_F(ShellModel, ProbesLieOnTriangles) {
  const Model model = build(body("sheet.obj", "[[probe]]\nat = [0.33, 0.05, 0.17]\n"));
  Vec3 point;
  model.probes[0].point.apply(model.rest_positions, Vectors(&point, 1));
  EXPECT_LT((point - Vec3(0.33, 0, 0.17)).norm(), 1e-12);
  EXPECT_THAT(model.warnings, testing::IsEmpty());
  EXPECT_THAT(build(body("sheet.obj", "[[probe]]\nat = [0.33, 1, 0.17]\n")).warnings,
              testing::ElementsAre(HasSubstr("lies 1 m from body")));
}

TEST_F(ShellModel, RestMeshHasNoStress) {
  const Model flat = build(body("bent.obj", "rest_mesh = 'sheet.obj'\n"));
  const Model bent = build(body("bent.obj"));
  EXPECT_GT(flat.potentials[1].potential->value(flat.rest_positions), 1e-6);
  EXPECT_NEAR(bent.potentials[1].potential->value(bent.rest_positions), 0, 1e-20);
  EXPECT_THAT(message(body("bent.obj", "rest_mesh = 'other.obj'\n")),
              testing::AllOf(HasSubstr("scene.toml:6:13"), HasSubstr("its polygons are not those of"),
                             HasSubstr("its vertex 5 has corners of vertices 6 and 4")));
  EXPECT_THAT(message(body("bent.obj", "rest_mesh = 'double.obj'\n")), HasSubstr("13 against 12"));
}

TEST_F(ShellModel, InvertedTrianglesAreAWarning) {
  Mesh turned = test::flat_sheet(4, 4, 0.4, 0.4);
  turned.positions[12].x() = 0.33;
  write_mesh(folder() / "turned.obj", turned);
  EXPECT_THAT(build(body("turned.obj")).warnings,
              testing::ElementsAre(HasSubstr("turned over in the stress-free shape, the first in polygon")));
}

TEST_F(ShellModel, LongEdgesAreAWarningIfTheMembraneLocks) {
  write_mesh(folder() / "fine.obj", test::flat_sheet(20, 20, 0.3, 0.3));
  const auto of = [](const std::string& material) {
    return "[[body]]\nname = 'cloth'\nmesh = 'fine.obj'\nmodel = 'shell'\nwarp = [1, 0, 0]\nmaterial = '" +
           material + "'\n";
  };
  EXPECT_THAT(build(of("denim") + "compression = 'elastic'\n").warnings, testing::IsEmpty());
  const Model silk = build(of("silk") + "compression = 'elastic'\n");
  ASSERT_THAT(silk.warnings,
              testing::ElementsAre(HasSubstr("silk drapes too stiffly with more than 0.0038 m")));
  const auto json = nlohmann::json::parse(describe_json(silk));
  EXPECT_NEAR(json["bodies"][0]["trusted_edge"].get<double>(), 0.00377, 1e-5);
  EXPECT_EQ(json["warnings"].size(), 1u);
  // The advice of the warning removes it.
  const Model buckling = build(of("silk"));
  EXPECT_THAT(buckling.warnings, testing::IsEmpty());
  EXPECT_THAT(describe_text(buckling), HasSubstr("as the fabric's with edges of up to 0.0047 m"));
}

TEST_F(ShellModel, WarpRotatesWithTheBody) {
  const std::string anisotropic =
      "[[body]]\nname = 'cloth'\nmesh = 'sheet.obj'\nmodel = 'shell'\nmaterial = { areal_density = 0.5, "
      "membrane_warp = 100, membrane_weft = 10, bending_warp = 1e-4 }\n";
  const auto stretched = [&](const std::string& more) {
    const Model model = build(anisotropic + more);
    std::vector<Vec3> x = model.rest_positions;
    for (Vec3& p : x) p.x() *= 1.01;
    return model.potentials[0].potential->value(x);
  };
  const double along_warp = stretched("warp = [1, 0, 0]\n"), along_weft = stretched("warp = [0, 0, 1]\n");
  EXPECT_NEAR(along_warp / along_weft, 10, 1e-6);
  EXPECT_NEAR(stretched("warp = [0, 0, 1]\nrotate = [0, 90, 0]\n") / along_warp, 1, 1e-9);
  EXPECT_THAT(build(anisotropic).warnings, testing::ElementsAre(HasSubstr("its warp is taken along x")));
}

TEST_F(ShellModel, StretchLimitIsASeparateTerm) {
  const Model model = build(body("sheet.obj", "stretch_limit = 1.08\n"));
  EXPECT_EQ(model.scene.bodies[0].own.as<ShellBodySettings>().stretch_limit, 1.08);
  EXPECT_EQ(nlohmann::json::parse(model.scene.resolved)["body"][0]["stretch_limit"], 1.08);
  EXPECT_EQ(nlohmann::json::parse(describe_json(model))["bodies"][0]["stretch_limit"], 1.08);
  EXPECT_THAT(describe_text(model), HasSubstr("stretched to 1.08 of its length at most"));
  ASSERT_EQ(model.potentials.size(), 3u);
  const PotentialTerm& term = model.potentials[1];
  EXPECT_EQ(term.name, "cloth: stretch limit");
  EXPECT_EQ(term.role, EnergyRole::elastic);
  std::vector<Vec3> x = model.rest_positions;
  for (Vec3& p : x) p.x() *= 1.035;
  EXPECT_EQ(term.potential->value(x), 0);
  for (Vec3& p : x) p.x() *= 1.035;
  EXPECT_GT(term.potential->value(x), 0);
  EXPECT_EQ(model.bodies[0].statistics.stable_step, build(body()).bodies[0].statistics.stable_step);

  const Scene without = parse_scene(body(), folder() / "scene.toml");
  EXPECT_FALSE(without.bodies[0].own.as<ShellBodySettings>().stretch_limit);
  EXPECT_FALSE(nlohmann::json::parse(without.resolved)["body"][0].contains("stretch_limit"));
  EXPECT_THAT(model.warnings, testing::IsEmpty());
  EXPECT_THAT(build(body("sheet.obj", "stretch_limit = 1.002\n")).warnings,
              testing::ElementsAre(HasSubstr("`stretch_limit` of less than 1.005")));
  EXPECT_THAT(build("[solver]\nintegrator = 'symplectic_euler'\n[time]\nsteps_per_frame = 1000\n" +
                    body("sheet.obj", "stretch_limit = 1.08\n"))
                  .warnings,
              testing::ElementsAre(HasSubstr("take an implicit integrator")));
}

TEST_F(ShellModel, TheStretchLimitOfAMaterialIsThatOfItsBodies) {
  const auto limit_of = [](const std::string& material, const std::string& more = "") {
    return build("[[body]]\nname = 'cloth'\nmesh = 'sheet.obj'\nmodel = 'shell'\nmaterial = " + material +
                 "\n" + more)
        .bodies[0]
        .stretch_limit(0);
  };
  EXPECT_EQ(limit_of("'cotton'"), 1.061);
  EXPECT_EQ(limit_of("'wool'"), 1.085);
  EXPECT_EQ(limit_of("'polyester'"), 1.065);
  EXPECT_EQ(limit_of("'denim'"), std::nullopt);
  EXPECT_EQ(limit_of("'cotton'", "stretch_limit = 1.2\n"), 1.2);
  EXPECT_EQ(limit_of("{ base = 'cotton', stretch_limit = 1.1 }"), 1.1);
}

TEST_F(ShellModel, StretchLimitIsRefusedWithItsPlace) {
  for (const char* limit : {"1", "0.9", "1.0000000000000002", "1.0009", "10.1", "'5 %'"}) {
    EXPECT_THAT(message(body("sheet.obj", "stretch_limit = " + std::string(limit) + "\n")),
                testing::AllOf(HasSubstr("scene.toml:6:17"), HasSubstr("`stretch_limit`")))
        << limit;
  }
  EXPECT_THAT(message(body("sheet.obj", "stretch_limit = 1\n")), HasSubstr("give a number from 1.001 to 10"));
  EXPECT_EQ(message(body("sheet.obj", "stretch_limit = 1.001\n")), "no error");
  EXPECT_EQ(message(body("sheet.obj", "stretch_limit = 10\n")), "no error");
  EXPECT_THAT(
      message("[[body]]\nmesh = 'sheet.obj'\nvoxel_width = 1\nmaterial = 'cotton'\nstretch_limit = 1.1\n"),
      testing::AllOf(HasSubstr("scene.toml:5:17"), HasSubstr("`stretch_limit` is a setting of shells")));
}

TEST_F(ShellModel, IsDescribed) {
  const Model model = build(body());
  const auto json = nlohmann::json::parse(describe_json(model))["bodies"][0];
  EXPECT_EQ(json["model"], "shell");
  EXPECT_EQ(json["vertices"], 20);
  EXPECT_EQ(json["triangles"], 24);
  EXPECT_EQ(json["hinges"], 29);
  EXPECT_EQ(json["voxels"], 0);
  EXPECT_NEAR(json["mass"], 0.24, 1e-12);
  EXPECT_NEAR(json["area"], 0.48, 1e-12);
  EXPECT_THAT(describe_text(model), HasSubstr("20 vertices, 24 triangles, 29 hinges"));
}

TEST_F(ShellModel, PinsThatHoldDuringTheWholeRunClamp) {
  const auto bending = [&](const std::string& pin) {
    const Model model = build(body() + pin);
    const auto is_bending = [](const PotentialTerm& term) { return term.name == "cloth: bending"; };
    const auto term = std::find_if(model.potentials.begin(), model.potentials.end(), is_bending);
    return term->potential->value(test::rolled(model.rest_positions, 2));
  };
  const std::string all = "[[pin]]\nwhere = { plane = { point = [0, 0, 0], normal = [0, 1, 0] } }\n";
  const double free = bending("");
  EXPECT_GT(free, 0);
  EXPECT_EQ(bending(all), 0) << "held triangles store nothing";
  EXPECT_EQ(bending(all + "until = 1\n"), free);
  EXPECT_EQ(bending(all + "from = 0.5\n"), free);
}

TEST_F(ShellModel, ErrorsStateProblemAndPlace) {
  EXPECT_THAT(message(body("double.obj")),
              testing::AllOf(HasSubstr("scene.toml:3:8"), HasSubstr("double.obj: polygons 1 and 13"),
                             HasSubstr("delete double polygons")));
  EXPECT_THAT(message(body("sheet.obj", "voxel_width = 1\n")),
              HasSubstr("scene.toml:6:15: `voxel_width` is a setting"));
  const std::string lattice =
      "[[body]]\nmesh = 'sheet.obj'\nvoxel_width = 1\nmaterial = 'cotton'\nwarp = [1, 0, 0]\n";
  EXPECT_THAT(message(lattice), HasSubstr("`warp` is a setting of shells"));
  const auto with = [&](const std::string& material) {
    return message("[[body]]\nmesh = 'sheet.obj'\nmodel = 'shell'\nmaterial = " + material + "\n");
  };
  EXPECT_THAT(with("'oak'"),
              testing::AllOf(HasSubstr("scene.toml:4:12: the material `oak` has no numbers for a shell"),
                             HasSubstr("cotton")));
  EXPECT_THAT(with("{ areal_density = 1, bending_warp = 1 }"), HasSubstr("has no `membrane_warp`"));
  EXPECT_THAT(
      with(
          "{ areal_density = 1, membrane_warp = 1, bending_warp = 9, bending_weft = 1, bending_bias = 0.5 }"),
      HasSubstr("give `bending_bias` at least 2.875"));
  EXPECT_THAT(with("{ areal_density = 1, membrane_warp = 1, bending_warp = 1, poisson = 1 }"),
              HasSubstr("`poisson`"));
  EXPECT_THAT(with("{ base = 'steel' }"), HasSubstr("`steel` has no numbers for a shell"));
  EXPECT_EQ(with("{ base = 'denim', bending_warp = 1e-4 }"), "no error");
  EXPECT_THAT(message(body("sheet.obj", "warp = [0, 0, 0]\n")), HasSubstr("`warp` has no direction"));
}

}  // namespace
}  // namespace muslin
