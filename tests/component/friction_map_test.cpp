// Friction varies over bodies by maps and by fabrics.
#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "cache/scratch.hpp"
#include "support/sheet.hpp"
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "muslin/contact/contact_surface.hpp"
#include "muslin/core/index.hpp"
#include "muslin/simulation/simulation.hpp"

namespace muslin {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr double slope = 20 * std::numbers::pi / 180, g = 9.81;

/// Two squares of cloth that are one body, on a slope of 20° that falls along x, of friction 1: a contact has
/// the root of the body's friction. The group `slick` has the vertices and faces of the first square, whose
/// vertices come first.
class FrictionMaps : public testing::Test {
 protected:
  FrictionMaps() : mesh_(test::flat_sheet(4, 4, 0.1, 0.1)), square_(static_cast<int>(mesh_.vertex_count())) {
    MeshGroup slick{"slick", {}, {}}, all{"all", {}, {}};
    const Mesh square = mesh_;
    for (const Vec3& p : square.positions) mesh_.positions.emplace_back(p + Vec3(0, 0, 0.3));
    for (std::size_t f = 0; f < square.face_count(); ++f) {
      std::array<int, 4> face{};
      for (std::size_t c = 0; c < 4; ++c) face[c] = square_ + square.face_vertices[4 * f + c];
      mesh_.add_face(face);
      slick.faces.push_back(static_cast<int>(f));
    }
    for (int v = 0; v < square_; ++v) slick.vertices.push_back(v);
    for (int f = 0; f < static_cast<int>(mesh_.face_count()); ++f) all.faces.push_back(f);
    mesh_.groups = {slick, all};
  }

  std::shared_ptr<const Model> model(const std::string& body, const std::string& rest = "") const {
    Scene scene = parse_scene(
        "[time]\nduration = 1\nframe_rate = 24\n[contact]\ndistance = 0.002\n[[body]]\nname = "
        "'cloth'\nmesh = 'squares'\nself_contact = false\ntranslate = [0, 0.0025, 0]\n" +
            body +
            fmt::format("\n[[collider]]\nname = 'slope'\nshape = 'plane'\nfriction = 1\n[[force]]\ntype = "
                        "'gravity'\nacceleration = [{}, {}, 0]\n",
                        g * std::sin(slope), -g * std::cos(slope)) +
            rest,
        scratch_.path() / "scene.toml");
    scene.meshes["squares"] = std::make_shared<Mesh>(mesh_);
    return std::make_shared<const Model>(build_model(scene));
  }
  std::vector<Vec3> run(const std::string& body, const std::string& rest = "", int frames = 3) const {
    Simulation simulation(model(body, rest));
    for (int f = 0; f < frames; ++f) simulation.advance();
    const ConstVectors x = simulation.state().positions;
    return {x.begin(), x.end()};
  }
  std::string complaint(const std::string& body) const {
    try {
      model(body);
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  }
  /// The vertices' weights 0, 1/(n − 1), …, 1 in `ramp.csv`.
  void write_ramp() const {
    std::string ramp = "weight\n";
    const std::size_t count = mesh_.vertex_count();
    for (std::size_t v = 0; v < count; ++v)
      ramp += fmt::format("{}\n", static_cast<double>(v) / static_cast<double>(count - 1));
    std::ofstream(scratch_.path() / "ramp.csv") << ramp;
  }

  static constexpr const char* shell =
      "model = 'shell'\nthickness = 0.001\nmaterial = { areal_density = 0.3, membrane_warp = 3000, "
      "bending_warp = 0.01 }\n";

  test::Scratch scratch_;
  Mesh mesh_;
  int square_;
};

TEST_F(FrictionMaps, OfOneValueEqualTheNumberBitForBit) {
  write_ramp();
  const std::string number = "friction = 0.3\n",
                    map = "friction = { map = 'ramp.csv', from = 0.3, to = 0.3 }\n";
  const std::string lattice =
      "thickness = 0.01\nvoxel_width = 0.025\nmaterial = { density = 90, youngs_modulus = 3000 }\n";
  for (const std::string& body : {std::string(shell), lattice})
    EXPECT_EQ(run(body + number), run(body + map));
}

TEST_F(FrictionMaps, LetTheSlickSquareSlideAndTheRoughOneStick) {
  // √0.01 = 0.1 < tan 20° = 0.36 < √0.36 = 0.6.
  Simulation simulation(model(std::string(shell) + "friction = { map = 'slick', from = 0.36, to = 0.01 }"));
  const auto velocity = [&](int first) {
    Vec3 sum = Vec3::Zero();
    for (int v = first; v < first + square_; ++v) sum += simulation.state().velocities[at(v)];
    return Vec3(sum / square_);
  };
  for (int f = 0; f < 6; ++f) simulation.advance();
  const double before = velocity(0).x();
  const Vec3 stuck = simulation.state().positions[at(square_)];
  for (int f = 0; f < 6; ++f) simulation.advance();
  const double expected = g * (std::sin(slope) - 0.1 * std::cos(slope)) * 6 / 24;
  EXPECT_NEAR(velocity(0).x() - before, expected, 0.01 * expected);
  EXPECT_LT((simulation.state().positions[at(square_)] - stuck).norm(), 1e-5);
}

TEST_F(FrictionMaps, OfFabricsEqualThoseOfTheirVertices) {
  write_ramp();
  const std::string body = std::string(shell) + "friction = 0.5\n[[body.fabric]]\nfaces = 'slick'\n" +
                           "material = { areal_density = 0.3, membrane_warp = 3000, bending_warp = 0.01 }\n";
  const std::vector<Vec3> by_vertices =
      run(std::string(shell) +
          "friction = { map = 'slick', from = 0.5, to = 0.0625 }\n[[body.fabric]]\nfaces "
          "= 'slick'\nmaterial = { areal_density = 0.3, membrane_warp = 3000, "
          "bending_warp = 0.01 }\n");
  EXPECT_EQ(run(body + "friction = 0.0625"), by_vertices);
  EXPECT_EQ(run(body + "friction = { map = 'ramp.csv', from = 0.0625, to = 0.0625 }"), by_vertices);
  EXPECT_NE(run(body), by_vertices);
  const std::string ramp = "friction = { map = 'ramp.csv', from = 0, to = 1 }\n";
  EXPECT_EQ(run(std::string(shell) +
                "[[body.fabric]]\nfaces = 'all'\nmaterial = { areal_density = 0.3, "
                "membrane_warp = 3000, bending_warp = 0.01 }\n" +
                ramp),
            run(shell + ramp))
      << "one fabric on all faces";
}

TEST_F(FrictionMaps, YieldToThePairOfBodies) {
  const std::string pair = "[[contact.pair]]\nbetween = ['cloth', 'slope']\nfriction = 0.2\n";
  EXPECT_EQ(run(std::string(shell) + "friction = { map = 'slick', from = 0.36, to = 0.01 }", pair),
            run(shell, pair));
}

TEST_F(FrictionMaps, ChangeOnAResume) {
  const auto with = [&](const char* to) {
    return model(std::string(shell) + "friction = { map = 'slick', from = 0.36, to = " + to + " }");
  };
  Simulation before(with("0.36"));
  for (int f = 0; f < 6; ++f) before.advance();
  EXPECT_LT(before.state().velocities.front().norm(), 1e-3);
  Simulation after(with("0"));
  after.restore(before.checkpoint());
  for (int f = 0; f < 6; ++f) after.advance();
  EXPECT_NEAR(after.state().velocities.front().x(), g * std::sin(slope) * 6 / 24, 0.01);
}

TEST_F(FrictionMaps, AreListedAndRefusedByName) {
  write_ramp();
  const auto listed = model(std::string(shell) +
                            "friction = { map = 'ramp.csv', from = 0, to = 1 }\n[[body.fabric]]\nfaces = "
                            "'slick'\nmaterial = { areal_density = 0.3, membrane_warp = 3000, bending_warp "
                            "= 0.01 }\nfriction = { map = 'slick', from = 0.1, to = 0.2 }\n");
  std::vector<std::string> keys;
  for (const MappedNumber& map : listed->bodies[0].maps) keys.push_back(map.variation.key);
  EXPECT_THAT(keys, ElementsAre("friction", "slick.friction"));

  std::ofstream(scratch_.path() / "short.csv") << "1\n0\n";
  std::ofstream(scratch_.path() / "text.csv") << "weight\n0.5\nnan\n";
  const auto with = [&](const std::string& map) { return complaint(shell + ("friction = " + map)); };
  EXPECT_THAT(
      with("{ map = 'short.csv', from = 0, to = 1 }"),
      HasSubstr("the map `short.csv` of `friction` has 2 numbers, but the mesh of body `cloth` has 50 "
                "vertices"));
  EXPECT_THAT(with("{ map = 'short.csv', from = 0, to = 1 }"), HasSubstr("scene.toml:14:"));
  EXPECT_THAT(with("{ map = 'text.csv', from = 0, to = 1 }"),
              HasSubstr("line 3: a number 'nan' is not a finite number"));
  EXPECT_THAT(with("{ map = 'slik', from = 0, to = 1 }"), HasSubstr("did you mean `slick`?"));
  EXPECT_THAT(with("{ map = 'slick', from = -0.1, to = 1 }"), HasSubstr("`from`"));
}

TEST(FrictionOfPoints, IsInterpolatedAndExactWhereItIsEven) {
  const ContactSurface surface({{0, 1, 2}}, {0, 0, 0, 1}, {{}, {.friction = 0.25}}, {}, {},
                               {.friction = {0.1, 0.3, 0.8, -1}, .radius = {}});
  const std::array triangle = {0, 1, 2}, other = {3, 3, 3};
  const std::array weights = {-0.2, -0.5, -0.3};
  const std::array one = {1.0};
  const auto friction = [&](const ContactSurface& of) {
    return of.friction({{other.data(), 1}, one}, {triangle, weights}, 0.5, 0);
  };
  EXPECT_DOUBLE_EQ(friction(surface), std::sqrt(0.25 * (0.2 * 0.1 + 0.5 * 0.3 + 0.3 * 0.8)));
  const ContactSurface even({{0, 1, 2}}, {0, 0, 0, 1}, {{}, {.friction = 0.3}}, {}, {},
                            {.friction = {0.3, 0.3, 0.3, -1}, .radius = {}});
  EXPECT_EQ(friction(even), 0.3);
  const ContactSurface common({{0, 1, 2}}, {0, 0, 0, 1}, {{}, {}}, {}, {},
                              {.friction = {-1, -1, -1, 0.7}, .radius = {}});
  EXPECT_EQ(friction(common), std::sqrt(0.7 * 0.5));
  EXPECT_THROW(ContactSurface({{0, 1, 2}}, {0, 0, 0}, {{}}, {}, {}, {.friction = {0.1}, .radius = {}}),
               Error);
}

}  // namespace
}  // namespace muslin
