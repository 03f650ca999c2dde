// Several fabrics in one shell: each face group has its numbers and maps.
#include "muslin/component/shell/shell_fabric.hpp"

#include <array>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "support/strip_scene.hpp"
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "muslin/component/shell/shell_body.hpp"
#include "muslin/core/index.hpp"
#include "muslin/energy/shell_bending.hpp"
#include "muslin/simulation/simulation.hpp"

namespace muslin {
namespace {

using testing::HasSubstr;

constexpr const char* soft = "{ areal_density = 0.1, membrane_warp = 50, bending_warp = 1e-5, poisson = 0";
constexpr const char* stiff = "{ areal_density = 0.3, membrane_warp = 200, bending_warp = 4e-5, poisson = 0";

/// A strip along x, held at x = 0. The group `cuff` has the faces of its far half, `all` every face, `tip`
/// the vertices at its far end.
class Fabrics : public test::StripScene {
 protected:
  Fabrics() {
    MeshGroup all{"all", {}, {}}, cuff{"cuff", {}, {}}, tip{"tip", {}, {}};
    for (int f = 0; f < columns * rows; ++f) {
      all.faces.push_back(f);
      if (f % columns >= columns / 2) cuff.faces.push_back(f);
    }
    for (int k = 0; k <= rows; ++k) tip.vertices.push_back(columns + k * (columns + 1));
    sheet_.groups = {all, cuff, tip};
  }
  std::shared_ptr<const Model> model(const std::string& material, const std::string& fabrics,
                                     const std::string& rest = "", const std::string& mesh = "sheet") const {
    return model_of("model = 'shell'\nwarp = [1, 0, 0]\n" + material + "\n" + fabrics, rest, mesh);
  }
  static std::string plain(const std::string& numbers) { return "material = " + numbers + " }"; }
  static std::string fabric(const std::string& faces, const std::string& numbers) {
    return fmt::format("[[body.fabric]]\nfaces = '{}'\nmaterial = {} }}\n", faces, numbers);
  }
  std::string complaint(const std::string& fabrics) const {
    return complaint_of("model = 'shell'\nwarp = [1, 0, 0]\n" + plain(soft) + "\n" + fabrics);
  }

  static constexpr const char* gravity = "[[force]]\ntype = 'gravity'\n";
};

TEST_F(Fabrics, OneForAllFacesEqualsTheMaterialBitForBit) {
  const std::string numbers =
      std::string(stiff) +
      ", stretch_limit = 1.1, mass_damping = 0.3, stiffness_damping = 0.01, yield_curvature = 30";
  const std::vector<Vec3> as_material = run(model(plain(numbers), "", gravity), 4);
  expect_same_bits(run(model(plain(soft), fabric("all", numbers), gravity), 4), as_material);
}

TEST_F(Fabrics, StretchAsSpringsInSeries) {
  const double force = 1;  // per width [N/m]
  const auto strip = model(plain(std::string(soft) + ", mass_damping = 40"),
                           fabric("cuff", std::string(stiff) + ", mass_damping = 40"),
                           fmt::format("[[force]]\ntype = 'point'\nforce = [{}, 0, 0]\nwhere = {{ group = "
                                       "'tip' }}\n",
                                       force * width / (rows + 1)));
  const std::vector<Vec3> x = run(strip, 100);
  // The stress S = F/λ of a strip is K (λ² − 1)/2.
  const auto stretch = [&](double modulus) {
    double stretched = 1;
    for (int i = 0; i < 50; ++i) stretched = std::sqrt(1 + 2 * force / (modulus * stretched));
    return stretched;
  };
  double middle = 0, end = 0;
  for (int k = 0; k <= rows; ++k) {
    middle += x[at(columns / 2 + k * (columns + 1))].x() / (rows + 1);
    end += x[at(columns + k * (columns + 1))].x() / (rows + 1);
  }
  EXPECT_NEAR(middle / (length / 2) - 1, stretch(50) - 1, 0.02 * (stretch(50) - 1));
  EXPECT_NEAR((end - middle) / (length / 2) - 1, stretch(200) - 1, 0.02 * (stretch(200) - 1));
}

TEST_F(Fabrics, BendEachWithItsRigidity) {
  const auto energy = [&](const std::shared_ptr<const Model>& strip) {
    const ShellBody& body = *as_shell(strip->bodies[0]);
    std::vector<BendingModuli> moduli;
    for (std::size_t t = 0; t < body.shell.triangles.size(); ++t) {
      const ShellMaterial& m = body.material_at(t);
      moduli.push_back({m.bending_warp, m.bending_weft, m.bending_bias, m.poisson});
    }
    return ShellBending(body.shell, moduli, nullptr, {}).value(test::rolled(sheet_.positions, 0.5));
  };
  const double of_soft = energy(model(plain(soft), "")), of_stiff = energy(model(plain(stiff), ""));
  EXPECT_NEAR(energy(model(plain(soft), fabric("cuff", stiff))), (of_soft + of_stiff) / 2, 1e-6 * of_soft);
}

TEST_F(Fabrics, HaveTheirAreasAndMassesInTheDescription) {
  const auto strip = model(plain(soft), fabric("cuff", stiff));
  const auto json = nlohmann::json::parse(strip->bodies[0].description_json());
  ASSERT_EQ(json["fabrics"].size(), 2u);
  EXPECT_EQ(json["fabrics"][0]["name"], "inline");
  EXPECT_EQ(json["fabrics"][1]["name"], "cuff");
  for (int f = 0; f < 2; ++f) {
    EXPECT_NEAR(double(json["fabrics"][at(f)]["area"]), 0.1, 1e-12);
    EXPECT_NEAR(double(json["fabrics"][at(f)]["mass"]), f == 0 ? 0.01 : 0.03, 1e-12);
  }
  EXPECT_NEAR(strip->bodies[0].statistics.mass, 0.04, 1e-12);
  EXPECT_THAT(strip->bodies[0].description(),
              HasSubstr("  fabric      cuff\n  mass        0.03 kg of inline"));
}

TEST_F(Fabrics, DampEachItsOwnMass) {
  const auto strip =
      model(plain(std::string(soft) + ", mass_damping = 2"), fabric("cuff", std::string(stiff)));
  const ShellBody& body = *as_shell(strip->bodies[0]);
  const std::vector<double> masses = body.masses(), dampings = body.mass_dampings();
  EXPECT_NEAR(dampings[3], 2 * masses[3], 1e-15);
  EXPECT_EQ(dampings[columns], 0);
  // A vertex between both has half of its area in each.
  const std::size_t between = columns / 2 + columns + 1;
  EXPECT_NEAR(dampings[between], 2 * 0.25 * masses[between], 1e-15);
}

TEST_F(Fabrics, LimitTheirOwnStretchOnly) {
  const auto one = model(plain(soft), fabric("cuff", std::string(stiff) + ", stretch_limit = 1.01"));
  EXPECT_FALSE(one->bodies[0].stretch_limit(0).has_value());
  const auto each = model(plain(std::string(soft) + ", stretch_limit = 1.2"),
                          fabric("cuff", std::string(stiff) + ", stretch_limit = 1.01"));
  EXPECT_EQ(each->bodies[0].stretch_limit(0), 1.2) << "the largest";
  const auto body = model("stretch_limit = 1.5\n" + plain(soft),
                          fabric("cuff", std::string(stiff) + ", stretch_limit = 1.01"));
  EXPECT_EQ(body->bodies[0].stretch_limit(0), 1.5) << "that of the body replaces all";
  const std::string pull = "[[force]]\ntype = 'point'\nforce = [3, 0, 0]\nwhere = { group = 'tip' }\n";
  const std::string damped = ", mass_damping = 20";
  const std::vector<Vec3> x =
      run(model(plain(soft + damped), fabric("cuff", std::string(stiff) + damped + ", stretch_limit = 1.01"),
                pull),
          50);
  const double middle = x[columns / 2].x(), end = x[columns].x();
  EXPECT_GT(middle, 1.2 * length / 2);
  EXPECT_LT(end - middle, 1.02 * length / 2);
}

TEST_F(Fabrics, HaveTheirOwnMapsAndKeyframes) {
  std::ofstream ramp(scratch_.path() / "ramp.csv");
  for (const Vec3& p : sheet_.positions) ramp << p.x() / length << '\n';
  ramp.close();
  const std::string mapped =
      "{ areal_density = 0.1, membrane_warp = 50, bending_warp = { map = 'ramp.csv', from = 1e-5, to = 2e-5 "
      "}, "
      "poisson = 0";
  const std::string keyed =
      "{ areal_density = 0.3, membrane_warp = { keyframes = [{ time = 0, value = 200 }, { time = 0.1, value "
      "= "
      "400 }] }, bending_warp = 4e-5, poisson = 0";
  const auto strip = model(plain(mapped), fabric("cuff", keyed), gravity);
  ASSERT_EQ(strip->bodies[0].maps.size(), 2u) << "of warp and of weft, which follows";
  EXPECT_EQ(strip->bodies[0].maps[0].variation.key, "inline.bending_warp");
  const std::vector<ShellMaterial> later = as_shell(strip->bodies[0])->materials_of_triangles(0.1);
  EXPECT_EQ(later.front().membrane_warp, 50);
  EXPECT_EQ(later[2 * columns - 1].membrane_warp, 400);
  EXPECT_EQ(later[2 * columns - 1].bending_warp, 4e-5);
  EXPECT_GT(later[columns - 1].bending_warp, 1.4e-5);
  Simulation simulation(strip);
  const double balance = simulation.diagnostics().balance();
  for (int f = 0; f < 5; ++f) simulation.advance();
  EXPECT_GT(simulation.diagnostics().material_work, 0);
  EXPECT_NEAR(simulation.diagnostics().balance() - simulation.diagnostics().unbalanced, balance, 1e-9);
}

TEST_F(Fabrics, AreFoundByTheMaterialsOfAnObjFile) {
  std::ofstream(scratch_.path() / "two.obj") << "v 0 0 0\nv 0 0 1\nv 1 0 1\nv 1 0 0\nv 2 0 1\nv 2 0 "
                                                "0\nusemtl Blue Cotton\nf 1 2 3 4\nusemtl rib\nf 4 3 "
                                                "5 6\n";
  const auto strip = model(plain(soft), fabric("rib", stiff), "", "two.obj");
  EXPECT_EQ(as_shell(strip->bodies[0])->triangle_fabrics, (std::vector{0, 0, 1, 1}));
  const auto both = model(plain(soft), fabric("rib", stiff) + fabric("Blue Cotton", stiff), "", "two.obj");
  EXPECT_EQ(as_shell(both->bodies[0])->fabrics.front().name, "rib") << "no face has the material of the body";
}

TEST_F(Fabrics, ThatAreWrongAreErrorsAtTheirPlace) {
  EXPECT_THAT(
      complaint(fabric("cufs", stiff)),
      HasSubstr("scene.toml:12:1: the mesh has no face group or material `cufs`; did you mean `cuff`?"));
  EXPECT_THAT(complaint(fabric("tip", stiff)),
              HasSubstr("the group `tip` of the mesh has vertices, but no faces"));
  EXPECT_THAT(complaint(fabric("cuff", stiff) + fabric("all", stiff)),
              HasSubstr("polygon 11 belongs to the fabrics of `cuff` and of `all`"));
  EXPECT_THAT(
      complaint(fabric("cuff", std::string(stiff) + ", yield_curvature = 30")),
      HasSubstr("the fabric `cuff` has a `yield_curvature`, which a body of several fabrics cannot have"));
  EXPECT_THAT(complaint("[[body.fabric]]\nfaces = 'cuff'\n"), HasSubstr("has no `material`"));
  EXPECT_THAT(complaint("[[body.fabric]]\nface = 'cuff'\n"), HasSubstr("did you mean `faces`?"));
  EXPECT_THAT(complaint("[[body.fabric]]\nfaces = 'cuff'\nmaterial = 'coton'\n"),
              HasSubstr("did you mean `cotton`?"));
}

TEST_F(Fabrics, ChangeTheHashThatASavedStateMustFit) {
  const auto hash = [&](const char* faces) {
    return model(plain(soft), fabric(faces, stiff))->bodies[0].material_hash(0);
  };
  EXPECT_EQ(hash("cuff"), hash("cuff"));
  EXPECT_NE(hash("cuff"), hash("all"));
}

}  // namespace
}  // namespace muslin
