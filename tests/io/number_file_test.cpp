// Files with one number for each vertex.
#include "muslin/io/number_file.hpp"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "muslin/core/error.hpp"
#include "muslin/io/mesh_file.hpp"

namespace muslin {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::string message(const std::string& bytes, const std::string& file) {
  try {
    read_numbers_from(bytes, file);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

/// A file as numpy.save writes it.
template <class Number>
std::string npy(const std::string& type, const std::string& shape, const std::vector<Number>& numbers) {
  const std::string header = "{'descr': '" + type + "', 'fortran_order': False, 'shape': " + shape + ", }\n";
  std::string bytes("\x93NUMPY\x01\x00", 8);
  bytes += static_cast<char>(header.size());
  bytes += '\0';
  bytes += header;
  std::string data(numbers.size() * sizeof(Number), '\0');
  std::memcpy(data.data(), numbers.data(), data.size());
  return bytes + data;
}

TEST(NumberFile, ReadsALineOfTextThenANumberALine) {
  EXPECT_THAT(read_numbers_from("weight\r\n0.5\r\n\r\n-1e-3\r\n", "w.csv"), ElementsAre(0.5, -1e-3));
  EXPECT_THAT(read_numbers_from("1\n2", "w.csv"), ElementsAre(1, 2));
  EXPECT_THAT(message("1\ntwo\n", "w.csv"), HasSubstr("w.csv:2"));
  EXPECT_THAT(message("a\n1, 2\n", "w.csv"), HasSubstr("the line has more than one number"));
}

TEST(NumberFile, ReadsArraysOfNumPy) {
  EXPECT_THAT(read_numbers_from(npy<float>("<f4", "(3,)", {0.25F, 1, 2}), "w.npy"), ElementsAre(0.25, 1, 2));
  EXPECT_THAT(read_numbers_from(npy<double>("<f8", "(1,)", {0.1}), "w.npy"), ElementsAre(0.1));
  EXPECT_THAT(read_numbers_from(npy<std::uint8_t>("|u1", "(2,)", {0, 255}), "w.npy"), ElementsAre(0, 255));
  EXPECT_THAT(message(npy<float>("<f4", "(4,)", {1, 2, 3}), "w.npy"), HasSubstr("12 bytes, but 4 numbers"));
  EXPECT_THAT(message(npy<float>("<f4", "(3, 1)", {1, 2, 3}), "w.npy"), HasSubstr("one dimension"));
  EXPECT_THAT(message(npy<double>("<c8", "(1,)", {1}), "w.npy"), HasSubstr("another type"));
  EXPECT_THAT(message(npy<float>("<f4", "(1,)", {std::stof("nan")}), "w.npy"),
              HasSubstr("number 0, counted from 0, is not finite"));
  EXPECT_THAT(message("NUMPY", "w.npy"), HasSubstr("not a file of NumPy"));
  const std::string whole = npy<float>("<f4", "(3,)", {1, 2, 3});
  for (std::size_t n = 0; n < whole.size(); ++n)
    EXPECT_NE(message(whole.substr(0, n), "w.npy"), "no error") << n << " bytes";
}

TEST(VertexAttributes, AreFurtherPropertiesOfPly) {
  const MeshFile file = read_mesh_from(
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "property float paint\nproperty uchar red\nelement face 1\nproperty list uchar int vertex_indices\n"
      "end_header\n0 0 0 0.5 0\n1 0 0 1 255\n0 1 0 nan 51\n3 0 1 2\n",
      ".ply", "m.ply");
  ASSERT_EQ(file.attributes.size(), 2u);
  EXPECT_EQ(file.attributes[0].name, "paint");
  EXPECT_EQ(file.attributes[0].values[1], 1);
  EXPECT_TRUE(std::isnan(file.attributes[0].values[2]));
  EXPECT_EQ(file.attributes[1].name, "red");
  EXPECT_THAT(file.attributes[1].values, ElementsAre(0, 1, 0.2));
}

TEST(VertexAttributes, AreTheColoursOfObj) {
  const MeshFile file =
      read_mesh_from("v 0 0 0 0.1 0.2 0.3\nv 1 0 0 1 0 0\nv 0 1 0 0 1 0\nf 1 2 3\n", ".obj", "m.obj");
  ASSERT_EQ(file.attributes.size(), 3u);
  EXPECT_EQ(file.attributes[0].name, "red");
  EXPECT_THAT(file.attributes[0].values, ElementsAre(0.1, 1, 0));
  EXPECT_THAT(file.attributes[2].values, ElementsAre(0.3, 0, 0));
  EXPECT_TRUE(read_mesh_from("v 0 0 0 1\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", ".obj", "m.obj").attributes.empty());
}

}  // namespace
}  // namespace muslin
