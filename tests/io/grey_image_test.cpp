#include "muslin/io/grey_image.hpp"

#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "muslin/core/error.hpp"
#include "muslin/render/image.hpp"

namespace muslin {
namespace {

using testing::HasSubstr;

/// Two by two: black and white above, 51 and 102 of 255 below.
std::string four_pixels() {
  Image image(2, 2, {0, 0, 0});
  const auto set = [&](int x, int y, std::uint8_t grey) {
    for (int c = 0; c < 3; ++c) image.pixel(x, y)[c] = grey;
  };
  set(1, 0, 255);
  set(0, 1, 51);
  set(1, 1, 102);
  return encode_png(image);
}

TEST(GreyImage, IsBilinearBetweenTheCentresOfPixels) {
  const GreyImage image = read_grey_image_from(four_pixels(), "four.png");
  ASSERT_EQ(image.width, 2);
  ASSERT_EQ(image.height, 2);
  EXPECT_NEAR(image.at({0.25, 0.75}), 0, 1e-15);
  EXPECT_NEAR(image.at({0.75, 0.75}), 1, 1e-15);
  EXPECT_NEAR(image.at({0.25, 0.25}), 0.2, 1e-15);
  EXPECT_NEAR(image.at({0.75, 0.25}), 0.4, 1e-15);
  EXPECT_NEAR(image.at({0.5, 0.75}), 0.5, 1e-15);
  EXPECT_NEAR(image.at({0.5, 0.5}), 0.4, 1e-15) << "the mean of all four";
  EXPECT_NEAR(image.at({0, 0}), 0.2, 1e-15) << "constant beyond the centres";
  EXPECT_NEAR(image.at({1, 1}), 1, 1e-15);
}

TEST(GreyImage, RefusesWhatIsNoPicture) {
  const auto complaint = [](const std::string& bytes) {
    try {
      read_grey_image_from(bytes, "four.png");
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input);
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_THAT(complaint("P5 2 2"), HasSubstr("four.png: it is no PNG picture"));
  const std::string whole = four_pixels();
  EXPECT_THAT(complaint(whole.substr(0, whole.size() - 30)), HasSubstr("the picture is damaged"));
}

}  // namespace
}  // namespace muslin
