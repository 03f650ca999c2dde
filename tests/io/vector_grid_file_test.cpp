// Grids of vectors from NumPy's files: both float types and byte orders, and every defect named.
#include "muslin/io/vector_grid_file.hpp"

#include <cstring>
#include <limits>
#include <random>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "muslin/core/error.hpp"

namespace muslin {
namespace {

using testing::HasSubstr;

template <class Number>
std::string npy(const std::string& descr, const std::string& shape, const std::vector<Number>& numbers,
                const std::string& fortran = "False") {
  const std::string header =
      fmt::format("{{'descr': '{}', 'fortran_order': {}, 'shape': {}, }}\n", descr, fortran, shape);
  std::string bytes("\x93NUMPY\x01\x00", 8);
  bytes += static_cast<char>(header.size() & 255);
  bytes += static_cast<char>(header.size() >> 8);
  bytes += header;
  bytes.append(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(Number));
  return bytes;
}

template <class Number>
std::vector<Number> counting(std::size_t count) {
  std::vector<Number> numbers(count);
  for (std::size_t i = 0; i < count; ++i) numbers[i] = static_cast<Number>(i);
  return numbers;
}

std::string message(const std::string& bytes) {
  try {
    read_vector_grid_from(bytes, "wind.npy");
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    EXPECT_THAT(error.what(), HasSubstr("wind.npy: "));
    return error.what();
  }
  return "no error";
}

TEST(VectorGridFile, HasTheLastAxisNext) {
  const std::string bytes = npy("<f4", "(2, 3, 4, 3)", counting<float>(72));
  const VectorGrid grid = read_vector_grid_from(bytes, "wind.npy");
  EXPECT_EQ(grid.size, (std::array<std::size_t, 3>{2, 3, 4}));
  ASSERT_EQ(grid.vectors.size(), 24u);
  EXPECT_EQ(grid.vectors[(1 * 3 + 2) * 4 + 1], Vec3(63, 64, 65));
  EXPECT_EQ(read_vector_grid_from(npy("<f8", "(2, 3, 4, 3)", counting<double>(72)), "w").vectors,
            grid.vectors);
}

TEST(VectorGridFile, ReadsBigEndianAndLaterVersions) {
  std::vector<float> numbers = counting<float>(24);
  for (float& number : numbers) {
    char raw[4];
    std::memcpy(raw, &number, 4);
    std::swap(raw[0], raw[3]);
    std::swap(raw[1], raw[2]);
    std::memcpy(&number, raw, 4);
  }
  std::string bytes = npy(">f4", "(2, 2, 2, 3)", numbers);
  EXPECT_EQ(read_vector_grid_from(bytes, "w").vectors[7], Vec3(21, 22, 23));
  bytes[6] = 2;
  bytes.insert(10, 2, '\0');  // the length of the header in four bytes
  EXPECT_EQ(read_vector_grid_from(bytes, "w").vectors[7], Vec3(21, 22, 23));
}

TEST(VectorGridFile, NamesWhatIsWrong) {
  const std::vector<float> numbers = counting<float>(24);
  EXPECT_THAT(message("x,y,z\n1,2,3\n"), HasSubstr("not a file of NumPy"));
  EXPECT_THAT(message(""), HasSubstr("not a file of NumPy"));
  EXPECT_THAT(message(npy("<f4", "(24,)", numbers)), HasSubstr("shape is (24)"));
  EXPECT_THAT(message(npy("<f4", "(2, 2, 2, 2)", numbers)), HasSubstr("(nx, ny, nz, 3)"));
  EXPECT_THAT(message(npy("<f4", "(1, 4, 2, 3)", numbers)), HasSubstr("an axis has 1 nodes"));
  EXPECT_THAT(message(npy("<f4", "(2, 2, 4, 3)", numbers)), HasSubstr("96 bytes, but 48 numbers of 4 bytes"));
  EXPECT_THAT(message(npy("<f4", "(4294967296, 4294967296, 2, 3)", numbers)), HasSubstr("96 bytes, but"));
  EXPECT_THAT(message(npy("<c8", "(2, 2, 2, 3)", numbers)), HasSubstr("another type"));
  EXPECT_THAT(message(npy("<f4", "(2, 2, 2, 3)", numbers, "True")), HasSubstr("Fortran"));
  std::vector<float> bad = numbers;
  bad[5] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(message(npy("<f4", "(2, 2, 2, 3)", bad)), HasSubstr("number 5, counted from 0, is not finite"));
  EXPECT_THROW(read_vector_grid("/nowhere/wind.npy"), Error);
}

TEST(VectorGridFile, SurvivesEveryCutAndManyMutations) {
  const std::string whole = npy("<f4", "(2, 2, 2, 3)", counting<float>(24));
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_NE(message(whole.substr(0, size)), "no error");
  std::mt19937 random(3);
  int refused = 0;
  for (int i = 0; i < 20000; ++i) {
    std::string bytes = whole;
    for (int n = 0; n < 3; ++n) bytes[random() % 90] = static_cast<char>(random());
    try {
      read_vector_grid_from(bytes, "w");
    } catch (const Error&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 10000);
}

}  // namespace
}  // namespace muslin
