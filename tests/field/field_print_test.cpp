#include "muslin/field/field_print.hpp"

#include <sstream>
#include <vector>

#include "geometry/shapes.hpp"
#include <gtest/gtest.h>

#include "muslin/core/error.hpp"

namespace muslin {
namespace {

using Rows = std::vector<std::vector<std::string>>;

Rows rows_of(const std::string& text) {
  Rows rows;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream cells(line);
    rows.emplace_back();
    for (std::string cell; cells >> cell;) rows.back().push_back(cell);
  }
  return rows;
}

FieldPrintSettings at_z0() {
  FieldPrintSettings settings;
  settings.slice = Slice{2, 0};
  return settings;
}

void expect_ring(const Rows& rows, std::size_t columns, std::size_t count, const std::string& corner,
                 const std::string& ring, const std::string& inner) {
  ASSERT_EQ(rows.size(), count);
  for (std::size_t j = 0; j < count; ++j) {
    ASSERT_EQ(rows[j].size(), columns);
    for (std::size_t i = 0; i < columns; ++i) {
      const bool side = i == 0 || i == columns - 1, end = j == 0 || j == count - 1;
      EXPECT_EQ(rows[j][i], side && end ? corner : side || end ? ring : inner) << i << " " << j;
    }
  }
}

TEST(FieldPrint, Figure52OfTheThesis) {
  const Mesh flag = shapes::box(Vec3(-0.1, -0.1, -0.1), Vec3(10.1, 6.1, 0.1));
  expect_ring(rows_of(print_field(flag, at_z0())), 13, 9, "1.273", "0.900", "-0.100");
}

TEST(FieldPrint, Figure59OfTheThesis) {
  const Mesh flag = shapes::box(Vec3(0.1, 0.1, -0.15), Vec3(9.9, 5.9, 0.15));
  expect_ring(rows_of(print_field(flag, at_z0())), 11, 7, "0.141", "0.100", "-0.150");
}

TEST(FieldPrint, Figure48OfTheThesis) {
  const Mesh shape = shapes::box(Vec3(0.1, 0.6, -0.3), Vec3(9.9, 6.4, 0.3));
  FieldPrintSettings settings = at_z0();
  settings.margin = parse_margin("3,1");
  const Rows rows = rows_of(print_field(shape, settings));
  ASSERT_EQ(rows.size(), 8u);
  const std::vector<std::string> bottom(rows.back().begin(), rows.back().begin() + 6);
  EXPECT_EQ(bottom, (std::vector<std::string>{"2.184", "1.253", "0.608", "0.600", "0.600", "0.600"}));
  for (std::size_t j = 1; j < 7; ++j) {
    const std::vector<std::string> left(rows[j].begin(), rows[j].begin() + 6);
    EXPECT_EQ(left, (std::vector<std::string>{"2.100", "1.100", "0.100", "-0.300", "-0.300", "-0.300"}));
  }
}

TEST(FieldPrint, FlatSheetIsOneVoxelThickByDefault) {
  FieldPrintSettings settings = at_z0();
  const Mesh sheet = shapes::rectangle(10, 6);
  EXPECT_EQ(rows_of(print_field(sheet, settings))[4][6], "-0.500");
  settings.thickness = 0.2;
  const Rows rows = rows_of(print_field(sheet, settings));
  ASSERT_EQ(rows.size(), 9u);
  ASSERT_EQ(rows[0].size(), 13u);
  EXPECT_EQ(rows[4][6], "-0.100");
  EXPECT_EQ(rows[4][0], "1.000");
  EXPECT_EQ(rows[4][1], "0.000");  // on the rim, never -0.000
  EXPECT_EQ(rows[0][0], "1.414");
  settings.thickness = 0;
  EXPECT_EQ(rows_of(print_field(sheet, settings))[4][6], "0.000");
}

TEST(FieldPrint, NeverPrintsMinusZero) {
  const Mesh box = shapes::box(Vec3(-0.0002, -0.0002, -1), Vec3(5.0002, 5.0002, 1));
  EXPECT_EQ(print_field(box, at_z0()).find("-0.000"), std::string::npos);
}

TEST(FieldPrint, SlicesLieExactlyAtTheRequestedPlane) {
  const Mesh box = shapes::box(Vec3::Zero(), Vec3(4, 6, 2));
  FieldPrintSettings settings;
  settings.slice = Slice{0, 0.25};
  Rows rows = rows_of(print_field(box, settings));
  ASSERT_EQ(rows.size(), 9u);     // y
  ASSERT_EQ(rows[0].size(), 5u);  // z
  EXPECT_EQ(rows[4][2], "-0.250");
  settings.slice = Slice{1, 3};
  rows = rows_of(print_field(box, settings));
  ASSERT_EQ(rows.size(), 5u);     // z
  ASSERT_EQ(rows[0].size(), 7u);  // x
  EXPECT_EQ(rows[2][3], "-1.000");
  settings.slice.reset();  // across the thinnest axis: z = 1
  rows = rows_of(print_field(box, settings));
  ASSERT_EQ(rows.size(), 9u);
  ASSERT_EQ(rows[0].size(), 7u);
}

TEST(FieldPrint, LargestYFirst) {
  const Mesh wedge = shapes::box(Vec3(0, 0, -1), Vec3(3, 2.75, 1));
  const Rows rows = rows_of(print_field(wedge, at_z0()));
  EXPECT_EQ(rows.front()[2], "0.250");  // y = 3, 0.25 above the top
  EXPECT_EQ(rows.back()[2], "1.000");   // y = −1
}

TEST(FieldPrint, CsvHasAllDigits) {
  FieldPrintSettings settings = at_z0();
  settings.csv = true;
  const std::string text = print_field(shapes::box(Vec3(-0.1, -0.1, -0.1), Vec3(10.1, 6.1, 0.1)), settings);
  std::istringstream lines(text);
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, "x,y,z,distance");
  std::getline(lines, line);
  double x, y, z, d;
  ASSERT_EQ(std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf", &x, &y, &z, &d), 4);
  EXPECT_EQ(Vec3(x, y, z), Vec3(-1, 7, 0));
  EXPECT_NEAR(d, 0.9 * std::sqrt(2.0), 1e-15);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1 + 13 * 9);
}

TEST(FieldPrint, SamplesAreMultiplesOfTheWidthAlsoWhereItRounds) {
  FieldPrintSettings settings = at_z0();
  settings.voxel_width = 0.1;
  const Rows rows = rows_of(print_field(shapes::box(Vec3(0.3, 0.3, -1), Vec3(0.6, 0.7, 1)), settings));
  ASSERT_EQ(rows.size(), 7u);     // 0.2 … 0.8
  ASSERT_EQ(rows[0].size(), 6u);  // 0.2 … 0.7
}

TEST(FieldPrint, RejectsInvalidSettings) {
  const Mesh box = shapes::box(Vec3::Zero(), Vec3::Ones());
  FieldPrintSettings settings;
  settings.voxel_width = 0;
  EXPECT_THROW(print_field(box, settings), Error);
  settings.voxel_width = 1e-9;
  EXPECT_THROW(print_field(box, settings), Error);
  settings.voxel_width = 1;
  settings.margin = Vec3i(-1, 0, 0);
  EXPECT_THROW(print_field(box, settings), Error);
  settings.margin = Vec3i::Ones();
  settings.thickness = -1;
  EXPECT_THROW(print_field(shapes::rectangle(1, 1), settings), Error);
}

TEST(ParseSlice, ReadsAxisAndValue) {
  EXPECT_EQ(parse_slice("z=0").axis, 2);
  EXPECT_EQ(parse_slice("x=-0.5").value, -0.5);
  EXPECT_EQ(parse_slice("y=1e-3").axis, 1);
  for (const char* bad : {"", "z", "z=", "w=0", "z=a", "z=0 ", "z:0", "z=nan", "z=inf", "0"})
    EXPECT_THROW(parse_slice(bad), Error) << bad;
}

TEST(ParseMargin, ReadsOneOrSeveralNumbers) {
  EXPECT_EQ(parse_margin("2"), Vec3i(2, 2, 2));
  EXPECT_EQ(parse_margin("3,1"), Vec3i(3, 1, 1));
  EXPECT_EQ(parse_margin("3,1,0"), Vec3i(3, 1, 0));
  for (const char* bad : {"", "-1", "a", "1,", ",1", "1,2,3,4", "1.5", "99999"})
    EXPECT_THROW(parse_margin(bad), Error) << bad;
}

}  // namespace
}  // namespace muslin
