// Files of measurements: what they say, and what is wrong with bad ones.
#include "muslin/fit/measurements.hpp"

#include <cmath>
#include <fstream>
#include <string>

#include "cache/scratch.hpp"
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "muslin/fit/points_file.hpp"
#include "muslin/schema/publish.hpp"

namespace muslin {
namespace {

using test::Scratch;
using test::write_bytes;
using testing::HasSubstr;

const std::string density = "areal_density = 0.12\n";

Measurements read(const Scratch& scratch, const std::string& text) {
  write_bytes(scratch / "m.toml", text);
  return read_measurements(scratch / "m.toml");
}

/// The message of the error of a file.
std::string refusal(const std::string& text, ErrorKind kind = ErrorKind::input) {
  const Scratch scratch;
  try {
    read(scratch, text);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), kind);
    return error.what();
  }
  return "none";
}

TEST(Measurements, RepeatsGiveTheirMeanAndItsError) {
  const Scratch scratch;
  const Measurements m = read(scratch,
                              "areal_density = [0.1, 0.12, 0.14]\n"
                              "thickness = { value = 3e-4, plus_minus = 1e-5 }\n"
                              "poisson = { value = 0.2, deviation = 0.06, count = 9 }\n");
  EXPECT_NEAR(m.areal_density->value, 0.12, 1e-15);
  EXPECT_NEAR(*m.areal_density->plus_minus, 0.02 / std::sqrt(3), 1e-15);
  EXPECT_EQ(*m.thickness->plus_minus, 1e-5);
  EXPECT_NEAR(*m.poisson->plus_minus, 0.02, 1e-15);
}

TEST(Measurements, UnitsBecomeSi) {
  const Scratch scratch;
  write_bytes(scratch / "warp.csv", "elongation;force\r\n# a remark\r\n1;2.5\r\n2;10\r\n");
  const Measurements m = read(scratch, density + R"(
[[tensile]]
direction = "weft"
file = "warp.csv"
strain_unit = "mm"
length = 0.2
force_unit = "N"
width = 0.05
plus_minus = 0.02
[[shear]]
points = [[0.1, 1]]
angle_unit = "radians"
force_unit = "gf/cm"
[[bending]]
direction = "warp"
points = [[0.5, 0.01], [1, 0.02]]
curvature_unit = "1/cm"
moment_unit = "gf cm/cm"
)");
  EXPECT_EQ(m.tensile[0].direction, Thread::weft);
  EXPECT_NEAR(m.tensile[0].points[1][0], 0.01, 1e-15);
  EXPECT_NEAR(m.tensile[0].points[1][1], 200, 1e-12);
  EXPECT_EQ(*m.tensile[0].factor.plus_minus, 0.02);
  EXPECT_NEAR(m.shear[0].points[0][0], 5.7295779513, 1e-9);
  EXPECT_NEAR(m.shear[0].points[0][1], 0.980665, 1e-12);
  EXPECT_NEAR(m.bending[0].points[1][0], 100, 1e-12);
  EXPECT_NEAR(m.bending[0].points[1][1], 0.02 * 0.00980665, 1e-12);
}

TEST(Measurements, KesSheetInItsUnits) {
  const Scratch scratch;
  const Measurements m = read(scratch, R"(
[kes]
W = 12.5
T = 0.55
[kes.warp]
EMT = 4
WT = 6.5
G = 1
2HG = 2
B = 0.1
2HB = 0.08
)");
  EXPECT_NEAR(m.areal_density->value, 0.125, 1e-15);
  EXPECT_NEAR(m.thickness->value, 5.5e-4, 1e-15);
  EXPECT_NEAR(m.kes->warp->extension->value, 0.04, 1e-15);
  EXPECT_NEAR(m.kes->warp->shear->value, 56.19, 0.01);
  EXPECT_NEAR(m.kes->warp->bending->value, 9.80665e-6, 1e-12);
  EXPECT_NEAR(m.kes->warp->bending_hysteresis->value, 7.8e-4, 1e-5);
  EXPECT_FALSE(m.kes->weft);
}

TEST(Measurements, OutlinesGiveTheDrape) {
  const Scratch scratch;
  for (const auto& [name, radius] : {std::pair{"a.csv", 260.0}, {"b.csv", 250.0}}) {
    std::ofstream file(scratch / name);
    for (int i = 0; i < 360; ++i)
      file << radius * std::cos(i * M_PI / 180) << ' ' << radius * std::sin(i * M_PI / 180) << '\n';
  }
  const Measurements m =
      read(scratch, density + "[drape]\noutlines = [\"a.csv\", \"b.csv\"]\noutline_unit = 0.0005\n");
  const auto share = [](double r) { return (r * r - 0.0081) / (0.0225 - 0.0081); };
  EXPECT_NEAR(m.drape->coefficient->value, (share(0.13) + share(0.125)) / 2, 1e-4);
  EXPECT_NEAR(*m.drape->coefficient->plus_minus, (share(0.13) - share(0.125)) / 2, 1e-4);
}

/// The message of the error of a drape's outline, a file of these lines.
std::string refused_outline(const std::string& lines) {
  const Scratch scratch;
  write_bytes(scratch / "o.csv", lines);
  try {
    read(scratch, density + "[drape]\noutlines = [\"o.csv\"]\n");
  } catch (const Error& error) {
    return error.what();
  }
  return "none";
}

TEST(Measurements, BadOutlinesHaveTheirLine) {
  const std::string around = "0.12 0\n0 0.12\n-0.12 0\n0 -0.12\n0.12 0\n";  // closed
  EXPECT_EQ(refused_outline(around), "none");
  EXPECT_THAT(
      refused_outline("0.12 0\n-0.12 0\n0 0.12\n0 -0.12\n"),
      HasSubstr("o.csv:3: the outline meets itself: its side from here meets that from line 1; list"));
  EXPECT_THAT(refused_outline(around + around), HasSubstr("meets itself"));
  EXPECT_THAT(refused_outline("0.12 0\n0.11 0.05\n0 0.18\n-0.11 0.05\n-0.12 0\n0 -0.12\n"),
              HasSubstr("o.csv:3: the outline leaves the specimen"));
  EXPECT_THAT(refused_outline("0.095 0.095\n0 0.02\n-0.095 0.095\n-0.095 -0.095\n0.095 -0.095\n"),
              HasSubstr("o.csv:2: the outline runs over the support"));
  EXPECT_THAT(refused_outline("0.12 0\n0 0.12\n"), HasSubstr("needs three points"));
  EXPECT_THAT(refused_outline("120 0\n0 120\n-120 0\n0 -120\n"), HasSubstr("check `outline_unit`"));
}

TEST(Measurements, UncertaintiesAreAboveZeroAndAtMostTheNumber) {
  const auto uncertain = [](const char* with) {
    return refusal(fmt::format("areal_density = {{ value = 0.1, {} }}\n", with));
  };
  EXPECT_THAT(uncertain("plus_minus = 0"), HasSubstr("give a number greater than 0 [kg/m²]"));
  EXPECT_THAT(uncertain("plus_minus = -0.01"), HasSubstr("give a number greater than 0 [kg/m²]"));
  EXPECT_THAT(uncertain("plus_minus = nan"), HasSubstr("give a number greater than 0 [kg/m²]"));
  EXPECT_THAT(uncertain("deviation = 0, count = 3"), HasSubstr("give a number greater than 0 [kg/m²]"));
  EXPECT_THAT(uncertain("plus_minus = 3"), HasSubstr("an uncertainty of 3 is above 100 % of 0.1; give"));
  EXPECT_THAT(uncertain("deviation = 0.3, count = 4"), HasSubstr("above 100 %"));
  const std::string strip = density + "[[tensile]]\ndirection = \"warp\"\npoints = [[0.01, 5]]\n";
  EXPECT_THAT(refusal(strip + "plus_minus = 0\n"), HasSubstr("above 0 to 1"));
  EXPECT_THAT(refusal(strip + "plus_minus = 1.5\n"), HasSubstr("above 0 to 1"));
  const Scratch scratch;
  // Poisson's ratio may be 0, of which no share is an uncertainty; equal repeats do not tell one.
  const Measurements m =
      read(scratch, "areal_density = [0.1, 0.1]\npoisson = { value = 0, plus_minus = 0.05 }\n");
  EXPECT_EQ(*m.poisson->plus_minus, 0.05);
  EXPECT_FALSE(m.areal_density->plus_minus);
}

TEST(Measurements, ListTheFilesThatWereRead) {
  const Scratch scratch;
  write_bytes(scratch / "warp.csv", "0.01,5\n");
  const Measurements m = read(scratch, density + "[[tensile]]\ndirection = \"warp\"\nfile = \"warp.csv\"\n");
  EXPECT_THAT(m.files, testing::ElementsAre(scratch / "m.toml", scratch / "warp.csv"));
}

TEST(Measurements, MissingFilesAreErrorsOfFiles) {
  EXPECT_THAT(refusal(density + "[[tensile]]\ndirection = \"warp\"\nfile = \"none.csv\"\n", ErrorKind::file),
              HasSubstr("none.csv"));
}

TEST(Measurements, BadFilesAreErrorsWithPlaceAndRemedy) {
  const std::string strip = density + "[[tensile]]\ndirection = \"warp\"\n";
  EXPECT_THAT(refusal("areal_densty = 0.1\n"),
              HasSubstr("m.toml:1:1: unknown key `areal_densty` in the file of "
                        "measurements; did you mean `areal_density`?"));
  EXPECT_THAT(refusal("areal_density = 120\n"), HasSubstr("give a number from 0.003 to 5 [kg/m²]"));
  EXPECT_THAT(refusal("name = \"x\"\n"), HasSubstr("add `areal_density = …`"));
  EXPECT_THAT(refusal(strip + "points = [[0.02, 5], [0.01, 9]]\n"),
              HasSubstr("m.toml:4:10: [[tensile]] 0: 0.01 "
                        "comes after 0.02; give the loading"));
  EXPECT_THAT(refusal(strip + "points = [[0.01, -5]]\n"), HasSubstr("is negative; subtract the offset"));
  EXPECT_THAT(refusal(strip + "points = [[1, 50], [4, 200]]\n"), HasSubstr("4 is beyond 2; give strains"));
  EXPECT_THAT(refusal(strip + "points = [[0.04, 490000]]\n"),
              HasSubstr("means 1.22e+07 N/m, which no fabric has; check the units"));
  EXPECT_THAT(refusal(strip + "points = [[0.04, 0.01]]\n"), HasSubstr("which no fabric has"));
  EXPECT_THAT(refusal(strip + "points = []\n"), HasSubstr("no force at its last point"));
  EXPECT_THAT(refusal(strip + "points = [[1]]\n"), HasSubstr("no pair of numbers"));
  EXPECT_THAT(refusal(strip + "points = [[1, 2]]\nforce_unit = \"N\"\nstrain_unit = \"%\"\n"),
              HasSubstr("forces in N need the `width`"));
  EXPECT_THAT(refusal(density + "[[bending]]\ndirection = \"warp\"\nbending_length = 21\n"),
              HasSubstr("from 0.002 to 0.3 [m]"));
  EXPECT_THAT(refusal(density + "[[bending]]\ndirection = \"warp\"\n"), HasSubstr("states 0 results"));
  EXPECT_THAT(refusal(density + "[[shear]]\nmodulus = 50\npoints = [[1, 1]]\n"),
              HasSubstr("keep one of them"));
  EXPECT_THAT(refusal(density + "[[shear]]\npoints = [[5, 4000000]]\n"),
              HasSubstr("fabrics have 0.1 to 1e+06 N/m"));
  EXPECT_THAT(refusal(density + "[[bending]]\ndirection = \"warp\"\npoints = [[100, 50]]\n"),
              HasSubstr("means 0.5 N·m, which no fabric has"));
  EXPECT_THAT(refusal(strip + "points = [[1e308, 1]]\n"), HasSubstr("from -1000000000 to 1000000000"));
  EXPECT_THAT(refusal(density + "[drape]\ncoefficient = 120\n"), HasSubstr("above 0 to 100 [%]"));
  EXPECT_THAT(refusal(density + "[drape]\n"), HasSubstr("[drape] has no `coefficient`"));
  EXPECT_THAT(refusal(density + "[kes]\n[kes.warp]\nEMT = 4\nWT = 6.5\nLT = 1\n"),
              HasSubstr("LT is 1, but WT and EMT make it 0.65; correct one of them"));
  EXPECT_THAT(refusal(density + "[kes]\n[kes.weft]\nWT = 6.5\n"),
              HasSubstr("m.toml:3:1: `weft` of [kes] has no `EMT`; add EMT"));
  EXPECT_THAT(refusal(density + "[kes]\n[kes.weft]\nLT = 0.6\n"), HasSubstr("has no `EMT`"));
  EXPECT_THAT(refusal(density + "[kes]\n[kes.warp]\nEMT = 4\nWT = 60\n"),
              HasSubstr("WT and EMT make LT 6, which no fabric has"));
  EXPECT_THAT(refusal(density + "[kes]\n[kes.warp]\n2HK = 4\n"), HasSubstr("did you mean"));
}

TEST(Measurements, BadPointsHaveTheirLine) {
  const Scratch scratch;
  write_bytes(scratch / "p.csv", "strain,force\n0.01,5\n0,02;9\n");
  try {
    read_points(scratch / "p.csv");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.place().line, 3);
    EXPECT_THAT(error.what(), HasSubstr("decimal points"));
  }
}

TEST(Measurements, FirstLinesOfSpreadsheetsAreRead) {
  const Scratch scratch;
  for (const char* text : {"\xef\xbb\xbf" "0.01,5\n0.02,15\n", "+0.01;+5\r\n0.02;15\r\n",
                           "\"0.01\",\"5\"\n\"0.02\",\"15\"\n", "strain,force\n%,N\n0.01\t5\n0.02\t15\n"}) {
    write_bytes(scratch / "p.csv", text);
    std::vector<Vec2> points;
    for (const PointRow& row : read_points(scratch / "p.csv")) points.push_back(row.point);
    EXPECT_THAT(points, testing::ElementsAre(Vec2(0.01, 5), Vec2(0.02, 15))) << text;
  }
  write_bytes(scratch / "p.csv", "nan,5\n0.02,15\n");
  EXPECT_THROW(read_points(scratch / "p.csv"), Error);
}

TEST(Measurements, GuideHasEveryKey) {
  std::ifstream file(std::string(MUSLIN_SOURCE_DIR) + "/docs/guide/fitting.md");
  std::stringstream guide;
  guide << file.rdbuf();
  const std::string tables = schema::markdown(measurements_table());
  for (std::size_t at = 0; at < tables.size();) {
    const std::size_t end = tables.find("<!-- end -->", at);
    const std::string block = tables.substr(at, end - at);
    EXPECT_NE(guide.str().find(block), std::string::npos) << block;
    at = end + 14;
  }
}

}  // namespace
}  // namespace muslin
