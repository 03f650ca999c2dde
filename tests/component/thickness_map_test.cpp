// The thickness of shells in contact varies by a map.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "cache/scratch.hpp"
#include "support/sheet.hpp"
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "muslin/contact/contact_surface.hpp"
#include "muslin/core/index.hpp"
#include "muslin/geometry/closest_point.hpp"
#include "muslin/simulation/simulation.hpp"

namespace muslin {
namespace {

using testing::HasSubstr;

constexpr int columns = 16, rows = 6;
constexpr double length = 0.4, width = 0.15, range = 0.0005;

/// Soft sheets that fall onto a plane. `ramp.csv` rises from 0 to 1 along x, and the group `thick` has the
/// vertices of the far half.
class ThicknessMaps : public testing::Test {
 protected:
  ThicknessMaps() : sheet_(test::flat_sheet(columns, rows, length, width)) {
    MeshGroup thick{"thick", {}, {}};
    std::ofstream ramp(scratch_.path() / "ramp.csv");
    for (std::size_t v = 0; v < sheet_.vertex_count(); ++v) {
      ramp << fmt::format("{}\n", sheet_.positions[v].x() / length);
      if (sheet_.positions[v].x() > 0.5 * length) thick.vertices.push_back(static_cast<int>(v));
    }
    sheet_.groups = {thick};
  }

  static std::string sheet(const std::string& name, double height, const std::string& keys) {
    return fmt::format(
        "[[body]]\nname = '{}'\nmesh = 'sheet'\nmodel = 'shell'\nwarp = [1, 0, 0]\ntranslate = [0, {}, 0]\n"
        "material = {{ areal_density = 0.2, membrane_warp = 300, bending_warp = 1e-6, mass_damping = 20 "
        "}}\n{}\n",
        name, height, keys);
  }
  std::shared_ptr<const Model> model(const std::string& bodies) const {
    Scene scene = parse_scene(
        fmt::format("[time]\nduration = 2\nframe_rate = 24\n[contact]\ndistance = {}\n{}[[collider]]\nname = "
                    "'ground'\nshape = 'plane'\n[[force]]\ntype = 'gravity'\n",
                    range, bodies),
        scratch_.path() / "scene.toml");
    scene.meshes["sheet"] = std::make_shared<Mesh>(sheet_);
    return std::make_shared<const Model>(build_model(scene));
  }
  std::vector<Vec3> run(const std::string& keys, int frames) const {
    Simulation simulation(model(sheet("cloth", 0.0056, keys)));
    for (int f = 0; f < frames; ++f) simulation.advance();
    return simulation.state().positions;
  }
  std::string complaint(const std::string& thickness) const {
    try {
      model(sheet("cloth", 0.0056, "thickness = " + thickness));
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  }

  static constexpr const char* ramp = "thickness = { map = 'ramp.csv', from = 0.002, to = 0.01 }";

  test::Scratch scratch_;
  Mesh sheet_;
};

TEST_F(ThicknessMaps, OfOneValueEqualTheNumberBitForBit) {
  EXPECT_EQ(run("thickness = { map = 'ramp.csv', from = 0.01, to = 0.01 }", 4), run("thickness = 0.01", 4));
}

TEST_F(ThicknessMaps, LetASheetRestAtItsLocalHalfThickness) {
  const std::vector<Vec3> x = run(ramp, 48);
  for (std::size_t v = 0; v < sheet_.vertex_count(); ++v) {
    const double half = (0.002 + 0.008 * sheet_.positions[v].x() / length) / 2, gap = x[v].y() - half;
    EXPECT_GT(gap, 0) << v;
    EXPECT_LT(gap, range) << v;
  }
}

TEST_F(ThicknessMaps, KeepTwoSheetsApartEverywhere) {
  Simulation simulation(model(sheet("lower", 0.0015, "thickness = 0.001") + sheet("upper", 0.0085, ramp)));
  const std::size_t count = sheet_.vertex_count();
  const std::vector<Vec3i> triangles = triangulate(sheet_).triangles;
  double least = 1;
  for (int f = 0; f < 36; ++f) {
    simulation.advance();
    const std::vector<Vec3> x = simulation.state().positions;
    const ClosestPointQuery lower(
        std::vector<Vec3>(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(count)), triangles);
    least = 1;
    for (const Vec3i& t : triangles) {
      for (const Vec3& share : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(0.5, 0.5, 0),
                                Vec3(0.5, 0, 0.5), Vec3(0, 0.5, 0.5), Vec3(1. / 3, 1. / 3, 1. / 3)}) {
        Vec3 point = Vec3::Zero();
        double along = 0;
        for (int c = 0; c < 3; ++c) {
          point += share[c] * x[count + at(t[c])];
          along += share[c] * sheet_.positions[at(t[c])].x() / length;
        }
        const double touching = 0.0005 + (0.002 + 0.008 * along) / 2;
        least = std::min(least, (point - lower(point).point).norm() - touching);
      }
    }
    ASSERT_GT(least, 0) << f;
    ASSERT_GT(simulation.diagnostics().min_distance, 0);
    ASSERT_LE(simulation.diagnostics().min_distance, least) << "the gap of the map's own thickness is wider";
  }
  EXPECT_LT(least, range) << "they touch";
}

TEST_F(ThicknessMaps, CarryBallsAtTheThicknessBelowThem) {
  const auto ball = [](const char* name, double x) {
    return fmt::format(
        "[[collider]]\nname = '{}'\nshape = 'sphere'\ncenter = [{}, 0.0335, 0.075]\nradius = 0.02\ndensity = "
        "100\n",
        name, x);
  };
  Simulation simulation(
      model(sheet("cloth", 0.0056, "thickness = { map = 'thick', from = 0.002, to = 0.01 }") +
            ball("left", 0.1) + ball("right", 0.3)));
  for (int f = 0; f < 40; ++f) simulation.advance();
  const Model& built = simulation.model();
  const auto height = [&](const char* name) {
    const Component& body = built.body(name);
    Vec3 sum = Vec3::Zero();
    const std::vector<Vec3> x = simulation.state().positions;
    for (int v = 0; v < body.vertex_count; ++v) sum += x[at(body.first_vertex + v)];
    return sum.y() / body.vertex_count;
  };
  const double difference = height("right") - height("left");
  EXPECT_NEAR(difference, 0.008, 2 * range);
}

TEST_F(ThicknessMaps, ThatAreWrongAreErrorsAtTheirPlace) {
  std::ofstream(scratch_.path() / "short.csv") << "1\n0\n";
  std::ofstream(scratch_.path() / "text.csv") << "0.5\nnan\n";
  EXPECT_THAT(complaint("{ map = 'short.csv', from = 0, to = 0.001 }"),
              HasSubstr("the map `short.csv` of `thickness` has 2 numbers, but the mesh of body `cloth` has "
                        "119 vertices"));
  EXPECT_THAT(complaint("{ map = 'short.csv', from = 0, to = 0.001 }"), HasSubstr("scene.toml:13:"));
  EXPECT_THAT(complaint("{ map = 'text.csv', from = 0, to = 0.001 }"),
              HasSubstr("line 2: a number 'nan' is not a finite number"));
  EXPECT_THAT(complaint("{ map = 'thik', from = 0, to = 0.001 }"), HasSubstr("did you mean `thick`?"));
  EXPECT_THAT(complaint("{ map = 'thick', from = -0.001, to = 0.001 }"),
              HasSubstr("`thickness` is -0.001 at the `from` of its map"));
}

TEST(RadiusOfFeatures, IsTheGreatestOfTheirPoints) {
  const ContactSurface surface({{0, 1, 2}}, {0, 0, 0, 1}, {{0.3}, {0.5}}, {}, {},
                               {.friction = {}, .radius = {0.1, 0.3, 0.2, -1}});
  const std::vector<int> edge = {0, 2}, triangle = {0, 1, 2}, other = {3, 3, 3};
  EXPECT_EQ(surface.radius_of(edge), 0.2);
  EXPECT_EQ(surface.radius_of(triangle), 0.3);
  EXPECT_EQ(surface.radius_of(other), 0.5);
  EXPECT_EQ(surface.radius_of(0), 0.3) << "that of the body";
  EXPECT_THROW(
      ContactSurface({{0, 1, 2}}, {0, 0, 0}, {{0.1}}, {}, {}, {.friction = {}, .radius = {0, 0.2, 0}}),
      Error);
  EXPECT_THROW(ContactSurface({{0, 1, 2}}, {0, 0, 0}, {{0.1}}, {}, {}, {.friction = {}, .radius = {0}}),
               Error);
}

}  // namespace
}  // namespace muslin
